// bandlimit pattern with scenes, from outside.
#include <cmath>

#include "apps/run_program_test.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit {
namespace {

/// The channels of a file by their names.
std::map<std::string, Image<float>> channels_in(const std::string& path) {
    ImageReader reader(path);
    const ImageInfo& info = reader.info();
    Image<float> all(info.width, info.height, info.channels(), Layout::interleaved);
    reader.read_rows(0, AnyView(all.view()));
    std::map<std::string, Image<float>> channels;
    for (int c = 0; c < info.channels(); ++c) {
        Image<float> one(info.width, info.height);
        for (int y = 0; y < info.height; ++y)
            for (int x = 0; x < info.width; ++x) one.view()(x, y) = all.view()(x, y, c);
        channels.emplace(info.channel_names[static_cast<std::size_t>(c)], std::move(one));
    }
    return channels;
}

/// Whether a file holds all channels of this frame, to the bit.
void expect_holds(const std::string& path, const Image<float>& frame) {
    const auto channels = channels_in(path);
    ASSERT_EQ(channels.size(), scene_channel_names.size());
    for (int c = 0; c < scene_channel::count; ++c) {
        const std::string name = scene_channel_names[static_cast<std::size_t>(c)];
        ASSERT_EQ(channels.count(name), 1u) << name;
        const View<const float> stored = channels.at(name).view();
        ASSERT_EQ(stored.width, frame.width());
        ASSERT_EQ(stored.height, frame.height());
        for (int y = 0; y < stored.height; ++y)
            for (int x = 0; x < stored.width; ++x)
                ASSERT_EQ(stored(x, y), frame.view()(x, y, c)) << name << " " << x << " " << y;
    }
}

TEST(Scenes, ExrHoldsAllChannels) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const std::string& name : scene_names()) {
        ASSERT_TRUE(
            succeeds(shell("pattern " + name + " out.exr --size 40x23 --frame 3 --jitter -0.25,0.125 --spp 3")));
        expect_holds(shell / "out.exr",
                     render_scene(make_scene(name, 40, 23), 40, 23, 3, {.jitter = {-0.25, 0.125}, .samples = 3}));
    }
    EXPECT_EQ(shell.files(), std::set<std::string>{"out.exr"});
}

// 512 x 1300 pixels are three bands.
TEST(Scenes, BandsAndThreadsGiveTheSameBits) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Image<float> frame = render_scene(make_scene("line", 512, 1300, {.speed = -1.5}), 512, 1300, 2);
    for (const std::string threads : {"1", "3"}) {
        ASSERT_TRUE(
            succeeds(shell("pattern line out.exr --size 512x1300 --frame 2 --speed -1.5 --threads " + threads)));
        expect_holds(shell / "out.exr", frame);
    }
}

TEST(Scenes, OtherFormatsHoldTheColour) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Image<float> frame = render_scene(make_scene("mover", 30, 20), 30, 20, 0, {.samples = 4});
    for (const std::string file : {"out.png", "out.tif", "out.jpg", "out.hdr", "out.pfm", "out.webp"})
        EXPECT_TRUE(succeeds(shell("pattern mover " + file + " --size 30x20 --spp 4"))) << file;
    const Image<std::uint8_t> png = load<std::uint8_t>(shell / "out.png");
    ASSERT_EQ(png.channels(), 3);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(png.view()(x, y, c), 255 * linear_to_srgb(std::min(1.0f, frame.view()(x, y, c))),
                            0.501);  // rounded to a code
    EXPECT_TRUE(fails(2, shell("pattern mover out.pgm --size 30x20"), "colour"));
}

TEST(Scenes, AnyOptionOfScenesMakesASignalOne) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const std::string option : {"--frame 0", "--jitter 0,0", "--spp 1", "--speed 0", "--ao-rays 0"}) {
        const Outcome run = shell("pattern zoneplate out.exr --size 20x10 --json " + option);
        ASSERT_TRUE(succeeds(run)) << option;
        EXPECT_EQ(run.json()["channels"], 14) << option;
    }
    const Outcome signal = shell("pattern zoneplate out.exr --size 20x10 --json");
    EXPECT_EQ(signal.json()["channels"], 1);
    EXPECT_TRUE(fails(2, shell("pattern zoneplate out.exr --size 20x10 --frame 1 --phase 0.5"), "--phase"));
    EXPECT_TRUE(fails(2, shell("pattern siemens out.exr --size 20x10 --spp 4 --antialias box"), "--antialias"));
}

TEST(Scenes, JsonSaysWhatWasDrawn) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run =
        shell("pattern foliage out.exr --size 20x10 --frame -4 --jitter 0.5,1/4 --spp 2 --threads 1 --json");
    ASSERT_TRUE(succeeds(run));
    const nlohmann::json r = run.json();
    EXPECT_EQ(r["kind"], "foliage");
    EXPECT_EQ(r["file"], "out.exr");
    EXPECT_EQ(r["width"], 20);
    EXPECT_EQ(r["frame"], -4);
    EXPECT_EQ(r["jitter"], (nlohmann::json{0.5, 0.25}));
    EXPECT_EQ(r["samples"], 2);
    EXPECT_EQ(r["depth"], "f32");
    EXPECT_EQ(r["transfer"], "linear");
    EXPECT_EQ(r["threads"], 1);
}

TEST(Scenes, HelpListsThem) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome help = shell("pattern --help");
    ASSERT_TRUE(succeeds(help));
    for (const std::string& name : scene_names())
        EXPECT_NE(help.out.find("  " + name + " "), std::string::npos) << name;
    const Outcome plane = shell("pattern plane --help");
    for (const char* name : scene_channel_names) EXPECT_NE(plane.out.find(name), std::string::npos) << name;
}

TEST(Scenes, SayWhatIsWrong) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::string plane = "pattern plane out.exr --size 8x8 ";
    EXPECT_TRUE(fails(2, shell("pattern plane out.exr"), "--size"));
    EXPECT_TRUE(fails(2, shell(plane + "--jitter 1"), "--jitter"));
    EXPECT_TRUE(fails(2, shell(plane + "--jitter 1,x"), "--jitter"));
    EXPECT_TRUE(fails(2, shell(plane + "--jitter 0,1e9"), "jitter"));
    EXPECT_TRUE(fails(2, shell(plane + "--spp 0"), "--spp"));
    EXPECT_TRUE(fails(2, shell(plane + "--speed 1e9"), "speed"));
    EXPECT_TRUE(fails(2, shell(plane + "--ao-rays -1"), "--ao-rays"));
    EXPECT_TRUE(fails(2, shell(plane + "--depth f16"), "f32"));
    EXPECT_TRUE(fails(2, shell(plane + "--antialias box"), "--antialias"));
    EXPECT_TRUE(fails(1, shell("pattern plane none/out.exr --size 8x8"), "none"));
    EXPECT_TRUE(fails(1, shell("pattern plane /dev/null --size 8x8"), "/dev/null"));
    EXPECT_TRUE(shell.files().empty());
}

TEST(Scenes, AnInterruptionLeavesNoFile) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const auto interrupt = [&](pid_t process) {
        return !shell.files().empty() && ::kill(process, SIGINT) == 0;  // minutes before the end
    };
    const Outcome run = shell("pattern foliage out.exr --size 2000x2000 --spp 1024", {.meanwhile = interrupt});
    EXPECT_EQ(run.signal, SIGINT) << run;
    EXPECT_TRUE(shell.files().empty());
}

}  // namespace
}  // namespace bandlimit
