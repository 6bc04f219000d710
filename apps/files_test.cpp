// Files in odd places: no pictures but pipes and devices, names that are no text, batches cut short, sizes without
// sense.
#include <sys/stat.h>

#include <cstdlib>

#include "apps/run_program_test.h"
#include "bandlimit/texture/container.h"

namespace bandlimit {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

void save_noise(const std::string& path, int channels = 3, int width = 40, int height = 30) {
    AnyImage image = noise(Depth::u8, width, height, channels);
    save(path, image);
}

/// Things that are no regular files, in a folder: reading some would wait for ever, reading others never end.
std::vector<std::string> make_no_files(const Shell& shell) {
    EXPECT_EQ(::mkfifo((shell / "pipe").c_str(), 0600), 0);
    fs::create_directory(shell / "folder");
    for (const std::string end : {".png", ".json", ".ktx2"}) {
        fs::create_symlink("pipe", shell / ("pipe" + end));
        fs::create_symlink("/dev/zero", shell / ("zero" + end));
        fs::create_symlink("folder", shell / ("folder" + end));
        fs::create_symlink("circle" + end, shell / ("circle" + end));
    }
    return {"pipe", "zero", "folder", "circle"};
}

TEST(Files, EveryVerbRefusesToReadWhatIsNoRegularFile) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in.png");
    fs::create_directory(shell / "pictures");
    const std::vector<std::string> kinds = make_no_files(shell);
    for (const std::string line : {"resize X.png out.png --size 9x9",
                                   "resize in.png out.png --size 9x9 --kernel X.json",
                                   "convolve X.png out.png --taps X.json",
                                   "convolve in.png out.png --taps X.json",
                                   "convolve in.png out.png --image X.png",
                                   "bokeh X.png out.png --radius 3",
                                   "bokeh in.png out.png --radius 3 --shape X.png",
                                   "bilateral X.png out.png --sigma-space 1 --sigma-range 1",
                                   "bilateral in.png out.png --sigma-space 1 --sigma-range 1 --guide X.png",
                                   "bilateral in.png out.png --sigma-space 1 --sigma-range 1 --guide-full X.png",
                                   "gradients X.png out.png",
                                   "gradients in.png out.exr --operator taps:X.json",
                                   "mips X.png out.ktx2",
                                   "mips X.ktx2 out.dds",
                                   "mips X.ktx2 out.dds --keep-levels",
                                   "mips in.png out.ktx2 --filter X.json",
                                   "mips in.png out.ktx2 --role roughness --normal X.png",
                                   "mips --batch pictures out --rules X.json",
                                   "compare X.png in.png",
                                   "compare in.png X.png",
                                   "analyze X.json",
                                   "info X.png",
                                   "info X.ktx2"})
        for (const std::string& kind : kinds) {
            std::string words = line;
            for (std::size_t at = 0; (at = words.find('X', at)) != words.npos;) words.replace(at, 1, kind);
            EXPECT_TRUE(fails(1, shell(words), kind)) << words;
        }
}

TEST(Files, ABatchListsWhatIsNoRegularFile) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::vector<std::string> kinds = make_no_files(shell);
    fs::create_directory(shell / "in");
    save_noise(shell / "in/good.png");
    for (const std::string kind : {"pipe", "zero", "circle"})
        fs::rename(shell / (kind + ".png"), shell / ("in/" + kind + ".png"));
    fs::rename(shell / "pipe", shell / "in/pipe");
    const Outcome run = shell("mips --batch in out --json");
    EXPECT_EQ(run.code, 1) << run;
    EXPECT_EQ(run.json()["made"], 1);
    EXPECT_EQ(run.json()["failed"].size(), 3u) << run;
    // Nor is a manifest read that never ends.
    fs::remove(shell / "out/.bandlimit-mips.json");
    fs::create_symlink("/dev/zero", shell / "out/.bandlimit-mips.json");
    EXPECT_TRUE(fails(1, shell("mips --batch in out"), ".bandlimit-mips.json"));
}

TEST(Files, APictureWhoseNameIsNoTextIsMadeOnce) {
    const Shell shell(BANDLIMIT_PROGRAM);
    fs::create_directory(shell / "in");
    for (const std::string name : {"latin-\xe4", "other-\xe5", "utf-\xc3\xa4", "per%41cent", "line\nbreak"})
        save_noise(shell / ("in/" + name + ".png"));
    for (const int made : {5, 0, 0}) {
        const Outcome run = shell("mips --batch in out --role color --json");
        ASSERT_EQ(run.code, 0) << run;
        EXPECT_EQ(run.json()["made"], made);
    }
    save_noise(shell / "in/other-\xe5.png", 4);
    EXPECT_EQ(shell("mips --batch in out --role color --json").json()["made"], 1);
}

