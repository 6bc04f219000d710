// Where samples sit. This is the only file of the project that knows about half a cell.
// Stability: stable.
#pragma once

namespace bandlimit {

/// `count` equal cells on [begin, end]; sample i is the centre of cell i.
///
/// Two axes in the same unit ARE the resampling between them: a crop, a shift or a zoom is another interval,
/// a flip is end < begin. Images of the same thing share their corners, whatever their sizes:
///
///     make_bank(kernel, Axis{640}, Axis{320}, edge)                       // half the samples on the same interval
///     make_bank(kernel, Axis{640, 0, 640}, Axis{320, 100, 200}, edge)     // cells 100 to 200 of it, enlarged
///
/// units  `begin` and `end` in any unit, the same for both axes of a pair; indices count samples
struct Axis {
    int count = 0;
    double begin = 0;
    double end = 1;

    /// Distance between neighbouring samples; negative for a flipped axis.
    double pitch() const { return (end - begin) / count; }
    /// Where sample i lies; fractions allowed.
    double position(double i) const { return begin + (i + 0.5) * pitch(); }
    /// The fractional index at position x: the inverse of position().
    double index(double x) const { return (x - begin) / pitch() - 0.5; }
    /// The axis of the cells [first, last) of this one.
    Axis cells(int first, int last) const { return {last - first, begin + first * pitch(), begin + last * pitch()}; }
};

/// The axes of an image.
struct Grid {
    Axis x, y;
};

/// An axis of `count` samples whose first and last sample centres coincide with those of `source` ("align_corners"
/// elsewhere). For interoperability with code that does so; our own alignment shares corners: Axis{count, begin, end}.
/// A single sample, on either side, has no pitch to match; then the interval of `source` is kept.
inline Axis center_aligned(const Axis& source, int count) {
    if (source.count < 2 || count < 2) return {count, source.begin, source.end};
    const double half_cell = source.pitch() / 2;
    const double first = source.begin + half_cell, last = source.end - half_cell;
    const double half_pitch = (last - first) / (count - 1) / 2;
    return {count, first - half_pitch, last + half_pitch};
}

}  // namespace bandlimit
