#include "bandlimit/filter/gradients.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/combine.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> gradients{"forward", "central",  "sobel",     "scharr",
                                         "prewitt", "diagonal", "diagonal3", "gaussian:0.8"};
const std::vector<std::string> laplacians{"laplacian4", "laplacian8", "log:0.9"};

template <class F>
Image<float> picture(int width, int height, int channels, F f) {
    Image<float> image(width, height, channels, Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.view()(x, y, c) = static_cast<float>(f(x, y, c));
    return image;
}

Image<float> noise(int width, int height, int channels, double offset = 0) {
    Random random(1);
    return picture(width, height, channels, [&](int, int, int) { return offset + random.uniform(); });
}

Image<float> run(const Image<float>& image, const DerivativeOperator& derivative, const GradientOptions& options,
                 Parallel parallel = {2}) {
    Image<float> out(image.width(), image.height(), channels_of(options.result, image.channels()), Layout::interleaved);
    gradient_filter(derivative, image.width(), image.height(), options)
        .run({image.view(), 0, {}}, {out.view(), 0, {}, {}}, parallel);
    return out;
}

Image<float> run(const Image<float>& image, const std::string& name, GradientResult result, Edge edge = Edge::reflect) {
    return run(image, parse_derivative(name), {.result = result, .edge = edge});
}

double at(const Image<float>& image, int x, int y, int c = 0) { return static_cast<double>(image.view()(x, y, c)); }

Gradient gradient_of(const std::string& name) { return std::get<Gradient>(parse_derivative(name)); }

/// The picture that goes on outside.
double value(const Image<float>& image, int x, int y, int c, Edge edge) {
    const int u = resolve(x, image.width(), edge), v = resolve(y, image.height(), edge);
    return u < 0 || v < 0 ? 0 : at(image, u, v, c);
}

/// The sum over `x` times `y` of f(i, j).
template <class F>
double weighted(const Taps& x, const Taps& y, F f) {
    double sum = 0;
    for (std::size_t j = 0; j < y.weights.size(); ++j)
        for (std::size_t i = 0; i < x.weights.size(); ++i)
            sum += x.weights[i] * y.weights[j] * f(x.first + static_cast<int>(i), y.first + static_cast<int>(j));
    return sum;
}

struct Slope {
    double x, y;
};
/// The definition: of any sample, also outside.
Slope slope(const Image<float>& image, const Gradient& g, int x, int y, int c, Edge edge) {
    const auto f = [&](int i, int j) { return value(image, x + i, y + j, c, edge); };
    return {weighted(g.along, g.across, f), weighted(g.across, g.along, f)};
}

TEST(Gradients, ARampOfSlope1HasGradient1) {
    const Image<float> ramp = picture(40, 36, 1, [](int x, int y, int) { return 3 + x - 0.5 * y; });
    for (const std::string& name : gradients) {
        const Image<float> dx = run(ramp, name, GradientResult::dx), dy = run(ramp, name, GradientResult::dy);
        const Image<float> length = run(ramp, name, GradientResult::magnitude);
        for (int y = 6; y < 30; ++y)
            for (int x = 6; x < 34; ++x) {
                EXPECT_NEAR(at(dx, x, y), 1, 1e-6) << name;
                EXPECT_NEAR(at(dy, x, y), -0.5, 1e-6) << name;
                EXPECT_NEAR(at(length, x, y), std::hypot(1, 0.5), 1e-6) << name;
            }
        EXPECT_NEAR(ramp_gain(gradient_of(name)), 1, 1e-12) << name;
    }
}

// At p the derivative of x^2 / 2 is p.x, and that of x y along x is p.y.
TEST(Gradients, ParabolasShowWhereDerivativesAreTaken) {
    const Image<float> bowls = picture(30, 30, 3, [](int x, int y, int c) {
        const double u = x - 15, v = y - 15;
        return c == 0 ? u * u / 2 : c == 1 ? v * v / 2 : u * v;
    });
    for (const std::string& name : gradients) {
        const GradientPosition of_dx = position_of_dx(gradient_of(name)), of_dy = position_of_dy(gradient_of(name));
        const Image<float> dx = run(bowls, name, GradientResult::dx), dy = run(bowls, name, GradientResult::dy);
        EXPECT_NEAR(at(dx, 15, 15, 0), of_dx.x, 1e-5) << name;
        EXPECT_NEAR(at(dx, 15, 15, 2), of_dx.y, 1e-5) << name;
        EXPECT_NEAR(at(dy, 15, 15, 1), of_dy.y, 1e-5) << name;
        EXPECT_NEAR(at(dy, 15, 15, 2), of_dy.x, 1e-5) << name;
    }
    EXPECT_EQ(position_of_dx(gradient_of("forward")).x, 0.5);
    EXPECT_EQ(position_of_dx(gradient_of("diagonal")).y, 0.5);
    EXPECT_EQ(position_of_dx(gradient_of("diagonal3")).x, 0);
}

TEST(Gradients, LaplaciansOfParabolasAre1AndOfRamps0) {
    const Image<float> shapes = picture(30, 30, 3, [](int x, int y, int c) {
        return c == 0 ? (x - 15) * (x - 15) / 2.0 : c == 1 ? (y - 15) * (y - 15) / 2.0 : x + 2.0 * y;
    });
    for (const std::string& name : laplacians) {
        const Image<float> found = run(shapes, name, GradientResult::value);
        EXPECT_NEAR(at(found, 15, 15, 0), 1, 1e-5) << name;
        EXPECT_NEAR(at(found, 13, 16, 1), 1, 1e-5) << name;
        EXPECT_NEAR(at(found, 15, 15, 2), 0, 1e-5) << name;
    }
    const Image<float> dot = picture(9, 9, 1, [](int x, int y, int) { return x == 4 && y == 4; });
    EXPECT_NEAR(at(run(dot, "laplacian4", GradientResult::value), 4, 4), -4, 1e-6);
    EXPECT_NEAR(at(run(dot, "laplacian4", GradientResult::magnitude), 4, 4), 4, 1e-6);
    const Image<float> eight = run(dot, "laplacian8", GradientResult::value);
    for (int y = 3; y < 6; ++y)
        for (int x = 3; x < 6; ++x) EXPECT_NEAR(at(eight, x, y), x == 4 && y == 4 ? -8.0 / 3 : 1.0 / 3, 1e-6);
}

constexpr Edge edges[] = {Edge::clamp, Edge::reflect, Edge::wrap, Edge::zero};

TEST(Gradients, EveryResultIsThatOfItsDefinitionUnderEveryEdge) {
    for (const auto& [width, height] : {std::pair{13, 11}, {2, 9}, {1, 1}}) {
        const Image<float> image = noise(width, height, 2);
        for (const std::string& name : gradients)
            for (const Edge edge : edges) {
                const Gradient g = gradient_of(name);
                const GradientOptions options{.edge = edge, .window = gaussian_taps(0.7)};
                const auto result = [&](GradientResult r) {
                    GradientOptions o = options;
                    o.result = r;
                    return run(image, g, o);
                };
                const Image<float> dx = result(GradientResult::dx), dy = result(GradientResult::dy);
                const Image<float> length = result(GradientResult::magnitude), tensor = result(GradientResult::tensor);
                const Taps window = convolved(options.window, g.mean);
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        const auto mean = [&](const Taps& taps, auto of_slope) {
                            return weighted(taps, taps, [&](int i, int j) {
                                double sum = 0;
                                for (int c = 0; c < 2; ++c) sum += of_slope(slope(image, g, x + i, y + j, c, edge), c);
                                return sum;
                            });
                        };
                        // A few roundings of sums of values up to 1.
                        constexpr double allowed = 2e-6;
                        const auto of_1 = [](double v, int c) { return c == 1 ? v : 0; };
                        const double squares =
                            mean(g.mean, [&](Slope s, int c) { return of_1(s.x * s.x + s.y * s.y, c); });
                        ASSERT_NEAR(at(dx, x, y, 1), mean(g.mean, [&](Slope s, int c) { return of_1(s.x, c); }),
                                    allowed)
                            << name << ' ' << name_of(edge) << ' ' << x << ',' << y;
                        ASSERT_NEAR(at(dy, x, y, 1), mean(g.mean, [&](Slope s, int c) { return of_1(s.y, c); }),
                                    allowed);
                        ASSERT_NEAR(std::pow(at(length, x, y, 1), 2), squares, allowed);
                        ASSERT_NEAR(at(tensor, x, y, 0), mean(window, [](Slope s, int) { return s.x * s.x; }), allowed)
                            << name << ' ' << name_of(edge) << ' ' << x << ',' << y;
                        ASSERT_NEAR(at(tensor, x, y, 1), mean(window, [](Slope s, int) { return s.x * s.y; }), allowed);
                        ASSERT_NEAR(at(tensor, x, y, 2), mean(window, [](Slope s, int) { return s.y * s.y; }), allowed);
                    }
            }
    }
}

