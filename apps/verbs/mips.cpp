// bandlimit mips: the command line of the mip chains.
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "bandlimit/job/batch.h"
#include "bandlimit/job/level_images.h"
#include "bandlimit/job/make_texture.h"

namespace bandlimit::app {
namespace {

using namespace job;
using nlohmann::ordered_json;

struct Options {
    std::vector<std::string> files;         ///< IN... OUT
    std::vector<Option> of_levels, of_one;  ///< options that --keep-levels, or --batch, does not take
    MipsJob job;
    bool is_batch = false;
    BatchJob batch;
    Parallel parallel;
    bool json = false;
};

/// The type of what a setter takes.
template <class Value>
Value value_set_by(void (*)(MipsRecipe&, Value));

/// Throws UsageError if one of these options was given.
void refuse(const std::vector<Option>& options, const std::string& by, const std::string& reason) {
    for (const Option option : options)
        if (option.is_given())
            throw UsageError(
                fmt::format("{} does not go with {}: {}; leave one of them out", option.name(), by, reason));
}

/// What names, numbers and options of one texture alone show to be wrong.
void check_one(const MipsJob& job) {
    check_job(job);
    if (!container_of_path(job.output)) check_output_format(path_of_level(job.output, 0), job.recipe.depth);
}

/// Splits the files into inputs and output, and checks what the command line alone shows.
void check(Options& o) {
    if (o.files.size() < 2)
        throw UsageError(o.is_batch ? "mips --batch: a directory is missing; give DIR and OUTDIR"
                                    : "mips: a file is missing; give IN and OUT, as mips wall.png wall.ktx2");
    if (o.is_batch && o.files.size() > 2)
        throw UsageError(fmt::format("mips --batch: {} directories; give DIR and OUTDIR", o.files.size()));
    o.job.output = o.files.back();
    o.job.inputs.assign(o.files.begin(), o.files.end() - 1);
    if (o.job.keep_levels) refuse(o.of_levels, "--keep-levels", "levels are copied as they are");
    if (!o.is_batch) return check_one(o.job);
    refuse(o.of_one, "--batch", "every picture makes a texture of its own");
    o.batch.in = o.files.front(), o.batch.out = o.files.back();
    o.batch.recipe = o.job.recipe;
    if (o.job.recipe.role) check_recipe(o.job.recipe, *o.job.recipe.role);
}

std::string_view name_of(MipSource from) { return from == MipSource::base ? "base" : "previous"; }

void note_choices(const Console& console, const MipsJob& job, const MipsReport& report) {
    const std::string& path = job.inputs.front();
    if (report.role && report.role->from != "option")
        console.note(fmt::format("{} has the role {}, because {}; --role chooses another", path,
                                 name_of(report.role->role),
                                 report.role->because.empty() ? "its name says nothing else"
                                                              : "its name holds \"" + report.role->because + "\""));
    for (const std::string& text : notes_of(report, path)) console.note(text);
}

ordered_json levels_json(const MipsReport& report) {
    ordered_json levels = ordered_json::array();
    for (const MipsReport::Level& l : report.levels) {
        levels.push_back({{"level", levels.size()}, {"width", l.width}, {"height", l.height}, {"bytes", l.bytes}});
        if (!l.file.empty()) levels.back()["file"] = l.file;
        if (l.coverage) levels.back()["coverage"] = *l.coverage;
    }
    return levels;
}

ordered_json report_of(const Options& o, const MipsReport& r, double total) {
    ordered_json report{{"input", o.job.inputs},
                        {"output",
                         {{"file", o.job.output},
                          {"format", r.format},
                          {"width", r.levels.front().width},
                          {"height", r.levels.front().height},
                          {"levels", r.levels.size()},
                          {"layers", r.layers},
                          {"faces", r.faces},
                          {"depth", name_of(r.depth)},
                          {"channels", r.channels},
                          {"srgb", r.is_srgb},
                          {"premultiplied", r.is_premultiplied}}}};
    if (r.role) {
        report["role"] = name_of(r.role->role);
        report["role_from"] = r.role->from;
        report["role_because"] = r.role->because;
        report["filter"] = {{"x", r.filter_x}, {"y", r.filter_y}};
        report["from"] = name_of(o.job.recipe.from);
        report["edge"] = {{"x", name_of(r.edge_x)}, {"y", name_of(r.edge_y)}};
    }
    report["levels"] = levels_json(r);
    report["threads"] = o.parallel.count();
    report["seconds"] = {{"read", r.read}, {"filter", r.filter}, {"write", r.write}, {"total", total}};
    return report;
}

std::string twice(std::string_view x, std::string_view y) {
    return x == y ? std::string(x) : fmt::format("{} along x, {} along y", x, y);
}

void print(Console& console, const Options& o, const MipsReport& r) {
    console.print("{}: {}", o.job.output, r.format);
    if (r.layers > 1) console.print(", {} layers", r.layers);
    if (r.faces > 1) console.print(", {} faces", r.faces);
    console.print("\n  texels    {} x {}, {} channel{} of {}{}{}\n", r.levels.front().width, r.levels.front().height,
                  r.channels, r.channels == 1 ? "" : "s", name_of(r.depth), r.is_srgb ? ", sRGB" : "",
                  r.is_premultiplied ? ", premultiplied" : "");
    if (r.role) {
        console.print("  role      {}{}\n", name_of(r.role->role),
                      r.role->because.empty() ? "" : " (" + r.role->because + ")");
        console.print("  filter    {}, from {}\n", twice(r.filter_x, r.filter_y),
                      o.job.recipe.from == MipSource::base ? "level 0" : "the level above");
        console.print("  edge      {}\n",
                      r.faces > 1 ? "the neighbouring face" : twice(name_of(r.edge_x), name_of(r.edge_y)));
    }
    for (std::size_t level = 0; level < r.levels.size(); ++level) {
        const MipsReport::Level& l = r.levels[level];
        console.print("  level {:<3} {:>5} x {:<5} {:>11} bytes", level, l.width, l.height, l.bytes);
        if (l.coverage) console.print("  {:6.2f} % pass", 100 * *l.coverage);
        if (!l.file.empty()) console.print("  {}", l.file);
        console.print("\n");
    }
}

void run_one(const Options& o, Console& console) {
    const Stopwatch watch;
    const MipsReport report = make_texture(o.job, context_of(console, o.parallel));
    note_choices(console, o.job, report);
    if (o.json) console.print_json(report_of(o, report, watch.total()));
    else print(console, o, report);
}

ordered_json report_of(const BatchReport& r) {
    ordered_json failed = ordered_json::array();
    for (const BatchReport::Failure& f : r.failed) failed.push_back({{"file", f.file}, {"error", f.error}});
    return {{"files", r.files()},     {"made", r.made},       {"skipped", r.skipped},
            {"left_out", r.left_out}, {"failed", failed},     {"notes", r.notes},
            {"roles", r.roles},       {"seconds", r.seconds}, {"megapixels_per_second", r.megapixels_per_second()}};
}

void print(Console& console, const BatchReport& r) {
    console.print("{} pictures: {} made, {} up to date, {} failed", r.files(), r.made, r.skipped, r.failed.size());
    if (r.left_out > 0) console.print(", {} more left out by the rules", r.left_out);
    console.print("; {:.1f} s", r.seconds);
    if (r.made > 0) console.print(", {:.1f} MPix/s", r.megapixels_per_second());
    console.print("\n");
    for (const auto& [role, count] : r.roles) console.print("  {:<13} {:>6}\n", role, count);
    if (!r.failed.empty()) console.print("failed:\n");
    for (const BatchReport::Failure& f : r.failed) console.print("  {}: {}\n", f.file, f.error);
}

void print(Console& console, const std::vector<PlannedFile>& plan) {
    for (const PlannedFile& file : plan)
        console.print("{:<11} {:<13} {}{}\n", file.state, file.role, file.input,
                      file.because.empty() ? "" : " (" + file.because + ")");
}

ordered_json report_of(const std::vector<PlannedFile>& plan) {
    ordered_json files = ordered_json::array();
    for (const PlannedFile& file : plan)
        files.push_back({{"file", file.input},
                         {"output", file.output},
                         {"state", file.state},
                         {"role", file.role},
                         {"role_because", file.because}});
    return {{"plan", files}};
}

void run_many(const Options& o, Console& console) {
    if (o.batch.is_dry) {
        const std::vector<PlannedFile> plan = plan_batch(o.batch, context_of(console, o.parallel));
        return o.json ? console.print_json(report_of(plan)) : print(console, plan);
    }
    const BatchReport report = make_batch(o.batch, context_of(console, o.parallel));
    for (const std::string& text : report.notes) console.note(text);
    o.json ? console.print_json(report_of(report)) : print(console, report);
    if (!report.failed.empty())
        throw std::runtime_error(fmt::format("{} of {} pictures failed; mend those that are listed, and run this again",
                                             report.failed.size(), report.files()));
}

/// Adds the options that say how levels are made, and returns them.
std::vector<Option> add_recipe(Verb verb, const std::shared_ptr<Options>& o) {
    std::vector<Option> added;
    for (const RecipeOption& option : recipe_options()) {
        const std::string name = "--" + std::string(option.name), help(option.help);
        const auto add = [&](auto set) {
            if constexpr (std::is_same_v<decltype(set), RecipeOption::Flag>) {
                added.push_back(verb.add_flag(name, o->job.recipe.*set, help));
            } else {
                using Value = std::remove_cvref_t<decltype(value_set_by(set))>;
                const auto call = [o, set](const Value& value) { set(o->job.recipe, value); };
                added.push_back(verb.add_option_function<Value>(name, call, help).type_name(std::string(option.type)));
            }
        };
        std::visit(add, option.set);
    }
    verb.option("--levels").in_range(1, most_levels);
    return added;
}

void add_batch(Verb verb, const std::shared_ptr<Options>& o) {
    Option batch =
        verb.add_flag("--batch", o->is_batch,
                      "Make a texture of every image below DIR, at the same place below OUTDIR, in files of --format;\n"
                      "what is up to date is skipped, by content, and what fails does not stop the others");
    verb.add_option_function<std::string>(
            "--format",
            [o](const std::string& s) {
                if (s != "ktx2" && s != "dds")
                    throw UsageError("--format: \"" + s + "\" is unknown; choose ktx2 or dds");
                o->batch.format = s == "dds" ? Container::dds : Container::ktx2;
            },
            "Kind of files that --batch makes; default ktx2")
        .needs(batch)
        .type_name("ktx2|dds");
    verb.add_option("--rules", o->batch.rules,
                    "Which pictures of a batch have which role and options: a JSON file, see docs/batch.md")
        .needs(batch)
        .type_name("FILE");
    verb.add_option_function<std::string>(
            "--memory", [o](const std::string& s) { o->batch.memory = parse_bytes("--memory", s); },
            "Memory for the pictures of a batch that are worked on at a time, e.g. 4GB; default: a quarter of\n"
            "what is available; one picture is always worked on")
        .needs(batch)
        .type_name("SIZE");
    verb.add_flag("--dry-run", o->batch.is_dry, "Show what --batch would do, with the roles it guesses, and stop")
        .needs(batch);
}

}  // namespace

void add_mips(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("mips", "Make textures with all their mip levels, by what their texels mean",
                                 "bandlimit mips examples/coffee.png coffee.ktx2 --role color\n"
                                 "  bandlimit mips examples/gravel.png gravel_%d.png --role height --edge wrap\n"
                                 "  bandlimit mips coffee.ktx2 coffee.dds --keep-levels\n"
                                 "  bandlimit mips --batch examples textures --edge wrap");
    verb.add_option("FILES", o->files,
                    "IN... OUT: images or textures (their level 0) to read, and a .ktx2 or .dds file to write, or\n"
                    "images, one per level, with %d for its number: wall_%d.png. With --batch: DIR OUTDIR")
        .required();
    o->of_levels = add_recipe(verb, o);
    Option cube = verb.add_flag("--cube", o->job.is_cube,
                                "Six inputs are the faces +x -x +y -y +z -z of a cube map, filtered across "
                                "their edges");
    Option array = verb.add_flag("--array", o->job.is_array, "The inputs, of equal size, are layers");
    Option keep = verb.add_flag("--keep-levels", o->job.keep_levels,
                                "Copy the levels of a texture as they are, into another kind of file");
    o->of_levels.insert(o->of_levels.end(), {cube, array});
    o->of_one = {cube, array, keep, verb.option("--normal")};
    add_batch(verb, o);
    add_threads(verb, o->parallel).description("Most threads to keep busy; 0 (default): one per core");
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); },
        [o](Console& console) { o->is_batch ? run_many(*o, console) : run_one(*o, console); });
}

}  // namespace bandlimit::app
