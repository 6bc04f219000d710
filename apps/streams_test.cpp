// Closed and full standard streams, and little memory: what only a process can have.
#include <array>
#include <limits>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

enum class State { open, closed, full };
constexpr std::array states{State::open, State::closed, State::full};

Circumstances streams_of(State in, State out, State err) {
    Circumstances c;
    const std::array all{in, out, err};
    for (int stream = 0; stream < 3; ++stream) {
        if (all[static_cast<std::size_t>(stream)] == State::closed) c.streams[stream] = "";
        if (all[static_cast<std::size_t>(stream)] == State::full) c.streams[stream] = "/dev/full";
    }
    return c;
}

/// A kind of run, and its exit code where streams are as usual.
struct Kind {
    std::string line;
    int code;
    bool writes_stdout;
    std::string file;
};

TEST(Streams, ClosedOnesAndFullOnesLeaveTheRightExitCodeAndWholeFiles) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::array kinds{
        Kind{"--version", 0, true, ""},
        Kind{"pattern box out.ppm --size 8x8", 0, false, "out.ppm"},
        Kind{"pattern box out.ppm --size 8x8 --json", 0, true, "out.ppm"},
        Kind{"pattern box out.png --size 8x8 --json", 0, true, "out.png"},  // by a codec, which takes a while to load
        Kind{"info none.png", 1, false, ""},
        Kind{"frob", 2, false, ""}};
    std::map<std::string, std::string> whole;
    for (const std::string type : {"png", "ppm"}) {
        ASSERT_TRUE(succeeds(shell("pattern box whole." + type + " --size 8x8")));
        whole["out." + type] = bytes_of(shell / ("whole." + type));
    }
    for (const State in : states)
        for (const State out : states)
            for (const State err : states)
                for (const Kind& kind : kinds) {
                    if (kind.file == "out.png" && (in != out || out != err)) continue;
                    const Outcome run = shell.start(kind.line, streams_of(in, out, err));
                    const bool is_lost = kind.writes_stdout && out != State::open;
                    SCOPED_TRACE(kind.line + " " + std::to_string(int(in)) + std::to_string(int(out)) +
                                 std::to_string(int(err)));
                    EXPECT_EQ(run.code, is_lost ? 1 : kind.code) << run;
                    EXPECT_EQ(run.signal, 0);
                    const std::size_t lines = err == State::open && run.code != 0 ? 1 : 0;
                    EXPECT_EQ(stderr_lines(run).size(), lines) << run;
                    if (kind.file.empty()) continue;
                    EXPECT_EQ(bytes_of(shell / kind.file), whole[kind.file]);
                    std::filesystem::remove(shell / kind.file);
                }
    EXPECT_EQ(shell.files(), (std::set<std::string>{"whole.png", "whole.ppm"}));
}

/// The exit code of the program, and what it says, where what it writes to `stream` is read by nobody any more.
Outcome without_reader(const Shell& sh, const std::string& line, const std::string& stream) {
    const std::string program = BANDLIMIT_PROGRAM, to = stream == "stderr" ? " 2>&3 >/dev/null 3>&-" : " >&3 3>&-";
    Outcome run = sh.start({"-c", "{ sleep 0.3; '" + program + "' " + line + to + "; echo $? >code; } 3>&1 | true"});
    run.code = std::stoi(bytes_of(sh / "code"));
    return run;
}

TEST(Streams, AReaderThatHasGoneIsAsAFullDisk) {
    const Shell shell(BANDLIMIT_PROGRAM), sh("/bin/sh");
    EXPECT_TRUE(fails(1, without_reader(sh, "analyze --list", "stdout"), "stdout"));
    EXPECT_EQ(without_reader(sh, "info none.png", "stderr").code, 1);
    // A note must not end the run that tells it.
    AnyImage image = image_of<float>(8, 8, 3, [](int, int, int) { return std::numeric_limits<float>::infinity(); });
    save(sh / "in.exr", image);
    EXPECT_EQ(without_reader(sh, "resize in.exr out.png --scale 1", "stderr").code, 0);
    EXPECT_EQ(sh.files(), (std::set<std::string>{"code", "in.exr", "out.png"}));
}

/// Whether the loader, and the libraries as they initialise, leave enough for main() to begin.
bool reaches_main(const Shell& shell, const std::string& line, const Circumstances& c) {
    ::setenv("LD_DEBUG", "files", 1);
    const Outcome run = shell.start(line, c);
    ::unsetenv("LD_DEBUG");
    return run.err.find("transferring control") != std::string::npos;
}

TEST(Memory, HoweverLittleThereIsARunSucceedsOrSaysSo) {
    if (is_sanitized) GTEST_SKIP() << "a sanitizer maps terabytes for itself";
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("pattern box in.png --size 500x500")));
    struct Case {
        int resource;
        std::string line;
        rlim_t step;  ///< between limits: fractions of what the run allocates by itself
    };
    int failures = 0;
    for (const auto& [resource, line, step] :
         {Case{RLIMIT_AS, "--version", 128 << 10}, Case{RLIMIT_DATA, "--version", 128 << 10},
          Case{RLIMIT_AS, "resize in.png out.png --scale 2 --threads 1", 4 << 20},
          Case{RLIMIT_DATA, "resize in.png out.png --scale 2 --threads 1", 4 << 20}}) {
        const auto run_with = [&, c = line, kind = resource](rlim_t limit) {
            const Outcome run = shell.start(c, {.limits = {{kind, limit}}});
            std::filesystem::remove(shell / "out.png");
            return run;
        };
        rlim_t enough = rlim_t(1) << 30, little = 0;
        while (enough - little > step) {
            const rlim_t between = little + (enough - little) / 2;
            (run_with(between).code == 0 ? enough : little) = between;
        }
        for (int i = 0; i < 8 && enough > step; ++i, enough -= step) {
            const Outcome run = run_with(enough);
            SCOPED_TRACE(line + " with " + std::to_string(enough) + " of " + std::to_string(resource));
            // With less yet it ends before main(): by 127 and words of the loader, or by a signal in a library.
            if (run.code == 127) break;
            if (run.signal != 0 && !reaches_main(shell, line, {.limits = {{resource, enough}}})) break;
            EXPECT_EQ(run.signal, 0) << run;
            if (run.code == 0) continue;
            ++failures;
            // A thread for which there is no room is refused by the system.
            EXPECT_TRUE(fails(1, run, run.err.find("system refuses") == std::string::npos ? "memory" : "system"));
        }
    }
    EXPECT_GT(failures, 0);
    EXPECT_EQ(shell.files(), std::set<std::string>{"in.png"});
}

}  // namespace
}  // namespace bandlimit