TEST(Gradients, WhatIsFlatHasNoneAndNoCoherence) {
    const Image<float> flat = picture(23, 21, 3, [](int, int, int c) { return 0.3 + c; });
    for (const std::string& name : gradients)
        for (const Edge edge : {Edge::clamp, Edge::reflect, Edge::wrap}) {
            const Image<float> length = run(flat, name, GradientResult::magnitude, edge);
            const Image<float> tensor = run(flat, name, GradientResult::tensor, edge);
            for (int y = 0; y < 21; ++y)
                for (int x = 0; x < 23; ++x) {
                    for (int c = 0; c < 3; ++c) ASSERT_EQ(at(length, x, y, c), 0) << name;
                    for (int c = 0; c < 6; ++c) ASSERT_EQ(at(tensor, x, y, c), 0) << name << ' ' << c;
                }
        }
}

TEST(Gradients, ValuesFarFromZeroCostNothing) {
    // 1000 to 1001 holds fewer values than 0 to 1; of those that it holds, gradients are as exact.
    const Image<float> far = noise(20, 20, 1, 1000);
    const Gradient g = gradient_of("gaussian:0.8");
    const Image<float> dx = run(far, g, {.result = GradientResult::dx});
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x)
            EXPECT_NEAR(at(dx, x, y), slope(far, g, x, y, 0, Edge::reflect).x, 4 * dot_bound(20, 1));
}

