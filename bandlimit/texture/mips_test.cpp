#include "bandlimit/texture/mips.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/texture/pictures_test.h"

namespace bandlimit {
namespace {

const MipSource sources[] = {MipSource::base, MipSource::previous};

std::vector<MipFilter> all_filters() { return {Auto{}, box(), lanczos(3), mitchell(), jinc_lanczos(2), downsample8()}; }

/// Fetches make one level of each, from the one above.
bool suits(const MipFilter& filter, MipSource from) {
    return from == MipSource::previous || !std::holds_alternative<Fetches>(filter);
}

void expect_constant(const MipChain& chain, const std::array<double, 4>& codes, int channels) {
    for (const AnyImage& image : chain.images)
        for (int y = 0; y < height_of(image); ++y)
            for (int x = 0; x < width_of(image); ++x)
                for (int c = 0; c < channels; ++c)
                    ASSERT_EQ(sample(image, x, y, c), codes[std::size_t(c)])
                        << width_of(image) << " x " << height_of(image) << " channel " << c;
}

TEST(MakeMips, HaveTheSizesOfTheChain) {
    const Image<std::uint8_t> base = noise_codes(903, 451, 1);
    const MipChain chain = make_mips(base.view(), plain, r8, {.role = Role::data});
    ASSERT_EQ(chain.images.size(), 10u);
    EXPECT_EQ(width_of(chain.images[1]), 451);
    EXPECT_EQ(height_of(chain.images[1]), 225);
    for (int level = 0; level < 10; ++level) {
        EXPECT_EQ(width_of(chain.images[std::size_t(level)]), mip_length(903, level));
        EXPECT_EQ(height_of(chain.images[std::size_t(level)]), mip_length(451, level));
    }
    EXPECT_EQ(make_mips(base.view(), plain, r8, {.role = Role::data, .levels = 3}).images.size(), 3u);
}

// Weights sum to one for every size, and means of equal values are that value, whatever is averaged.
TEST(MakeMips, KeepConstants) {
    const std::array<double, 4> codes{200, 31, 7, 250}, normal{89, 179, 238, 17};
    for (const Role role : all_roles()) {
        const auto& want = role == Role::normal ? normal : codes;  // a unit vector, to rounding
        const bool is_light = role == Role::color || role == Role::alpha_tested;
        const TexelFormat target = is_light ? rgba8_srgb : rgba8;
        for (int h = 1; h <= 17; ++h)
            for (int w = 1; w <= 17; w += h == 1 ? 1 : 8) {
                const auto base = picture<std::uint8_t>(w, h, 4, [&](int, int, int c) { return want[std::size_t(c)]; });
                for (const MipFilter& filter : all_filters())
                    for (const MipSource from : sources) {
                        // The tables of radial kernels take a while.
                        const bool is_radial =
                            std::get_if<Kernel>(&filter) && bandlimit::is_radial(std::get<Kernel>(filter));
                        if (!suits(filter, from) || (is_radial && h % 8 != 1)) continue;
                        expect_constant(make_mips(base.view(), is_light ? srgb_alpha : linear_alpha, target,
                                                  {.role = role, .filter = filter, .from = from}, {1}),
                                        want, 4);
                        if (testing::Test::HasFatalFailure()) FAIL() << name_of(role) << ' ' << w << " x " << h;
                    }
            }
    }
}

TEST(MakeMips, AverageLightAndNotCodes) {
    const auto board =
        picture<std::uint8_t>(8, 8, 4, [](int x, int y, int c) { return c == 3 || (x + y) % 2 ? 255 : 0; });
    for (const auto& [role, stored, target, code] :
         {std::tuple{Role::color, srgb_alpha, rgba8_srgb, 188}, {Role::color_linear, linear_alpha, rgba8, 128}}) {
        const MipChain chain = make_mips(board.view(), stored, target, {.role = role, .filter = box()});
        for (std::size_t level = 1; level < chain.images.size(); ++level)
            EXPECT_EQ(sample(chain.images[level], 0, 0), code) << name_of(role);
    }
}

TEST(MakeMips, KeepTheMeanByTheBox) {
    const Image<std::uint8_t> codes = noise_codes(64, 32, 1);
    const auto base = picture<float>(64, 32, 1, [&](int x, int y, int) { return codes.view()(x, y) / 255.0f; });
    const auto mean = [](const AnyImage& image) {
        double sum = 0;
        for (int y = 0; y < height_of(image); ++y)
            for (int x = 0; x < width_of(image); ++x) sum += sample(image, x, y);
        return sum / (width_of(image) * height_of(image));
    };
    for (const MipSource from : sources) {
        const MipChain chain =
            make_mips(base.view(), plain, r32f, {.role = Role::height, .filter = box(), .from = from});
        // Halves of floats: a rounding of 2^-24 per sum, of at most 64 * 32 samples in pairs.
        for (const AnyImage& image : chain.images) EXPECT_NEAR(mean(image), mean(chain.images[0]), 11 * 0x1p-24);
    }
}

TEST(MakeMips, FromBaseAreResizesOfTheBase) {
    const Image<std::uint8_t> base = noise_codes(45, 30, 4);
    const MipChain chain =
        make_mips(base.view(), srgb_alpha, rgba8_srgb, {.filter = lanczos(3), .from = MipSource::base});
    for (std::size_t level = 1; level < chain.images.size(); ++level) {
        const int w = width_of(chain.images[level]), h = height_of(chain.images[level]);
        AnyImage expected = make_image(Depth::u8, w, h, 4);
        Resizer({{45}, {30}}, {{w}, {h}}, 4, {.reconstruction = lanczos(3)})
            .run({base.view(), 0, srgb_alpha}, {view_of(expected), 0, srgb_alpha, {}});
        EXPECT_EQ(difference(chain.images[level], expected), 0) << level;
    }
}

// A box of boxes is the box of all where borders meet; what lies between levels is not rounded.
TEST(MakeMips, FromPreviousAreThoseFromBaseByTheBox) {
    for (const Role role : {Role::color, Role::data, Role::normal, Role::roughness}) {
        const Image<std::uint8_t> base = noise_codes(64, 16, 4, 3);
        const TexelFormat target = role == Role::color ? rgba8_srgb : rgba8;
        const Encoding stored = role == Role::color ? srgb_alpha : plain;
        MipOptions options{.role = role, .filter = box(), .from = MipSource::previous};
        const MipChain previous = make_mips(base.view(), stored, target, options);
        options.from = MipSource::base;
        const MipChain direct = make_mips(base.view(), stored, target, options);
        for (std::size_t level = 0; level < direct.images.size(); ++level)
            EXPECT_LE(difference(previous.images[level], direct.images[level]), 1) << name_of(role) << level;
    }
}

TEST(MakeMips, HaveTheSameBitsForEveryNumberOfThreads) {
    const Image<std::uint8_t> base = noise_codes(70, 301, 4);
    for (const Role role : all_roles())
        for (const MipFilter& filter : {MipFilter(Auto{}), MipFilter(downsample8())}) {
            const bool is_srgb = role == Role::color || role == Role::alpha_tested;
            const MipOptions options{.role = role, .filter = filter};
            const auto run = [&](int threads) {
                return make_mips(base.view(), is_srgb ? srgb_alpha : linear_alpha, is_srgb ? rgba8_srgb : rgba8,
                                 options, {threads});
            };
            const MipChain one = run(1);
            for (const int threads : {2, 3}) {
                const MipChain several = run(threads);
                for (std::size_t level = 0; level < one.images.size(); ++level)
                    ASSERT_EQ(difference(one.images[level], several.images[level]), 0) << name_of(role);
            }
        }
}

// Whatever colour hides where alpha is 0 must leave no trace in any level.
TEST(MakeMips, DoNotMixInWhatIsTransparent) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Image<std::uint8_t> noise = noise_codes(37, 22, 4, 5);
    const auto floats = [&](float poison) {
        return picture<float>(37, 22, 4, [&](int x, int y, int c) {
            const bool hidden = noise.view()(x, y, 3) < 100;
            if (c == 3) return hidden ? 0.0f : noise.view()(x, y, 3) / 255.0f;
            return hidden ? poison : noise.view()(x, y, c) / 255.0f;
        });
    };
    for (const Role role : {Role::color, Role::color_linear, Role::alpha_tested})
        for (const MipFilter& filter : all_filters()) {
            const auto chain = [&](float poison) {
                const Image<float> base = floats(poison);
                return make_mips(base.view(), linear_alpha, rgba32f, {.role = role, .filter = filter});
            };
            const MipChain clean = chain(0), magenta = chain(1e6f), poisoned = chain(nan);
            EXPECT_FALSE(poisoned.lost_non_finite);
            for (std::size_t level = 1; level < clean.images.size(); ++level) {
                ASSERT_EQ(difference(clean.images[level], magenta.images[level]), 0) << name_of(role) << level;
                ASSERT_EQ(difference(clean.images[level], poisoned.images[level]), 0) << name_of(role) << level;
            }
        }
}

TEST(MakeMips, ReportWhatIsNotFinite) {
    auto base = picture<float>(9, 9, 4, [](int, int, int) { return 0.5f; });
    base.view()(4, 4, 1) = std::numeric_limits<float>::quiet_NaN();
    base.view()(2, 7, 0) = std::numeric_limits<float>::infinity();
    for (const Role role : all_roles())
        for (const MipFilter& filter : all_filters())
            EXPECT_TRUE(make_mips(base.view(), linear_alpha, rgba8, {.role = role, .filter = filter}).lost_non_finite)
                << name_of(role);
}

TEST(MakeMips, GrowToTheTarget) {
    const auto codes = [](int width, int channels) {
        return picture<std::uint8_t>(width, 1, channels, [](int, int, int c) { return 50 * (c + 1); });
    };
    struct Row {
        Role role;
        int channels, alpha, target;
        std::array<double, 4> expected;
    };
    for (const Row& row :
         {Row{Role::color, 1, -1, 4, {50, 50, 50, 255}}, Row{Role::color, 2, 1, 4, {50, 50, 50, 100}},
          Row{Role::color, 3, -1, 4, {50, 100, 150, 255}}, Row{Role::data, 2, -1, 4, {50, 100, 0, 255}},
          Row{Role::mask, 1, -1, 2, {50, 50, 0, 0}}, Row{Role::data, 4, -1, 4, {50, 100, 150, 200}},
          Row{Role::roughness, 3, -1, 4, {50, 100, 150, 255}}}) {
        const Image<std::uint8_t> base = codes(6, row.channels);
        const TexelFormat target{row.target, Depth::u8, row.role == Role::color, false};
        const Encoding stored{row.role == Role::color ? Transfer::srgb : Transfer::linear, row.alpha, false};
        expect_constant(make_mips(base.view(), stored, target, {.role = row.role}), row.expected, row.target);
    }
}

TEST(MakeMips, StorePremultipliedColour) {
    const Image<std::uint8_t> base = noise_codes(16, 16, 4, 8);
    TexelFormat target = rgba32f;
    const MipChain straight = make_mips(base.view(), srgb_alpha, target, {});
    target.premultiplied = true;
    const MipChain multiplied = make_mips(base.view(), srgb_alpha, target, {});
    for (std::size_t level = 0; level < straight.images.size(); ++level)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sample(multiplied.images[level], 0, 0, c),
                        sample(straight.images[level], 0, 0, c) * sample(straight.images[level], 0, 0, 3), 1e-6);
}

