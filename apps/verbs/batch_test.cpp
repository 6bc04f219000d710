// bandlimit mips --batch, from outside.
#include <chrono>
#include <cstdlib>

#include "apps/run_program_test.h"
#include "bandlimit/texture/container.h"

namespace bandlimit {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* manifest_name = ".bandlimit-mips.json";

void save_noise(const std::string& path, int channels = 3, int size = 8) {
    fs::create_directories(fs::path(path).parent_path());
    AnyImage image = noise(Depth::u8, size, size, channels);
    save(path, image);
}

/// Everything below a folder, relative to it.
std::set<std::string> files_below(const std::string& folder) {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory()) files.insert(entry.path().lexically_relative(folder).generic_string());
    return files;
}

/// The plan of a dry run: state, role and so on, by input.
std::map<std::string, json> plan_of(const Outcome& run) {
    std::map<std::string, json> plan;
    EXPECT_EQ(run.code, 0) << run;
    const json report = run.json();
    for (const json& file : report["plan"]) plan[file["file"]] = file;
    return plan;
}

/// The files of a report that failed.
std::set<std::string> failed_in(const json& report) {
    std::set<std::string> files;
    for (const json& failure : report["failed"]) files.insert(failure["file"]);
    return files;
}

TEST(Batch, MakesWhatIsNotUpToDateAndGoesOnAfterFailures) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in/wall_albedo.png");
    save_noise(shell / "in/deep/er/wall_n.png");
    save_noise(shell / "in/twin.png");
    save_noise(shell / "in/twin.TGA");
    save_noise(shell / "in/.hidden/no.png");
    write_bytes(shell / "in/broken.png", "no picture");
    write_bytes(shell / "in/notes.txt", "no picture, and none by its name");

    const auto run = [&](const std::string& options = "") { return shell("mips --batch in in/out --json " + options); };
    const Outcome first = run();
    EXPECT_EQ(first.code, 1) << first;
    ASSERT_EQ(stderr_lines(first).size(), 1u);
    EXPECT_NE(first.err.find("2 of 5 pictures failed"), std::string::npos) << first;
    const json report = first.json();
    EXPECT_EQ(report["files"], 5);
    EXPECT_EQ(report["made"], 3);
    EXPECT_EQ(report["skipped"], 0);
    EXPECT_EQ(report["roles"], json({{"color", 2}, {"normal", 1}}));
    EXPECT_EQ(failed_in(report), (std::set<std::string>{"broken.png", "twin.png"}));
    const std::set<std::string> made{manifest_name, "wall_albedo.ktx2", "deep/er/wall_n.ktx2", "twin.ktx2"};
    EXPECT_EQ(files_below(shell / "in/out"), made);

    fs::remove(shell / "in/broken.png");
    fs::remove(shell / "in/twin.png");
    const auto expect = [&](const Outcome& again, int made_now, int skipped) {
        ASSERT_TRUE(succeeds(again));
        EXPECT_EQ(again.json()["made"], made_now);
        EXPECT_EQ(again.json()["skipped"], skipped);
    };
    expect(run(), 0, 3);
    fs::last_write_time(shell / "in/wall_albedo.png", fs::file_time_type::clock::now());  // its content is the same
    expect(run(), 0, 3);
    save_noise(shell / "in/wall_albedo.png", 4);
    expect(run(), 1, 2);
    fs::remove(shell / "in/out/twin.ktx2");
    expect(run(), 1, 2);
    write_bytes(shell / "in/out/wall_albedo.ktx2", "somebody else's");
    expect(run(), 1, 2);
    const std::string same_size(fs::file_size(shell / "in/out/twin.ktx2"), '?');
    write_bytes(shell / "in/out/twin.ktx2", same_size);
    fs::last_write_time(shell / "in/out/twin.ktx2", fs::file_time_type::clock::now() + std::chrono::seconds(5));
    expect(run(), 1, 2);
    expect(run("--edge wrap"), 3, 0);
    write_bytes(shell / ("in/out/" + std::string(manifest_name)), "{ damaged");
    expect(run("--edge wrap"), 3, 0);
    EXPECT_EQ(files_below(shell / "in/out"), made);
}

