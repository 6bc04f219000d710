// Which kernel, placement, edge mode and table of phases explain weights that were measured.
// Stability: evolving.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/analysis/line_probe.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit {

/// Where the samples of the target lie among those of the source.
struct Placement {
    bool centers = false;  ///< first and last sample centres coincide; else corners do, apart from the shift
    double shift = 0;      ///< in target samples; above 0 the content moves right (down)
};

/// The target's axis in the source's [0, inputs].
Axis target_axis(const Placement& placement, int inputs, int outputs);

/// The shift against shared corners if the first sample of both grids is at the same place: -1/2 for twice the size.
double top_left_shift(const Ratio& ratio);

/// The mean distance of the rows' centres of mass from shared corners, in target samples: a shift without a kernel.
double mean_shift(const MeasuredBank& bank);

/// "corners", "centers", "top-left" (within a hundredth of a sample) or "shifted".
std::string_view alignment_name(const Placement& placement, const Ratio& ratio);

/// A kernel in one of the ways in which programs use it.
struct Candidate {
    Kernel kernel;
    double widening = 1;      ///< what its nominal radius is multiplied by, in pitches of the coarser grid
    bool ties_down = false;   ///< nearest: of two equally near samples the one at the lower index
    bool is_radial = false;   ///< `kernel` is what a radial one does to lines: its integral across them
    bool is_sampled = false;  ///< box by equal weights of the samples within it, not by areas
};

/// Every kernel of kernel_list(), with usual parameters, and the variants of other programs: box by equal weights,
/// cubics of other parameters, for scales below 1 all of them also not widened, and above 1 "area", the mean over
/// the target's cell where box picks a sample.
std::vector<Candidate> all_candidates(const Ratio& ratio);

/// The weights that a candidate would have, clamped at the borders.
Bank bank_of(const Candidate& candidate, const Placement& placement, int inputs, int outputs);

/// How well a candidate explains a measured bank, away from the borders.
struct CandidateFit {
    Placement placement;
    double residual = 1;  ///< root of the mean square error over that of the weights
};

/// The residual of a candidate at one placement, from at most so many outputs.
CandidateFit fit(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement, int rows = 100);

/// The same at the best of: corners, top-left, centers, and the shift that the centres of the measured rows show. The
/// earlier one stays unless a later one is better by more than noise.
CandidateFit best_fit(const MeasuredBank& bank, const Candidate& candidate, int rows = 100);

/// The residual that rounding alone leaves.
double noise_floor(const MeasuredBank& bank);

/// The shift near that of `fit` with the least residual, by golden section: to about a thousandth of a sample.
CandidateFit refined(const MeasuredBank& bank, const Candidate& candidate, const CandidateFit& fit);

/// A candidate of free parameters (any cubic, any Gaussian, another width of `start`), fitted by least squares.
struct FittedCandidate {
    Candidate candidate;
    CandidateFit fit;
};
FittedCandidate fit_parameters(const MeasuredBank& bank, const Candidate& start, const CandidateFit& fit);

/// How far measured weights reach from the output's place, in source samples: the largest distance of one that is above
/// six standard deviations of the noise and 0.4 % of the largest.
double support(const MeasuredBank& bank, const Placement& placement);

/// The weights of all outputs away from the borders, over their place: x in pitches of the coarser grid, y so that a
/// kernel of integral 1 comes out as it is.
struct KernelSamples {
    std::vector<double> x, y;
};
KernelSamples kernel_samples(const MeasuredBank& bank, const Placement& placement);

/// Six rules for what lies outside: those of Edge, and "mirror", which reflects without repeating the border sample.
inline constexpr std::array<std::string_view, 6> edge_rules{"clamp", "reflect",     "wrap",
                                                            "zero",  "renormalize", "mirror"};

/// Squared errors of the rows that reach outside, against what each rule predicts of a candidate. Sums over scales and
/// axes make one verdict.
struct EdgeErrors {
    std::array<double, edge_rules.size()> squares{};
    double energy = 0, noise = 0;  ///< sums of squares of the weights, and of what rounding leaves
    double variance = 0;           ///< of one weight, by rounding

    EdgeErrors& operator+=(const EdgeErrors& other);
    /// The relative residual of a rule.
    double residual(std::size_t rule) const;
    /// The rules that explain the rows as well as the best, within noise; empty if none explains them or no row
    /// reaches outside.
    std::vector<std::string_view> explained_by(double tolerance) const;
};
EdgeErrors edge_errors(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement);

/// Whether weights come from a table of so many phases per source sample.
struct Phases {
    std::optional<int> count;  ///< 4, 8, ... 256; none if positions are exact as far as can be measured
    int finest = 0;            ///< the largest number of phases that would have been detected; 0: none
    double deviation = 0;      ///< root mean square of the rows' shifts against their places, in source samples
};

/// Looks at the shift of each row for the pattern of a table. Kernels that jump (nearest, box) reveal nothing.
Phases find_phases(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement);

}  // namespace bandlimit
