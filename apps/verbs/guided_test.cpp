// The guided filter by the program, from outside.
#include <cmath>
#include <limits>

#include "apps/run_program_test.h"
#include "bandlimit/filter/local_models.h"
#include "bandlimit/job/local_models_file.h"

namespace bandlimit {
namespace {

template <class F>
void save_floats(const Shell& shell, const std::string& name, int width, int height, int channels, F f) {
    AnyImage image = image_of<float>(width, height, channels, f);
    save(shell / name, image);
}

/// A depth that steps and rises, at any size.
double depth_at(double x, double y) { return 4 + 2 * x + std::sin(5 * y) + (x + y > 1 ? 3 : 0); }
void save_depth(const Shell& shell, const std::string& name, int width, int height) {
    save_floats(shell, name, width, height, 1,
                [&](int x, int y, int) { return depth_at((x + 0.5) / width, (y + 0.5) / height); });
}
double signal_of(double depth) { return 0.1 + 0.05 * depth; }

TEST(Guided, RunsTheFilterOfTheLibrary) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_depth(shell, "depth.exr", 33, 21);
    Random random(2);
    save_floats(shell, "noisy.exr", 33, 21, 3, [&](int, int, int) { return random.uniform(); });
    const Image<float> noisy = load<float>(shell / "noisy.exr"), depth = load<float>(shell / "depth.exr");
    struct Case {
        std::string options;
        LocalModelOptions model;
    };
    for (const Case& c :
         {Case{"", {.radius = 3, .epsilon = 0.01}}, Case{" --window gaussian", {3, 0.01, WindowShape::gaussian}},
          Case{" --order 2 --average", {3, 0.01, WindowShape::box, 2, true}},
          Case{" --edge wrap", {.radius = 3, .epsilon = 0.01, .edge = Edge::wrap}}}) {
        const Outcome run =
            shell("guided noisy.exr out.exr --guide depth.exr --radius 3 --epsilon 0.01 --json" + c.options);
        ASSERT_TRUE(succeeds(run)) << c.options;
        EXPECT_EQ(run.json()["guide_channels"], 1);
        EXPECT_EQ(run.json()["terms"], c.model.order);
        EXPECT_EQ(run.json()["coefficients"], c.model.averages ? "average" : "centre");
        const Image<float> found = load<float>(shell / "out.exr");
        const Image<float> wanted = guided_filter(noisy.view(), depth.view(), c.model);
        for (int y = 0; y < 21; ++y)
            for (int x = 0; x < 33; ++x)
                for (int k = 0; k < 3; ++k) ASSERT_EQ(found.view()(x, y, k), wanted.view()(x, y, k)) << c.options;
    }
    // Infinity is a regularisation too: the mean of the window, here of all.
    ASSERT_TRUE(succeeds(shell("guided noisy.exr out.exr --guide depth.exr --radius 1000 --epsilon inf")));
    EXPECT_NEAR(load<float>(shell / "out.exr").view()(0, 0), load<float>(shell / "out.exr").view()(32, 20), 1e-6);
}

TEST(Guided, UpsamplesALinearSceneExactlyAndSavesWhatItFitted) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_depth(shell, "low.exr", 24, 16);
    save_floats(shell, "signal.exr", 24, 16, 1, [](int x, int y, int) {
        if (x % 5 == 2 && y % 3 == 1) return double(std::numeric_limits<float>::quiet_NaN());  // holes are filled
        return signal_of(depth_at((x + 0.5) / 24, (y + 0.5) / 16));
    });
    for (const int scale : {1, 2, 4, 8}) {
        save_depth(shell, "high.exr", 24 * scale, 16 * scale);
        ASSERT_TRUE(
            succeeds(shell("guided signal.exr out.exr --guide low.exr --guide-full high.exr --radius 2 "
                           "--epsilon 1e-9 --save-models models.exr")));
        const Image<float> found = load<float>(shell / "out.exr"), depth = load<float>(shell / "high.exr");
        ASSERT_EQ(found.width(), 24 * scale);
        const LocalModels models = job::read_local_models(shell / "models.exr");
        const Image<float> again = apply_local_models(models, depth.view());
        for (int y = 0; y < 16 * scale; ++y)
            for (int x = 0; x < 24 * scale; ++x) {
                ASSERT_NEAR(found.view()(x, y), signal_of(double(depth.view()(x, y))), 1e-5);
                ASSERT_EQ(found.view()(x, y), again.view()(x, y));
            }
    }
}

