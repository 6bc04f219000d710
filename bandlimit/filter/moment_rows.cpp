#include "bandlimit/filter/moment_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandlimit {
namespace {

/// Columns of a channel side by side: where they are, or in `copy`.
const float* contiguous(View<const float> image, int y, int channel, IndexRange xs, std::vector<float>& copy) {
    if (image.dx == 1) return &image(xs.begin, y, channel);
    copy.resize(static_cast<std::size_t>(xs.count()));
    for (int x = xs.begin; x < xs.end; ++x) copy[static_cast<std::size_t>(x - xs.begin)] = image(x, y, channel);
    return copy.data();
}

FiniteRange range_of(View<const float> image, int channel, IndexRange xs, IndexRange ys) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    FiniteRange range{infinity, -infinity};
    std::vector<float> copy;
    for (int y = ys.begin; y < ys.end; ++y) widen(range, contiguous(image, y, channel, xs, copy), xs.count());
    return range;
}

bool is_whole(View<const float> image) {
    for (int c = 0; c < image.channels; ++c)
        if (!range_of(image, c, {0, image.width}, {0, image.height}).is_whole) return false;
    return true;
}

}  // namespace

MomentRows::MomentRows(View<const float> signal, View<const float> guide, int order)
    : signal_(signal),
      guide_(guide),
      shape_{guide.channels, signal.channels, order},
      has_holes_(!is_whole(signal) || !is_whole(guide)) {}

double MomentRows::offset(View<const float> image, int channel, IndexRange xs, IndexRange ys) {
    const FiniteRange range = range_of(image, channel, xs, ys);
    if (range.least > range.most) return 0;  // nothing is finite
    return static_cast<double>(std::clamp(0.0f, range.least, range.most));
}

void MomentRows::fill_guides(int y, IndexRange xs, const double* offsets, double* const* to) const {
    std::vector<float> copy;
    for (int k = 0; k < shape_.guides; ++k)
        recentre_row(contiguous(guide_, y, k, xs, copy), offsets[k], to[k], xs.count());
}

void MomentRows::fill(int y, IndexRange xs, const double* offsets, const double* signal_offsets,
                      double* const* planes) const {
    fill_guides(y, xs, offsets, planes + 1);
    std::vector<float> copy;
    for (int s = 0; s < shape_.signals; ++s)
        recentre_row(contiguous(signal_, y, s, xs, copy), signal_offsets[s], planes[signal_plane(s)], xs.count());
    if (planes[0] != nullptr) clear_holes(y, xs, planes);
    multiply(xs.count(), planes);
}

void MomentRows::fill_zero(const double* offsets, const double* signal_offsets, double* const* planes) const {
    planes[0][0] = 1;
    for (int k = 0; k < shape_.guides; ++k) planes[1 + k][0] = -offsets[k];
    for (int s = 0; s < shape_.signals; ++s) planes[signal_plane(s)][0] = -signal_offsets[s];
    multiply(1, planes);
}

void MomentRows::multiply(int count, double* const* planes) const {
    const int terms = shape_.terms();
    shape_.each_guide_pair(
        [&](int term, int k, int l) { multiply_rows(planes[1 + k], planes[1 + l], planes[1 + term], count); });
    each_pair(shape_.first_product(), terms,
              [&](int plane, int i, int j) { multiply_rows(planes[1 + i], planes[1 + j], planes[plane], count); });
    for (int s = 0; s < shape_.signals; ++s)
        for (int i = 0; i < terms; ++i)
            multiply_rows(planes[signal_plane(s)], planes[1 + i], planes[signal_plane(s) + 1 + i], count);
}

void MomentRows::clear_holes(int y, IndexRange xs, double* const* planes) const {
    const auto is_finite = [&](View<const float> image, int x) {
        for (int c = 0; c < image.channels; ++c)
            if (!std::isfinite(image(x, y, c))) return false;
        return true;
    };
    for (int x = xs.begin, i = 0; x < xs.end; ++x, ++i) {
        const bool is_there = is_finite(signal_, x) && is_finite(guide_, x);
        planes[0][i] = is_there ? 1 : 0;
        if (is_there) continue;
        for (int k = 0; k < shape_.guides; ++k) planes[1 + k][i] = 0;
        for (int s = 0; s < shape_.signals; ++s) planes[signal_plane(s)][i] = 0;
    }
}

}  // namespace bandlimit