TEST(MakeMips, KeepMasksBetweenZeroAndOne) {
    const auto base = picture<float>(32, 32, 1, [](int x, int y, int) { return x > y; });
    const auto range = [&](Role role) {
        const MipChain chain = make_mips(base.view(), plain, r32f, {.role = role, .filter = lanczos(3)});
        double low = 1, high = 0;
        for (const AnyImage& image : chain.images)
            for (int i = 0; i < width_of(image) * height_of(image); ++i) {
                low = std::min(low, sample(image, i % width_of(image), i / width_of(image)));
                high = std::max(high, sample(image, i % width_of(image), i / width_of(image)));
            }
        return std::pair{low, high};
    };
    EXPECT_EQ(range(Role::mask), (std::pair{0.0, 1.0}));
    EXPECT_LT(range(Role::height).first, 0);  // a height may overshoot: the kernel has negative weights
}

// A texture that tiles must tile at every level: four of it side by side give four of its levels.
TEST(MakeMips, WrapWithoutSeams) {
    const Image<std::uint8_t> tile = noise_codes(32, 16, 4, 11);
    const auto four =
        picture<std::uint8_t>(64, 32, 4, [&](int x, int y, int c) { return tile.view()(x % 32, y % 16, c); });
    for (const MipFilter& filter : all_filters())
        for (const MipSource from : sources) {
            if (!suits(filter, from)) continue;
            const MipOptions options{
                .filter = filter, .from = from, .edge_x = Edge::wrap, .edge_y = Edge::wrap, .levels = 5};
            const MipChain one = make_mips(tile.view(), srgb_alpha, rgba8_srgb, options);
            const MipChain all = make_mips(four.view(), srgb_alpha, rgba8_srgb, options);
            for (std::size_t level = 0; level < one.images.size(); ++level) {
                const AnyImage &a = one.images[level], &b = all.images[level];
                for (int y = 0; y < height_of(b); ++y)
                    for (int x = 0; x < width_of(b); ++x)
                        for (int c = 0; c < 4; ++c)
                            ASSERT_EQ(sample(b, x, y, c), sample(a, x % width_of(a), y % height_of(a), c)) << level;
            }
        }
}

