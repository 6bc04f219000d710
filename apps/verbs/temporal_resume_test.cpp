// Runs over frames that end before their time, and go on.
#include <csignal>
#include <fstream>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int frames = 8;
const std::string checkpoint = ".bandlimit-temporal";

std::string frame_name(int i) { return "f_" + std::to_string(100 + i) + ".exr"; }

/// Frames of a scene in "in", what they should be in "truth", and their jitter in meta.json.
void add_sequence(const Shell& shell) {
    fs::create_directory(shell / "in");
    fs::create_directory(shell / "truth");
    json jitter = json::array();
    for (int i = 0; i < frames; ++i) {
        jitter.push_back({(i * 3 % 4 - 1.5) / 4, (i * 5 % 8 - 3.5) / 8});
        const std::string line = "mover in/" + frame_name(i) + " --size 24x18 --frame " + std::to_string(i);
        ASSERT_TRUE(succeeds(
            shell("pattern " + line + " --spp 1 --jitter " + jitter.back()[0].dump() + "," + jitter.back()[1].dump())));
        ASSERT_TRUE(succeeds(
            shell("pattern mover truth/" + frame_name(i) + " --size 48x36 --spp 4 --frame " + std::to_string(i))));
    }
    std::ofstream(shell / "meta.json") << json{{"sequences", {{"in", {{"jitter", jitter}}}}}}.dump();
}

/// Cuts a file in half while `work` runs; its time stays as it was.
template <class Work>
void with_cut_file(const std::string& path, const Work& work) {
    const std::string bytes = bytes_of(path);
    const fs::file_time_type time = fs::last_write_time(path);
    write_bytes(path, bytes.substr(0, bytes.size() / 2));
    work();
    write_bytes(path, bytes);
    fs::last_write_time(path, time);
}

std::set<std::string> names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
    return names;
}

/// What is there when the run ended at frame `count`.
std::set<std::string> first_frames(int count) {
    std::set<std::string> names;
    for (int i = 0; i < count; ++i) names.insert(frame_name(i));
    if (count > 0) names.insert(checkpoint);
    return names;
}

/// Without what a clock decides.
json lasting(json report) {
    for (const char* key : {"seconds", "ms_per_frame", "continued_at", "output"}) report.erase(key);
    for (json& frame : report["frames"]) frame.erase("ms");
    return report;
}

class TemporalResume : public ::testing::Test {
protected:
    void SetUp() override { add_sequence(shell); }
    /// Ends at frame `at`.
    void interrupt(const std::string& line, int at) const {
        with_cut_file(shell / ("in/" + frame_name(at)),
                      [&] { EXPECT_TRUE(fails(1, shell(line), frame_name(at))) << line; });
        EXPECT_EQ(names_in(shell / "out"), first_frames(at));
    }
    void interrupt_anew(const std::string& line, int at) const {
        fs::remove_all(shell / "out");
        interrupt(line, at);
    }
    std::string frame(const std::string& folder, int i) const { return shell / (folder + "/" + frame_name(i)); }
    /// Whether the next run goes on at frame `at`, or begins again (0), and ends as it should.
    void expect_next(const std::string& line, int at, const std::string& wanted = "whole") const {
        const Outcome run = shell(line + " --json");
        ASSERT_TRUE(succeeds(run));
        EXPECT_EQ(run.json()["continued_at"], at == 0 ? json() : json(100 + at));
        for (int i = 0; i < frames; ++i) EXPECT_EQ(bytes_of(frame("out", i)), bytes_of(frame(wanted, i))) << i;
        EXPECT_FALSE(fs::exists(shell / ("out/" + checkpoint)));
    }

    const std::string options = " --meta meta.json --scale 2 --reference truth";
    const Shell shell{BANDLIMIT_PROGRAM};
};

TEST_F(TemporalResume, GoesOnAfterAnErrorWithTheSameBytes) {
    ASSERT_TRUE(succeeds(shell("temporal in whole" + options + " --report whole/report")));
    for (const int at : {1, 5, 7}) {
        const std::string line = "temporal in out" + options + " --report report";
        interrupt(line, at);
        const fs::file_time_type before = fs::last_write_time(frame("out", at - 1));
        const Outcome run = shell(line);
        ASSERT_TRUE(succeeds(run));
        EXPECT_NE(run.out.find("continued at frame " + std::to_string(100 + at)), std::string::npos) << run;
        EXPECT_EQ(fs::last_write_time(frame("out", at - 1)), before) << "made again";
        std::set<std::string> all = first_frames(frames);
        all.erase(checkpoint);
        EXPECT_EQ(names_in(shell / "out"), all);
        for (int i = 0; i < frames; ++i) EXPECT_EQ(bytes_of(frame("out", i)), bytes_of(frame("whole", i))) << i;
        EXPECT_EQ(lasting(json::parse(bytes_of(shell / "report/report.json"))),
                  lasting(json::parse(bytes_of(shell / "whole/report/report.json"))));
        for (const std::string picture : {"animation.png", "sheet.png", "memory.png", "weight.png", "rejection.png",
                                          "motion.png", "disocclusion.png", "last.png"})
            EXPECT_EQ(bytes_of(shell / ("report/" + picture)), bytes_of(shell / ("whole/report/" + picture)))
                << picture;
        fs::remove_all(shell / "out");
    }
}

