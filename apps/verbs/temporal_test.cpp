// What the program makes of sequences of frames.
#include <fstream>

#include "apps/run_program_test.h"
#include "bandlimit/job/channels.h"
#include "bandlimit/job/check_conventions.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit {
namespace {

using nlohmann::json;

/// Twelve frames of a scene in a folder, with their jitter in meta.json.
void add_sequence(const Shell& shell, const std::string& scene, const std::string& folder, int frames = 12) {
    std::filesystem::create_directory(shell / folder);
    json jitter = json::array();
    for (int f = 0; f < frames; ++f) {
        const double x = (f * 5 % 12 - 5.5) / 12, y = (f * 7 % 12 - 5.5) / 12;
        jitter.push_back({x, y});
        ASSERT_TRUE(succeeds(shell("pattern " + scene + " " + folder + "/f_" + std::to_string(100 + f) +
                                   ".exr --size 32x24 --frame " + std::to_string(f) + " --spp 1 --jitter " +
                                   std::to_string(x) + "," + std::to_string(y))));
    }
    std::ofstream(shell / "meta.json") << json{{"sequences", {{folder, {{"jitter", jitter}}}}}}.dump();
}

TEST(TemporalVerb, UpscalesASceneTowardsItsTruth) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run =
        shell("temporal glyphs out --size 32x24 --scale 2 --preset reference --report out/report --json");
    ASSERT_TRUE(succeeds(run));
    const json report = run.json();
    EXPECT_EQ(report, json::parse(bytes_of(shell / "out/report/report.json")));
    EXPECT_EQ(report["width"], 64);
    EXPECT_EQ(report["jitter_length"], 32);
    EXPECT_EQ(report["mip_bias"], -1);
    ASSERT_EQ(report["frames"].size(), 32u);
    EXPECT_EQ(report["frames"][31]["frame"], 31);
    EXPECT_GT(report["frames"][31]["psnr"].get<double>(), report["frames"][0]["psnr"].get<double>() + 6);
    EXPECT_GT(report["frames"][31]["ssim"].get<double>(), 0.9);
    EXPECT_NE(bytes_of(shell / "out/report/index.html").find("psnr.svg"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(shell / "out/frame_031.exr"));
}

TEST(TemporalVerb, ReportsMeasuresAndPictures) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell("temporal mover out --size 32x24 --scale 2 --frames 12 --report r --json");
    ASSERT_TRUE(succeeds(run));
    const json report = run.json();
    EXPECT_EQ(report["measured_frames"], 6) << "half of all, less than a period of the jitter";
    for (const char* key : {"flicker", "warped_difference", "sharpness", "ms_per_frame"})
        EXPECT_GT(report[key].get<double>(), 0) << key;
    EXPECT_GT(report["ghosting"]["disoccluded"].get<double>(), 0);
    EXPECT_GT(report["ghosting"]["elsewhere"].get<double>(), 0);
    EXPECT_LT(report["flicker"].get<double>(), 0.05);
    EXPECT_TRUE(report["continued_at"].is_null());
    const std::string page = bytes_of(shell / "r/index.html");
    for (const char* picture :
         {"animation", "sheet", "last", "weight", "memory", "rejection", "motion", "disocclusion"}) {
        const std::string name = std::string(picture) + ".png";
        EXPECT_NE(page.find("\"" + name + "\""), std::string::npos) << name;
        EXPECT_GT(job::read_codes(shell / ("r/" + name)).width(), 0) << name;
    }
    const Image<float> strip = job::read_codes(shell / "r/animation.png"),
                       sheet = job::read_codes(shell / "r/sheet.png");
    EXPECT_EQ(strip.width(), 3 * 64 + 2 * 4);
    EXPECT_EQ(strip.height(), 48);
    EXPECT_EQ(sheet.width(), 8 * 64 + 7 * 4);
    EXPECT_EQ(sheet.height(), 3 * 48 + 2 * 4);
    EXPECT_NE(bytes_of(shell / "r/animation.png").find("acTL"), std::string::npos);
}

