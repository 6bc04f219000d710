// Where the samples of one axis lie among those of another.
// Stability: inner.
#pragma once
#include <cstdint>

#include "bandlimit/core/axis.h"

namespace bandlimit {

/// A fractional index into the source, in two parts so that outputs at the same phase have the same bits.
struct Position {
    std::int64_t whole = 0;
    double fraction = 0;     ///< in [0, 1)
    std::int64_t phase = 0;  ///< equal for outputs of one mapping whose fractions are equal
    double offset = 0;       ///< fraction * units() of the mapping: an integer where the position is a ratio
};

/// Gives the position of each sample of `dst` among the samples of `src`.
///
/// Where the step is a ratio of modest integers, as for all sizes of images, positions are computed in integers: phases
/// repeat exactly, and a part of `dst` has the same phases as the whole. (It has so too where `dst` begins at an odd
/// fraction of a sample, but for the rounding of that fraction.)
///
/// throws   Error for counts < 1, and for intervals that are empty, not finite or absurdly far apart
class Mapping {
public:
    Mapping(const Axis& src, const Axis& dst);

    Position operator()(int output) const;
    /// Source samples per output; negative if one axis is flipped.
    double step() const { return step_; }
    /// How much a kernel must be widened to limit the band: the step where that is above 1, else 1.
    double stretch() const { return span() / units(); }
    /// Positions, and the widening, in a unit in which they are integers where the step is a ratio.
    double units() const { return static_cast<double>(units_); }
    double span() const;
    bool is_whole_step(int factor) const { return p_ == factor && q_ == 1; }

private:
    Axis src_, dst_;
    double step_ = 1;
    std::int64_t p_ = 0, q_ = 0;          ///< step = p / q, or q = 0 if it is no such ratio
    std::int64_t units_ = 1, shift_ = 0;  ///< positions are multiples of 1 / units ...
    double shift_fraction_ = 0;           ///< ... plus this part of one
};

}  // namespace bandlimit
