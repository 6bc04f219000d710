// What is summed over windows to fit polynomials: a row of it at a time.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/view.h"
#include "bandlimit/filter/polynomial_fit.h"
#include "bandlimit/filter/window_rows.h"

namespace bandlimit {

/// Rows of weights, terms and their products, in the order of PolynomialShape. Weights are 1, and 0 in holes, where
/// everything is 0.
class MomentRows {
public:
    MomentRows(View<const float> signal, View<const float> guide, int order);

    const PolynomialShape& shape() const { return shape_; }
    /// Whether anything is not finite.
    bool has_holes() const { return has_holes_; }
    /// Of a guide, the finite value nearest to 0 among columns `xs` of the rows, or 0. Subtracting it costs no accuracy:
    /// no difference is more than twice the value that it comes from.
    double offset(int guide) const { return offset(guide_, guide, {0, guide_.width}, {0, guide_.height}); }
    static double offset(View<const float> image, int channel, IndexRange xs, IndexRange ys);

    /// Columns `xs` of the stored row y, about `offsets` [guides] and, for signals, [signals].
    /// shapes   planes [shape().planes()], each with memory for a multiple of window_group; the first may be null without
    ///          holes
    void fill(int y, IndexRange xs, const double* offsets, const double* signal_offsets, double* const* planes) const;
    /// The same of one sample that is 0 in all channels.
    void fill_zero(const double* offsets, const double* signal_offsets, double* const* planes) const;
    /// Columns of the guide alone: [guides], about `offsets`.
    void fill_guides(int y, IndexRange xs, const double* offsets, double* const* to) const;

private:
    void multiply(int count, double* const* planes) const;
    int signal_plane(int s) const { return shape_.first_signal() + s * (1 + shape_.terms()); }
    void clear_holes(int y, IndexRange xs, double* const* planes) const;

    View<const float> signal_, guide_;
    PolynomialShape shape_;
    bool has_holes_;
};

}  // namespace bandlimit
