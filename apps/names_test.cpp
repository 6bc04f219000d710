// Names and values that try to do something to the terminal, in every verb.
#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

/// Clears the screen, rings, goes back to the start of the line, begins a new one, and is no UTF-8.
const std::string nasty = "\x1b[2J\x07\r\n\x7f\xc2\x9b\xff";

/// Whether nothing but text and line breaks reaches the terminal, and no words of libraries do.
void expect_plain(const Outcome& run, int lines_of_errors) {
    for (const std::string& text : {run.out, run.err}) EXPECT_EQ(app::visible(text, true), text);
    for (const char* words : {"[json.exception", "basic_filebuf", "unknown reason", "filesystem error",
                              "std::", "not convert", "were not expected", "was not expected", "TEXT", "terminate"})
        EXPECT_EQ(run.err.find(words), std::string::npos) << run;
    if (lines_of_errors == 0) return;
    EXPECT_EQ(stderr_lines(run).size(), std::size_t(lines_of_errors)) << run;
    EXPECT_NE(run.err.find("; "), std::string::npos) << run;
}

/// Command lines of every verb, where N stands for the nasty name. The arguments are separated by blanks.
TEST(Names, OfEveryVerbReachTheTerminalEscaped) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 8, 8, 4);
    save(shell / "in.png", image);
    write_bytes(shell / "text.json", "no JSON");
    write_bytes(shell / "number.json", "7");
    for (const std::string line : {"N",
                                   "N.png N",
                                   "--N",
                                   "info N",
                                   "info N.png",
                                   "info in.png N",
                                   "info in.png --N",
                                   "info in.png --json=N",
                                   "info",
                                   "resize N.png out.png --scale 1",
                                   "resize in.png N --scale 1",
                                   "resize in.png N/out.png --scale 1",
                                   "resize in.png out.N --scale 1",
                                   "resize in.png out.png --size N",
                                   "resize in.png out.png --scale N",
                                   "resize in.png out.png --width N",
                                   "resize in.png out.png --width 1e400",
                                   "resize in.png out.png --width",
                                   "resize in.png out.png --scale 1 --scale 2",
                                   "resize in.png out.png --scale 1 --kernel N",
                                   "resize in.png out.png --scale 1 --kernel N.json",
                                   "resize in.png out.png --scale 1 --kernel text.json",
                                   "resize in.png out.png --scale 1 --kernel number.json",
                                   "resize in.png out.png --scale 1 --kernel .",
                                   "resize in.png out.png --scale 1 --edge N",
                                   "resize in.png out.png --scale 1 --space N",
                                   "resize in.png out.png --scale 1 --alpha N",
                                   "resize in.png out.png --scale 1 --align N",
                                   "resize in.png out.png --scale 1 --depth N",
                                   "resize in.png out.png --scale 1 --region N",
                                   "resize in.png out.png --scale 1 --antiring N",
                                   "resize in.png out.png --scale 1 --background N",
                                   "resize in.png out.png --scale 1 --tiles N",
                                   "resize in.png out.png --scale 1 --threads N",
                                   "resize in.png out.png --scale 1 --threads -7",
                                   "resize in.png out.png --scale 1 --quiet=N",
                                   "convolve N.png out.png --taps N.json",
                                   "convolve in.png out.png --taps N.json",
                                   "convolve in.png out.png --taps text.json",
                                   "convolve in.png out.png --image N",
                                   "convolve in.png out.png --image N --axis N",
                                   "convolve in.png out.png --image in.png --rank 2 --exact",
                                   "bilateral in.png out.png --sigma-space N --sigma-range 1",
                                   "bilateral in.png out.png --sigma-space 1 --sigma-range N",
                                   "bilateral in.png out.png --sigma-space 1 --sigma-range 1 --guide N",
                                   "raster N.json out.png",
                                   "raster text.json out.png",
                                   "raster number.json out.png",
                                   "raster number.json N",
                                   "raster number.json out.png --filter N",
                                   "raster number.json out.png --truth N",
                                   "bokeh N.png out.png --radius 2",
                                   "bokeh in.png out.png --radius N",
                                   "bokeh in.png out.png --radius 2 --shape N",
                                   "bokeh in.png out.png --radius 2 --shape N.png",
                                   "mips N.png out.ktx2",
                                   "mips in.png N",
                                   "mips in.png N.xyz",
                                   "mips in.png N/out.ktx2",
                                   "mips in.png out.ktx2 --role N",
                                   "mips in.png out.ktx2 --filter N",
                                   "mips in.png out.ktx2 --format ktx2",
                                   "mips in.png N out.ktx2",
                                   "mips N",
                                   "mips --batch N out",
                                   "mips --batch in.png out",
                                   "mips --batch . out --rules N",
                                   "mips --batch . out --rules text.json",
                                   "mips --batch . out --rules number.json",
                                   "mips --batch . out --memory N",
                                   "mips --batch . out --format N",
                                   "pattern N",
                                   "pattern box N --size 8x8",
                                   "pattern box N/out.png --size 8x8",
                                   "pattern box out.png --size N",
                                   "pattern box out.png --size 8x8 --antialias N",
                                   "pattern box out.png --size 8x8 --region N",
                                   "pattern box out.png --size 8x8 --low N",
                                   "pattern noise out.png --size 8x8 --seed N",
                                   "supersample N out.png --size 8x8",
                                   "supersample edge out.png --size 8x8 --pattern N",
                                   "supersample edge out.png --size 8x8 --kernel N",
                                   "supersample edge out.png --size 8x8 --mixed N",
                                   "analyze --pattern N",
                                   "compare N in.png",
                                   "compare in.png N",
                                   "compare in.png in.png --diff N",
                                   "compare in.png in.png --measure N",
                                   "compare in.png in.png --border N",
                                   "analyze N",
                                   "analyze N.json",
                                   "analyze text.json",
                                   "analyze number.json",
                                   "analyze tent --phase N",
                                   "analyze tent --plot N",
                                   "analyze tent --plot N/out.svg",
                                   "analyze tent --emit N",
                                   "design N",
                                   "design downsample -o N",
                                   "design downsample -o N/taps.json",
                                   "design downsample --emit glsl --name N",
                                   "design downsample --emit-to N",
                                   "design downsample --fetches N",
                                   "design downsample --layout N",
                                   "design separable N",
                                   "design separable N.png",
                                   "design disk --radius N",
                                   "design gaussian --sigma N",
                                   "design sharpen --undo N",
                                   "design kernel --for N",
                                   "design derivative --optimal N",
                                   "audit N",
                                   "audit cp_{in}_{out}_{scale} --scales N",
                                   "audit cp_{in}_{out}_{scale} --format N",
                                   "audit cp_{in}_{out}_{scale} --html N/page",
                                   "audit N{in}_{out}_{scale}",
                                   "tour N/out",
                                   "tour in.png"}) {
        std::vector<std::string> words = words_of(line);
        for (std::string& word : words)
            for (auto at = word.find('N'); at != word.npos; at = word.find('N', at + nasty.size()))
                word.replace(at, 1, nasty);
        SCOPED_TRACE(line);
        const Outcome run = shell.run(words);
        EXPECT_NE(run.code, 0) << run;
        expect_plain(run, 1);
    }
}