// Twice stopped is once stopped.
TEST_F(TemporalResume, GoesOnAgainAndAgain) {
    ASSERT_TRUE(succeeds(shell("temporal in whole" + options)));
    const std::string line = "temporal in out" + options;
    interrupt(line, 2);
    interrupt(line, 3);
    interrupt(line, 6);
    expect_next(line, 6);
}

TEST_F(TemporalResume, GoesOnAfterASignal) {
    if (is_sanitized) GTEST_SKIP() << "takes long to start";
    const std::string line = "temporal glyphs out --size 48x32 --scale 2 --frames 40";
    ASSERT_TRUE(succeeds(shell("temporal glyphs whole --size 48x32 --scale 2 --frames 40")));
    for (const int signal : {SIGINT, SIGKILL}) {
        fs::remove_all(shell / "out");
        const Outcome stopped =
            shell.start(line, {.meanwhile = [&](pid_t child) {
                            return fs::exists(shell / "out/frame_007.exr") && ::kill(child, signal) == 0;
                        }});
        ASSERT_EQ(stopped.signal, signal) << stopped;
        const Outcome run = shell(line + " --json");
        ASSERT_TRUE(succeeds(run));
        EXPECT_GE(run.json()["continued_at"].get<int>(), 7) << "frame 7 is there; it may not have been noted";
        for (const std::string& name : names_in(shell / "whole"))
            EXPECT_EQ(bytes_of(shell / ("out/" + name)), bytes_of(shell / ("whole/" + name))) << name;
        EXPECT_FALSE(fs::exists(shell / ("out/" + checkpoint)));
    }
}

TEST_F(TemporalResume, BeginsAgainWhereAnythingChanged) {
    const std::string line = "temporal in out" + options;
    ASSERT_TRUE(succeeds(shell("temporal in whole" + options)));
    ASSERT_TRUE(succeeds(shell("temporal in sharp" + options + " --preset sharp")));
    interrupt_anew(line, 4);
    expect_next(line + " --preset sharp", 0, "sharp");
    interrupt_anew(line, 4);
    fs::last_write_time(frame("in", 2), fs::file_time_type::clock::now());  // another picture, for all that is known
    expect_next(line, 0);
    interrupt_anew(line, 4);
    fs::remove(frame("out", 1));
    expect_next(line, 0);
    interrupt_anew(line, 4);
    write_bytes(frame("out", 3), "something else");
    expect_next(line, 0);
    interrupt_anew(line, 4);
    std::ofstream(shell / "meta.json", std::ios::app) << "\n";
    expect_next(line, 0);
    expect_next(line, 0);  // after a run that is complete
}

// What others put there is no history: a run begins again, and ends well.
TEST_F(TemporalResume, ChecksWhatItFinds) {
    const std::string line = "temporal in out" + options, path = shell / ("out/" + checkpoint);
    ASSERT_TRUE(succeeds(shell("temporal in whole" + options)));
    interrupt(line, 4);
    const std::string good = bytes_of(path);
    fs::rename(shell / "out", shell / "kept");
    std::vector<std::string> bad{"",
                                 "bandlimit temporal 1\n",
                                 std::string(1000, '\xff'),
                                 good.substr(0, 40),
                                 good.substr(0, good.size() / 2),
                                 good.substr(0, good.size() - 1),
                                 good + "x"};
    Random random(11);
    for (int i = 0; i < 5; ++i) {
        bad.push_back(good);
        bad.back()[static_cast<std::size_t>(random.integer(0, static_cast<int>(good.size()) - 1))] ^= 0x41;
    }
    std::string huge = good;  // a length of 2^63
    huge[21 + 7] = '\x80';
    bad.push_back(huge);
    for (const std::string& bytes : bad) {
        fs::remove_all(shell / "out");
        fs::copy(shell / "kept", shell / "out");
        for (int i = 0; i < 4; ++i) fs::last_write_time(frame("out", i), fs::last_write_time(frame("kept", i)));
        write_bytes(path, bytes);
        expect_next(line, 0);
    }
    fs::remove_all(shell / "out");
    fs::rename(shell / "kept", shell / "out");
    expect_next(line, 4);
}

}  // namespace
}  // namespace bandlimit
