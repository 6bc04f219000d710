// What the verbs share: options and errors.
#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "apps/command_line.h"
#include "apps/console.h"
#include "bandlimit/color/depth.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit::app {

/// A run of the program: verbs add themselves and name what to run.
struct Program {
    Console& console;
    std::string command;  ///< the command line as one would paste it
    CommandLine command_line;
    std::function<void()> selected = {};  ///< set by parsing

    /// Adds a verb; `example` is a command line that works as pasted, or several, each on a line that begins with two
    /// blanks but the first.
    Verb add_verb(const std::string& name, const std::string& summary, const std::string& example);
    /// `check` sees the parsed options and throws Error or UsageError (exit 2); `run` does the work.
    void on(Verb verb, std::function<void()> check, std::function<void(Console&)> run);
    /// Adds --quiet.
    void add_quiet(Verb verb);
};

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

/// Options that many verbs have, with one wording.
Option add_space(Verb verb, Space& space);
Option add_depth(Verb verb, std::optional<Depth>& depth);
Option add_edge(Verb verb, std::optional<Edge>& edge);
/// `tile` stays 0 for an output stored in rows.
Option add_tiles(Verb verb, int& tile);
Option add_threads(Verb verb, Parallel& parallel);
Option add_json(Verb verb, bool& json);

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