// Without a truth, and of a single frame, what is unknown is null.
TEST(TemporalVerb, ReportsWhatIsKnown) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_sequence(shell, "fence", "in", 4);
    const json report = shell("temporal in out --meta meta.json --report r --json").json();
    EXPECT_TRUE(report["sharpness"].is_null());
    EXPECT_TRUE(report["ghosting"]["elsewhere"].is_null());
    EXPECT_TRUE(report["frames"][0]["psnr"].is_null());
    EXPECT_TRUE(report["flicker"].is_number());
    EXPECT_TRUE(report["high_frequencies"]["output"].is_number());
    EXPECT_EQ(job::read_codes(shell / "r/animation.png").width(), 2 * 32 + 4);
    const json single = shell("temporal in out --meta meta.json --frames 1 --report r --json").json();
    EXPECT_TRUE(single["flicker"].is_null());
    EXPECT_TRUE(single["warped_difference"].is_null());
    EXPECT_EQ(single["measured_frames"], 0);
}

/// Writes NaN into the depth of a frame at (5, 7).
void lose_depth(const std::string& path) {
    ImageReader reader(path);
    const ImageInfo info = reader.info();
    AnyImage all = read_image(reader);
    const auto depth = std::ranges::find(info.channel_names, "Depth.Z") - info.channel_names.begin();
    std::get<Image<float>>(all).view()(5, 7, static_cast<int>(depth)) = std::numeric_limits<float>::quiet_NaN();
    ImageTarget target = target_of(Depth::f32, info.width, info.height, info.channels());
    target.channel_names = info.channel_names, target.transfer = Transfer::linear;
    write_image(path, target, pixels(all));
}

// One line, the frames before, and nothing half-written.
TEST(TemporalVerb, StopsAtAFrameThatIsBad) {
    using Spoil = std::function<void(const Shell&)>;
    const std::string bad = "in/f_103.exr";
    const auto drawn = [&](const std::string& line) -> Spoil {
        return [=](const Shell& shell) { ASSERT_TRUE(succeeds(shell(line))); };
    };
    const Spoil no_depth = [&](const Shell& shell) { lose_depth(shell / bad); };
    const Spoil half = [&](const Shell& shell) {
        const std::string bytes = bytes_of(shell / bad);
        write_bytes(shell / bad, bytes.substr(0, bytes.size() / 2));
    };
    const Spoil empty = [&](const Shell& shell) { write_bytes(shell / bad, ""); };
    const Spoil missing = [&](const Shell& shell) { std::filesystem::remove(shell / bad); };
    const Spoil meta = [&](const Shell& shell) { write_bytes(shell / "meta.json", "{\"sequences\": {"); };
    struct Case {
        std::string word;
        Spoil spoil;
        int made;
    };
    const std::vector<Case> cases{
        {"33 x 24", drawn("pattern mover " + bad + " --size 33x24 --spp 1"), 3},
        {"has the channels", drawn("supersample mover " + bad + " --size 32x24 --pattern regular:1"), 3},
        {"depth at 5, 7", no_depth, 3},
        {"f_103.exr", half, 3},
        {"f_103.exr", empty, 3},
        {"frame 103 is missing", missing, 0},
        {"not JSON", meta, 0}};
    for (const Case& c : cases) {
        const Shell shell(BANDLIMIT_PROGRAM);
        add_sequence(shell, "mover", "in", 6);
        c.spoil(shell);
        EXPECT_TRUE(fails(1, shell("temporal in out --meta meta.json --report r"), c.word));
        std::set<std::string> made, wanted;
        if (std::filesystem::exists(shell / "out"))
            for (const auto& entry : std::filesystem::directory_iterator(shell / "out"))
                made.insert(entry.path().filename());
        for (int i = 0; i < c.made; ++i) wanted.insert("f_10" + std::to_string(i) + ".exr");
        if (c.made > 0) wanted.insert(".bandlimit-temporal");
        EXPECT_EQ(made, wanted) << c.word;
        EXPECT_FALSE(std::filesystem::exists(shell / "r")) << c.word;
    }
}