TEST(Guided, ModelsComeBackFromFilesAsTheyWere) {
    const Folder folder;
    Random random(6);
    Image<float> guide(9, 7, 3), signal(9, 7, 2);
    for (Image<float>* image : {&guide, &signal})
        for (int c = 0; c < image->channels(); ++c)
            for (int y = 0; y < 7; ++y)
                for (int x = 0; x < 9; ++x) image->view()(x, y, c) = static_cast<float>(random.uniform(3, 4));
    for (const int order : {1, 2}) {
        const LocalModels models = fit_local_models(signal.view(), guide.view(), {.radius = 2, .order = order});
        job::write_local_models(folder / "models.exr", models);
        const LocalModels back = job::read_local_models(folder / "models.exr");
        EXPECT_EQ(back.guides, 3);
        EXPECT_EQ(back.signals, 2);
        EXPECT_EQ(back.order, order);
        EXPECT_EQ(back.offsets, models.offsets);
        ASSERT_TRUE(same_shape(back.coefficients.view(), models.coefficients.view()));
        for (int c = 0; c < models.coefficients.channels(); ++c)
            for (int y = 0; y < 7; ++y)
                for (int x = 0; x < 9; ++x)
                    EXPECT_EQ(back.coefficients.view()(x, y, c), models.coefficients.view()(x, y, c));
    }
    EXPECT_THROW(job::write_local_models(folder / "models.png", fit_local_models(signal.view(), guide.view())), Error);
}

TEST(Guided, AlphaIsFilteredAndDoesNotGuide) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_floats(shell, "in.exr", 12, 12, 4, [](int x, int, int c) {
        return c == 3 ? (x < 6 ? 1 : 0) : x < 6 ? 0.5 : 0;
    });
    const Outcome run = shell("guided in.exr out.exr --guide in.exr --radius 2 --epsilon inf --json");
    ASSERT_TRUE(succeeds(run));
    EXPECT_EQ(run.json()["guide_channels"], 3);
    const Image<float> out = load<float>(shell / "out.exr");
    EXPECT_NEAR(out.view()(6, 6, 3), 0.4, 1e-6);  // two of five columns
    EXPECT_EQ(shell("guided in.exr out.exr --guide in.exr --radius 2 --epsilon 1 --space data --json")
                  .json()["guide_channels"],
              4);
}

TEST(Guided, RefusesWhatDoesNotFit) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_depth(shell, "in.exr", 12, 10);
    save_depth(shell, "small.exr", 6, 5);
    save_floats(shell, "ten.exr", 12, 10, 10, [](int x, int, int) { return x; });
    const std::string guided = "guided in.exr out.exr --guide in.exr ";
    struct Case {
        int code;
        std::string command, word;
    };
    for (const Case& c : std::vector<Case>{
             {2, "guided in.exr out.exr --radius 2 --epsilon 1", "--guide"},
             {2, guided + "--epsilon 1", "--radius"},
             {2, guided + "--radius 2", "--epsilon"},
             {2, guided + "--radius -1 --epsilon 1", "--radius"},
             {2, guided + "--radius 40000 --epsilon 1", "32767"},
             {2, guided + "--radius 300 --epsilon 1 --window gaussian", "255"},
             {2, guided + "--radius 2 --epsilon -1", "--epsilon"},
             {2, guided + "--radius 2 --epsilon nan", "--epsilon"},
             {2, guided + "--radius 2 --epsilon 1 --order 3", "--order"},
             {2, guided + "--radius 2 --epsilon 1 --window disc", "box or gaussian"},
             {2, guided + "--radius 2 --epsilon 1 --save-models m.png", "--save-models"},
             {1, "guided in.exr out.exr --guide small.exr --radius 2 --epsilon 1", "size of the input"},
             {1, "guided small.exr out.exr --guide small.exr --guide-full ten.exr --radius 2 --epsilon 1",
              "same channels"},
             {2, "guided in.exr out.exr --guide ten.exr --radius 2 --epsilon 1 --order 2", "up to 8"},
             {1, "guided in.exr out.exr --guide none.exr --radius 2 --epsilon 1", "none.exr"},
             {1, "guided none.exr out.exr --guide in.exr --radius 2 --epsilon 1", "none.exr"},
         })
        EXPECT_TRUE(fails(c.code, shell(c.command), c.word)) << c.command;
    EXPECT_FALSE(shell.files().count("out.exr"));
    EXPECT_TRUE(fails_for(
        shell / "in.exr", [&] { job::read_local_models(shell / "in.exr"); }, "no local models"));
}

}  // namespace
}  // namespace bandlimit
