// Designs as files of taps, with what they cost: what `design` makes, for those who call it from a program.
//
//     write_taps("blur.json", job::taps_file(design_gaussian({.sigma = 2})));
//     job::design_separable({.kernel = read_weights("star.png"), .rank = 4}).file.terms;
// Stability: evolving.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/design/derivative.h"
#include "bandlimit/design/disk.h"
#include "bandlimit/design/downsample.h"
#include "bandlimit/design/gaussian.h"
#include "bandlimit/design/kernel_fit.h"
#include "bandlimit/design/separable.h"
#include "bandlimit/design/sharpen.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/job/context.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit::job {

/// Of designs along one axis. Costs are those of both axes in turn, but of a derivative: it has one.
TapsFile taps_file(const DerivativeDesign& design);
TapsFile taps_file(const GaussianDesign& design);
TapsFile taps_file(const SharpenDesign& design);
TapsFile taps_file(const KernelFit& fit);

// ---- Discs

struct DiskJob {
    int components = 2;         ///< 1 to 5; of the published sets 1 or 2
    bool is_published = false;  ///< the parameters of Niemitalo 2011, fitted; else the nearest to a disc
    double radius = 0;          ///< in pixels: adds the weights, as terms; 0: without
    int reach = -1;             ///< weights on either side of the middle one; -1: so many that 1 % of the sum is lost
};

struct DiskReport {
    Components components;  ///< of a disc of radius 1
    double radius = 0;      ///< for which costs are
    int reach = 0;          ///< the same
    /// Of what was published: its radius, and how much higher ours are. 0 for a fit.
    double published_radius = 0, published_scale = 0;
    TapsFile file;
};

/// Throws OptionError.
void check(const DiskJob& job);
/// throws   OptionError as check()
DiskReport design_disk(const DiskJob& job);

// ---- Filters that shrink by a whole factor, or double

struct DownsampleJob {
    RateGoal goal{};
    FetchOptions where{};
    int fetches = 0;  ///< 0: as many as are usual, or, with `where.taps`, none

    /// Taps along one axis, rather than fetches.
    bool is_one_dimensional() const { return where.taps > 0 && fetches == 0 && where.threshold == 0; }
    /// The best weights without the smallest, folded into fetches.
    bool is_folded() const { return where.taps > 0 && fetches == 0 && where.threshold > 0; }
    /// The same with `fetches` filled in where neither they nor taps are given.
    DownsampleJob completed() const;
};

struct DownsampleReport {
    PlacedWeights2D whole;  ///< its weights in two dimensions
    /// Other numbers of fetches, the fewest first, and as far as more gain something; empty for folded ones and taps.
    std::vector<FetchDesign> curve = {};
    TapsFile file;
};

/// `function` is what errors call the maker. Throws Error and OptionError.
void check(const DownsampleJob& job, const char* function);
/// throws   as check(); std::runtime_error where so few fetches make no filter
DownsampleReport design_downsample(const DownsampleJob& job);

// ---- Sums of products

struct SeparableJob {
    WeightGrid kernel;
    std::string name = "the kernel";  ///< what errors call it
    bool is_measured = false;         ///< an image, whose noise is not to be copied
    std::optional<int> rank{};        ///< none: 99.9 % of the energy, or of a measured kernel what is above the noise
    SeparableLoss loss{};
    bool optimise = false;
};

struct SeparableReport {
    Svd svd;
    std::vector<double> energy, sum;             ///< of the first singular values, as shares of all
    int exact = 0, nearly = 0, above_noise = 0;  ///< ranks: of the kernel, of 99.9 % of its energy, of what is no noise
    WeightGrid weights;                          ///< the sum of the terms
    double error = 0;                            ///< sum of squared differences over that of squares
    double loss = 0;                             ///< what is minimised
    std::optional<SeparableFit> optimised = {};
    TapsFile file;

    int rank() const { return static_cast<int>(file.terms.size()); }
};

/// The nearest sum of products of columns and rows.
/// throws   std::runtime_error for kernels of zeros, and more terms than the kernel has
/// cost     about three seconds for 512 x 512
SeparableReport design_separable(const SeparableJob& job, const Context& context = {});

/// Multiply-adds of so many terms.
double multiply_adds(const WeightGrid& kernel, int rank);

constexpr int most_terms = 64;  ///< that a taps.json holds

}  // namespace bandlimit::job
