#include "bandlimit/filter/convolve.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/combine.h"

namespace bandlimit {
namespace {

constexpr Method methods[] = {Method::direct, Method::low_rank, Method::fft};

template <class F>
Image<float> picture(int width, int height, int channels, F f) {
    Image<float> image(width, height, channels, Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.view()(x, y, c) = static_cast<float>(f(x, y, c));
    return image;
}

Image<float> noise(int width, int height, int channels, std::uint64_t seed = 1) {
    Random random(seed);
    return picture(width, height, channels, [&](int, int, int) { return random.uniform(); });
}

/// Positive weights of full rank that sum to 1.
ConvolutionWeights weights(int width, int height, int first_x, int first_y) {
    Random random(7);
    WeightGrid grid(width, height);
    for (double& w : grid.weights) w = random.uniform();
    return with_unit_sum(ConvolutionWeights{grid, first_x, first_y});
}

Image<float> convolved(const Image<float>& image, const ConvolutionWeights& w, const ConvolveOptions& options = {},
                       Encoding encoding = {}, Parallel parallel = {2}) {
    Image<float> out(image.width(), image.height(), image.channels(), Layout::interleaved);
    Convolution(w, image.width(), image.height(), options)
        .run({image.view(), 0, encoding}, {out.view(), 0, encoding, {}}, parallel);
    return out;
}

/// From the definition.
double expected(const Image<float>& image, const ConvolutionWeights& w, int x, int y, int c, Edge edge) {
    const WeightGrid grid = grid_of(w);
    double sum = 0, inside = 0, whole = 0;
    for (int v = 0; v < grid.height; ++v)
        for (int u = 0; u < grid.width; ++u) {
            const int from_x = resolve(x + w.first_x + u, image.width(), edge);
            const int from_y = resolve(y + w.first_y + v, image.height(), edge);
            whole += grid.at(u, v);
            if (from_x < 0 || from_y < 0) continue;
            inside += grid.at(u, v);
            sum += grid.at(u, v) * static_cast<double>(image.view()(from_x, from_y, c));
        }
    return edge == Edge::renormalize ? sum * whole / inside : sum;
}

/// Rounding of positive weights of sum 1 on samples up to 1. Sums run along x, then over all products along y, and a
/// renormalized one is scaled up by at most the inverse of the smallest part inside, here 1/16.
double bound(const Convolution& convolution, const WeightGrid& grid) {
    const int taps = convolution.chosen().method == Method::fft ? 1 : grid.width + grid.width * grid.height;
    // Products have weights of either sign: their magnitudes sum to more than 1.
    return 16 * 4 * dot_bound(taps, 1);
}

TEST(Convolve, EveryMethodIsTheSumOfItsDefinitionUnderEveryEdge) {
    for (const auto& [width, height] : {std::pair{37, 29}, {3, 50}, {40, 2}, {1, 1}})
        for (const int channels : {1, 3, 4}) {
            const Image<float> image = noise(width, height, channels);
            const ConvolutionWeights w = weights(7, 5, -4, -1);
            for (const Method method : methods)
                for (const Edge edge : all_edges()) {
                    const ConvolveOptions options{.method = method, .edge_x = edge, .edge_y = edge};
                    const Image<float> found = convolved(image, w, options);
                    const double allowed = bound(Convolution(w, width, height, options), grid_of(w));
                    for (int y = 0; y < height; ++y)
                        for (int x = 0; x < width; ++x)
                            for (int c = 0; c < channels; ++c)
                                ASSERT_NEAR(found.view()(x, y, c), expected(image, w, x, y, c, edge), allowed)
                                    << name_of(method) << ' ' << name_of(edge) << ' ' << x << ',' << y;
                }
        }
}

TEST(Convolve, AnImpulseBecomesTheWeightsTurned) {
    const ConvolutionWeights w = weights(5, 3, -1, -2);
    const WeightGrid grid = grid_of(w);
    const Image<float> image = picture(21, 17, 1, [](int x, int y, int) { return x == 10 && y == 8; });
    for (const Method method : methods) {
        const Image<float> found = convolved(image, w, {.method = method});
        const Image<float> drawn = convolved(image, turned(w), {.method = method});
        for (int v = 0; v < 3; ++v)
            for (int u = 0; u < 5; ++u) {
                // Products are rounded one by one.
                EXPECT_NEAR(found.view()(10 - w.first_x - u, 8 - w.first_y - v), grid.at(u, v), 1e-7);
                EXPECT_NEAR(drawn.view()(10 + w.first_x + u, 8 + w.first_y + v), grid.at(u, v), 1e-7);
            }
    }
}

TEST(Convolve, ConstantsStayAndRampsStayRampsInside) {
    // Symmetric, so that the mean of a ramp is its middle.
    WeightGrid grid(9, 9);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) grid.at(x, y) = std::hypot(x - 4, y - 4) < 4.3;
    const ConvolutionWeights w = with_unit_sum(centred(grid));
    const Image<float> ramp = picture(40, 30, 2, [](int x, int y, int c) { return c == 0 ? 0.75 : x + 2.0 * y; });
    for (const Method method : methods) {
        const Image<float> found = convolved(ramp, w, {.method = method});
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                EXPECT_NEAR(found.view()(x, y, 0), 0.75, 4 * dot_bound(90, 1));
                if (x < 4 || x >= 36 || y < 4 || y >= 26) continue;
                EXPECT_NEAR(found.view()(x, y, 1), x + 2 * y, 400 * dot_bound(90, 1));
            }
    }
}

TEST(Convolve, WhatIsNotFiniteReachesItsFootprintOnly) {
    const ConvolutionWeights w = weights(7, 5, -4, -1);
    const int at_x = 20, at_y = 15;
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image<float> image = noise(60, 40, 3);
        image.view()(at_x, at_y, 1) = value;
        for (const Method method : methods) {
            const Image<float> found = convolved(image, w, {.method = method});
            for (int y = 0; y < 40; ++y)
                for (int x = 0; x < 60; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const int u = at_x - x - w.first_x, v = at_y - y - w.first_y;
                        const bool reads = c == 1 && u >= 0 && u < 7 && v >= 0 && v < 5;
                        ASSERT_EQ(!std::isfinite(found.view()(x, y, c)), reads)
                            << name_of(method) << ' ' << x << ',' << y << ',' << c;
                    }
        }
    }
}

