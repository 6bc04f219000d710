#include "bandlimit/resample/row_filter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {
namespace {

/// The row above in one picture plus the row itself of another: what a filter over frames does.
RowFilter sum_of_two(int width, int height) {
    RowProtocol p;
    p.name = "sum_of_two";
    p.sources = {{width, height, Edge::clamp}, {width, height, Edge::zero}};
    p.width = width, p.height = height;
    p.rows_read = [](std::size_t source, int first, int last) {
        return source == 0 ? IndexRange{first - 1, last - 1} : IndexRange{first, last};
    };
    p.bytes = [](int, const Parallel&) { return 0.0; };
    p.start = [height](const RowRun& run) {
        const RowParts parts(run.rows(), 2, 100);
        return RowWork{parts.count(), [height, &run, parts](int piece) {
                           const auto row = [&](int source, int y) {
                               const SourceRows& s = run.sources[static_cast<std::size_t>(source)];
                               return &std::get<View<const float>>(s.samples)(0, y - s.first_row);
                           };
                           const View<float> to = std::get<View<float>>(run.target.samples);
                           for (int y = parts[piece].begin; y < parts[piece].end; ++y)
                               for (int x = 0; x < to.width; ++x)
                                   to(x, y - run.target.first_row) =
                                       row(0, resolve(y - 1, height, Edge::clamp))[x] + row(1, y)[x];
                           run.monitor.made(std::int64_t{parts[piece].count()} * to.width);
                           return false;
                       }};
    };
    return RowFilter(std::move(p));
}

Image<float> ramp(int width, int height, float step) {
    Image<float> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.view()(x, y) = step * static_cast<float>(y * width + x);
    return image;
}

TEST(RowFilter, RunsOverSeveralSources) {
    const Image<float> a = ramp(5, 9, 1), b = ramp(5, 9, 0.5f);
    const RowFilter filter = sum_of_two(5, 9);
    for (const int threads : {1, 2, 5}) {
        Image<float> out(5, 9);
        const std::vector<SourceRows> sources{{a.view(), 0, {}}, {b.view(), 0, {}}};
        filter.run(sources, {out.view(), 0, {}, {}}, {threads});
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 5; ++x) ASSERT_EQ(out.view()(x, y), a.view()(x, std::max(0, y - 1)) + b.view()(x, y));
    }
}

TEST(RowFilter, AsksEachSourceForTheRowsOfItsOwn) {
    const RowFilter filter = sum_of_two(5, 9);
    EXPECT_EQ(filter.rows_needed(4, 6, 0).begin, 3);
    EXPECT_EQ(filter.rows_needed(0, 2, 0).begin, 0) << "what lies outside leads back in";
    EXPECT_EQ(filter.rows_needed(4, 6, 1).begin, 4);
    EXPECT_THROW(filter.rows_needed(4, 6, 2), Error);
    EXPECT_THROW(filter.rows_needed(4, 10), Error);
    const Image<float> a = ramp(5, 9, 1);
    Image<float> out(5, 2);
    const auto run = [&](int first_a, int first_b) {
        const std::vector<SourceRows> sources{{cropped(a.view(), 0, first_a, 5, 3), first_a, {}},
                                              {cropped(a.view(), 0, first_b, 5, 3), first_b, {}}};
        filter.run(sources, {out.view(), 4, {}, {}});
    };
    EXPECT_NO_THROW(run(3, 4));
    EXPECT_THROW(run(4, 4), Error) << "row 3 of the first is missing";
    EXPECT_THROW(run(3, 2), Error) << "row 5 of the second is missing";
    EXPECT_THROW(filter.run(SourceRows{a.view(), 0, {}}, {out.view(), 4, {}, {}}), Error) << "one source of two";
}

TEST(RowParts, CoverTheRowsOnce) {
    for (int rows = 1; rows < 40; ++rows)
        for (const int least : {1, 3, 64})
            for (const int most : {1, 2, 7}) {
                const RowParts parts({5, 5 + rows}, least, most);
                ASSERT_LE(parts.count(), most);
                int at = 5;
                for (int i = 0; i < parts.count(); ++i) {
                    ASSERT_EQ(parts[i].begin, at);
                    ASSERT_TRUE(parts[i].count() >= least || i + 1 == parts.count());
                    at = parts[i].end;
                }
                ASSERT_EQ(at, 5 + rows);
            }
}

/// One filter of every kind, from 64 x 400 samples.
std::vector<RowFilter> some_filters() {
    const Grid src{{64}, {400}};
    const Terms box{{{0.5, 0.5}, {0.25, 0.5, 0.25}}};
    return {Resizer(src, {{32}, {200}}, 1).rows(), Resizer(src, {{90}, {800}}, 1).rows(),
            Resizer(src, {{32}, {200}}, 1, {.reconstruction = jinc_lanczos(3)}).rows(),
            term_filter(box, -1, -1, {64, 400})};
}

TEST(RowFilter, ReportsProgressThatGrowsToOne) {
    const Image<float> image = ramp(64, 400, 0.001f);
    for (const RowFilter& filter : some_filters())
        for (const int threads : {1, 3}) {
            Image<float> out(filter.protocol().width, filter.protocol().height);
            double last = 0;
            int calls = 0;
            filter.run(SourceRows{image.view(), 0, {}}, {out.view(), 0, {}, {}}, {threads}, [&](double done) {
                EXPECT_GT(done, last);
                last = done;
                ++calls;
            });
            EXPECT_EQ(last, 1);
            EXPECT_GT(calls, 3);
        }
}