TEST(Batch, LinksThatLeadNowhereFailAlone) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in/a.png");
    fs::create_symlink("circle.png", shell / "in/circle.png");
    fs::create_symlink("gone.png", shell / "in/lost.png");
    fs::create_symlink("a.png", shell / "in/b.png");
    fs::create_directory_symlink(".", shell / "in/again");
    const Outcome run = shell("mips --batch in out --json");
    EXPECT_EQ(run.code, 1) << run;
    EXPECT_EQ(run.json()["made"], 2);
    EXPECT_EQ(failed_in(run.json()), (std::set<std::string>{"circle.png", "lost.png"}));
    EXPECT_EQ(files_below(shell / "out"), (std::set<std::string>{manifest_name, "a.ktx2", "b.ktx2"}));
}

TEST(Batch, AManifestThatIsADirectoryIsNamed) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in/a.png");
    fs::create_directories(shell / ("out/" + std::string(manifest_name)));
    EXPECT_TRUE(fails(1, shell("mips --batch in out"), manifest_name));
    EXPECT_TRUE(files_below(shell / "out").empty());
}

TEST(Batch, RulesDecideByTheFirstThatFits) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const std::string name : {"a_n.png", "sub/b_n.png", "sub/c.png", "sources/a.png", "sources/x/b.png",
                                   "Foliage/oak/leaf.PNG", "wall_rough.png", "wall_N.png", "lone_rough.png"})
        save_noise(shell / ("in/" + name), name == "Foliage/oak/leaf.PNG" ? 4 : 3);
    write_bytes(shell / "rules.json", R"({ "version": 1, "rules": [
        { "match": "sources/**", "skip": true },
        { "match": "sub/*_n.png", "role": "data" },
        { "match": "**/*_n.png", "role": "normal", "two-channel": true },
        { "match": "foliage/**/*.png", "role": "alpha-tested", "alpha-threshold": 0.4, "edge": "wrap,clamp" },
        { "match": "*_rough.png", "role": "roughness", "normal": "*_N.png", "channels": 1 },
        { "match": "?.png", "role": "mask", "levels": 1 } ] })");
    const std::string line = "mips --batch in out --rules rules.json --json";
    const auto plan = plan_of(shell(line + " --dry-run"));
    ASSERT_EQ(plan.size(), 9u);
    for (const auto& [file, role] : std::map<std::string, std::string>{{"a_n.png", "normal"},
                                                                       {"sub/b_n.png", "data"},
                                                                       {"sub/c.png", "mask"},
                                                                       {"Foliage/oak/leaf.PNG", "alpha-tested"},
                                                                       {"wall_rough.png", "roughness"},
                                                                       {"wall_N.png", "normal"}})
        EXPECT_EQ(plan.at(file)["role"], role) << file;
    EXPECT_EQ(plan.at("sources/x/b.png")["state"], "left out");
    EXPECT_EQ(plan.at("sub/c.png")["state"], "make");
    EXPECT_EQ(plan.at("lone_rough.png")["state"], "fail");  // its normal map is missing
    EXPECT_FALSE(fs::exists(shell / "out"));

    const Outcome run = shell(line);
    EXPECT_EQ(run.code, 1) << run;
    EXPECT_EQ(run.json()["made"], 6);
    EXPECT_EQ(run.json()["left_out"], 2);
    // A rule says what the options of one texture say.
    ASSERT_TRUE(
        succeeds(shell("mips in/wall_rough.png rough.ktx2 --role roughness --normal in/wall_N.png --channels 1")));
    ASSERT_TRUE(succeeds(shell("mips in/a_n.png normal.ktx2 --role normal --two-channel")));
    EXPECT_EQ(bytes_of(shell / "out/wall_rough.ktx2"), bytes_of(shell / "rough.ktx2"));
    EXPECT_EQ(bytes_of(shell / "out/a_n.ktx2"), bytes_of(shell / "normal.ktx2"));
    // The normal map is among what a roughness map is made of.
    save_noise(shell / "in/wall_N.png", 4);
    EXPECT_EQ(shell(line).json()["made"], 2);
}