TEST(Names, OfThatWhichWorksAreEscapedToo) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::string name = nasty + "_n.png";
    AnyImage image = noise(Depth::u8, 8, 8, 3);
    save(shell / "in.png", image);
    std::filesystem::create_directory(shell / "in");
    save(shell / ("in/" + name), image);
    write_bytes(shell / "in/\x1b.png", "not a picture");
    std::filesystem::copy_file(shell / ("in/" + name), shell / name);
    struct Case {
        std::vector<std::string> words;
        int code = 0;
    };
    for (const auto& [words, code] : {
             Case{{"info", name}},
             {{"info", "--json", name}},
             {{"compare", name, name}},
             {{"compare", "--json", name, name}},
             {{"resize", name, "\x1b.png", "--scale", "1", "--json"}},
             {{"mips", name, nasty + ".ktx2"}},
             {{"mips", name, nasty + "%d.png"}},
             {{"mips", name, "--json", "--role", "normal", nasty + ".ktx2"}},
             {{"mips", "--batch", "in", "out", "--dry-run"}, 0},
             {{"mips", "--batch", "in", "out"}, 1},
             {{"mips", "--batch", "in", "out", "--json"}, 1},
             {{"convolve", "in.png", "out.png", "--image", name}},
             {{"design", "separable", name, "--rank", "1", "-o", nasty + ".json"}},
             {{"analyze", nasty + ".json"}},
             {{"analyze", nasty + ".json", "--emit", "glsl"}},
             {{"design", "downsample", "--emit", "glsl", "--plot", nasty + ".svg"}},
             {{"design", "downsample", "--emit", "glsl", "--emit-to", "."}},
         }) {
        const Outcome run = shell.run(words);
        SCOPED_TRACE(words[0] + " " + words[1]);
        EXPECT_EQ(run.code, code) << run;
        expect_plain(run, code);
    }
}

}  // namespace
}  // namespace bandlimit