// After a period, what is still is what the samples of all frames add up to: supersampling with that kernel.
TEST(TemporalVerb, ReadsASequenceAndItsReference) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_sequence(shell, "fence", "in");
    ASSERT_TRUE(succeeds(shell("temporal in one --meta meta.json --preset reference")));
    const Outcome run = shell("temporal in two --meta meta.json --preset reference --reference one --report r --json");
    ASSERT_TRUE(succeeds(run));
    const json report = run.json();
    EXPECT_EQ(report["conventions"], "bandlimit");
    for (const json& frame : report["frames"]) {
        EXPECT_TRUE(frame["psnr"].is_null()) << "the same bits are infinitely near";
        EXPECT_EQ(frame["ssim"], 1);
    }
    EXPECT_EQ(report["frames"][3]["frame"], 103);
    EXPECT_EQ(bytes_of(shell / "one/f_111.exr"), bytes_of(shell / "two/f_111.exr"));
}

// Colour is stored multiplied by alpha, in the input as in the output: glass stays as it is.
TEST(TemporalVerb, KeepsWhatIsTransparent) {
    const Shell shell(BANDLIMIT_PROGRAM);
    std::filesystem::create_directory(shell / "in");
    Image<float> glass(8, 6, 4);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x)
            for (int c = 0; c < 4; ++c) glass.view()(x, y, c) = c == 3 ? 0.5f : 0.25f;
    job::write_picture(shell / "in/f_0.exr", glass.view(), Depth::f32);
    ASSERT_TRUE(succeeds(shell("temporal in out --quiet")));
    const Image<float> before = job::read_picture(shell / "in/f_0.exr"),
                       after = job::read_picture(shell / "out/f_0.exr");
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(after.view()(3, 3, c), before.view()(3, 3, c), 1e-6) << c;
}

// A sign that is wrong sends history the wrong way.
TEST(TemporalVerb, MotionHasADirection) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_sequence(shell, "mover", "in", 6);
    const auto last = [&](const std::string& flags) {
        EXPECT_TRUE(succeeds(shell("temporal in out --meta meta.json --preset reference " + flags)));
        return job::read_picture(shell / "out/f_105.exr");
    };
    std::filesystem::create_directory(shell / "truth");
    ASSERT_TRUE(succeeds(
        shell("supersample mover truth/f_105.exr --size 32x24 --frame 5 --pattern regular:64 --kernel lanczos2")));
    const Image<float> truth = job::read_picture(shell / "truth/f_105.exr");
    const auto error = [&](const Image<float>& found) {
        double sum = 0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x) sum += std::abs(double(found.view()(x, y) - truth.view()(x, y)));
        return sum;
    };
    EXPECT_LT(error(last("")), error(last("--motion-direction current-previous")));
}

/// Writes floats to an EXR file.
void write_channels(const std::string& path, View<const float> values, const std::vector<std::string>& names) {
    ImageTarget target;
    target.width = values.width, target.height = values.height, target.channel_names = names;
    target.depth = Depth::f32, target.transfer = Transfer::linear;
    job::write_codes(path, target, values);
}

/// Channels of an EXR file as a file of their own. Those of scenes are read in the order R G B A AO Albedo Depth Normal
/// Vector.
void copy_channels(const std::string& from, const std::string& to, int first, const std::vector<std::string>& names) {
    write_channels(to, job::channels_copied(job::read_codes(from).view(), first, int(names.size())).view(), names);
}

/// Three frames of a scene whose buffers have files of their own, and those of all buffers in `in`.
void add_buffers(const Shell& shell) {
    add_sequence(shell, "mover", "in", 3);
    std::filesystem::create_directories(shell / "own/passes");
    for (const std::string number : {"100", "101", "102"}) {
        const std::string from = shell / ("in/f_" + number + ".exr");
        copy_channels(from, shell / ("own/beauty_" + number + "_v2.exr"), 0, {"R", "G", "B", "A"});
        copy_channels(from, shell / ("own/depth_" + number + ".exr"), 8, {"Y"});
        copy_channels(from, shell / ("own/passes/vectors_" + number + ".exr"), 12, {"R", "G"});
    }
}
const std::string own_buffers = "--color beauty_###_v2.exr --depth depth_###.exr --motion passes/vectors_###.exr";