/// Waves whose gradient has the angle `degrees` from +x towards +y.
Image<float> waves(int width, int height, double degrees, double frequency = 0.08) {
    const double u = std::cos(degrees * pi / 180), v = std::sin(degrees * pi / 180);
    return picture(width, height, 1, [=](int x, int y, int) { return std::cos(2 * pi * frequency * (x * u + y * v)); });
}

TEST(Gradients, OrientationIsThatOfTheWavesAndTurnsWithThem) {
    for (const double degrees : {-75.0, -40.0, 0.0, 17.0, 45.0, 70.0, 90.0}) {
        const Image<float> tensor = run(waves(41, 41, degrees), "scharr", GradientResult::tensor);
        const double angle = at(tensor, 20, 20, 4) * 180 / pi;
        EXPECT_NEAR(angle, degrees, 0.1);
        EXPECT_GT(at(tensor, 20, 20, 5), 0.999);
    }
    // By a quarter of a turn: (x, y) of the picture goes to (-y, x), towards +y.
    const Image<float> image = noise(19, 19, 1);
    const Image<float> turned = picture(19, 19, 1, [&](int x, int y, int) { return at(image, y, 18 - x); });
    for (const char* name : {"scharr", "central", "diagonal3"}) {
        const Image<float> a = run(image, name, GradientResult::tensor), b = run(turned, name, GradientResult::tensor);
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 19; ++x) {
                double turn = at(b, 18 - y, x, 4) - at(a, x, y, 4);
                if (turn < 0) turn += pi;
                ASSERT_NEAR(turn, pi / 2, 1e-3) << name << x << ',' << y;  // where hardly any direction dominates
                ASSERT_NEAR(at(a, x, y, 3), at(b, 18 - y, x, 3), 1e-5);
                ASSERT_NEAR(at(a, x, y, 5), at(b, 18 - y, x, 5), 1e-5);
            }
    }
}