TEST(Convolve, ThreadsAndPartsHaveTheBitsOfTheWhole) {
    const Image<float> image = noise(150, 90, 4);
    const ConvolutionWeights w = weights(11, 9, -5, -4);
    for (const Method method : methods)
        for (const Edge edge : {Edge::renormalize, Edge::wrap, Edge::reflect}) {
            const ConvolveOptions options{.method = method, .edge_x = edge, .edge_y = edge};
            const Image<float> whole = convolved(image, w, options, {}, {1});
            const Convolution convolution(w, 150, 90, options);
            for (const int threads : {2, 3, 7}) {
                Image<float> found(150, 90, 4, Layout::interleaved);
                for (const auto& [first, last] : {std::pair{0, 33}, {33, 34}, {34, 90}}) {
                    const IndexRange rows = convolution.rows_needed(first, last);
                    const auto from = cropped(image.view(), 0, rows.begin, 150, rows.end - rows.begin);
                    convolution.run({View<const float>(from), rows.begin, {}},
                                    {cropped(found.view(), 0, first, 150, last - first), first, {}, {}}, {threads});
                }
                for (int i = 0; i < 150 * 90 * 4; ++i)
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(found.view().data[i]),
                              std::bit_cast<std::uint32_t>(whole.view().data[i]))
                        << name_of(method) << ' ' << name_of(edge) << ' ' << threads << " threads, sample " << i;
            }
        }
}

