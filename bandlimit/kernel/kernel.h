// Continuous reconstruction kernels.
// Stability: stable.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bandlimit {

/// A continuous reconstruction kernel: an even function that is zero outside [-radius, radius].
///
/// units  radius and the argument of value() in pitches of the source (of the target where the kernel is widened to
///        minify). Values are as published, not scaled to an integral of 1: weights are normalised when they are made.
struct Kernel {
    /// What a kernel is in two dimensions, and how it becomes weights.
    enum class Form {
        separable,  ///< value(x) * value(y), sampled where the source samples are
        radial,     ///< value(sqrt(x^2 + y^2))
        area,       ///< separable; when minifying each weight is the exact overlap of cells (box)
        nearest     ///< the one sample whose cell holds the position; never widened
    };

    std::string name;   ///< as parse_kernel() reads it
    double radius = 0;  ///< exact: value is 0 beyond
    std::function<double(double)>
        value;  ///< any finite argument; at a jump the mean of both sides unless stated otherwise
    Form form = Form::separable;
    std::vector<double>
        knots;  ///< borders in (0, radius) between which value is smooth, and not too wavy, for quadrature
};

Kernel nearest();  ///< the nearest sample; of two equally near ones the one at the higher index
Kernel box();      ///< radius 1/2; the exact mean over the target's cell when minifying
Kernel tent();     ///< radius 1: linear interpolation

Kernel quadratic_bspline();        ///< radius 3/2, smooth, approximating
Kernel quadratic_interpolating();  ///< radius 3/2, Dodgson 1997, "Quadratic interpolation for image resampling", r = 1

/// radius 2: the family of Mitchell & Netravali 1988, eq. 8. (1, 0) is the B-spline, (0, 1/2)
/// Catmull-Rom, (1/3, 1/3) Mitchell.
Kernel cubic(double b, double c);
Kernel bspline();
Kernel catmull_rom();
Kernel mitchell();

/// radius 5/2 and 9/2: Costella's Magic Kernel, the quadratic B-spline, behind the sharpening of 2013 or 2021.
Kernel magic_sharp_2013();
Kernel magic_sharp_2021();

/// radius 3: the least-squares kernels that `auto` uses, to shrink and to grow or stay. See least_squares.cpp.
Kernel shrink3();  ///< approximating
Kernel grow3();    ///< interpolating

Kernel lanczos(int lobes);                  ///< radius lobes >= 1: sinc(x) sinc(x / lobes)
Kernel truncated_sinc(double radius);       ///< radius > 0: sinc(x), cut off
Kernel gaussian(double sigma);              ///< exp(-x^2 / (2 sigma^2)), radius 4 sigma (3.4e-4 of the peak is cut off)
Kernel blackman_harris();                   ///< exp(-2.29 x^2), a fit of the window below, cut at the same radius
Kernel blackman_harris_window();            ///< radius 1.65: the 4-term window, 3.3 pitches wide
Kernel kaiser(double radius, double beta);  ///< sinc(x) I0(beta sqrt(1 - (x/radius)^2)) / I0(beta)

Kernel jinc_lanczos(int lobes);  ///< radial: jinc(r) jinc(r z1/zN), radius the N-th zero zN of jinc; continuous
Kernel jinc_lanczos_unscaled(int lobes);  ///< radial: pi jinc(r) jinc(r / N) for r < N; jumps to 0 at its radius N
Kernel radial_lanczos(int lobes);         ///< radial and WRONG: lanczos(r) is not a low-pass in 2D; kept for study

/// The kernel that `name` describes: a name of kernel_list(), with parameters after colons ("cubic:0.3:0.35"), or an
/// alias ("bilinear").
///
/// throws  Error for an unknown name (listing the names), for "bicubic" and other words that mean several kernels
///         (naming the candidates), and for parameters that are missing, extra, not numbers or out of range
Kernel parse_kernel(std::string_view name);

/// One line of documentation.
struct KernelInfo {
    std::string_view name;     ///< with its parameters, as "cubic:B:C"
    std::string_view example;  ///< a name that parse_kernel() takes
    std::string_view summary;
};

/// All kernels, in the order of the documentation.
std::span<const KernelInfo> kernel_list();

inline bool is_radial(const Kernel& kernel) { return kernel.form == Kernel::Form::radial; }

}  // namespace bandlimit
