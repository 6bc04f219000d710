#include "bandlimit/analysis/kernel_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double quadrature_error = 1e-12;

// Cardinal B-splines are boxes convolved with themselves: their transforms are powers of sinc.
TEST(Spectrum, OfBSplinesIsAPowerOfSinc) {
    for (const double f : {0.0, 0.1, 0.5, 0.99, 1.5, 3.7, 12.25}) {
        EXPECT_NEAR(spectrum(box(), f), sinc(f), quadrature_error);
        EXPECT_NEAR(spectrum(tent(), f), std::pow(sinc(f), 2), quadrature_error);
        EXPECT_NEAR(spectrum(quadratic_bspline(), f), std::pow(sinc(f), 3), quadrature_error);
        EXPECT_NEAR(spectrum(bspline(), f), std::pow(sinc(f), 4), quadrature_error);
    }
}

TEST(Spectrum, OfAGaussianIsAGaussian) {
    const double sigma = 0.7;
    for (const double f : {0.0, 0.2, 0.5, 0.8})  // what the kernel cuts off at 4 sigma is below 1e-4 of it
        EXPECT_NEAR(relative_spectrum(gaussian(sigma), f), std::exp(-2 * pi * pi * sigma * sigma * f * f), 1e-4);
}

// A truncated sinc tends to the ideal low-pass, and jinc to the disc, as their radius grows; here the transform of the
// disc itself: a kernel that is 1 within radius R has the profile R J1(2 pi R f) / f = 2 pi R^2 jinc(2 R f).
TEST(Spectrum, OfADiscIsAJinc) {
    const Kernel disc{"disc", 1.5, [](double r) { return std::abs(r) < 1.5 ? 1.0 : 0.0; }, Kernel::Form::radial, {}};
    for (const double f : {0.0, 0.1, 0.33, 0.5, 2.0, 8.3})
        EXPECT_NEAR(spectrum(disc, f), 2 * pi * 1.5 * 1.5 * jinc(3 * f), 1e-11);
}

TEST(Spectrum, IsEven) { EXPECT_EQ(spectrum(mitchell(), -0.3), spectrum(mitchell(), 0.3)); }

/// Where the profile of a kernel is highest on (0, 1/2), by small steps.
std::pair<double, double> peak(const Kernel& kernel) {
    std::pair<double, double> best{0, 0};
    for (double f = 0; f < 0.5; f += 0.0005)
        if (const double height = relative_spectrum(kernel, f); height > best.second) best = {f, height};
    return best;
}

// The published figures have three digits.
TEST(Spectrum, WrongRadialLanczosBoostsHighFrequencies) {
    const auto [f2, height2] = peak(radial_lanczos(2));
    EXPECT_NEAR(height2, 1.233, 5e-4);
    EXPECT_NEAR(f2, 0.296, 1e-3);
    const auto [f3, height3] = peak(radial_lanczos(3));
    EXPECT_NEAR(height3, 1.644, 5e-4);
    EXPECT_NEAR(f3, 0.380, 1e-3);
}

TEST(Spectrum, RightRadialLanczosDoesNot) {
    for (const int lobes : {2, 3}) EXPECT_LT(peak(jinc_lanczos(lobes)).second, 1.03) << lobes;
}

// Sampling a kernel repeats its spectrum: sum_j k(j - p) e^{2 pi i f (j - p)} = sum_m K(f + m) e^{...}; at f = 0 and
// for kernels whose K vanishes at the whole frequencies the weights sum to K(0) at every phase.
TEST(Spectrum, OfSampledKernelIsTheSumOfItsRepetitions) {
    const double phase = 0.3, f = 0.2;
    const PhaseWeights w = weights_at(bspline(), phase);
    std::complex<double> expected = 0;
    for (int m = -60; m <= 60; ++m)
        expected += spectrum(bspline(), f - m) * std::polar(1.0, -2 * pi * m * phase);  // falls with m^-4
    EXPECT_LT(std::abs(w.sum * response(PlacedWeights(w.taps, phase), f) - expected), 1e-7);
}

TEST(KernelBands, OfTheTent) {
    EXPECT_NEAR(passband_ripple(tent(), 0.25), 1 - std::pow(sinc(0.25), 2), 1e-6);
    EXPECT_NEAR(stopband_leakage(tent(), 0.5, 0.8), std::pow(sinc(0.5), 2), 1e-6);
    EXPECT_NEAR(stopband_leakage(tent(), 1, 2), 0.04719, 1e-5);  // the first side lobe of sinc^2, at 1.43
}

TEST(KernelAliasEnergy, FallsFromBoxToLanczosAndIsKnownForSplines) {
    // By Simpson's rule over the closed forms of the numerators; energies of the box 1 and of the tent 2/3.
    const auto within = [](int power) {
        double total = 0;
        constexpr int n = 2000;
        for (int i = 0; i <= n; ++i)
            total += std::pow(sinc(0.5 * i / n), 2 * power) * (i == 0 || i == n ? 1 : i % 2 ? 4 : 2);
        return 2 * total * 0.5 / n / 3;
    };
    EXPECT_NEAR(alias_energy(box()), 1 - within(1), 1e-10);
    EXPECT_NEAR(alias_energy(tent()), 1 - within(2) / (2.0 / 3), 1e-10);
    EXPECT_LT(alias_energy(lanczos(3)), alias_energy(lanczos(2)));
    EXPECT_LT(alias_energy(lanczos(2)), alias_energy(box()));
}

TEST(KernelAliasEnergy, OfARadialKernelIsThatOfThePlane) {
    // A Gaussian is both radial and separable: 2D share = 1 - (1 - share along x)^2.
    Kernel radial = gaussian(0.5);
    const double along_x = alias_energy(radial);
    radial.form = Kernel::Form::radial;
    EXPECT_NEAR(alias_energy(radial), 1 - (1 - along_x) * (1 - along_x), 1e-4);  // it is cut at 4 sigma: square or disc
}

TEST(KernelAliasEnergy, IsWhatFineTapsOfTheWidenedKernelFold) {
    const int factor = 32;
    for (const Kernel& kernel : {tent(), mitchell(), lanczos(3)}) {
        const Axis src{40 * factor, 0, 40}, dst{40, 0, 40};
        const Bank bank = make_bank(kernel, src, dst, Edge::reflect);
        const PlacedWeights taps(bank, 20, src.index(dst.position(20)));
        EXPECT_NEAR(alias_energy(taps, factor), alias_energy(kernel), 1e-4) << kernel.name;  // O(1 / factor^2)
    }
}

TEST(SpectrumGrid, ProductOrRadius) {
    const Axis f{5, -0.5, 0.5};
    EXPECT_NEAR(relative_spectrum_grid(tent(), f, f).at(4, 1).real(), std::pow(sinc(0.4) * sinc(0.2), 2), 1e-12);
    const ComplexGrid jinc = relative_spectrum_grid(jinc_lanczos(2), f, f);
    EXPECT_NEAR(jinc.at(4, 3).real(), relative_spectrum(jinc_lanczos(2), std::hypot(0.4, 0.2)), 1e-12);
    EXPECT_NEAR(jinc.at(2, 2).real(), 1, 1e-12);
}

TEST(Spectrum, RefusesWhatMakesNoSense) {
    EXPECT_THROW(spectrum(tent(), NAN), Error);
    EXPECT_THROW(passband_ripple(tent(), -1), Error);
    EXPECT_THROW(stopband_leakage(tent(), 0.5, 0.1), Error);
}

}  // namespace
}  // namespace bandlimit