TEST(TemporalVerb, BuffersMayHaveFilesOfTheirOwn) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_buffers(shell);
    ASSERT_TRUE(succeeds(shell("temporal in one")));
    ASSERT_TRUE(succeeds(shell("temporal own two " + own_buffers)));
    ASSERT_TRUE(succeeds(shell("temporal in three --depth ../own/depth_###.exr:Y")));
    ASSERT_TRUE(succeeds(shell("temporal in four --depth ../in/f_###.exr:AO")));
    const std::string wanted = bytes_of(shell / "one/f_102.exr");
    EXPECT_TRUE(bytes_of(shell / "two/beauty_102_v2.exr") == wanted);
    EXPECT_TRUE(bytes_of(shell / "three/f_102.exr") == wanted);
    EXPECT_FALSE(bytes_of(shell / "four/f_102.exr") == wanted) << "another depth finds other things disoccluded";
    const job::FrameSequence own = job::open_sequence({.folder = shell / "own",
                                                       .color = "beauty_###_v2.exr",
                                                       .depth = "depth_###.exr",
                                                       .motion = "passes/vectors_###.exr"});
    EXPECT_EQ(own.paths(1).size(), 3u) << "a run goes on only where none of them has changed";
    EXPECT_EQ(job::open_sequence({.folder = shell / "in"}).paths(1).size(), 1u);
    // The colour's files are those that are not another buffer's.
    for (const std::string number : {"100", "101", "102"})
        std::filesystem::copy(shell / ("own/depth_" + number + ".exr"), shell / ("in/d_" + number + ".exr"));
    ASSERT_TRUE(succeeds(shell("temporal in five --depth d_###.exr")));
    EXPECT_TRUE(bytes_of(shell / "five/f_102.exr") == wanted);
}

TEST(TemporalVerb, BuffersMustFitEachOther) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_buffers(shell);
    EXPECT_TRUE(fails(2, shell("temporal own out --depth depth.exr"), "####"));
    EXPECT_TRUE(fails(2, shell("temporal own out --depth d_##_##.exr"), "--depth: "));
    EXPECT_TRUE(fails(1, shell("temporal own out --color c_###.exr"), "holds no c_###.exr"));
    EXPECT_TRUE(fails(1, shell("temporal own out " + own_buffers + ":Vector"), "Vector.X"));
    EXPECT_TRUE(fails(1, shell("temporal in out --depth ../own/passes/vectors_###.exr"), "no channel Z"));
    std::filesystem::copy(shell / "in/f_100.exr", shell / "in/g_100.exr");
    EXPECT_TRUE(fails(1, shell("temporal in out"), "both frame 100"));
    std::filesystem::remove(shell / "own/depth_101.exr");
    EXPECT_TRUE(fails(1, shell("temporal own out " + own_buffers), "there is no depth_101.exr for beauty_101_v2.exr"));
    ASSERT_TRUE(succeeds(shell("pattern mover own/depth_101.exr --size 31x24 --spp 1")));
    EXPECT_TRUE(fails(1, shell("temporal own out " + own_buffers), "one size"));
}

// A sequence that another program rendered: Blender, whose vectors have y up.
TEST(TemporalVerb, ReadsWhatBlenderRendered) {
    const Shell shell(BANDLIMIT_PROGRAM);
    std::filesystem::copy(BANDLIMIT_EXAMPLES "-temporal/sequence", shell / "sequence");
    const Outcome run = shell("temporal sequence out --meta sequence/meta.json --json");
    ASSERT_TRUE(succeeds(run));
    EXPECT_EQ(run.json()["conventions"], "blender");
    EXPECT_EQ(run.json()["frames"].size(), 4u);
    ASSERT_TRUE(succeeds(shell("temporal sequence same --meta sequence/meta.json --conventions blender")));
    ASSERT_TRUE(succeeds(shell("temporal sequence other --meta sequence/meta.json --conventions bandlimit")));
    const std::string last = bytes_of(shell / "out/frame_004.exr");
    EXPECT_TRUE(bytes_of(shell / "same/frame_004.exr") == last);
    EXPECT_FALSE(bytes_of(shell / "other/frame_004.exr") == last);
    // Each frame adds samples: the floor near by becomes smoother.
    const auto roughness = [&](const std::string& name) {
        const Image<float> image = job::read_picture(shell / name);
        double sum = 0;
        for (int y = 80; y < 134; ++y)
            for (int x = 20; x < 220; ++x) sum += std::abs(double(image.view()(x, y)) - double(image.view()(x, y + 1)));
        return sum;
    };
    EXPECT_LT(roughness("out/frame_004.exr"), 0.95 * roughness("out/frame_001.exr"));
}

