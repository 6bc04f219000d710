// What kernels and taps do: weights at phases, responses, variance, spectrum, rows of banks. And patterns of samples.
// Stability: evolving.
#pragma once
#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bandlimit/io/taps_json.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/sampling/pattern.h"
#include "bandlimit/sampling/pattern_analysis.h"

namespace bandlimit::job {

/// Something to analyze.
using Subject = std::variant<Kernel, TapsFile>;

/// Whether `name` is that of a taps file: it ends in .json. Other names are kernels.
bool is_taps_name(const std::string& name);

/// The kernel `name`, or the content of the taps file `name`: a Kernel if it holds polynomial pieces, or else taps,
/// fetches or terms.
///
/// throws   Error as parse_kernel(); std::runtime_error for a file that cannot be read, that holds nothing of these, or
///          whose terms expand to more than 4 million weights
Subject read_subject(const std::string& name);

struct ResponseAt {
    double f;  ///< cycles per source sample
    std::complex<double> h;
};

/// Weights at one phase. Positions are in source samples, from sample 0.
struct PhaseReport {
    double phase = 0;
    int first = 0;
    std::optional<int> first_y;                ///< of radial kernels, fetches and terms, whose weights have rows
    std::vector<std::vector<double>> weights;  ///< one row, or all of them
    double sum = 1;                            ///< before they were normalised
    double variance = 0;                       ///< of the output, for white noise of variance 1
    double centroid = 0;
    std::vector<ResponseAt> responses;  ///< along x, relative to the output's position
    std::vector<ResponseAt> diagonal;   ///< of fetches and terms: H(f, f)
};

/// The kernel at one phase in [0, 1): the output lies so far right of sample 0. Weights are normalised to sum 1.
PhaseReport kernel_phase(const Kernel& kernel, double phase, const std::vector<double>& frequencies);
/// Weights as they are, at their one phase.
PhaseReport taps_phase(const TapsFile& file, const std::vector<double>& frequencies);
/// The first for a kernel, the second for taps, which ignore `phase`.
PhaseReport phase_of(const Subject& subject, double phase, const std::vector<double>& frequencies);
/// Where the output of `file` lies, right of input sample i * factor.
double output_position(const TapsFile& file);

/// Rows of the bank from one number of samples to another, which an analysis reports as they are applied.
struct BankRows {
    int from = 0, to = 0;
    std::vector<int> outputs = {};  ///< each in [0, to)
};
struct RowReport {
    int output = 0, first = 0;
    std::vector<float> weights;
};

struct AnalyzeOptions {
    std::vector<double> positions = {};  ///< where to take the kernel's value; empty: 0, 1/2, 1, ... and its radius
    std::vector<double> phases = {0, 0.25, 0.5, 0.75};               ///< of kernels
    std::vector<double> frequencies = {0, 0.125, 0.25, 0.375, 0.5};  ///< cycles per source sample, up to 1000
    std::optional<BankRows> bank = {};                               ///< edges are renormalised
};

struct Analysis {
    std::string name;
    std::optional<double> radius;  ///< none for taps
    bool separable = true;
    std::vector<std::pair<double, double>> values;   ///< of the kernel: position and value
    std::vector<std::pair<double, double>> profile;  ///< of the kernel: frequency and relative spectrum
    std::vector<PhaseReport> phases;
    std::vector<RowReport> rows;
};

/// throws   Error for options out of range; as require_memory() for a bank that does not fit into memory
/// example  analyze_kernel(lanczos(3), {.phases = {0.5}}).phases[0].variance
Analysis analyze_kernel(const Kernel& kernel, const AnalyzeOptions& options = {});

/// Taps, fetches or terms; `name` is what the analysis and errors call them.
/// throws   Error for frequencies out of range, and for a bank that the taps do not make
Analysis analyze_taps(const TapsFile& file, const std::string& name, const AnalyzeOptions& options = {});

/// Throws Error for phases outside [0, 1), and frequencies out of range, as the functions above do.
void check_analysis(const AnalyzeOptions& options);

/// How good a pattern of samples is.
struct PatternAnalysis {
    SamplePattern pattern;
    std::vector<EdgeSweep> edges;  ///< in each of sweep_degrees
    double least_distance = 1;     ///< between points, in pixels
    /// Both only of patterns inside the pixel.
    std::optional<double> star_discrepancy, l2_discrepancy;
};

/// example  analyze_pattern(parse_pattern("d3d:4")).edges[0].levels
PatternAnalysis analyze_pattern(const SamplePattern& pattern);

}  // namespace bandlimit::job
