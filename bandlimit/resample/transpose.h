// Between rows of samples, and samples of several rows side by side.
// Stability: inner.
#pragma once
#include <cstddef>

namespace bandlimit {

/// lanes[x * stride + y] = rows[y * pitch + x], for x in [0, width) and y in [0, count).
///
/// shapes   rows and lanes must not overlap
/// cost     one load and one store per 4 samples, and 2 shuffles
void rows_to_lanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes, std::ptrdiff_t stride);

/// The way back: rows[y * pitch + x] = lanes[x * stride + y].
inline void lanes_to_rows(const float* lanes, std::ptrdiff_t stride, int count, int width, float* rows,
                          std::ptrdiff_t pitch) {
    rows_to_lanes(lanes, stride, width, count, rows, pitch);
}

/// The same for pixels of four samples, which stay together: lanes[x * stride + 4 * y + c] = rows[y * pitch + 4 * x +
/// c].
void pixels_to_lanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes,
                     std::ptrdiff_t stride);

/// The way back: rows[y * pitch + 4 * x + c] = lanes[x * stride + 4 * y + c].
inline void lanes_to_pixels(const float* lanes, std::ptrdiff_t stride, int count, int width, float* rows,
                            std::ptrdiff_t pitch) {
    pixels_to_lanes(lanes, stride, width, count, rows, pitch);
}

}  // namespace bandlimit
