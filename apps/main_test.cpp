// The command line as such: usage, help, examples, streams.
#include <array>
#include <limits>

#include "apps/run_program_test.h"
#include "bandlimit/core/sanitized_test.h"

namespace bandlimit {
namespace {

const std::array kinds{"zoneplate", "siemens", "chirp", "edge",  "stripes", "checker", "box",   "disc",      "ramp",
                       "impulse",   "line",    "noise", "fence", "glyphs",  "plane",   "mover", "highlight", "foliage"};
const std::array verbs{"resize",      "convolve", "bokeh",  "bilateral", "guided",  "gradients", "mips", "pattern",
                       "supersample", "temporal", "raster", "compare",   "analyze", "audit",     "info", "tour"};

/// A folder in which examples work as pasted.
void add_examples(const Shell& shell) {
    std::filesystem::copy(BANDLIMIT_EXAMPLES, shell / "examples", std::filesystem::copy_options::recursive);
}

TEST(CommandLine, WhatItAloneShowsToBeWrongIsExitCode2) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_examples(shell);
    const std::string resize = "resize examples/coffee.png out.png ", pattern = "pattern checker out.png --size 8x8 ";
    const std::string compare = "compare examples/coffee.png examples/coffee.png ";
    struct Case {
        std::string line, word;
    };
    for (const auto& [line, word] : {
             Case{"",
                  "resize, convolve, bokeh, bilateral, guided, gradients, mips, pattern, supersample, temporal, "
                  "raster, compare, "
                  "analyze, "
                  "design, "
                  "audit, "
                  "info, tour"},
             {"frob", "\"frob\" is not a verb"},
             {"--bogus " + resize + "--scale 1", "--bogus"},
             {"resize", "IN"},
             {resize, "--size"},
             {resize + "--size 8x8 --scale 1", "exactly once"},
             {resize + "--size 8x8 --width 8", "exactly once"},
             {resize + "--size 0x0", "0x0"},
             {resize + "--size 8x", "8x"},
             {resize + "--size 99999999999x1", "99999999999x1"},
             {resize + "--width 0", "--width"},
             {resize + "--scale 0", "--scale"},
             {resize + "--scale nan", "--scale"},
             {resize + "--scale 1/0", "--scale"},
             {resize + "--scale 1e30", "2147483647"},
             {resize + "--scale 1 --kernel bicubic", "bspline, catmull-rom, mitchell or cubic:B:C"},
             {resize + "--scale 1 --kernel none", "nearest, box, tent, quadratic"},
             {resize + "--scale 1 --edge mirror", "clamp, reflect, wrap, zero or renormalize"},
             {resize + "--scale 1 --align middle", "corners or centers"},
             {resize + "--scale 1 --space rgb", "auto, srgb, linear or data"},
             {resize + "--scale 1 --alpha none", "premultiply or straight"},
             {resize + "--scale 1 --depth u32", "u8, u16, f16 or f32"},
             {resize + "--scale 1 --antiring 1.5", "--antiring"},
             {resize + "--scale 1 --antiring nan", "--antiring"},
             {resize + "--scale 1 --threads -1", "--threads"},
             {resize + "--scale 1 --region 1,2,3", "--region"},
             {resize + "--scale 1 --region 1,2,0,5", "--region"},
             {resize + "--scale 1 more", "more"},
             {resize + "--scale 1 --bogus", "--bogus"},
             {"resize examples/coffee.png out.xyz --scale 1", "png, jpg, tif, exr"},
             {"resize examples/coffee.png out --scale 1", "png, jpg, tif, exr"},
             {"pattern", "zoneplate"},
             {"pattern moire out.png --size 8x8", "\"moire\" is not a kind of signal"},
             {"pattern --bogus checker out.png --size 8x8", "--bogus"},
             {"pattern checker out.png", "--size"},
             {pattern + "--cell 0", "checkerboard"},
             {pattern + "--samples 0", "--samples"},
             {"pattern siemens out.png --size 8x8 --antialias exact", "siemens"},
             {"pattern noise out.png --size 8x8 --seed -1", "--seed"},
             {"pattern checker out.jpg --size 8x8 --depth u16", "u8"},
             {compare + "--border -1", "--border"},
             {compare + "--measure codes", "encoded or linear"},
             {compare + "--diff out.xyz", "png, jpg, tif, exr"},
             {"analyze", "--list"},
             {"analyze none", "nearest, box, tent, quadratic"},
             {"analyze gaussian:0", "sigma"},
             {"analyze tent --phase 1", "--phase"},
             {"analyze tent --at 1,,2", "--at"},
             {"analyze tent --frequency 1e308", "--frequency"},
             {"analyze tent --from 4", "--to"},
             {"analyze tent --from 4 --to 2 --rows 2", "--rows"},
             {"analyze tent --rows 0", "--rows"},
             {"analyze jinc2 --from 4 --to 2", "radial"},
             {"analyze tent --plot out.bmp", ".svg or .png"},
             {"audit", "COMMAND"},
             {"tour", "DIR"},
         })
        EXPECT_TRUE(fails(2, shell(line), word)) << "bandlimit " << line;
    EXPECT_EQ(shell.files(), std::set<std::string>{"examples"});
}

TEST(CommandLine, VersionAndHelp) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome version = shell("--version");
    ASSERT_TRUE(succeeds(version));
    EXPECT_TRUE(version.out.starts_with("bandlimit ")) << version;
    EXPECT_EQ(std::count(version.out.begin(), version.out.end(), '\n'), 1);
    const Outcome help = shell("--help");
    ASSERT_TRUE(succeeds(help));
    for (const std::string verb : verbs) EXPECT_NE(help.out.find(verb), std::string::npos) << verb;
    EXPECT_NE(shell("resize --help").out.find("align_corners"), std::string::npos);
    EXPECT_TRUE(shell.files().empty());
}

