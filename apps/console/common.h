// What the verbs share: options and errors.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "apps/console/command_line.h"
#include "apps/console/console.h"
#include "bandlimit/color/depth.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::app {

using job::Stopwatch;

/// A run of the program: verbs add themselves and name what to run.
struct Program {
    Console& console;
    std::string command;  ///< the command line, quoted for a shell
    CommandLine command_line;
    std::function<void()> selected = {};  ///< set by parsing

    /// Adds a verb; `example` is a command line that works when pasted, or several: each further one on its own line,
    /// which begins with two blanks.
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
void add_bilateral(Program& program);
void add_guided(Program& program);
void add_gradients(Program& program);
void add_mips(Program& program);
void add_pattern(Program& program);
void add_supersample(Program& program);
void add_temporal(Program& program);
void add_raster(Program& program);
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

/// What a job is given: threads, and a console for what it has to say.
job::Context context_of(const Console& console, const Parallel& parallel);

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

}  // namespace bandlimit::app
