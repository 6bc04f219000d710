#include "apps/common.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace bandlimit::app {
namespace {

std::FILE* real_stderr = stderr;
bool quiet = false;

/// Errors of CLI11 and of codecs may hold line breaks; ours is one line.
std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text;
}

}  // namespace

CLI::App* Program::add_verb(const std::string& name, const std::string& summary, const std::string& example) {
    CLI::App* verb = cli.add_subcommand(name, summary);
    verb->footer("Example:\n  " + example);
    return verb;
}

void Program::on(CLI::App* verb, std::function<void()> check, std::function<void()> run) {
    verb->callback([this, check = std::move(check), run = std::move(run)] {
        check();
        selected = run;
    });
}

void require_one_subcommand(CLI::App& app, const std::string& noun) {
    app.require_subcommand(0, 1);
    app.allow_extras();
    app.callback([&app, noun] {
        const std::vector<std::string> words = app.remaining();
        if (words.empty() && !app.get_subcommands().empty()) return;
        std::string names;
        for (const CLI::App* command : app.get_subcommands({}))
            names += (names.empty() ? "" : ", ") + command->get_name();
        throw UsageError(fmt::format("{} {}; choose one of: {}",
                                     words.empty() ? "there is no" : "\"" + words.front() + "\" is no", noun, names));
    });
}

CLI::Option* add_space(CLI::App* verb, Space& space) {
    return verb
        ->add_option_function<std::string>(
            "--space", [&space](const std::string& s) { space = parse_space(s); },
            "What the file's codes mean: auto (8 and 16 bit: sRGB, float: linear, unless the file says\n"
            "otherwise), srgb, linear, or data (never decoded: normals, masks, heights)")
        ->type_name("auto|srgb|linear|data");
}

CLI::Option* add_depth(CLI::App* verb, std::optional<Depth>& depth) {
    return verb
        ->add_option_function<std::string>(
            "--depth", [&depth](const std::string& s) { depth = parse_depth(s); },
            "Depth of the output; default: that of the input, or the nearest the format holds")
        ->type_name("u8|u16|f16|f32");
}

CLI::Option* add_edge(CLI::App* verb, std::optional<Edge>& edge) {
    return verb
        ->add_option_function<std::string>(
            "--edge", [&edge](const std::string& s) { edge = parse_edge(s); },
            "What lies outside the image; reflect repeats the border sample, renormalize (the default)\n"
            "leaves it out and rescales the other weights")
        ->type_name("clamp|reflect|wrap|zero|renormalize");
}

CLI::Option* add_tiles(CLI::App* verb, int& tile) {
    return verb
        ->add_option("--tiles", tile,
                     "Store square tiles of N pixels a side, a multiple of 16 up to 4096, as 256 (TIFF and EXR);\n"
                     "default: rows")
        ->check(CLI::PositiveNumber)
        ->type_name("N");
}

CLI::Option* add_threads(CLI::App* verb, Parallel& parallel) {
    return verb
        ->add_option(
            "--threads", parallel.threads,
            "Most threads to keep busy; 0 (default): one per core; 1: reading, filtering and writing take turns\n"
            "instead of overlapping")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
}

CLI::Option* add_json(CLI::App* verb, bool& json) {
    return verb->add_flag("--json", json, "Print a report as JSON on stdout, and nothing else there");
}

CLI::Option* add_quiet(CLI::App* verb) { return verb->add_flag("--quiet", quiet, "No notes, no progress bar"); }

Shares shares_of(Parallel parallel) {
    // A codec that works in parallel keeps its stage's thread busy too; below three OpenImageIO does not try.
    const int threads = parallel.count(), quarter = threads / 4;
    const int codecs = quarter >= 3 ? quarter : 1;
    return {{codecs}, {threads - codecs + 1}};
}

Size parse_size(const std::string& option, const std::string& text) {
    const auto refuse = [&]() -> Size {
        throw UsageError(fmt::format(
            "{}: \"{}\" is no size; write WIDTHxHEIGHT, as 1920x1080, each from 1 to 2147483647", option, text));
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
            throw UsageError(fmt::format("{}: \"{}\" is no number; write as 0.25 or 1/6", option, text));
        return value;
    };
    const auto slash = text.find('/');
    if (slash == std::string::npos) return read(text);
    const double denominator = read(std::string_view(text).substr(slash + 1));
    if (denominator == 0) throw UsageError(fmt::format("{}: \"{}\" divides by zero; write as 1/6", option, text));
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

void print_json(const nlohmann::ordered_json& report) {
    // Names of files need not be UTF-8, JSON must.
    fmt::print("{}\n", report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void note(const std::string& text) {
    if (!quiet) fmt::print(real_stderr, "bandlimit: note: {}\n", one_line(text));
}

void print_error(const std::string& what) { fmt::print(real_stderr, "bandlimit: error: {}\n", one_line(what)); }

void silence_codecs() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // whose reports go to the same place
    const int kept = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept < 0 || nowhere < 0) return;
    real_stderr = fdopen(kept, "w");
    std::setvbuf(real_stderr, nullptr, _IONBF, 0);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
#endif
}

Progress::Progress(std::string label, double total, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      visible_(!quiet && isatty(fileno(real_stderr)) != 0) {}

Progress::~Progress() {
    if (drawn_ != Clock::time_point{}) fmt::print(real_stderr, "\r\x1b[K");
}

void Progress::advance_to(double done) {
    using namespace std::chrono_literals;
    const auto now = Clock::now();
    if (!visible_ || now - start_ < 2s || now - drawn_ < 100ms || done <= 0) return;
    drawn_ = now;
    constexpr int width = 30;
    const double share = std::min(1.0, done / total_);
    const auto filled = static_cast<std::size_t>(share * width);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string rate = unit_.empty() ? "" : fmt::format("{:.1f} {}/s  ", done / elapsed, unit_);
    fmt::print(real_stderr, "\r\x1b[K{} [{:<{}}] {:3.0f} %  {}{:.0f} s left", label_, std::string(filled, '#'), width,
               100 * share, rate, elapsed * (1 / share - 1));
}

}  // namespace bandlimit::app