/// The commands that help ends with, without the program's name.
std::vector<std::string> examples_of(const Outcome& help) {
    const std::string heading = "Example:\n", mark = "  bandlimit ";
    std::vector<std::string> examples;
    const auto begin = help.out.find(heading);
    if (begin == std::string::npos) return examples;
    std::istringstream lines(help.out.substr(begin + heading.size()));
    for (std::string line; std::getline(lines, line) && line.starts_with(mark);)
        examples.push_back(line.substr(mark.size()));
    return examples;
}

TEST(CommandLine, TheExamplesOfEveryHelpWorkAsPasted) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_examples(shell);
    std::vector<std::string> commands(verbs.begin(), verbs.end());
    std::erase(commands, "tour");  // has a test of its own: it takes longest
    for (const std::string kind : kinds) commands.push_back("pattern " + kind);
    for (const std::string& command : commands) {
        const Outcome help = shell(command + " --help");
        ASSERT_TRUE(succeeds(help)) << command;
        const std::vector<std::string> examples = examples_of(help);
        ASSERT_FALSE(examples.empty()) << help;
        for (const std::string& example : examples) {
            EXPECT_TRUE(example.starts_with(command)) << help;
            // An audit of the program finds it beside itself.
            EXPECT_TRUE(succeeds(command == "audit" ? shell.start(example) : shell(example))) << example;
        }
    }
    EXPECT_EQ(shell.files().count("half.png") + shell.files().count("bspline.svg"), 2u);
}

TEST(CommandLine, TheTourIsAPageWithItsPictures) {
    if (is_sanitized) GTEST_SKIP() << "takes minutes there, and its parts are tested by themselves";
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome help = shell("tour --help");
    ASSERT_EQ(examples_of(help), std::vector<std::string>{"tour out"});
    const Outcome tour = shell.start("tour out");  // it runs the program too
    ASSERT_TRUE(succeeds(tour));
    EXPECT_NE(tour.out.find("out/index.html"), std::string::npos) << tour;
    const std::string page = bytes_of(shell / "out/index.html");
    int pictures = 0;
    for (auto at = page.find("src=\""); at != std::string::npos; at = page.find("src=\"", at + 1)) {
        const std::string name = page.substr(at + 5, page.find('"', at + 5) - at - 5);
        EXPECT_TRUE(std::filesystem::exists(shell / ("out/" + name))) << name;
        ++pictures;
    }
    EXPECT_GT(pictures, 10);
    EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org"));  // self-contained
    EXPECT_EQ(shell.files(), std::set<std::string>{"out"});
    for (const auto& entry : std::filesystem::directory_iterator(shell / "out"))
        EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
}

TEST(CommandLine, NothingOutlastsARun) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = image_of<float>(8, 8, 3, [](int, int, int) { return std::numeric_limits<float>::infinity(); });
    save(shell / "in.exr", image);
    const std::string line = "resize in.exr out.png --scale 1";
    EXPECT_EQ(stderr_lines(shell(line)).size(), 1u);
    EXPECT_EQ(stderr_lines(shell(line + " --quiet")).size(), 0u);
    EXPECT_EQ(stderr_lines(shell(line)).size(), 1u);
}

TEST(CommandLine, TheProgramSaysWhatTheFunctionSays) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_examples(shell);
    for (const std::string line : {"--version", "--help", "resize --help", "info examples/coffee.png", "info none.png",
                                   "resize", "", "compare examples/coffee.png examples/coffee.png --json"}) {
        const Outcome here = shell(line), started = shell.start(line);
        EXPECT_EQ(started.code, here.code) << line;
        EXPECT_EQ(started.out, here.out) << line;
        EXPECT_EQ(stderr_lines(started), stderr_lines(here)) << line;
    }
}

TEST(CommandLine, AReportThatCannotBeWrittenIsExitCode1) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_examples(shell);
    for (const std::string line :
         {"resize examples/gravel.png out.png --scale 0.1 --json", "info examples/coffee.png",
          "compare examples/gravel.png examples/gravel.png --json", "analyze tent --from 900 --to 300",
          "pattern box out.png --size 8x8 --json", "--version", "resize --help"})
        EXPECT_TRUE(fails(1, shell(line, {.streams = {{STDOUT_FILENO, "/dev/full"}}}), "stdout")) << line;
    for (const std::string line : {"resize examples/gravel.png out.png --scale 0.1 --json", "analyze --list", "--help"})
        EXPECT_TRUE(fails(1, shell(line, {.streams = {{STDOUT_FILENO, ""}}}), "stdout")) << line;
}

TEST(CommandLine, ClosedStreamsDoNotReachFiles) {
    // The first file that is opened must not take the place of stdout.
    const Shell shell(BANDLIMIT_PROGRAM);
    EXPECT_EQ(shell("pattern box out.png --size 8x8", {.streams = {{STDOUT_FILENO, ""}}}).code, 0);
    EXPECT_EQ(read_image(shell / "out.png").index(), std::size_t(Depth::u8));
}

}  // namespace
}  // namespace bandlimit
