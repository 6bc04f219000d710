#include "apps/console/common.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

namespace bandlimit::app {

Verb Program::add_verb(const std::string& name, const std::string& summary, const std::string& example) {
    const Verb verb = command_line.program().add_subcommand(name, summary);
    verb.example(example);
    return verb;
}

void Program::on(Verb verb, std::function<void()> check, std::function<void(Console&)> run) {
    verb.on([this, check = std::move(check), run = std::move(run)] {
        check();
        selected = [this, run] { run(console); };
    });
}

void Program::add_quiet(Verb verb) { verb.add_flag("--quiet", console.quiet, "No notes, no progress bar"); }

Option add_space(Verb verb, Space& space) {
    return verb
        .add_option_function<std::string>(
            "--space", [&space](const std::string& s) { space = parse_space(s); },
            "What the file's codes mean: auto (8 and 16 bit: sRGB, float: linear, unless the file says\n"
            "otherwise), srgb, linear, or data (never decoded: normals, masks, heights)")
        .type_name("auto|srgb|linear|data");
}

Option add_depth(Verb verb, std::optional<Depth>& depth) {
    return verb
        .add_option_function<std::string>(
            "--depth", [&depth](const std::string& s) { depth = parse_depth(s); },
            "Depth of the output; default: that of the input, or the nearest the format holds")
        .type_name("u8|u16|f16|f32");
}

Option add_edge(Verb verb, std::optional<Edge>& edge) {
    return verb
        .add_option_function<std::string>(
            "--edge", [&edge](const std::string& s) { edge = parse_edge(s); },
            "What lies outside the image; reflect repeats the border sample, renormalize (the default)\n"
            "leaves it out and rescales the other weights")
        .type_name("clamp|reflect|wrap|zero|renormalize");
}

Option add_tiles(Verb verb, int& tile) {
    return verb
        .add_option("--tiles", tile,
                    "Store square tiles of N pixels a side, a multiple of 16 up to 4096, e.g. 256 (TIFF and EXR);\n"
                    "default: rows")
        .in_range(1, 4096)
        .type_name("N");
}

Option add_threads(Verb verb, Parallel& parallel) {
    return verb
        .add_option(
            "--threads", parallel.threads,
            "Most threads to keep busy; 0 (default): one per core; 1: reading, filtering and writing take turns\n"
            "instead of overlapping")
        .in_range(0, 1024)
        .type_name("N");
}

Option add_json(Verb verb, bool& json) {
    return verb.add_flag("--json", json, "Print a report as JSON on stdout, and nothing else there");
}

job::Context context_of(const Console& console, const Parallel& parallel) {
    return {parallel, [&console](std::string_view text) { console.note(text); },
            [bar = std::make_shared<std::optional<Progress>>(), doing = std::make_shared<std::string>(),
             &console](const job::Progress& p) {
                if (!*bar || *doing != p.doing) {
                    *doing = p.doing;
                    bar->emplace(console, *doing, p.total, std::string(p.unit));
                }
                (*bar)->advance_to(p.done);
            }};
}

Size parse_size(const std::string& option, const std::string& text) {
    const auto refuse = [&]() -> Size {
        throw UsageError(fmt::format(
            "{}: \"{}\" is not a size; write WIDTHxHEIGHT, e.g. 1920x1080, each from 1 to 2147483647", option, text));
    };
    Size size;
    const char* const end = text.data() + text.size();
    const auto [after_width, width_status] = std::from_chars(text.data(), end, size.width);
    if (width_status != std::errc{} || after_width == end || *after_width != 'x') return refuse();
    const auto [after_height, height_status] = std::from_chars(after_width + 1, end, size.height);
    if (height_status != std::errc{} || after_height != end || size.width < 1 || size.height < 1) return refuse();
    return size;
}

double parse_number(const std::string& option, const std::string& text) {
    const auto read = [&](std::string_view part) {
        double value = 0;
        const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (status != std::errc{} || end != part.data() + part.size() || !std::isfinite(value))
            throw UsageError(fmt::format("{}: \"{}\" is not a number; use e.g. 0.25 or 1/6", option, text));
        return value;
    };
    const auto slash = text.find('/');
    if (slash == std::string::npos) return read(text);
    const double denominator = read(std::string_view(text).substr(slash + 1));
    if (denominator == 0) throw UsageError(fmt::format("{}: \"{}\" divides by zero; use e.g. 1/6", option, text));
    return read(std::string_view(text).substr(0, slash)) / denominator;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        numbers.push_back(parse_number(option, text.substr(begin, comma - begin)));
        begin = comma + 1;
    }
    return numbers;
}

void check_output_format(const std::string& path, std::optional<Depth> depth, int tile) {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) check_output_path(path);
    const FormatAbilities format = abilities_of(path);
    check_tile(format, tile);
    if (!depth || nearest_depth(format, *depth) == *depth) return;
    std::string depths;
    for (const Depth d : format.depths) depths += (depths.empty() ? "" : ", ") + std::string(name_of(d));
    throw UsageError(fmt::format("--depth: {} files cannot hold {}; choose {}", format.name, name_of(*depth), depths));
}

}  // namespace bandlimit::app
