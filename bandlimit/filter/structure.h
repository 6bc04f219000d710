// Structure tensors: what the gradients about a sample have in common.
// Stability: evolving.
#pragma once
#include <algorithm>
#include <cmath>

namespace bandlimit {

/// The weighted mean of gradients times themselves: [xx xy; xy yy]. x runs right and y down.
struct StructureTensor {
    double xx = 0, xy = 0, yy = 0;

    double trace() const { return xx + yy; }
    double determinant() const { return xx * yy - xy * xy; }
    /// Half of the difference of the eigenvalues. Of floats, no square leaves the range of doubles.
    double half_gap() const { return std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy); }
};

/// Eigenvalues, the larger one first; of gradients, none is below 0.
struct Eigenvalues {
    double larger = 0, smaller = 0;
};

/// Closed form. The smaller one is the determinant over the larger one, which loses less than a difference.
inline Eigenvalues eigenvalues(const StructureTensor& t) {
    const double larger = t.trace() / 2 + t.half_gap();
    if (larger == 0) return {};
    return {larger, std::clamp(t.determinant() / larger, 0.0, larger)};
}

/// The direction of the dominant gradient, which is across edges, in (-pi/2, pi/2] radians from +x towards +y; 0 where no
/// direction is dominant.
inline double orientation(const StructureTensor& t) {
    constexpr double most = 0x1.921fb4p+0;  // the largest float that is no more than pi / 2
    const double angle = std::atan2(2 * t.xy, t.xx - t.yy) / 2;
    return angle < -most || angle > most ? most : angle;
}

/// How coherence is defined; either is 1 where all gradients are parallel, and 0 where they are not at all, or flat.
enum class Coherence {
    difference,  ///< (l1 - l2) / (l1 + l2)
    sqrt         ///< (sqrt l1 - sqrt l2) / (sqrt l1 + sqrt l2)
};

/// In [0, 1], also after rounding.
inline double coherence_of(const StructureTensor& t, Coherence definition = Coherence::difference) {
    if (t.trace() == 0) return 0;
    if (definition == Coherence::difference) return std::clamp(2 * t.half_gap() / t.trace(), 0.0, 1.0);
    const Eigenvalues l = eigenvalues(t);
    const double a = std::sqrt(l.larger), b = std::sqrt(l.smaller);
    return std::clamp((a - b) / (a + b), 0.0, 1.0);
}

/// The tensor along x and y of one along the diagonals: of d1 along (1, 1) / sqrt 2, right and down, and d2 along
/// (1, -1) / sqrt 2, right and up. With d2 the other way round, d1 d2 has the other sign, and so have both its terms.
inline StructureTensor from_diagonals(double d1_d1, double d1_d2, double d2_d2) {
    return {(d1_d1 + 2 * d1_d2 + d2_d2) / 2, (d1_d1 - d2_d2) / 2, (d1_d1 - 2 * d1_d2 + d2_d2) / 2};
}

/// det - k trace^2: Harris and Stephens 1988. Above 0 at corners, below at edges.
inline double harris(const StructureTensor& t, double k = 0.05) { return t.determinant() - k * t.trace() * t.trace(); }
/// The smaller eigenvalue: Shi and Tomasi 1994.
inline double shi_tomasi(const StructureTensor& t) { return eigenvalues(t).smaller; }

}  // namespace bandlimit