TEST(Gradients, StripesCheckerboardsAndCornersAreSeenAsTheOperatorsAre) {
    const auto of = [](const std::string& name, auto f) {
        return at(run(picture(12, 12, 1, f), name, GradientResult::magnitude), 5, 6);
    };
    const auto stripes = [](int x, int, int) { return x % 2; };
    const auto checkers = [](int x, int y, int) { return (x + y) % 2; };
    EXPECT_EQ(of("central", stripes), 0);
    for (const char* name : {"forward", "diagonal", "diagonal3"}) EXPECT_NEAR(of(name, stripes), 1, 1e-6) << name;
    for (const char* name : {"diagonal", "diagonal3"}) EXPECT_NEAR(of(name, checkers), 0, 1e-6) << name;
    EXPECT_NEAR(of("forward", checkers), std::sqrt(2), 1e-6);
    // The forward gradient of a square's corner is sqrt 2 at one and 0 at the opposite one.
    const Image<float> square = picture(12, 12, 1, [](int x, int y, int) { return x > 3 && x < 8 && y > 3 && y < 8; });
    const Image<float> forward = run(square, "forward", GradientResult::magnitude);
    EXPECT_NEAR(at(forward, 7, 7), std::sqrt(2), 1e-6);
    EXPECT_EQ(at(forward, 3, 3), 0);
}

// The ideal differentiator has the response 2 pi i f about where the derivative is taken.
TEST(Gradients, ResponsesAreTheKnownShareOfTheIdealDifferentiators) {
    const auto share = [](const std::string& name, double f) {
        const Gradient g = gradient_of(name);
        return (response(PlacedWeights(g.along, position_of_dx(g).x), f) / std::complex<double>(0, 2 * pi * f)).real();
    };
    const auto sinc = [](double x) { return std::sin(pi * x) / (pi * x); };
    for (const double f : {0.01, 0.1, 0.25, 0.4, 0.5}) {
        EXPECT_NEAR(share("forward", f), sinc(f), 1e-12);
        EXPECT_NEAR(share("scharr", f), sinc(2 * f), 1e-12);
        EXPECT_NEAR(share("gaussian:2", f), std::exp(-2 * std::pow(pi * 2 * f, 2)), 1e-3);
    }
    // Diagonal differences of waves are biased at high frequencies (Wronski 2021): (10, 3) / 64 cycles per sample.
    const Image<float> waves =
        picture(64, 64, 1, [](int x, int y, int) { return std::sin(2 * pi * (10 * x + 3 * y) / 64); });
    const Image<float> tensor = run(waves, "diagonal", GradientResult::tensor, Edge::wrap);
    EXPECT_NEAR(at(tensor, 30, 30, 4) * 180 / pi, 15.51, 0.005);
}

TEST(Gradients, ANaNStaysWithinTheWeights) {
    Image<float> image = noise(31, 31, 1);
    image.view()(15, 14) = static_cast<float>(nan);
    for (const std::string& name : gradients)
        for (const GradientResult result : {GradientResult::dx, GradientResult::magnitude, GradientResult::tensor,
                                            GradientResult::normals, GradientResult::direction}) {
            const GradientOptions options{.result = result, .window = gaussian_taps(0.5)};
            const Image<float> found = run(image, parse_derivative(name), options);
            // A Gaussian of 0.8 reaches 4 samples, one of 0.5 reaches 2, and the others 1.
            const int reach = (name == "gaussian:0.8" ? 4 : 1) + (result == GradientResult::tensor ? 2 : 0);
            int lost = 0;
            for (int y = 0; y < 31; ++y)
                for (int x = 0; x < 31; ++x) {
                    const bool is_nan = std::isnan(at(found, x, y));
                    lost += is_nan;
                    EXPECT_FALSE(is_nan && std::max(std::abs(x - 15), std::abs(y - 14)) > reach) << name;
                }
            EXPECT_GT(lost, 0) << name;
        }
}

TEST(Gradients, ThreadsAndBandsChangeNoBit) {
    const Image<float> image = noise(37, 150, 3);
    for (const char* name : {"scharr", "diagonal3", "gaussian:1.2"})
        for (const GradientResult result : {GradientResult::magnitude, GradientResult::tensor}) {
            const GradientOptions options{.result = result};
            const Image<float> whole = run(image, parse_derivative(name), options, {1});
            const Image<float> threads = run(image, parse_derivative(name), options, {3});
            const RowFilter filter = gradient_filter(parse_derivative(name), 37, 150, options);
            for (int first = 0; first < 150; first += 47) {
                const int last = std::min(first + 47, 150);
                const IndexRange needed = filter.rows_needed(first, last);
                Image<float> band(37, last - first, whole.channels(), Layout::interleaved);
                filter.run({cropped(image.view(), 0, needed.begin, 37, needed.count()), needed.begin, {}},
                           {band.view(), first, {}, {}});
                for (int y = first; y < last; ++y)
                    for (int x = 0; x < 37; ++x)
                        for (int c = 0; c < whole.channels(); ++c) {
                            const auto bits = std::bit_cast<unsigned>(whole.view()(x, y, c));
                            ASSERT_EQ(std::bit_cast<unsigned>(threads.view()(x, y, c)), bits);
                            ASSERT_EQ(std::bit_cast<unsigned>(band.view()(x, y - first, c)), bits);
                        }
            }
        }
}

