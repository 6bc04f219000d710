// What the subcommands of `design` share: one makes a Design, this prints, draws, writes and ships it.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/console/common.h"
#include "apps/page/plot.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit::app {

/// A design, as people and as programs read it.
struct Design {
    TapsFile file;                        ///< with its cost and multiply_adds, which are printed from here
    std::vector<std::string> lines;       ///< what was made, its error and its response, for people
    std::vector<std::string> table = {};  ///< of its weights, printed last and in no shader
    int enlarges = 1;                     ///< outputs per texel and axis
    int intermediates = 0;                ///< pictures that a first pass writes and a second reads
    std::vector<Panel> panels;            ///< of --plot
};

/// The verb `design`, and what its subcommands need to add themselves.
struct DesignVerb {
    Program& program;
    Verb cli;
};

/// Adds a subcommand with the options that all have. The caller adds its own to what is returned.
///
/// `check` sees the parsed options, and throws Error or UsageError for what they alone show to be wrong; `make` does
/// the work, once all outputs are known to be possible.
Verb add_design_kind(const DesignVerb& verb, const std::string& name, const std::string& summary,
                     const std::string& example, std::function<void()> check, std::function<Design(Console&)> make);

/// The subcommands, each in a file of its own.
void add_design_disk(const DesignVerb& verb);
void add_design_downsample(const DesignVerb& verb);
void add_design_separable(const DesignVerb& verb);
void add_design_derivative(const DesignVerb& verb);
void add_design_gaussian(const DesignVerb& verb);
void add_design_sharpen(const DesignVerb& verb);
void add_design_kernel(const DesignVerb& verb);

}  // namespace bandlimit::app
