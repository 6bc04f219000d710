// Textures and batches of them, as a library user makes them.
#include "bandlimit/job/batch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stop_token>

#include "bandlimit/io/files_test.h"
#include "bandlimit/job/batch_manifest.h"
#include "bandlimit/job/batch_rules.h"
#include "bandlimit/job/make_texture.h"
#include "bandlimit/job/texture_file.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;

void save_noise(const std::string& path, int size, int channels = 3) {
    AnyImage image = noise(Depth::u8, size, size, channels);
    write_image(path, target_of(Depth::u8, size, size, channels), pixels(image));
}

std::set<std::string> files_below(const std::string& folder) {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory()) files.insert(entry.path().lexically_relative(folder).generic_string());
    return files;
}

TEST(MakeTexture, ReportsWhatItWrote) {
    const Folder folder;
    save_noise(folder / "wall_n.png", 20);
    MipsJob job;
    job.inputs = {folder / "wall_n.png"}, job.output = folder / "wall_n.ktx2";
    double done = 0, total = 0;
    const MipsReport report =
        make_texture(job, {.progress = [&](const Progress& p) { done = p.done, total = p.total; }});
    ASSERT_TRUE(report.role);
    EXPECT_EQ(report.role->role, Role::normal);
    EXPECT_EQ(report.role->because, "n");
    EXPECT_EQ(report.levels.size(), 5u);
    EXPECT_EQ(read_texture(job.output).levels.size(), 5u);
    EXPECT_GT(done, 0);
    EXPECT_EQ(done, total);
}

TEST(MakeTexture, StoppedLeavesNothing) {
    const Folder folder;
    save_noise(folder / "in.png", 20);
    std::stop_source source;
    source.request_stop();
    for (const Role role : {Role::color, Role::roughness}) {  // by rows, and whole
        MipsJob job;
        job.inputs = {folder / "in.png"}, job.output = folder / "out.ktx2", job.recipe.role = role;
        EXPECT_THROW(make_texture(job, {.parallel = {.threads = 2, .stop = source.get_token()}}), Stopped);
    }
    EXPECT_EQ(files_below(folder / "."), std::set<std::string>{"in.png"});
}

TEST(MipsRecipe, OptionsThatDoNotFitAreNamed) {
    MipsRecipe recipe;
    for (const RecipeOption& option : recipe_options()) EXPECT_EQ(find_option(option.name), &option);
    EXPECT_EQ(find_option("rolle"), nullptr);
    recipe.two_channel = true;
    try {
        check_recipe(recipe, Role::color);
        ADD_FAILURE() << "color has two channels";
    } catch (const OptionError& e) {
        EXPECT_TRUE(std::string(e.what()).starts_with("two-channel: ")) << e.what();
    }
    check_recipe(recipe, Role::normal);
}

TEST(BatchRules, PatternsMatchNamesAndFolders) {
    EXPECT_TRUE(matches("*_n.png", "deep/er/WALL_N.PNG"));
    EXPECT_FALSE(matches("sub/*_n.png", "deep/sub/wall_n.png"));
    EXPECT_TRUE(matches("**/sub/*_n.png", "deep/sub/wall_n.png"));
    EXPECT_TRUE(matches("**/*.png", "a.png"));
    EXPECT_FALSE(matches("?.png", "ab.png"));
    EXPECT_TRUE(matches("foliage/**", "Foliage/oak/leaf.png"));
}

TEST(Batch, StoppedKeepsWhatIsMadeAndGoesOnFromThere) {
    const Folder folder;
    constexpr int count = 24;
    fs::create_directories(folder / "in");
    for (int i = 0; i < count; ++i) save_noise(folder / ("in/" + std::to_string(i) + ".png"), 30 + i);
    const BatchJob job{.in = folder / "in", .out = folder / "out"};
    std::stop_source source;
    int calls = 0;  // by one at a time
    const auto stop_soon = [&](const Progress& p) {
        if (p.doing == "making" && ++calls == 3) source.request_stop();
    };
    EXPECT_THROW(make_batch(job, {.parallel = {.threads = 2, .stop = source.get_token()}, .progress = stop_soon}),
                 Stopped);

    const std::set<std::string> left = files_below(folder / "out");
    EXPECT_TRUE(left.contains(".bandlimit-mips.json"));
    const int made = static_cast<int>(left.size()) - 1;
    EXPECT_GE(made, 2);
    EXPECT_LT(made, count);
    for (const std::string& file : left) {
        if (!file.ends_with(".ktx2")) continue;
        EXPECT_GE(read_texture(folder / ("out/" + file)).levels.size(), 5u);
    }

    int current = 0;
    for (const PlannedFile& file : plan_batch(job)) current += file.state == "up to date";
    EXPECT_EQ(current, made);
    const BatchReport rest = make_batch(job);
    EXPECT_EQ(rest.skipped, made);
    EXPECT_EQ(rest.made, count - made);
    EXPECT_TRUE(rest.failed.empty());
}

TEST(Batch, RunsOnThreadsOfTheCaller) {
    const Folder folder;
    fs::create_directories(folder / "in");
    for (int i = 0; i < 4; ++i) save_noise(folder / ("in/" + std::to_string(i) + ".png"), 16);
    std::atomic<int> tasks = 0;
    const TaskRunner runner = [&](int n, const std::function<void(int)>& task) {
        for (int i = 0; i < n; ++i) ++tasks, task(i);
    };
    const BatchReport report =
        make_batch({.in = folder / "in", .out = folder / "out"}, {.parallel = {.threads = 3, .runner = &runner}});
    EXPECT_EQ(report.made, 4);
    EXPECT_GT(tasks, 0);
}

}  // namespace
}  // namespace bandlimit::job