TEST(Gradients, NormalsOfAPlaneAndTheirConventions) {
    const Image<float> plane = picture(9, 9, 1, [](int x, int y, int) { return 0.25 * x + 0.5 * y; });
    GradientOptions options{.result = GradientResult::normals, .height = 2};
    const double length = std::sqrt(0.5 * 0.5 + 1 + 1);
    for (const auto convention : {NormalConvention::opengl, NormalConvention::directx}) {
        options.convention = convention;
        const double up = convention == NormalConvention::opengl ? 1 : -1;  // falls where y grows: faces up
        const Image<float> n = run(plane, parse_derivative("scharr"), options);
        EXPECT_NEAR(at(n, 4, 4, 0), -0.5 / length, 1e-6);
        EXPECT_NEAR(at(n, 4, 4, 1), up / length, 1e-6);
        EXPECT_NEAR(at(n, 4, 4, 2), 1 / length, 1e-6);
    }
    Image<std::uint8_t> codes(9, 9, 3, Layout::interleaved);
    gradient_filter(parse_derivative("scharr"), 9, 9, options)
        .run({plane.view(), 0, {}}, {codes.view(), 0, {Transfer::srgb, -1, false}, {}});
    EXPECT_EQ(codes.view()(4, 4, 0), std::lround((1 - 0.5 / length) / 2 * 255));
    EXPECT_EQ(codes.view()(4, 4, 2), std::lround((1 + 1 / length) / 2 * 255));
}

TEST(Gradients, DirectionsAreHues) {
    for (const double degrees : {0.0, 60.0, 120.0, 180.0, 210.0, 300.0}) {
        const double u = std::cos(degrees * pi / 180), v = std::sin(degrees * pi / 180);
        const Image<float> ramp =
            picture(9, 9, 3, [=](int x, int y, int c) { return c == 1 ? (x * u + y * v) / 2 : 0.1 * x; });
        const Image<float> rgb = run(ramp, "scharr", GradientResult::direction);
        const double peak = degrees / 120;  // 0 red, 1 green, 2 blue
        for (int c = 0; c < 3; ++c) {
            const double from = std::abs(std::remainder(peak - c, 3.0));
            EXPECT_NEAR(at(rgb, 4, 4, c), 1 - 0.5 * (1 - std::clamp(2 - 2 * from, 0.0, 1.0)), 1e-5) << degrees << c;
        }
    }
}

TEST(Gradients, AlphaIsAChannelLikeOthers) {
    const Image<float> image = picture(9, 9, 2, [](int x, int, int c) { return c == 1 ? x / 8.0 : 0.5; });
    const auto found = [&](bool premultiply) {
        Image<float> out(9, 9, 2, Layout::interleaved);
        gradient_filter(parse_derivative("central"), 9, 9, {.result = GradientResult::dx, .premultiply = premultiply})
            .run({image.view(), 0, {Transfer::linear, 1, false}}, {out.view(), 0, {Transfer::linear, 1, false}, {}});
        return std::pair{at(out, 4, 4, 0), at(out, 4, 4, 1)};
    };
    EXPECT_EQ(found(true), (std::pair{1.0 / 16, 1.0 / 8}));
    EXPECT_EQ(found(false), (std::pair{0.0, 1.0 / 8}));
}