TEST(Batch, RulesThatAreWrongAreRefusedBeforeAnythingIsMade) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in/a.png");
    for (const auto& [rule, word] : std::map<std::string, std::string>{
             {R"({"match": "*", "rolle": "normal"})", "rolle"},
             {R"({"match": "*", "role": "norml"})", "color, color-linear, normal"},
             {R"({"match": "*", "edge": 3})", "edge"},
             {R"({"match": "*", "levels": 0})", "levels"},
             {R"({"match": "*", "role": "color", "two-channel": true})", "two-channel: the role is color"},
             {R"({"match": "*_?.png", "role": "roughness", "normal": "*_n.png"})", "one *"},
             {R"({"role": "normal"})", "match"},
             {R"(7)", "rule 1"},
             {R"({)", "JSON"}}) {
        write_bytes(shell / "rules.json", R"({"version": 1, "rules": [)" + rule + "]}");
        const Outcome run = shell("mips --batch in out --rules rules.json");
        EXPECT_TRUE(fails(1, run, word)) << rule;
        EXPECT_TRUE(fails(1, run, "rules.json")) << rule;
    }
    EXPECT_TRUE(fails(1, shell("mips --batch in out --rules none.json"), "none.json"));
    EXPECT_TRUE(fails(1, shell("mips --batch none out"), "none"));
    write_bytes(shell / "file", "");
    EXPECT_TRUE(fails(1, shell("mips --batch in file"), "file"));
    EXPECT_FALSE(fs::exists(shell / "out"));
}

TEST(Batch, ThreadsAndMemoryDoNotChangeTheFiles) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (int i = 0; i < 12; ++i) save_noise(shell / ("in/" + std::to_string(i) + ".png"), 3, 5 + 20 * i);
    for (const std::string options : {"one --threads 1", "three --threads 3", "little --threads 3 --memory 1MB"})
        ASSERT_TRUE(succeeds(shell("mips --batch in " + options)));
    const std::set<std::string> files = files_below(shell / "one");
    EXPECT_EQ(files.size(), 13u);
    for (const std::string other : {"three", "little"}) {
        EXPECT_EQ(files_below(shell / other), files);
        for (const std::string& file : files) {
            if (file == manifest_name) continue;
            EXPECT_EQ(bytes_of(shell / ("one/" + file)), bytes_of(shell / (other + "/" + file))) << file;
        }
    }
}

TEST(Batch, AnInterruptedOneLeavesWholeFilesAndGoesOn) {
    const Shell shell(BANDLIMIT_PROGRAM);
    constexpr int count = 60;
    save_noise(shell / "in/0.png", 4, 300);
    for (int i = 1; i < count; ++i) fs::copy_file(shell / "in/0.png", shell / ("in/" + std::to_string(i) + ".png"));
    const auto interrupt = [&](pid_t process) {
        return fs::exists(shell / ("out/" + std::string(manifest_name))) && ::kill(process, SIGINT) == 0;
    };
    const Outcome stopped = shell("mips --batch in out --role color", {.meanwhile = interrupt});
    EXPECT_EQ(stopped.signal, SIGINT) << stopped;

    int whole = 0;
    for (const std::string& file : files_below(shell / "out")) {
        const std::string bytes = bytes_of(shell / ("out/" + file));
        if (file == manifest_name) {
            EXPECT_GE(json::parse(bytes)["outputs"].size(), 1u);
            continue;
        }
        ASSERT_TRUE(file.ends_with(".ktx2") && !file.starts_with(".")) << file;
        EXPECT_EQ(read_container(std::as_bytes(std::span(bytes)), file).levels.size(), 9u);
        ++whole;
    }
    EXPECT_LT(whole, count);

    const Outcome rest = shell("mips --batch in out --role color --json");
    ASSERT_TRUE(succeeds(rest));
    EXPECT_GE(rest.json()["skipped"], 1);
    EXPECT_EQ(rest.json()["made"].get<int>() + rest.json()["skipped"].get<int>(), count);
    EXPECT_EQ(files_below(shell / "out").size(), std::size_t{count + 1});
}

}  // namespace
}  // namespace bandlimit