TEST(Files, AnArrayOfOnePictureIsTheSameByRowsAndWhole) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in.png");
    // A picture is read row by row, a texture as a whole.
    ASSERT_TRUE(succeeds(shell("mips in.png in.ktx2 --levels 1 --role color")));
    constexpr std::size_t at_layers = 32;
    for (const std::string kind : {"ktx2", "dds"})
        for (const std::string option : {"", " --array"}) {
            ASSERT_TRUE(succeeds(shell("mips in.png rows." + kind + " --role color" + option)));
            ASSERT_TRUE(succeeds(shell("mips in.ktx2 whole." + kind + " --role color" + option)));
            const std::string rows = bytes_of(shell / ("rows." + kind));
            EXPECT_EQ(rows, bytes_of(shell / ("whole." + kind))) << kind << option;
            // 0 for what is no array, as the specification of KTX2 asks.
            if (kind == "ktx2") {
                EXPECT_EQ(rows[at_layers], option.empty() ? 0 : 1);
            }
        }
}

TEST(Files, WeightsWithoutSenseTakeLittleMemoryOrAreRefused) {
    // 12,000 weights in 60 kB stand for 144 million in two dimensions.
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in.png");
    const json long_row(std::vector<int>(12000, 1)), point(std::vector<int>(1, 1));
    const auto write = [&](const std::string& name, json content) {
        content["version"] = 1, content["kind"] = "a";
        write_bytes(shell / name, content.dump());
    };
    write("taps.json", {{"taps", {{"first", 0}, {"weights", long_row}}}});
    write("terms.json", {{"terms", json::array({{{"column", long_row}, {"row", long_row}}})}});
    Circumstances limited;
    if (!is_sanitized) limited.limits = {{RLIMIT_AS, rlim_t{1} << 30}};  // a sanitizer maps terabytes for itself
    for (const std::string line :
         {"convolve in.png out.png --taps taps.json --edge reflect --threads 1",
          "convolve in.png out.png --taps terms.json --edge reflect --threads 1",
          "resize in.png out.png --size 40x30 --kernel taps.json --threads 1", "analyze taps.json"})
        EXPECT_EQ(shell(line, limited).code, 0) << line;
    EXPECT_TRUE(fails(1, shell("analyze terms.json", limited), "12000 x 12000"));
    EXPECT_TRUE(fails(1, shell("convolve in.png out.png --taps terms.json --rank 3", limited), "12000 x 12000"));
}

TEST(Files, ABatchThatIsInterruptedLeavesNothingUnfinished) {
    const Shell shell(BANDLIMIT_PROGRAM);
    constexpr int pictures = 40, rounds = 30;
    fs::create_directory(shell / "in");
    for (int i = 0; i < pictures; ++i) save_noise(shell / ("in/" + std::to_string(i) + ".png"));
    for (int round = 0; round < rounds; ++round) {
        fs::remove_all(shell / "out");
        // Once the first texture is there, the others are on their way.
        const auto interrupt = [&](pid_t process) {
            std::error_code error;
            if (fs::is_empty(shell / "out", error) || error) return false;
            std::this_thread::sleep_for(std::chrono::microseconds(300 * round));
            ::kill(process, SIGINT);
            return true;
        };
        shell("mips --batch in out --role color --threads 4", {.meanwhile = interrupt});
        for (const auto& entry : fs::directory_iterator(shell / "out")) {
            const std::string name = entry.path().filename();
            ASSERT_TRUE(name == ".bandlimit-mips.json" || (name.ends_with(".ktx2") && name.front() != '.'))
                << "round " << round << ": " << name;
        }
    }
}

TEST(Files, AuditedCommandsGetPathsThatNoShellTakesApart) {
    const Shell shell(BANDLIMIT_PROGRAM);
    // Were it run, it would end the program.
    const std::string place = shell / "a b$(kill -9 $PPID)`kill -9 $PPID`'\"&;|<*";
    fs::create_directory(place);
    ::setenv("TMPDIR", place.c_str(), 1);
    for (const std::string names : {"{in} {out}", "\"{in}\" '{out}'", "'{in}' \"{out}\""}) {
        const Outcome run = shell.start(
            {"audit", "bandlimit resize " + names + " --size \"{width}x{height}\"", "--scales", "2", "--grey"});
        EXPECT_TRUE(succeeds(run)) << names;
    }
    EXPECT_TRUE(fs::is_empty(place));
    ::unsetenv("TMPDIR");
    fs::create_directory(shell / "$(kill -9 $PPID)");
    EXPECT_TRUE(succeeds(shell.start({"audit", "bandlimit resize \"{in}\" \"{out}\" --size {width}x{height}",
                                      "--scales", "2", "--grey", "--keep", "$(kill -9 $PPID)"})));
    EXPECT_TRUE(fs::exists(shell / "$(kill -9 $PPID)/01-out.png"));
    fs::create_directory(shell / "a$(echo)b");  // nothing in it but what names have, and the dollar
    EXPECT_TRUE(succeeds(shell.start({"audit", "bandlimit resize {in} {out} --size {width}x{height}", "--scales", "2",
                                      "--grey", "--keep", "a$(echo)b"})));
    EXPECT_TRUE(fails(2, shell("audit 'x {in} {width} -o {out}.png'"), "option format"));
}

}  // namespace
}  // namespace bandlimit