// One axis wraps and the other does not: a picture that is periodic along x and a ramp along y.
TEST(MakeMips, HaveAnEdgePerAxis) {
    const auto base =
        picture<float>(16, 16, 1, [](int x, int y, int) { return y + std::sin(x * 0.39269908169872414); });
    for (const MipFilter& filter : all_filters()) {
        const auto level = [&](Edge x, Edge y) {
            return std::move(make_mips(base.view(), plain, r32f,
                                       {.role = Role::height, .filter = filter, .edge_x = x, .edge_y = y, .levels = 2})
                                 .images[1]);
        };
        const AnyImage both = level(Edge::wrap, Edge::clamp), wrapped = level(Edge::wrap, Edge::wrap),
                       clamped = level(Edge::clamp, Edge::clamp);
        // In the middle of an axis its edge does not matter.
        for (int i = 0; i < 8; ++i) {
            EXPECT_NEAR(sample(both, i, 4), sample(wrapped, i, 4), 1e-5);
            EXPECT_NEAR(sample(both, 4, i), sample(clamped, 4, i), 1e-5);
        }
        // The sine goes on across the border: neighbours there differ as they do inside, by the same step of phase.
        const double across = sample(both, 0, 4) - sample(both, 7, 4), inside = sample(both, 4, 4) - sample(both, 3, 4);
        EXPECT_NEAR(across, -inside, 1e-4);
    }
}

