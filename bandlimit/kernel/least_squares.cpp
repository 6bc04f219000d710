// Kernels of three lobes with the least error that their ringing allows.
//
// A Fourier series of the period 6 on [-3, 3],
//
//     h(x) = (1 + 2 sum_k c_k cos(pi k x / 3)) / 6,
//
// has the response c_k at k / 6 cycles per sample (1 at 0). With c_6 = 0, and a highest k below 12, the response is
// 0 at every whole frequency: shifted copies sum to 1 at any phase, so that dividing weights by their sum changes
// nothing. With h(3) = 0 its slope is 0 there as well: the kernel ends smoothly.
//
// The c_k minimise the mean square error on pictures whose rows have the power spectrum S(f) ~ f^-a, once shrunk by a
// large factor or enlarged by one (H the response, 1 the ideal one below 1/2 and 0 beyond):
//
//     shrink   int_0^oo S(f) (H(f) - [f < 1/2])^2 df
//     grow     int_0^1/2 S(f) ((1 - H(f))^2 + sum_{n >= 1} H(n - f)^2 + H(n + f)^2) df
//
// among all whose answer to a unit step stays below 1 + r. Without that bound they would ring more than Lanczos-3
// (r = 0.073 shrinking, 0.118 growing), as low-passes with steep flanks do.
//
// Steps have a = 2. shrink3 takes a = 5/2: with 2 it did not come out better on smooth photographs, whose fine detail
// is weaker. least_squares_test.cpp has both integrals, and shows that the two coefficient sets are where error can
// only be had for ringing. docs/kernels.md measures them.
//
// source  T. W. Parks & C. S. Burrus, Digital Filter Design, 1987 (least squares against the ideal response); L. R.
//         Rabiner & B. Gold, Theory and Application of Digital Signal Processing, 1975 (a design by samples of the
//         response); M. Unser, "Sampling: 50 years after Shannon", Proc. IEEE 88, 2000 (the error of reconstruction,
//         frequency by frequency)
#include <array>
#include <cmath>

#include "bandlimit/kernel/kernel.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

/// cos(pi x / 3).
double series_cosine(double x) { return sin_pi(x / 3 + 0.5); }

}  // namespace

Kernel shrink3() {
    // a = 5/2, r = 0.073. Rounded so that h(3) = 0.
    constexpr std::array c{0.98602, 1.01519, 0.51394, 0.03703, 0.05226};
    const auto value = [c](double x) {
        x = std::abs(x);
        if (!(x < 3)) return 0.0;
        // Clenshaw's recurrence for a sum of cosines.
        const double cosine = series_cosine(x);
        double after = 0, next = 0;
        for (std::size_t k = c.size(); k-- > 0;) {
            const double here = c[k] + 2 * cosine * next - after;
            after = next, next = here;
        }
        return (1 + 2 * (cosine * next - after)) / 6;
    };
    return {"shrink3", 3, value, Kernel::Form::separable, {1, 2}};
}

Kernel grow3() {
    // a = 2, r = 0.115. h = 1 at 0 and 0 at 1 and 2 leave the series
    //     h(x) = sin(pi x) (cot(pi x / 6) / 6 + sum_j s_j sin(pi j x / 3)),
    // whose first part is that of all c_k = 1 below 1/2; s_3 would make a c_6.
    constexpr std::array s{0.02116, -0.00193, 0.0, -0.00787, -0.00279, -0.02213, 0.00316, 0.00781};
    const auto value = [s](double x) {
        x = std::abs(x);
        if (!(x < 3)) return 0.0;
        if (x == 0) return 1.0;
        // Clenshaw's recurrence for a sum of sines.
        const double cosine = series_cosine(x), sine = sin_pi(x / 3);
        double after = 0, next = 0;
        for (std::size_t j = s.size(); j-- > 0;) {
            const double here = s[j] + 2 * cosine * next - after;
            after = next, next = here;
        }
        return sin_pi(x) * ((1 + cosine) / (6 * sine) + next * sine);
    };
    return {"grow3", 3, value, Kernel::Form::separable, {1, 2}};
}

}  // namespace bandlimit