TEST(RowFilter, StopsInTheMiddle) {
    const Image<float> image = ramp(64, 400, 0.001f);
    for (const RowFilter& filter : some_filters())
        for (const int threads : {1, 3}) {
            Image<float> out(filter.protocol().width, filter.protocol().height);
            std::stop_source user;
            double last = 0;
            EXPECT_THROW(filter.run(SourceRows{image.view(), 0, {}}, {out.view(), 0, {}, {}},
                                    {.threads = threads, .stop = user.get_token()},
                                    [&](double done) {
                                        last = done;
                                        if (done > 0.3) user.request_stop();
                                    }),
                         Stopped);
            EXPECT_LT(last, 0.9);
        }
}

TEST(RowFilter, RunsCodesOfBytesWithProgressToo) {
    Image<std::uint8_t> codes(64, 400, 4, Layout::interleaved), out(32, 200, 4, Layout::interleaved);
    double last = 0;
    Resizer({{64}, {400}}, {{32}, {200}}, 4)
        .run({View<const std::uint8_t>(codes.view()), 0, {}}, {out.view(), 0, {}, {}}, {2},
             [&](double done) { last = done; });
    EXPECT_EQ(last, 1);
}

TEST(RowFilter, RefusesShapesThatDoNotFit) {
    const RowFilter filter = Resizer({{6}, {8}}, {{3}, {4}}, 4).rows();
    struct Case {
        int from_width = 6, from_channels = 4, to_width = 3, to_channels = 4;
        std::size_t background = 0;
        int alpha = 3;
    };
    const auto run = [&](const Case& c) {
        const Image<float> from(c.from_width, 8, c.from_channels);
        Image<float> to(c.to_width, 4, c.to_channels);
        const Encoding encoding{Transfer::linear, c.alpha, false};
        filter.run(SourceRows{from.view(), 0, encoding}, {to.view(),
                                                          0,
                                                          {Transfer::linear, c.to_channels == 4 ? c.alpha : -1, false},
                                                          std::vector<float>(c.background, 0.5f)});
    };
    EXPECT_NO_THROW(run({}));
    EXPECT_NO_THROW(run({.to_channels = 3, .background = 3}));
    EXPECT_THROW(run({.from_width = 5}), Error);
    EXPECT_THROW(run({.from_width = 7}), Error);
    EXPECT_THROW(run({.to_width = 4}), Error);
    EXPECT_THROW(run({.from_channels = 3, .alpha = -1}), Error);
    EXPECT_THROW(run({.to_channels = 3}), Error) << "a channel is missing";
    EXPECT_THROW(run({.background = 4}), Error) << "what lies over a colour has no alpha";
    EXPECT_THROW(run({.to_channels = 3, .background = 2}), Error);
    EXPECT_THROW(run({.to_channels = 3, .background = 4}), Error);
    EXPECT_THROW(run({.to_channels = 3, .background = 3, .alpha = -1}), Error);
}

// Of floats as they are, no code lies between filter and target: alpha must be treated all the same.
TEST(RowFilter, StoresFloatsWithAlphaAsTheTargetHasIt) {
    Image<float> image(64, 400, 4, Layout::interleaved);
    for (int y = 0; y < 400; ++y)
        for (int x = 0; x < 64; ++x) {
            float* const texel = &image.view()(x, y);
            for (int c = 0; c < 4; ++c) texel[c] = static_cast<float>((x * 7 + y * 3 + c * 11) % 17 + 1) / 18;
        }
    const Terms box{{{0.5, 0.5}, {0.25, 0.5, 0.25}}};
    const std::vector<float> background{0.25f, 0.5f, 1};
    for (const RowFilter& filter :
         {Resizer({{64}, {400}}, {{32}, {200}}, 4).rows(),
          Resizer({{64}, {400}}, {{32}, {200}}, 4, {.reconstruction = jinc_lanczos(3)}).rows(),
          term_filter(box, -1, -1, {64, 400})}) {
        const int width = filter.protocol().width, height = filter.protocol().height;
        const auto run = [&](int channels, const Encoding& encoding, const std::vector<float>& over) {
            Image<float> out(width, height, channels, Layout::interleaved);
            filter.run(SourceRows{image.view(), 0, {Transfer::linear, 3, false}}, {out.view(), 0, encoding, over});
            return out;
        };
        const Image<float> straight = run(4, {Transfer::linear, 3, false}, {});
        const Image<float> multiplied = run(4, {Transfer::linear, 3, true}, {});
        const Image<float> flat = run(3, {}, background);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c) {  // a few roundings of floats up to 1
                    const float alpha = straight.view()(x, y, 3), colour = multiplied.view()(x, y, c);
                    ASSERT_NEAR(colour, straight.view()(x, y, c) * alpha, 1e-6);
                    ASSERT_NEAR(flat.view()(x, y, c), colour + (1 - alpha) * background[std::size_t(c)], 1e-6);
                }
    }
}

}  // namespace
}  // namespace bandlimit
