// Weights in two dimensions, run over images in the cheapest way that there is.
// Stability: evolving.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/filter/fft_filter.h"
#include "bandlimit/kernel/terms.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {

/// How weights are run.
enum class Method {
    automatic,  ///< as is cheapest, of those that change nothing but rounding
    direct,     ///< every weight by itself
    separable,  ///< as one product: a pass along each axis
    low_rank,   ///< as a sum of products
    fft         ///< by Fourier transforms
};
std::string_view name_of(Method method);

/// Weights on a grid, or as the sum of products that they were designed as. Each output at (x, y) is
/// sum_uv weight(u, v) in(x + first_x + u, y + first_y + v): a single bright sample becomes the weights turned by half
/// a turn about first_x and first_y, as taps and correlation have it.
struct ConvolutionWeights {
    std::variant<WeightGrid, Terms> weights;
    int first_x = 0, first_y = 0;
};

/// `weights` centred on their output, see centred_first().
ConvolutionWeights centred(std::variant<WeightGrid, Terms> weights);

/// How many they are along each axis. Throws Error for none, as size_of(terms).
WeightSize size_of(const ConvolutionWeights& weights);
/// All of them on a grid, which for products takes more memory by far. Throws as size_of().
WeightGrid grid_of(const ConvolutionWeights& weights);
/// Their sum: what becomes of a picture of ones.
double sum_of(const ConvolutionWeights& weights);
/// The same weights, turned by half a turn: what convolution in the textbook's sense runs.
ConvolutionWeights turned(ConvolutionWeights weights);
/// Whether they cancel, by the rule of kernel/taps.h; magnitudes of products stand for those of their weights.
bool cancel(const ConvolutionWeights& weights);
/// The same, divided by their sum.
/// throws   Error where they cancel()
ConvolutionWeights with_unit_sum(ConvolutionWeights weights);

struct ConvolveOptions {
    Method method = Method::automatic;
    Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
    /// Work on colour multiplied by alpha, so that transparent texels do not bleed. Has no effect without alpha.
    bool premultiply = true;
    /// Memory for what is worked out before a convolution runs, above which it is refused.
    std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max();
};

/// What a method would take.
struct MethodCost {
    Method method = Method::direct;
    int rank = 0;              ///< products of separable and low_rank
    double multiply_adds = 0;  ///< per sample
    double time = 0;           ///< relative, as measured: 1 is a multiply-add of the direct method, per sample
    double bytes = 0;          ///< about what is worked out before it runs
};

/// A convolution ready to run on blocks of rows. Approximations are not its business: low_rank() makes products that
/// stand for a grid, and those are run as they are.
///
/// error    direct, separable and low_rank as term_filter(), fft as fft_filter(). A grid that runs as products differs by no
///          more than rounding its weights to floats
/// cost     chosen(); for a grid of up to 512 x 512 or method low_rank, that of its singular value decomposition too
class Convolution {
public:
    /// throws  Error for empty weights or such as are not finite, width or height < 1, Method::separable for weights
    ///         that are no product, for what takes more than options.most_bytes, and as BorderScale
    Convolution(const ConvolutionWeights& weights, int width, int height, const ConvolveOptions& options = {});

    /// What was chosen.
    const MethodCost& chosen() const { return chosen_; }
    /// All that was to choose from, the cheapest first.
    const std::vector<MethodCost>& candidates() const { return candidates_; }

    /// What runs, for code that takes any filter.
    const RowFilter& rows() const { return *rows_; }
    /// As those of RowFilter.
    std::uint64_t bytes(int channels, const Parallel& parallel) const { return rows_->bytes(channels, parallel); }
    IndexRange rows_needed(int first, int last) const { return rows_->rows_needed(first, last); }
    RunReport run(const SourceRows& source, const TargetRows& target, const Parallel& parallel = {},
                  const RowProgress& progress = {}) const {
        return rows_->run(source, target, parallel, progress);
    }

private:
    std::vector<MethodCost> candidates_;
    MethodCost chosen_;
    std::optional<RowFilter> rows_;  ///< always there, once constructed
};

}  // namespace bandlimit