// Of a rendered sequence, too, each of the 216 readings is told what to change.
TEST(CheckConventionsVerb, FindsEveryFlipOfARenderedSequence) {
    const std::string folder = BANDLIMIT_EXAMPLES "-temporal/sequence";
    const job::ConventionReport report =
        job::check_conventions(job::open_sequence({.folder = folder, .meta = folder + "/meta.json"}));
    const job::MotionConvention& right = job::convention_called("blender").motion;
    EXPECT_EQ(report.verdict, job::ConventionReport::Verdict::right);
    ASSERT_EQ(report.candidates.size(), 216u);
    for (const job::ConventionCandidate& c : report.candidates)
        EXPECT_EQ(job::judged(report, c.convention).flags, job::flags_between(c.convention, right));
}

TEST(CheckConventionsVerb, NamesTheFlagsToChange) {
    const Shell shell(BANDLIMIT_PROGRAM);
    std::filesystem::create_directory(shell / "in");
    for (const std::string frame : {"0", "1", "2"})
        ASSERT_TRUE(succeeds(shell("pattern plane in/f_" + frame + ".exr --size 96x64 --spp 1 --frame " + frame)));
    const Outcome right = shell("temporal in --check-conventions");
    ASSERT_TRUE(succeeds(right));
    EXPECT_NE(right.out.find("the same"), std::string::npos) << right;
    const std::set<std::string> files = shell.files();
    const std::string wrong = "temporal in --check-conventions --motion-y up --motion-axes yx";
    const Outcome run = shell(wrong);
    EXPECT_EQ(run.code, 1);
    EXPECT_EQ(run.err, "bandlimit: error: in: is read wrongly; pass --motion-y down --motion-axes xy\n");
    EXPECT_EQ(shell.files(), files) << "nothing is written";
    const json report = shell(wrong + " --json").json();
    EXPECT_EQ(report["conventions"], "bandlimit");
    EXPECT_EQ(report["verdict"], "wrong");
    EXPECT_EQ(report["flags"], (json{"--motion-y down", "--motion-axes xy"}));
    EXPECT_EQ(report["reading"]["motion-axes"], "yx");
    EXPECT_EQ(report["best"]["reading"]["motion-axes"], "xy");
    EXPECT_LT(report["best"]["error"].get<double>(), report["error"].get<double>());
    EXPECT_EQ(report["candidates"].size(), 24u);
    EXPECT_TRUE(succeeds(shell("temporal in --check-conventions --conventions blender --motion-y down")));
    EXPECT_TRUE(fails(1, shell("temporal in --check-conventions --conventions unity"), "MotionVectors.X"));
    EXPECT_TRUE(fails(2, shell("temporal plane --check-conventions --size 96x64"), "--check-conventions: "));
    EXPECT_TRUE(fails(2, shell("temporal in --check-conventions --motion-axes zx"), "xy, yx"));
}

// What the check asks for is what reading does. The other sequence is the same, stored with axes swapped, current minus
// previous, the jitter in the vectors, and that turned round with y up.
TEST(CheckConventionsVerb, FlagsAreHonoured) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_sequence(shell, "mover", "in", 3);
    std::filesystem::create_directory(shell / "other");
    json meta = json::parse(bytes_of(shell / "meta.json")), stored = json::array();
    std::array<double, 2> before{};
    for (int i = 0; i < 3; ++i) {
        const auto jitter = meta["sequences"]["in"]["jitter"][std::size_t(i)].get<std::array<double, 2>>();
        stored.push_back({-jitter[0], jitter[1]});
        if (i == 0) before = jitter;  // there is no frame before
        const std::string name = "/f_10" + std::to_string(i) + ".exr";
        Image<float> all = job::read_codes(shell / ("in" + name));
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x) {
                const float motion_x = all.view()(x, y, 12), motion_y = all.view()(x, y, 13);
                all.view()(x, y, 12) = -(motion_y + float(jitter[1] - before[1]));
                all.view()(x, y, 13) = -(motion_x + float(jitter[0] - before[0]));
            }
        write_channels(shell / ("other" + name), all.view(), ImageReader(shell / ("in" + name)).info().channel_names);
        before = jitter;
    }
    meta["sequences"]["other"]["jitter"] = stored;
    std::ofstream(shell / "meta.json") << meta.dump();
    ASSERT_TRUE(succeeds(shell("temporal in one --meta meta.json")));
    ASSERT_TRUE(
        succeeds(shell("temporal other two --meta meta.json --motion-axes yx --motion-direction "
                       "current-previous --motion-jitter included --jitter-sign minus --jitter-y up")));
    const Image<float> one = job::read_picture(shell / "one/f_102.exr");
    const Image<float> two = job::read_picture(shell / "two/f_102.exr");
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) EXPECT_NEAR(one.view()(x, y), two.view()(x, y), 1e-4) << "vectors are rounded";
}