// What is transparent adds no colour: red beside nothing stays red.
TEST(Convolve, TransparentTexelsDoNotBleed) {
    const Image<float> image = picture(20, 20, 4, [](int x, int, int c) {
        const bool opaque = x < 10;
        return c == 3 ? opaque : c == (opaque ? 0 : 1);  // opaque red, transparent green
    });
    const Encoding straight{Transfer::linear, 3, false};
    const ConvolutionWeights w = weights(7, 5, -3, -2);
    for (const Method method : methods) {
        const Image<float> found = convolved(image, w, {.method = method}, straight);
        for (int x = 0; x < 13; ++x) {
            EXPECT_NEAR(found.view()(x, 10, 0), 1, 1e-4) << name_of(method);  // a quotient of sums down to 1/50
            EXPECT_NEAR(found.view()(x, 10, 1), 0, 1e-4);
        }
        EXPECT_EQ(found.view()(13, 10, 0), method == Method::fft ? found.view()(13, 10, 0) : 0.0f);
    }
}

TEST(Convolve, AutoTakesWhatIsCheapestAndChangesNothing) {
    const auto chosen = [](const ConvolutionWeights& w) { return Convolution(w, 400, 300).chosen(); };
    Random random(3);
    WeightGrid product(31, 31);
    for (int y = 0; y < 31; ++y)
        for (int x = 0; x < 31; ++x) product.at(x, y) = (x + 1.0) * (40 - y);
    EXPECT_EQ(chosen(centred(product)).method, Method::separable);
    EXPECT_EQ(chosen(centred(product)).multiply_adds, 62);
    EXPECT_EQ(chosen(weights(3, 3, -1, -1)).method, Method::direct);
    EXPECT_EQ(chosen(weights(3, 3, -1, -1)).multiply_adds, 9);
    EXPECT_EQ(chosen(weights(101, 101, -50, -50)).method, Method::fft);
    product.at(3, 3) += 50;  // rank 2
    const MethodCost two = chosen(centred(product));
    EXPECT_EQ(two.method, Method::low_rank);
    EXPECT_EQ(two.rank, 2);
    // A row of weights is one pass, and the other axis a shift.
    EXPECT_EQ(chosen(centred(Terms{{{1}, {1, 2, 1}}})).method, Method::direct);
    for (const Method method : {Method::direct, Method::separable, Method::low_rank, Method::fft})
        EXPECT_NO_THROW(Convolution(centred(Terms{{{1, 1}, {1, 2, 1}}}), 5, 5, {.method = method}));
}

TEST(Convolve, TermsRunAsTheyAre) {
    Random random(5);
    Terms terms;
    for (int t = 0; t < 3; ++t) {
        Term term;
        for (int i = 0; i < 9; ++i) {
            term.column.push_back(random.uniform() - 0.3);
            term.row.push_back(random.uniform() - 0.3);
        }
        terms.push_back(term);
    }
    const ConvolutionWeights w = with_unit_sum(centred(terms));
    EXPECT_NEAR(sum_of(w), 1, 1e-14);
    EXPECT_EQ(Convolution(w, 100, 100, {.method = Method::low_rank}).chosen().rank, 3);
    const Image<float> image = noise(50, 40, 1);
    const Image<float> found = convolved(image, w, {.method = Method::low_rank, .edge_x = Edge::wrap});
    ConvolutionWeights grid{grid_of(w), w.first_x, w.first_y};
    const Image<float> same = convolved(image, grid, {.method = Method::fft, .edge_x = Edge::wrap});
    for (int i = 0; i < 50 * 40; ++i) EXPECT_NEAR(found.view().data[i], same.view().data[i], 1e-4);
}

