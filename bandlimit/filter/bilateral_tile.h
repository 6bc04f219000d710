// What a bilateral filter reads for a part of its outputs: signal and guide in planes with a margin, and what is missing.
// Stability: inner.
#pragma once
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "bandlimit/core/allocator.h"
#include "bandlimit/filter/bilateral.h"

namespace bandlimit {

/// The channels of a guide that tell samples apart, and what their differences are multiplied by, see falloff().
struct RangeChannels {
    std::vector<int> channels;  ///< those whose sigma is finite
    std::vector<float> scales;  ///< of at least one: a guide without channels has one that is 0 everywhere

    /// Throws Error for more or fewer sigmas than one or `channels`.
    RangeChannels(const std::vector<double>& sigmas, int channels);
    int count() const { return static_cast<int>(scales.size()); }
};

/// Weights in space: exp(-d^2 / (2 sigma^2)), 1 at 0, also for sigma 0 and infinity.
double space_weight(double distance, double sigma);

/// A value of a guide, not NaN, so limited that differences are finite.
float limited_guide(float value);

/// An image of floats or of stored samples, and what lies outside it.
struct TileSource {
    const SourceRows& rows;
    int height;
    Edge edge_x, edge_y;
    bool premultiply;
};

/// A rectangle of samples, which may reach outside.
class BilateralTile {
public:
    BilateralTile(IndexRange columns, IndexRange rows, int signals, const RangeChannels& range);

    /// Decodes both. Rows outside that are missing are not read.
    void load(const TileSource& signal, const TileSource& guide);
    /// Whether somewhere some channels of the signal are missing and others not: then they are to be filtered one by one.
    bool is_mixed() const { return is_mixed_; }
    /// Marks what is missing in the guide or in channels [first, first + count) of the signal, which become 0 there.
    void mark(int first, int count);

    /// Whether a channel of the guide is missing at (x, y).
    bool is_blind(int x, int y) const { return std::isnan(*centre(x, y)); }
    /// The guide of such a sample inside: NaN where it is missing.
    std::span<const float> blind_guide(int x, int y) const;
    /// Whether all of row y is missing, since it lies outside.
    bool is_lost_row(int y) const { return !is_read_[static_cast<std::size_t>(y - rows_.begin)]; }
    float* signal(int x, int y, int c) { return samples_.data() + at(x, y) + c * plane_; }
    /// Channel 0 is infinite where a sample is missing.
    const float* guide(int x, int y) const { return samples_.data() + at(x, y) + signals_ * plane_; }
    /// Channel 0 of the guide, NaN where it is missing.
    const float* centre(int x, int y) const { return guide(x, y) + range_.count() * plane_; }
    std::ptrdiff_t row() const { return row_; }
    std::ptrdiff_t plane() const { return plane_; }

private:
    std::ptrdiff_t at(int x, int y) const { return (y - rows_.begin) * row_ + (x - columns_.begin); }
    void load_signal(int y, const float* from);
    void load_guide(int y, const float* from, int channels);
    void lose(int x, int y);
    void find_mixed(int y);

    IndexRange columns_, rows_;
    int signals_;
    const RangeChannels& range_;
    std::ptrdiff_t row_, plane_;
    bool is_mixed_ = false;
    std::vector<char> is_read_;               ///< per row
    std::vector<std::pair<int, int>> blind_;  ///< y and x of blind samples inside, in order
    std::vector<float> blind_guides_;
    std::vector<float, SampleAllocator<float>> samples_;
};

}  // namespace bandlimit