TEST(TemporalVerb, EmitsItsPassAsAShader) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome balanced = shell("temporal --emit wgsl");
    EXPECT_TRUE(succeeds(balanced));
    for (const char* part : {"fn temporal_step(", "fn temporal_show(", "Made by: bandlimit temporal --emit wgsl"})
        EXPECT_NE(balanced.out.find(part), std::string::npos) << part;
    const Outcome plain = shell("temporal --preset fast --set rectification=none --emit hlsl");
    EXPECT_TRUE(succeeds(plain));
    EXPECT_EQ(plain.out.find("temporal_rectified"), std::string::npos);
    EXPECT_TRUE(fails(2, shell("temporal glyphs out --emit wgsl"), "INPUT"));
    EXPECT_TRUE(fails(2, shell("temporal --emit wgsl --json"), "--json"));
    EXPECT_TRUE(fails(2, shell("temporal --emit metal"), "msl"));
    EXPECT_TRUE(fails(2, shell("temporal --preset per-frame --emit glsl"), "per-frame"));
    EXPECT_TRUE(fails(2, shell("temporal"), "INPUT"));
}

TEST(TemporalVerb, RefusesWhatDoesNotFit) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_sequence(shell, "edge", "in", 3);
    struct Case {
        int code;
        std::string line, word;
    };
    std::ofstream(shell / "broken.json") << "{\"sequences\": ";
    std::ofstream(shell / "other.json") << "{\"sequences\": {\"elsewhere\": {}}}";
    std::ofstream(shell / "far.json") << "{\"sequences\": {\"in\": {\"jitter\": [[40, 0]]}}}";
    std::filesystem::create_directory(shell / "empty");
    for (const Case& c : {
             Case{2, "temporal in", "OUTDIR"},
             {2, "temporal in out --scale 5", "--scale: "},
             {2, "temporal in out --scale nan", "--scale"},
             {2, "temporal in out --preset ultra", "balanced"},
             {2, "temporal in out --set speed=1", "still-frames"},
             {2, "temporal in out --set alpha=2", "alpha = 2"},
             {2, "temporal in out --set alpha", "no value"},
             {2, "temporal in out --set kernel=jinc2", "separable"},
             {2, "temporal in out --conventions maya", "blender"},
             {2, "temporal in out --motion-units inches", "pixels"},
             {2, "temporal in out --size 8x8", "--size"},
             {2, "temporal mover out", "--size"},
             {2, "temporal in out --report no/where", "--report"},
             {1, "temporal none out", "not a folder"},
             {1, "temporal empty out", "no EXR files"},
             {1, "temporal in out --meta broken.json", "not JSON"},
             {1, "temporal in out --meta other.json", "\"in\""},
             {1, "temporal in out --meta far.json", "line 1: \"jitter\""},
             {1, "temporal in out --color Beauty", "Beauty"},
             {1, "temporal in out --reference empty", "no reference"},
         })
        EXPECT_TRUE(fails(c.code, shell(c.line), c.word)) << c.line;
    std::filesystem::remove(shell / "in/f_101.exr");
    EXPECT_TRUE(fails(1, shell("temporal in out"), "frame 101 is missing"));
    ASSERT_TRUE(succeeds(shell("pattern edge in/f_101.exr --size 33x24 --spp 1")));
    EXPECT_TRUE(fails(1, shell("temporal in out"), "one size"));
}

}  // namespace
}  // namespace bandlimit