TEST(Convolve, RefusesWhatCannotBe) {
    EXPECT_THROW(Convolution(ConvolutionWeights{}, 5, 5), Error);
    EXPECT_THROW(Convolution(weights(3, 3, -1, -1), 0, 5), Error);
    EXPECT_THROW(Convolution(weights(3, 3, -1, -1), 5, 5, {.method = Method::separable}), Error);
    WeightGrid bad(2, 2);
    bad.at(0, 0) = std::nan("");
    for (const Method method : methods) EXPECT_THROW(Convolution(centred(bad), 5, 5, {.method = method}), Error);
    const ConvolutionWeights derivative = centred(Terms{{{1}, {-1, 0, 1}}});
    EXPECT_THROW(with_unit_sum(derivative), Error);
    EXPECT_THROW(Convolution(derivative, 9, 9), Error);
    EXPECT_NO_THROW(Convolution(derivative, 9, 9, {.edge_x = Edge::reflect, .edge_y = Edge::reflect}));
    // All weights of the last column lie outside.
    for (const Method method : methods) EXPECT_THROW(Convolution(weights(2, 2, 3, 0), 9, 9, {.method = method}), Error);
    Image<float> out(5, 5, 2, Layout::interleaved);
    for (const Method method : methods) {
        const Convolution convolution(weights(3, 3, -1, -1), 5, 5, {.method = method});
        EXPECT_THROW(convolution.run({noise(5, 5, 1).view(), 0, {}}, {out.view(), 0, {}, {}}), Error);
        EXPECT_THROW(convolution.run({noise(5, 4, 2).view(), 0, {}}, {out.view(), 0, {}, {}}), Error);
        EXPECT_THROW(convolution.rows_needed(2, 6), Error);
    }
}

TEST(FftTiles, CoverAllOutputs) {
    for (const int weights : {1, 2, 51, 201, 1500})
        for (const int samples : {1, 7, 300, 1920, 5000}) {
            const FftTiles tiles = fft_tiles(weights, samples);
            EXPECT_EQ(tiles.outputs, tiles.size - weights + 1);
            EXPECT_GE(tiles.outputs, 1);
            EXPECT_GE(tiles.count * tiles.outputs, samples) << weights << ' ' << samples;
            EXPECT_LT((tiles.count - 1) * tiles.outputs, samples);
        }
}

TEST(Convolution, OnesStayExactlyOnes) {
    Random random(12);
    for (const int size : {3, 8, 25}) {
        WeightGrid disc(size, size);
        for (double& w : disc.weights) w = random.uniform(0, 1);
        Image<float> ones(40, 30), out(40, 30);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) ones.view()(x, y) = 1;
        const ConvolveOptions options{.method = Method::direct, .edge_x = Edge::reflect, .edge_y = Edge::reflect};
        Convolution(with_unit_sum(centred(disc)), 40, 30, options)
            .run({View<const float>(ones.view()), 0, {}}, {out.view(), 0, {}, {}});
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) ASSERT_EQ(out.view()(x, y), 1) << size;
    }
}

TEST(Convolution, RenormalizesHoweverLittleIsInside) {
    // A bell so wide and so far off that a millionth of it lies inside: all weights are positive, nothing cancels.
    WeightGrid far(41, 1);
    for (int x = 0; x < 41; ++x) far.at(x, 0) = std::exp(-x * x / 2.0 / 9);
    Image<float> ones(8, 1), out(8, 1);
    for (int x = 0; x < 8; ++x) ones.view()(x, 0) = 1;
    Convolution({far, -18, 0}, 8, 1, {.method = Method::direct})
        .run({View<const float>(ones.view()), 0, {}}, {out.view(), 0, {}, {}});
    const double sum = sum_of(ConvolutionWeights{far, 0, 0});
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(out.view()(x, 0), sum, 1e-5 * sum);
    // But what is below the digits of the sums is nothing.
    for (int x = 0; x < 41; ++x) far.at(x, 0) = x < 5 ? 1 : 1e-12;
    EXPECT_THROW(Convolution({far, -18, 0}, 8, 1, {.method = Method::direct}), Error);
}

// Tiles of a transform are at most 1024 rows high here: a part of the rows begins in the second one.
TEST(Convolution, PartsOfTallImagesHaveTheBitsOfTheWhole) {
    const int height = 2500;
    const Image<float> image = noise(4, height, 1);
    const ConvolutionWeights w = weights(3, 9, -1, -4);
    const ConvolveOptions options{.method = Method::fft};
    const Image<float> whole = convolved(image, w, options);
    const Convolution convolution(w, 4, height, options);
    const int first = 1300, rows = 900;
    Image<float> part(4, rows);
    convolution.run({View<const float>(image.view()), 0, {}}, {part.view(), first, {}, {}});
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 4; ++x) ASSERT_EQ(part.view()(x, y), whole.view()(x, first + y)) << y;
}

}  // namespace
}  // namespace bandlimit
