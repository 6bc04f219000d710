// Gradients of pictures, and what follows from them: magnitudes, directions, structure tensors, normal maps.
// Stability: evolving.
#pragma once
#include <string_view>

#include "bandlimit/core/edge.h"
#include "bandlimit/filter/derivatives.h"
#include "bandlimit/filter/structure.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// What is stored of the derivatives.
enum class GradientResult {
    magnitude,  ///< of each channel; of a Laplacian, its absolute value
    dx,         ///< of each channel
    dy,         ///< of each channel
    value,      ///< of each channel: a Laplacian with its sign
    direction,  ///< red, green, blue: the hue is the angle of the gradient from +x towards +y (0 is red, a third of a turn
                ///< green), the saturation its magnitude up to 1, and the value 1; of the channel with the largest
    tensor,  ///< xx, xy, yy, strength, angle, coherence: see structure.h; strength is the root of the larger eigenvalue
    coherence,  ///< one channel
    normals     ///< x, y, z of the surface whose height is the first channel
};
std::string_view name_of(GradientResult result);
/// Throws Error, listing the names, for any other.
GradientResult parse_gradient_result(std::string_view name);
/// How many channels the result for a source of `channels` has.
int channels_of(GradientResult result, int channels);
/// Whether a result is in units of the source's values, and so is encoded as they are. Others are stored as they are.
bool has_source_units(GradientResult result);

/// Which way y of a normal map points. A green that grows where the surface looks up is OpenGL's.
enum class NormalConvention { opengl, directx };

struct GradientOptions {
    GradientResult result = GradientResult::magnitude;
    Edge edge = Edge::reflect;         ///< any but renormalize: weights that sum to 0 cannot be rescaled
    Taps window = gaussian_taps(1.5);  ///< of tensors, along both axes; sums to 1
    Coherence coherence = Coherence::difference;
    double height = 1;  ///< of the value 1, in pixels: for normals
    NormalConvention convention = NormalConvention::opengl;
    /// Differentiate colour multiplied by alpha. In the result alpha is the derivative of alpha, a channel like others.
    bool premultiply = true;
};

/// Whether `derivative` has that result. Laplacians have a magnitude and a value, gradients all but that.
bool has_result(const DerivativeOperator& derivative, GradientResult result);

/// Derivatives of a picture of width x height, ready to run on blocks of rows. The picture goes on outside as the edge
/// says, and so do its gradients: windows at borders see what they would see inside a larger picture.
///
/// Derivatives of more than two weights run on differences of neighbours, so that they are exactly 0 where a picture is
/// flat, and as exact on values of 1000 to 1001 as on 0 to 1.
///
/// shapes   source [width x height x any]; target [width x height x channels_of()]
/// units    values per sample. Integers hold normals as (n + 1) / 2, and nothing below 0 or above 1
/// range    |gradient| from 1e-18 to 1e18 where squares are summed; a NaN reaches the outputs whose weights cover it
/// error    of linear results dot_bound() of the weights; angle, coherence and normals are computed in double
/// memory   per thread a few dozen rows of each channel, more where the window is larger
/// throws   Error for sizes below 1, a result that `derivative` does not have, Edge::renormalize, and a window that
///          does not sum to 1 or has a weight below 0
RowFilter gradient_filter(const DerivativeOperator& derivative, int width, int height, const GradientOptions& options);

}  // namespace bandlimit