TEST(Gradients, WhatMakesNoSenseIsRefused) {
    EXPECT_THROW(parse_derivative("roberts"), Error);
    EXPECT_THROW(parse_derivative("gaussian"), Error);
    EXPECT_THROW(parse_derivative("gaussian:0"), Error);
    EXPECT_THROW(parse_derivative("log:nan"), Error);
    EXPECT_THROW(parse_derivative("sobel:3"), Error);
    EXPECT_THROW(parse_gradient_result("length"), Error);
    EXPECT_THROW(gradient_by({0, {1, 1}, 1}, "sum"), Error);
    EXPECT_THROW(gradient_by({0, {-1, 1}, 2}, "half"), Error);
    const auto make = [](const std::string& name, GradientOptions o) {
        gradient_filter(parse_derivative(name), 4, 4, o);
    };
    EXPECT_THROW(make("sobel", {.edge = Edge::renormalize}), Error);
    EXPECT_THROW(make("sobel", {.result = GradientResult::value}), Error);
    EXPECT_THROW(make("log:1", {.result = GradientResult::dx}), Error);
    EXPECT_THROW(make("sobel", {.window = {0, {0.5}, 1}}), Error);
    EXPECT_THROW(make("sobel", {.window = {0, {-1, 2}, 1}}), Error);
}

TEST(StructureTensor, ClosedFormsAndDegenerateCases) {
    const StructureTensor tilted{3, 1, 3};  // eigenvalues 4 and 2
    EXPECT_NEAR(eigenvalues(tilted).larger, 4, 1e-12);
    EXPECT_NEAR(eigenvalues(tilted).smaller, 2, 1e-12);
    EXPECT_NEAR(orientation(tilted), pi / 4, 1e-12);
    EXPECT_NEAR(coherence_of(tilted), 2.0 / 6, 1e-12);
    EXPECT_NEAR(coherence_of(tilted, Coherence::sqrt), (2 - std::sqrt(2)) / (2 + std::sqrt(2)), 1e-12);
    EXPECT_NEAR(harris(tilted, 0.05), 8 - 0.05 * 36, 1e-12);
    EXPECT_NEAR(shi_tomasi(tilted), 2, 1e-12);
    for (const auto definition : {Coherence::difference, Coherence::sqrt}) {
        EXPECT_EQ(coherence_of({0, 0, 0}, definition), 0);
        EXPECT_EQ(coherence_of({2, 0, 2}, definition), 0);
        EXPECT_EQ(coherence_of({2, 0, 0}, definition), 1);
        EXPECT_EQ(coherence_of({0, 0, 2}, definition), 1);
        EXPECT_NEAR(coherence_of({1, 1, 1}, definition), 1, 1e-7);
        EXPECT_TRUE(std::isnan(coherence_of({nan, 0, 1}, definition)));
    }
    EXPECT_EQ(orientation({0, 0, 0}), 0);
    EXPECT_EQ(orientation({2, 0, 2}), 0);
    for (const double zero : {0.0, -0.0}) EXPECT_NEAR(orientation({0, zero, 2}), pi / 2, 1e-7);
    EXPECT_GT(orientation({0, -1e-30, 2}), 0);  // not -pi / 2
    EXPECT_LE(static_cast<double>(static_cast<float>(orientation({0, 0, 2}))), pi / 2);
    Random random(3);
    for (int i = 0; i < 1000; ++i) {  // of parallel gradients: rounding must not lead past 1
        const double x = random.uniform(), y = random.uniform();
        const float xx = static_cast<float>(x * x), xy = static_cast<float>(x * y), yy = static_cast<float>(y * y);
        const StructureTensor t{static_cast<double>(xx), static_cast<double>(xy), static_cast<double>(yy)};
        EXPECT_LE(coherence_of(t), 1);
        EXPECT_LE(coherence_of(t, Coherence::sqrt), 1);
        EXPECT_GE(eigenvalues(t).smaller, 0);
    }
}

// In the frame of the diagonals, four equal entries are a HORIZONTAL gradient with d2 = (1, -1) / sqrt 2.
TEST(StructureTensor, OfDiagonalsIsTurned) {
    for (const Slope s : {Slope{1, 0}, {0, 1}, {0.6, 0.8}, {1, -1}}) {
        const double d1 = (s.x + s.y) / std::sqrt(2), d2 = (s.x - s.y) / std::sqrt(2);
        const StructureTensor t = from_diagonals(d1 * d1, d1 * d2, d2 * d2);
        EXPECT_NEAR(t.xx, s.x * s.x, 1e-12);
        EXPECT_NEAR(t.xy, s.x * s.y, 1e-12);
        EXPECT_NEAR(t.yy, s.y * s.y, 1e-12);
    }
    EXPECT_EQ(from_diagonals(1, 1, 1).yy, 0);
}

}  // namespace
}  // namespace bandlimit
