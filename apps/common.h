// What the verbs share: options and errors.
#pragma once
#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "apps/console.h"
#include "bandlimit/color/depth.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit::app {

/// Something that the command line alone shows to be wrong: exit 2. While the command line is parsed and checked, an
/// Error of the library means the same; once a verb runs, every other exception is exit 1.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A run of the program: verbs add themselves to `cli` and name what to run.
struct Program {
    Console& console;
    std::string command = {};  ///< the command line as one would paste it
    CLI::App cli{"bandlimit: sampling done right, for graphics", "bandlimit"};
    std::function<void()> selected = {};  ///< set by parsing

    /// Adds a verb; `example` is a command line that works as pasted, or several, each on a line that begins with two
    /// blanks but the first.
    CLI::App* add_verb(const std::string& name, const std::string& summary, const std::string& example);
    /// `check` sees the parsed options and throws Error or UsageError (exit 2); `run` does the work.
    void on(CLI::App* verb, std::function<void()> check, std::function<void(Console&)> run);
    /// Adds --quiet.
    void add_quiet(CLI::App* verb);
};

/// Makes `app`, which has all its subcommands, take exactly one of them; a message that lists them, each of which is a
/// `noun`, takes the place of the parser's own.
void require_one_subcommand(CLI::App& app, const std::string& noun);

void add_info(Program& program);
void add_resize(Program& program);
void add_convolve(Program& program);
void add_bokeh(Program& program);
void add_mips(Program& program);
void add_pattern(Program& program);
void add_compare(Program& program);
void add_analyze(Program& program);
void add_design(Program& program);
void add_audit(Program& program);
void add_tour(Program& program);

/// For options that are numbers: refuses others than `least` to `most`.
template <class Number>
CLI::Validator in_range(Number least, Number most) {
    const std::string range = fmt::format("{} to {}", least, most);
    return {[=](std::string& text) {
                Number value{};
                if (!CLI::detail::lexical_cast(text, value) || !(value >= least && value <= most))
                    return fmt::format("\"{}\" is out of range; pass {}", text, range);
                return std::string();
            },
            range};
}

/// Options that many verbs have, with one wording.
CLI::Option* add_space(CLI::App* verb, Space& space);
CLI::Option* add_depth(CLI::App* verb, std::optional<Depth>& depth);
CLI::Option* add_edge(CLI::App* verb, std::optional<Edge>& edge);
/// `tile` stays 0 for an output stored in rows.
CLI::Option* add_tiles(CLI::App* verb, int& tile);
CLI::Option* add_threads(CLI::App* verb, Parallel& parallel);
CLI::Option* add_json(CLI::App* verb, bool& json);

/// How many threads codecs may use for what they do in parallel, and how many are left for the stages of a pipeline
/// that reads and writes through them: together no more than the caller allows.
struct Shares {
    Parallel codecs, stages;
};
Shares shares_of(Parallel parallel);

struct Size {
    int width = 0, height = 0;
};
/// "1920x1080". Throws UsageError, naming the option.
Size parse_size(const std::string& option, const std::string& text);

/// A decimal or a fraction such as 1/6. Throws UsageError, naming the option.
double parse_number(const std::string& option, const std::string& text);
/// Numbers between commas.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);

/// Checks what the command line alone shows of an output: that its format is known and holds the depth and the tiles
/// (UsageError). A path that exists and is no regular file is refused before that, as a matter of the file system.
void check_output_format(const std::string& path, std::optional<Depth> depth, int tile = 0);

/// Seconds that pieces of work took, added up.
class Stopwatch {
public:
    /// Since this watch was made.
    double total() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

    template <class Work>
    decltype(auto) time(double& seconds, Work work) {
        struct Add {
            double& seconds;
            std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
            ~Add() { seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
        } add{seconds};
        return work();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace bandlimit::app