TEST(MakeMips, RefuseWhatDoesNotFit) {
    const Image<std::uint8_t> base = noise_codes(12, 12, 4), grey = noise_codes(12, 12, 1);
    const Taps halving{-1, {0.125, 0.375, 0.375, 0.125}, 2};
    const auto refuses = [](const Image<std::uint8_t>& image, const Encoding& stored, const TexelFormat& target,
                            const MipOptions& options) {
        EXPECT_THROW(make_mips(image.view(), stored, target, options), Error);
    };
    refuses(base, srgb_alpha, rgba8_srgb, {.filter = halving});  // 12 to 6 to 3 to 1
    refuses(base, srgb_alpha, rgba8_srgb, {.filter = Taps{0, {1}, 3}});
    refuses(base, srgb_alpha, rgba8_srgb, {.filter = downsample8(), .from = MipSource::base});
    refuses(base, srgb_alpha, rgba8_srgb, {.filter = Fetches{}});
    refuses(base, srgb_alpha, rgba8_srgb, {.levels = 5});
    refuses(base, srgb_alpha, rgba8_srgb, {.levels = -1});
    refuses(base, srgb_alpha, rgba8_srgb, {.role = Role::alpha_tested, .alpha_threshold = 0});
    refuses(base, srgb_alpha, rgba8_srgb, {.role = Role::alpha_tested, .alpha_threshold = NAN});
    refuses(base, srgb_alpha, rgba8_srgb, {.role = Role::normal});
    refuses(base, srgb_alpha, {4, Depth::u16, true, false}, {});
    refuses(base, srgb_alpha, {3, Depth::u8, true, false}, {});
    refuses(base, srgb_alpha, r8, {.role = Role::data});
    refuses(base, {Transfer::srgb, 0, false}, rgba8_srgb, {});
    refuses(grey, plain, r8, {.role = Role::normal});
    refuses(grey, plain, r8, {.role = Role::alpha_tested});
    refuses(grey, plain, r8, {.role = Role::data, .normals = base.view()});
    refuses(Image<std::uint8_t>(0, 4), plain, r8, {});
    EXPECT_NO_THROW(make_mips(base.view(), srgb_alpha, rgba8_srgb, {.filter = halving, .levels = 3}));
}

TEST(MakeMips, TakeTapsThatHalve) {
    const Taps halving{-1, {0.125, 0.375, 0.375, 0.125}, 2};
    for (const auto& [w, h] : {std::pair{32, 8}, {1, 16}, {64, 1}}) {
        const Image<std::uint8_t> base = noise_codes(w, h, 4);
        const MipChain chain = make_mips(base.view(), plain, rgba8, {.role = Role::data, .filter = halving});
        EXPECT_EQ(width_of(chain.images.back()), 1);
        AnyImage expected = make_image(Depth::u8, std::max(1, w / 2), std::max(1, h / 2), 4);
        const Axis x{w, 0, double(w)}, y{h, 0, double(h)};
        if (w == 1 || h == 1) continue;
        Resizer({x, y}, {{w / 2, 0, double(w)}, {h / 2, 0, double(h)}}, 4, {.reconstruction = halving})
            .run({base.view(), 0, plain}, {view_of(expected), 0, plain, {}});
        EXPECT_LE(difference(chain.images[1], expected), 1);
    }
}

}  // namespace
}  // namespace bandlimit
