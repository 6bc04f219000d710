#include "bandlimit/resample/resize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/byte_bank.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/naive_test.h"
#include "bandlimit/resample/operator_checker_test.h"

namespace bandlimit {
namespace {

constexpr double largest = 2;  ///< no sample of these tests is larger

/// A scale and a kernel per axis.
struct Resizing {
    Kernel kernel;
    Edge edge;
    int x_numerator, x_denominator, y_numerator, y_denominator;

    Size output(Size s) const {
        return {std::max(1, s.width * x_numerator / x_denominator),
                std::max(1, s.height * y_numerator / y_denominator)};
    }
    Grid src(Size s) const { return {{s.width, 0, double(s.width)}, {s.height, 0, double(s.height)}}; }
    Grid dst(Size s) const {
        const Size out = output(s);
        return {{out.width, 0, double(s.width)}, {out.height, 0, double(s.height)}};
    }
};

std::vector<Resizing> resizings() {
    return {{lanczos(3), Edge::reflect, 1, 2, 1, 2},
            {mitchell(), Edge::renormalize, 3, 2, 3, 2},
            {catmull_rom(), Edge::wrap, 2, 1, 1, 3},
            {tent(), Edge::zero, 1, 3, 2, 1},
            {box(), Edge::clamp, 2, 5, 1, 1}};
}

Size size_of(View<const float> v) { return {v.width, v.height}; }

const std::vector<NaiveRow>& rows_of(const Kernel& kernel, int n, int m, Edge edge) {
    static std::map<std::tuple<std::string, int, int, Edge>, std::vector<NaiveRow>> known;
    std::vector<NaiveRow>& rows = known[{kernel.name, n, m, edge}];
    for (int i = static_cast<int>(rows.size()); i < m; ++i)
        rows.push_back(naive_row(kernel, Axis{n, 0, double(n)}, Axis{m, 0, double(n)}, i, edge));
    return rows;
}

Grid part_of(const Grid& whole, const Window& w) {
    return {whole.x.cells(w.x, w.x + w.width), whole.y.cells(w.y, w.y + w.height)};
}

/// Runs a part of the output as a resizing of its own, from a view of floats to a view of floats.
void run_part(const Resizing& r, View<const float> src, View<float> dst, Window w, Parallel parallel,
              const ResizeOptions& options) {
    Resizer(r.src(size_of(src)), part_of(r.dst(size_of(src)), w), src.channels, options)
        .run({src, 0, {}}, {dst, 0, {}, {}}, parallel);
}

TEST(Resizer, PassesTheOperatorChecker) {
    for (const Resizing& r : resizings()) {
        Operator op;
        op.output_size = [r](Size size) { return r.output(size); };
        op.run = [r](View<const float> src, View<float> dst, Window w, Parallel parallel) {
            run_part(r, src, dst, w, parallel, {.reconstruction = r.kernel, .edge = r.edge});
        };
        const auto row_x = [r](View<const float> src, int x) -> const NaiveRow& {
            return rows_of(r.kernel, src.width, r.output(size_of(src)).width, r.edge)[std::size_t(x)];
        };
        const auto row_y = [r](View<const float> src, int y) -> const NaiveRow& {
            return rows_of(r.kernel, src.height, r.output(size_of(src)).height, r.edge)[std::size_t(y)];
        };
        op.reference = [=](View<const float> src, int x, int y, int c) {
            const NaiveRow &across = row_x(src, x), &down = row_y(src, y);
            double sum = 0;
            for (int v = 0; v < src.height; ++v)
                if (const double w = down.weights[std::size_t(v)]; w != 0) sum += w * dot(across, src, v, c);
            return sum;
        };
        op.bound = [=](View<const float> src, int x, int y, int) {
            const NaiveRow &a = row_x(src, x), &b = row_y(src, y);
            return dot_bound(a.taps + b.taps + 3, a.sum_abs * b.sum_abs * largest);
        };
        EXPECT_TRUE(check_operator(op)) << r.kernel.name << ' ' << name_of(r.edge);
    }
}

::testing::AssertionResult check_radial(const Resizing& r) {
    /// The weights of the disc, straight from the kernel.
    const auto for_each_weight = [r](View<const float> src, int x, int y, auto visit) {
        const Size size = size_of(src);
        const Grid from = r.src(size), to = r.dst(size);
        const double tx = from.x.index(to.x.position(x)), ty = from.y.index(to.y.position(y));
        const double sx = std::max(1.0, to.x.pitch()), sy = std::max(1.0, to.y.pitch()), radius = r.kernel.radius;
        for (int j = static_cast<int>(std::floor(ty - radius * sy)); j <= ty + radius * sy; ++j)
            for (int i = static_cast<int>(std::floor(tx - radius * sx)); i <= tx + radius * sx; ++i)
                visit(resolve(i, size.width, r.edge), resolve(j, size.height, r.edge),
                      r.kernel.value(std::hypot((i - tx) / sx, (j - ty) / sy)));
    };
    /// Made once per shape: the table of the kernel takes longer than all runs together.
    std::map<std::array<int, 7>, Resizer> resizers;
    Operator op;
    op.output_size = [r](Size size) { return r.output(size); };
    op.run = [&](View<const float> src, View<float> dst, Window w, Parallel parallel) {
        const Grid part = part_of(r.dst(size_of(src)), w);
        const ResizeOptions options{.reconstruction = r.kernel, .edge = r.edge};
        resizers
            .try_emplace({src.width, src.height, src.channels, w.x, w.y, w.width, w.height}, r.src(size_of(src)), part,
                         src.channels, options)
            .first->second.run({src, 0, {}}, {dst, 0, {}, {}}, parallel);
    };
    op.reference = [=](View<const float> src, int x, int y, int c) {
        double sum = 0, whole = 0;
        for_each_weight(src, x, y, [&](int i, int j, double w) {
            if (i >= 0 && j >= 0) sum += w * src(i, j, c), whole += w;
        });
        return sum / whole;
    };
    op.bound = [=](View<const float> src, int x, int y, int) {
        double sum_abs = 0, whole = 0;
        int taps = 0;
        for_each_weight(src, x, y, [&](int i, int j, double w) {
            if (i >= 0 && j >= 0) sum_abs += std::abs(w), whole += w, taps += w != 0;
        });
        // The table of the kernel is good to 1e-7 of its peak, for each weight and for their sum.
        const double table = 2 * taps * 1e-7 * r.kernel.value(0) / whole * largest * sum_abs / whole;
        return dot_bound(taps, sum_abs / whole * largest) + table;
    };
    return check_operator(op);
}

TEST(Resizer, OfARadialKernelThatGrowsPassesTheOperatorChecker) {
    EXPECT_TRUE(check_radial({jinc_lanczos(2), Edge::reflect, 2, 3, 2, 3}));
}

TEST(Resizer, OfARadialKernelThatShrinksPassesTheOperatorChecker) {
    EXPECT_TRUE(check_radial({jinc_lanczos(2), Edge::renormalize, 2, 1, 2, 1}));
}

Image<float> noise(int width, int height, int channels, std::uint64_t seed) {
    Image<float> image(width, height, channels, Layout::interleaved);
    Random random(seed);
    for (int i = 0; i < width * height * channels; ++i)
        image.view().data[i] = static_cast<float>(random.uniform(-0.1, 1.1));
    return image;
}

template <class T>
void expect_same(View<const T> a, View<const T> b, const std::string& what) {
    ASSERT_TRUE(same_shape(a, b));
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < a.channels; ++c)
                ASSERT_EQ(a(x, y, c), b(x, y, c)) << what << ' ' << x << ' ' << y << ' ' << c;
}

TEST(Resizer, BlocksOfRowsGiveTheBitsOfTheWhole) {
    const Image<float> src = noise(19, 83, 3, 1);
    for (const bool flipped : {false, true})
        for (const Edge edge : all_edges())
            for (const auto& [width, height] : {std::pair{7, 31}, {40, 200}, {40, 31}, {7, 200}}) {
                const Grid from{{19}, {83}}, to{{width}, flipped ? Axis{height, 1, 0} : Axis{height}};
                const Resizer resizer(from, to, 3, {.edge = edge});
                Image<float> whole(width, height, 3), blocks(width, height, 3);
                resizer.run({src.view(), 0, {}}, {whole.view(), 0, {}, {}});
                for (int first = 0; first < height;) {
                    const int last = std::min(height, first + 1 + first % 23);
                    // Only the rows that are needed are given.
                    const IndexRange rows = resizer.rows_needed(first, last);
                    resizer.run({cropped(src.view(), 0, rows.begin, 19, rows.end - rows.begin), rows.begin, {}},
                                {cropped(blocks.view(), 0, first, width, last - first), first, {}, {}}, {2});
                    first = last;
                }
                expect_same<float>(blocks.view(), whole.view(), message(name_of(edge), ' ', width, ' ', height));
            }
}

TEST(Resizer, BesideTheImageItReadsWhatTheEdgeSays) {
    const Image<float> src = noise(50, 40, 3, 6);
    for (const Edge edge : {Edge::clamp, Edge::reflect, Edge::wrap})
        for (const Axis& place : {Axis{30, 60, 90}, {30, -40, -10}, {30, -10, 20}, {30, 45, 130}}) {
            const Bank x = make_bank(lanczos(3), {50, 0, 50}, place, edge);
            const Bank y = make_bank(lanczos(3), {40, 0, 40}, {20, 0, 40}, edge);
            Image<float> middle(50, 20, 3), expected(30, 20, 3), found(30, 20, 3);
            apply_scalar(y, transposed(View<const float>(src.view())), transposed(middle.view()));
            apply_scalar(x, middle.view(), expected.view());
            Resizer({{50, 0, 50}, {40, 0, 40}}, {place, {20, 0, 40}}, 3, {.reconstruction = lanczos(3), .edge = edge})
                .run({src.view(), 0, {}}, {found.view(), 0, {}, {}});
            for (int i = 0; i < 30 * 20 * 3; ++i)
                ASSERT_NEAR(found.view().data[i], expected.view().data[i], 1e-5) << name_of(edge) << ' ' << place.begin;
        }
}

TEST(Resizer, HasAnEdgePerAxis) {
    const Image<float> src = noise(21, 18, 3, 7);
    for (const Edge edge_x : all_edges())
        for (const Edge edge_y : all_edges()) {
            const Bank x = make_bank(lanczos(3), Axis{21}, Axis{10}, edge_x);
            const Bank y = make_bank(lanczos(3), Axis{18}, Axis{9}, edge_y);
            Image<float> middle(21, 9, 3), expected(10, 9, 3);
            apply(y, transposed(src.view()), transposed(middle.view()));
            apply(x, middle.view(), expected.view());
            const ResizeOptions options{.reconstruction = lanczos(3), .edge = edge_x, .edge_y = edge_y};
            const Image<float> found = resample(src.view(), 10, 9, options);
            for (int i = 0; i < 10 * 9 * 3; ++i)
                ASSERT_NEAR(found.view().data[i], expected.view().data[i], 1e-5) << name_of(edge_x) << name_of(edge_y);
            // A radial kernel, far from the borders of y: what lies beyond those of x is read as x says.
            const auto stripes = [&](Edge along_y) {
                Image<float> image(16, 16);
                for (int v = 0; v < 256; ++v) image.view().data[v] = src.view()(v % 16, 0);
                return resample(image.view(), 8, 8,
                                {.reconstruction = jinc_lanczos(2), .edge = edge_x, .edge_y = along_y});
            };
            const Image<float> one = stripes(edge_y), same = stripes(edge_x);
            for (int v = 8 * 4; v < 8 * 5; ++v) ASSERT_NEAR(one.view().data[v], same.view().data[v], 1e-5);
        }
}

TEST(Resizer, PartsOfWideImagesGiveTheBitsOfTheWhole) {
    constexpr int width = 7000, height = 70, new_width = 2999, new_height = 12;
    for (const int channels : {1, 3, 4}) {
        const Image<float> src = noise(width, height, channels, 5);
        for (const Edge edge : all_edges()) {
            const Axis x{new_width, 0, double(width)}, y{new_height, 0, double(height)};
            const Grid from{{width, 0, double(width)}, {height, 0, double(height)}};
            Image<float> whole(new_width, new_height, channels), part(1, new_height, channels);
            const auto resize_to = [&](const Axis& columns, View<float> to) {
                Resizer(from, {columns, y}, channels, {.edge = edge}).run({src.view(), 0, {}}, {to, 0, {}, {}});
            };
            resize_to(x, whole.view());
            for (int i = 0; i < new_width; i += 397) {
                resize_to(x.cells(i, i + 1), part.view());
                expect_same<float>(part.view(), cropped(View<const float>(whole.view()), i, 0, 1, new_height),
                                   message(name_of(edge), ' ', channels, ' ', i));
            }
        }
    }
}

template <class T>
Image<T> stored(const Image<float>& values, const Encoding& encoding) {
    Image<T> image(values.width(), values.height(), values.channels(), Layout::interleaved);
    for (int y = 0; y < values.height(); ++y) {
        const float* row = &values.view()(0, y);
        encode_row({row, std::size_t(values.width() * values.channels())}, false, image.view(), y, encoding);
    }
    return image;
}

template <class From, class To>
void expect_codes_of_the_float_result(const Encoding& encoding) {
    const Image<From> src = stored<From>(noise(23, 17, 4, 2), encoding);
    const Resizer resizer({{23}, {17}}, {{11}, {30}}, 4, {.reconstruction = catmull_rom()});
    // By way of floats: decode, resize what is linear and premultiplied, encode.
    Image<float> linear(23, 17, 4, Layout::interleaved), result(11, 30, 4, Layout::interleaved);
    for (int y = 0; y < 17; ++y)
        decode_row(View<const From>(src.view()), y, encoding, true, {&linear.view()(0, y), 23 * 4});
    resizer.run({View<const float>(linear.view()), 0, {}}, {result.view(), 0, {}, {}});
    Image<To> expected(11, 30, 4, Layout::interleaved), direct(11, 30, 4, Layout::interleaved);
    for (int y = 0; y < 30; ++y) encode_row({&result.view()(0, y), 11 * 4}, true, expected.view(), y, encoding);
    for (const int threads : {1, 3}) {
        resizer.run({View<const From>(src.view()), 0, encoding}, {direct.view(), 0, encoding, {}}, {threads});
        expect_same<To>(direct.view(), expected.view(), "");
    }
}

TEST(Resizer, CodesAreThoseOfTheFloatResult) {
    for (const Encoding& encoding :
         {Encoding{Transfer::srgb, 3}, {Transfer::linear, 3}, {Transfer::srgb, -1}, {Transfer::linear, 3, true}}) {
        // What u8 codes become without any decoding is in byte_resize_test.cpp: they run in integers.
        if (!encoding.associated) expect_codes_of_the_float_result<std::uint8_t, std::uint8_t>(encoding);
        expect_codes_of_the_float_result<std::uint16_t, std::uint8_t>(encoding);
        expect_codes_of_the_float_result<std::uint16_t, std::uint16_t>(encoding);
        expect_codes_of_the_float_result<Half, Half>(encoding);
        expect_codes_of_the_float_result<std::uint8_t, float>(encoding);
    }
}

TEST(Resizer, TheSameSizeKeepsEveryCodeUnderAuto) {
    const Encoding encoding{Transfer::srgb, 3};
    Random random(4);
    Image<std::uint8_t> src(20, 9, 4, Layout::interleaved), dst(20, 9, 4, Layout::interleaved);
    for (int i = 0; i < 20 * 9 * 4; ++i) src.view().data[i] = static_cast<std::uint8_t>(random.integer(1, 255));
    for (const bool premultiply : {false, true}) {
        Resizer({{20}, {9}}, {{20}, {9}}, 4, {.premultiply = premultiply})
            .run({View<const std::uint8_t>(src.view()), 0, encoding}, {dst.view(), 0, encoding, {}});
        expect_same<std::uint8_t>(dst.view(), src.view(), "");
    }
}

TEST(Resizer, TransparentColourDoesNotBleed) {
    // Left half opaque grey, right half transparent red.
    Image<float> src(8, 1, 4, Layout::interleaved), dst(4, 1, 4, Layout::interleaved);
    for (int x = 0; x < 8; ++x) {
        const bool opaque = x < 4;
        for (int c = 0; c < 3; ++c) src.view()(x, 0, c) = opaque ? 0.5f : c == 0 ? 1.0f : 0.0f;
        src.view()(x, 0, 3) = opaque;
    }
    const Encoding encoding{Transfer::linear, 3};
    Resizer({{8}, {1}}, {{4}, {1}}, 4, {.reconstruction = tent()})
        .run({View<const float>(src.view()), 0, encoding}, {dst.view(), 0, encoding, {}});
    for (int x = 0; x < 4; ++x)
        for (int c = 0; c < 3; ++c) {
            if (dst.view()(x, 0, 3) > 0) EXPECT_NEAR(dst.view()(x, 0, c), 0.5, 1e-6) << x;
            else EXPECT_EQ(dst.view()(x, 0, c), 0) << x;
        }
    // By hand, weights [1 3 3 1]/8: the edge lies between outputs 1 and 2.
    EXPECT_NEAR(dst.view()(1, 0, 3), 7 / 8.0, 1e-6);
    EXPECT_NEAR(dst.view()(2, 0, 3), 1 / 8.0, 1e-6);
}

TEST(Resizer, ReportsWhatIsNotFinite) {
    Image<float> src(9, 9);
    Image<std::uint8_t> dst(9, 9);
    const Resizer resizer({{9}, {9}}, {{9}, {9}}, 1);
    EXPECT_FALSE(resizer.run({View<const float>(src.view()), 0, {}}, {dst.view(), 0, {}, {}}).lost_non_finite);
    src.view()(4, 4) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(resizer.run({View<const float>(src.view()), 0, {}}, {dst.view(), 0, {}, {}}).lost_non_finite);
}

TEST(Resizer, AutoShrinksWithOneKernelAndGrowsOrStaysWithAnother) {
    EXPECT_EQ(Resizer({{9}, {9}}, {{9}, {10}}, 1).kernel_x(), "grow3");
    EXPECT_EQ(Resizer({{9}, {9}}, {{8}, {10}}, 1).kernel_x(), "shrink3");
    EXPECT_EQ(Resizer({{9}, {9}}, {{8}, {10}}, 1).kernel_y(), "grow3");
    EXPECT_EQ(Resizer({{9}, {9}}, {{8, 1, 0}, {10, 1, 0}}, 1).kernel_x(), "shrink3");
}

TEST(Resizer, RefusesWhatDoesNotFit) {
    const Image<float> src(9, 7, 2);
    Image<float> dst(4, 3, 2);
    const Resizer resizer({{9}, {7}}, {{4}, {3}}, 2);
    EXPECT_NO_THROW(resizer.run({src.view(), 0, {}}, {dst.view(), 0, {}, {}}));
    EXPECT_THROW(resizer.run({src.view(), 1, {}}, {dst.view(), 0, {}, {}}), Error) << "row 0 is missing";
    EXPECT_THROW(resizer.run({src.view(), 0, {}}, {dst.view(), 1, {}, {}}), Error) << "rows 1 to 4 of 3";
    EXPECT_THROW(resizer.run({src.view(), 0, {}}, {Image<float>(5, 3, 2).view(), 0, {}, {}}), Error);
    EXPECT_THROW(resizer.run({src.view(), 0, {}}, {Image<float>(4, 3, 1).view(), 0, {}, {}}), Error);
    EXPECT_THROW(resizer.run({src.view(), 0, {}}, {dst.view(), 0, {}, {0.5f}}), Error) << "no alpha to lay over it";
    EXPECT_THROW(resizer.rows_needed(2, 2), Error);
    EXPECT_THROW(resizer.rows_needed(-1, 2), Error);
    EXPECT_THROW(Resizer({{9}, {7}}, {{0}, {3}}, 2), Error);
    EXPECT_THROW(Resizer({{9}, {7}}, {{4}, {3}}, 0), Error);
    EXPECT_THROW(Resizer({{9}, {7}}, {{4}, {3}}, 2, {.antiring = 2}), Error);
}

TEST(Resample, IsTheResizerOnWholeImages) {
    const Image<float> src = noise(9, 7, 2, 5);
    Image<float> expected(20, 3, 2);
    Resizer({{9}, {7}}, {{20}, {3}}, 2, {.reconstruction = tent()})
        .run({src.view(), 0, {}}, {expected.view(), 0, {}, {}});
    for (const Layout layout : {Layout::planar, Layout::interleaved})
        expect_same<float>(std::as_const(expected).view(),
                           resample(src.view(), 20, 3, {.reconstruction = tent()}, {}, layout).view(), "");
}

std::vector<Kernel> all_kernels() {
    std::vector<Kernel> kernels;
    for (const KernelInfo& info : kernel_list()) kernels.push_back(parse_kernel(info.example));
    return kernels;
}

/// A picture of each depth, of noise that reaches the extreme codes.
std::vector<AnyImage> noise_of_all_depths(int width, int height, int channels) {
    const Image<float> values = noise(width, height, channels, 4);
    std::vector<AnyImage> images;
    for (const Depth depth : all_depths()) {
        images.push_back(make_image(depth, width, height, channels));
        for (int y = 0; y < height; ++y) {
            std::vector<float> row(std::size_t(width * channels));
            decode_row(View<const float>(values.view()), y, {}, false, row);
            encode_row(row, false, view_of(images.back()), y, {});
        }
    }
    return images;
}

/// The bits of a part of a picture, row after row.
std::vector<std::uint32_t> bits_of(const AnyConstView& view, const Window& w) {
    std::vector<std::uint32_t> bits;
    std::visit(
        [&](const auto& v) {
            for (int y = w.y; y < w.y + w.height; ++y)
                for (int x = w.x; x < w.x + w.width; ++x)
                    for (int c = 0; c < v.channels; ++c) {
                        std::uint32_t sample = 0;
                        std::memcpy(&sample, &v(x, y, c), sizeof(v(x, y, c)));
                        bits.push_back(sample);
                    }
        },
        view);
    return bits;
}

/// Compares parts of `size` x `size`, side by side, with the whole, at all depths.
void expect_parts_are_those_of_the_whole(std::vector<AnyImage>& sources, const Grid& src, const Grid& dst,
                                         const ResizeOptions& options, int size, const std::string& what) {
    const int channels = shape_of(view_of(sources[0])).channels;
    const auto run = [&](const Resizer& resizer, AnyImage& source, const Grid& to) {
        AnyImage image = make_image(depth_of(const_view(view_of(source))), to.x.count, to.y.count, channels);
        resizer.run({const_view(view_of(source)), 0, {}}, {view_of(image), 0, {}, {}}, {1});
        return image;
    };
    const Resizer whole(src, dst, channels, options);
    std::vector<AnyImage> expected;
    for (AnyImage& source : sources) expected.push_back(run(whole, source, dst));
    for (int y = 0; y < dst.y.count; y += size)
        for (int x = 0; x < dst.x.count; x += size) {
            const Window w{x, y, std::min(size, dst.x.count - x), std::min(size, dst.y.count - y)};
            const Grid to = part_of(dst, w);
            const Resizer part(src, to, channels, options);
            for (std::size_t i = 0; i < sources.size(); ++i) {
                AnyImage found = run(part, sources[i], to);
                ASSERT_EQ(bits_of(const_view(view_of(found)), {0, 0, w.width, w.height}),
                          bits_of(const_view(view_of(expected[i])), w))
                    << what << ' ' << name_of(all_depths()[i]) << ", part " << x << ' ' << y << " of " << size;
            }
        }
}

/// Whether every output reads something: a narrow kernel finds nothing beside the picture under zero and renormalize.
bool has_weights(AnyImage& source, const Grid& src, const Grid& dst, const ResizeOptions& options) {
    AnyImage image = make_image(Depth::u8, dst.x.count, dst.y.count, 1);
    try {
        Resizer(src, dst, 1, options).run({const_view(view_of(source)), 0, {}}, {view_of(image), 0, {}, {}});
    } catch (const Error&) {
        return false;
    }
    return true;
}

TEST(Resizer, PartsOfAnySizeGiveTheBitsOfTheWholeAtEveryDepth) {
    std::vector<AnyImage> sources = noise_of_all_depths(29, 37, 1);
    const Grid src{{29, 0, 29}, {37, 0, 37}};
    // Smaller, larger, by about half; and reaching beside the picture, where edges cut rows to a few weights.
    const Grid targets[] = {
        {{14, 0, 29}, {18, 0, 37}}, {{40, 0, 29}, {43, 37, 0}}, {{11, -1.25, 27.25}, {23, 3, 38.25}}};
    int round = 0;
    for (const Kernel& kernel : all_kernels())
        for (const Edge edge : all_edges())
            for (const Grid& dst : targets) {
                const ResizeOptions options{.reconstruction = kernel, .edge = edge};
                const int size = std::array{8, 13, 22}[std::size_t((round + round / 3) % 3)];
                ++round;
                if (!has_weights(sources[0], src, dst, options)) continue;
                const std::string what = message(kernel.name, ' ', name_of(edge), ' ', dst.x.count);
                ASSERT_NO_FATAL_FAILURE(expect_parts_are_those_of_the_whole(sources, src, dst, options, size, what));
            }
}

TEST(Resizer, CodesOfBoxesNearAHalfAreThoseOfTheWhole) {
    std::vector<AnyImage> sources = noise_of_all_depths(6, 517, 4);
    const Grid src{{6}, {517}}, dst{{6}, {258}};
    expect_parts_are_those_of_the_whole(sources, src, dst, {.reconstruction = box()}, 43, "box");
}

TEST(Resizer, RowsOfCodesThatDoNotFitIntegersRunInFloats) {
    // Beside the border 0.9 is cut off, and what is left is scaled by 10.
    const Taps taps{-1, {0.9, -0.4, 0.5}};
    std::vector<AnyImage> sources = noise_of_all_depths(40, 40, 1);
    Image<float> values(40, 40), expected(40, 40);
    Image<std::uint8_t> found(40, 40);
    for (int y = 0; y < 40; ++y) decode_row(const_view(view_of(sources[0])), y, {}, false, {&values.view()(0, y), 40});
    const Grid grid{{40}, {40}};
    const Bank bank = make_bank(taps, 40, Edge::renormalize);
    const ByteBanks banks = make_byte_banks(bank, bank);
    EXPECT_FALSE(banks.x.fits(0) || banks.y.fits(0));
    EXPECT_TRUE(banks.x.fits(1) && banks.y.fits(1));
    const Resizer resizer(grid, grid, 1, {.reconstruction = taps});
    resizer.run({View<const float>(values.view()), 0, {}}, {expected.view(), 0, {}, {}});
    resizer.run({const_view(view_of(sources[0])), 0, {}}, {found.view(), 0, {}, {}});
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            ASSERT_NEAR(found.view()(x, y), 255 * std::clamp(expected.view()(x, y), 0.0f, 1.0f), x && y ? 0.7 : 0.5001)
                << x << ' ' << y;
    expect_parts_are_those_of_the_whole(sources, grid, grid, {.reconstruction = taps}, 17, "taps");
}

TEST(Resizer, OnesStayOnesOnEveryInstructionSet) {
    const auto is_one = [](const Image<float>& image) {
        const float* const begin = image.view().data;
        return std::all_of(begin, begin + image.width() * image.height() * image.channels(),
                           [](float x) { return x == 1; });
    };
    const auto ones = [](int width, int height, int channels) {
        Image<float> image(width, height, channels, Layout::interleaved);
        std::fill_n(image.view().data, width * height * channels, 1.0f);
        return image;
    };
    const Image<float> small = ones(31, 37, 3), wide = ones(4000, 5, 1), high = ones(3, 4000, 4);
    for_each_target([&](Target target) {
        for (const Kernel& kernel : all_kernels())
            for (const Edge edge : {Edge::clamp, Edge::renormalize}) {
                const ResizeOptions options{.reconstruction = kernel, .edge = edge};
                const std::string what = message(name_of(target), ' ', kernel.name, ' ', name_of(edge));
                for (const auto& [width, height] : {std::pair{12, 80}, {50, 60}, {31, 37}})
                    EXPECT_TRUE(is_one(resample(small.view(), width, height, options))) << what << ' ' << width;
                // Discs of a million samples take too long; and both edges take the same way.
                if (is_radial(kernel) || edge == Edge::clamp) continue;
                EXPECT_TRUE(is_one(resample(wide.view(), 9, 4, options))) << what;
                EXPECT_TRUE(is_one(resample(high.view(), 2, 9, options))) << what;
            }
    });
}

TEST(ResizeSrgb, IsTheResizerOnPaddedRows) {
    Random random(8);
    for (const int channels : {1, 2, 3, 4}) {
        const int stride = 9 * channels + 5, new_stride = 4 * channels + 3;
        std::vector<std::uint8_t> from(static_cast<std::size_t>(stride * 7)),
            to(static_cast<std::size_t>(new_stride * 3));
        for (std::uint8_t& code : from) code = static_cast<std::uint8_t>(random.integer(0, 255));
        const auto src = interleaved(std::as_const(from).data(), 9, 7, channels, stride);
        const auto dst = interleaved(to.data(), 4, 3, channels, new_stride);
        resize_srgb(src, dst);
        Image<std::uint8_t> expected(4, 3, channels);
        const Encoding encoding{Transfer::srgb, channels % 2 == 0 ? channels - 1 : -1, false};
        Resizer({{9}, {7}}, {{4}, {3}}, channels).run({src, 0, encoding}, {expected.view(), 0, encoding, {}});
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 4; ++x)
                for (int c = 0; c < channels; ++c) ASSERT_EQ(dst(x, y, c), expected.view()(x, y, c));
        EXPECT_EQ(to[static_cast<std::size_t>(4 * channels)], 0) << "what pads rows is left alone";
    }
    std::vector<std::uint8_t> five(5);
    EXPECT_THROW(resize_srgb(interleaved(std::as_const(five).data(), 1, 1, 5), interleaved(five.data(), 1, 1, 5)),
                 Error);
}

}  // namespace
}  // namespace bandlimit
