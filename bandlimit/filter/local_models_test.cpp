#include "bandlimit/filter/local_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/targets_test.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr float hole = std::numeric_limits<float>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr WindowShape shapes[] = {WindowShape::box, WindowShape::gaussian};

template <class F>
Image<float> picture(int width, int height, int channels, F f, Layout layout = Layout::planar) {
    Image<float> image(width, height, channels, layout);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.view()(x, y, c) = static_cast<float>(f(x, y, c));
    return image;
}

Image<float> noise(int width, int height, int channels, double low = 0, double high = 1, std::uint64_t seed = 1) {
    Random random(seed);
    return picture(width, height, channels, [&](int, int, int) { return random.uniform(low, high); });
}

// ---- The definition: every window by itself, in doubles, about its own means

/// The weight of the sample (u, v) away.
double weight_of(const LocalModelOptions& o, int u, int v) {
    if (o.window == WindowShape::box) return std::abs(u) <= o.radius && std::abs(v) <= o.radius ? 1 : 0;
    const double sigma = gaussian_sigma(o.radius);
    if (std::max(std::abs(u), std::abs(v)) > std::ceil(4 * sigma)) return 0;
    return u == 0 && v == 0 ? 1 : std::exp(-(u * u + v * v) / (2 * sigma * sigma));
}

struct Sample {
    double weight;
    std::vector<double> guide, signal;
};

std::vector<Sample> window_at(View<const float> signal, View<const float> guide, const LocalModelOptions& o, int x,
                              int y) {
    const int reach =
        o.window == WindowShape::box ? o.radius : static_cast<int>(std::ceil(4 * gaussian_sigma(o.radius)));
    std::vector<Sample> samples;
    for (int v = -reach; v <= reach; ++v)
        for (int u = -reach; u <= reach; ++u) {
            const int from_x = resolve(x + u, signal.width, o.edge), from_y = resolve(y + v, signal.height, o.edge);
            const bool is_outside = from_x < 0 || from_y < 0;
            if (is_outside && o.edge == Edge::renormalize) continue;
            Sample sample{weight_of(o, u, v), {}, {}};
            bool is_finite = true;
            const auto read = [&](View<const float> image, std::vector<double>& to) {
                for (int c = 0; c < image.channels; ++c) {
                    to.push_back(is_outside ? 0 : static_cast<double>(image(from_x, from_y, c)));
                    is_finite = is_finite && std::isfinite(to.back());
                }
            };
            read(guide, sample.guide), read(signal, sample.signal);
            if (is_finite) samples.push_back(sample);
        }
    return samples;
}

/// Gaussian elimination with pivots on the diagonal; what has none is 0.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
    const std::size_t n = b.size();
    std::vector<bool> is_done(n, false);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, a[i][i]);
    for (std::size_t step = 0; step < n; ++step) {
        std::size_t k = n;
        for (std::size_t i = 0; i < n; ++i)
            if (!is_done[i] && a[i][i] > 1e-13 * largest && (k == n || a[i][i] > a[k][k])) k = i;
        if (k == n) break;
        is_done[k] = true;
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k) continue;
            const double f = a[i][k] / a[k][k];
            for (std::size_t j = 0; j < n; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (std::size_t i = 0; i < n; ++i) b[i] = is_done[i] ? b[i] / a[i][i] : 0;
    return b;
}

/// What the model about (x, y) gives for signal s.
double expected(View<const float> signal, View<const float> guide, const LocalModelOptions& o, int x, int y, int s) {
    const std::vector<Sample> samples = window_at(signal, guide, o, x, y);
    const auto n = static_cast<std::size_t>(guide.channels);
    double weight = 0, mean = 0;
    std::vector<double> centre(n);
    for (const Sample& sample : samples) {
        weight += sample.weight;
        mean += sample.weight * sample.signal[static_cast<std::size_t>(s)];
        for (std::size_t k = 0; k < n; ++k) centre[k] += sample.weight * sample.guide[k];
    }
    mean /= weight;
    for (double& c : centre) c /= weight;
    const auto terms_of = [&](const std::vector<double>& g) {
        std::vector<double> terms;
        for (std::size_t k = 0; k < n; ++k) terms.push_back(g[k] - centre[k]);
        for (std::size_t k = 0; o.order == 2 && k < n; ++k)
            for (std::size_t l = k; l < n; ++l) terms.push_back(terms[k] * terms[l]);
        return terms;
    };
    const std::size_t count = terms_of(centre).size();
    std::vector<double> means(count), b(count);
    for (const Sample& sample : samples) {
        const std::vector<double> terms = terms_of(sample.guide);
        for (std::size_t i = 0; i < count; ++i) means[i] += sample.weight / weight * terms[i];
    }
    std::vector<std::vector<double>> a(count, std::vector<double>(count));
    for (const Sample& sample : samples) {
        const std::vector<double> terms = terms_of(sample.guide);
        for (std::size_t i = 0; i < count; ++i) {
            const double w = sample.weight / weight * (terms[i] - means[i]);
            b[i] += w * (sample.signal[static_cast<std::size_t>(s)] - mean);
            for (std::size_t j = 0; j < count; ++j) a[i][j] += w * (terms[j] - means[j]);
        }
    }
    const double e = o.epsilon;
    std::size_t pair = n;
    for (std::size_t k = 0; o.order == 2 && k < n; ++k)
        for (std::size_t l = k; l < n; ++l, ++pair)
            a[pair][pair] += (k == l ? 2 : 1) * ((a[k][k] + a[l][l]) * e + e * e);
    for (std::size_t k = 0; k < n; ++k) a[k][k] += e;
    const std::vector<double> coefficients = solved(a, b);
    std::vector<double> here;
    for (int k = 0; k < guide.channels; ++k) here.push_back(static_cast<double>(guide(x, y, k)));
    const std::vector<double> terms = terms_of(here);
    for (std::size_t i = 0; i < count; ++i) mean += coefficients[i] * (terms[i] - means[i]);
    return mean;
}

/// The largest difference from the definition.
double error_of(const Image<float>& found, const Image<float>& signal, const Image<float>& guide,
                const LocalModelOptions& o) {
    double most = 0;
    for (int s = 0; s < signal.channels(); ++s)
        for (int y = 0; y < signal.height(); ++y)
            for (int x = 0; x < signal.width(); ++x) {
                const double difference =
                    static_cast<double>(found.view()(x, y, s)) - expected(signal.view(), guide.view(), o, x, y, s);
                most = std::isnan(difference) ? infinity : std::max(most, std::abs(difference));
            }
    return most;
}

TEST(LocalModels, AreTheLeastSquaresOfTheirWindows) {
    for (const WindowShape window : shapes)
        for (const int order : {1, 2})
            for (const int guides : {1, 2, 3, 5}) {
                if (order == 2 && guides > 3) continue;
                const Image<float> guide = noise(10, 8, guides), signal = noise(10, 8, 2, 0, 1, 2);
                for (const Edge edge : all_edges()) {
                    const LocalModelOptions o{
                        .radius = 2, .epsilon = 0.01, .window = window, .order = order, .edge = edge};
                    const Image<float> found = guided_filter(signal.view(), guide.view(), o, {2});
                    // Sums of floats against sums of doubles.
                    const double allowed = window == WindowShape::box ? 2e-6 : 1e-4;
                    EXPECT_LT(error_of(found, signal, guide, o), allowed)
                        << name_of(window) << ' ' << order << ' ' << guides << ' ' << name_of(edge);
                    // The models as a value say the same.
                    const LocalModels models = fit_local_models(signal.view(), guide.view(), o, {2});
                    EXPECT_LT(error_of(apply_local_models(models, guide.view()), signal, guide, o), 2 * allowed);
                }
            }
}

TEST(LocalModels, FindARelationThatIsThere) {
    for (const WindowShape window : shapes)
        for (const double epsilon : {0.0, 1e-9}) {
            const Image<float> guide = noise(40, 30, 3);
            const auto g = guide.view();
            const Image<float> linear = picture(40, 30, 2, [&](int x, int y, int c) {
                return c == 0 ? 0.25 + 2.0 * g(x, y, 0) - g(x, y, 1) + 0.5 * g(x, y, 2) : 1 - 3.0 * g(x, y, 1);
            });
            const Image<float> square = picture(40, 30, 1, [&](int x, int y, int) {
                return 1 + 0.5 * g(x, y, 0) - 2.0 * g(x, y, 0) * g(x, y, 1) + double(g(x, y, 2)) * g(x, y, 2);
            });
            const double allowed = window == WindowShape::box ? 2e-6 : 2e-4;
            for (const bool averages : {false, true}) {
                const LocalModelOptions o{.radius = 4, .epsilon = epsilon, .window = window, .averages = averages};
                LocalModelOptions second = o;
                second.order = 2;
                const Image<float> a = guided_filter(linear.view(), g, o), b = guided_filter(square.view(), g, second);
                for (int y = 0; y < 30; ++y)
                    for (int x = 0; x < 40; ++x) {
                        EXPECT_NEAR(a.view()(x, y, 0), linear.view()(x, y, 0), allowed);
                        EXPECT_NEAR(a.view()(x, y, 1), linear.view()(x, y, 1), allowed);
                        EXPECT_NEAR(b.view()(x, y), square.view()(x, y), 20 * allowed);
                    }
            }
        }
}

TEST(LocalModels, WithoutRegularisationAPictureThatGuidesItselfStays) {
    const Image<float> image = noise(31, 22, 1);
    for (const WindowShape window : shapes)
        for (const int radius : {0, 1, 5}) {
            const LocalModelOptions o{.radius = radius, .epsilon = 0, .window = window};
            const Image<float> same = guided_filter(image.view(), image.view(), o);
            for (int y = 0; y < 22; ++y)
                for (int x = 0; x < 31; ++x) EXPECT_NEAR(same.view()(x, y), image.view()(x, y), 1e-6);
        }
}

TEST(LocalModels, WithInfiniteRegularisationOrAConstantGuideTheyAreMeansOfWindows) {
    const Image<float> signal = noise(26, 33, 1), guide = noise(26, 33, 3, 0, 1, 5);
    const Image<float> constant = picture(26, 33, 3, [](int, int, int c) { return 1000.25 + c; });
    const auto mean_at = [](View<const float> image, int x, int y) {
        double sum = 0, count = 0;
        for (int v = std::max(0, y - 2); v <= std::min(32, y + 2); ++v)
            for (int u = std::max(0, x - 2); u <= std::min(25, x + 2); ++u) sum += double(image(u, v)), ++count;
        return sum / count;
    };
    const Image<float> means = picture(26, 33, 1, [&](int x, int y, int) { return mean_at(signal.view(), x, y); });
    for (const int order : {1, 2})
        for (const int guides : {1, 3})
            for (const bool averages : {false, true})
                for (const double epsilon : {0.0, 1e-6, infinity}) {
                    const Image<float>& by = epsilon == infinity ? guide : constant;
                    const LocalModelOptions o{.radius = 2, .epsilon = epsilon, .order = order, .averages = averages};
                    const Image<float> found = guided_filter(signal.view(), channels_of(by.view(), 0, guides), o);
                    for (int y = 0; y < 33; ++y)
                        for (int x = 0; x < 26; ++x)
                            ASSERT_NEAR(found.view()(x, y),
                                        averages ? mean_at(means.view(), x, y) : double(means.view()(x, y)), 1e-6);
                }
}

TEST(LocalModels, TermsThatDoNotVaryOrRepeatOthersAreLeftOut) {
    // A channel that varies; one that is constant on the right, but not where its range says; one that is twice the first.
    const Image<float> random = noise(30, 20, 1), signal = noise(30, 20, 1, 0, 1, 2);
    const Image<float> guide = picture(30, 20, 5, [&](int x, int y, int c) {
        const double r = double(random.view()(x, y));
        return c == 0   ? r
               : c == 1 ? (x < 10 ? 0.1 * y : 0.7)
               : c == 2 ? 2 * r
               : c == 3 ? 0.3 - r / 4
                        : (x < 10 ? 0.0 : 1 / 3.0);
    });
    for (const WindowShape window : shapes)
        for (const int guides : {3, 5})  // by vectors, and by any number of terms
            for (const int order : {1, 2}) {
                const LocalModels models =
                    fit_local_models(signal.view(), channels_of(guide.view(), 0, guides),
                                     {.radius = 2, .epsilon = 0, .window = window, .order = order});
                for (int y = 0; y < 20; ++y)
                    for (int x = 20; x < 30; ++x) {
                        EXPECT_NE(models.coefficients.view()(x, y, 1), 0);
                        for (int k = 1; order == 1 && k < guides; ++k)
                            ASSERT_EQ(models.coefficients.view()(x, y, 1 + k), 0) << name_of(window) << ' ' << k;
                        for (int i = 0; i <= models.terms(); ++i)
                            ASSERT_LT(std::abs(models.coefficients.view()(x, y, i)), 1000) << order << ' ' << i;
                    }
            }
}

TEST(LocalModels, AveragesAreMeansOfTheModelsAbout) {
    const Image<float> guide = noise(21, 15, 2, 50, 51), signal = noise(21, 15, 1, 0, 1, 2);
    for (const WindowShape window : shapes)
        for (const int order : {1, 2})
            for (const Edge edge : all_edges()) {
                LocalModelOptions o{.radius = 2, .epsilon = 0.01, .window = window, .order = order, .edge = edge};
                const LocalModels own = fit_local_models(signal.view(), guide.view(), o);
                o.averages = true;
                const LocalModels means = fit_local_models(signal.view(), guide.view(), o);
                const int reach = window == WindowShape::box ? 2 : static_cast<int>(std::ceil(4 * gaussian_sigma(2)));
                const auto mean_at = [&](int x, int y, int c) {
                    double sum = 0, weight = 0;
                    for (int v = -reach; v <= reach; ++v)
                        for (int u = -reach; u <= reach; ++u) {
                            const int from_x = resolve(x + u, 21, edge), from_y = resolve(y + v, 15, edge);
                            const bool is_outside = from_x < 0 || from_y < 0;
                            if (is_outside && edge == Edge::renormalize) continue;
                            weight += weight_of(o, u, v);
                            if (!is_outside)
                                sum += weight_of(o, u, v) * double(own.coefficients.view()(from_x, from_y, c));
                        }
                    return sum / weight;
                };
                for (int c = 0; c < own.coefficients.channels(); ++c)
                    for (int y = 0; y < 15; ++y)
                        for (int x = 0; x < 21; ++x)
                            ASSERT_NEAR(means.coefficients.view()(x, y, c), mean_at(x, y, c),
                                        1e-5 + 2e-6 * std::abs(mean_at(x, y, c)))
                                << name_of(edge);
            }
}

/// A ramp with steps, and noise that follows it.
TEST(LocalModels, GuidesFarFromZeroDoNotMatter) {
    Random random(4);
    for (const WindowShape window : shapes)
        for (const double offset : {0.0, 100.0, 1000.0, -1000.0}) {
            const Image<float> guide =
                picture(40, 9, 1, [&](int x, int y, int) { return offset + x / 40.0 * 0.9 + (y > 4 ? 0.1 : 0.0); });
            const Image<float> signal = picture(
                40, 9, 1, [&](int x, int, int) { return 0.5 + 0.3 * std::sin(x * 0.2) + random.uniform(-.2, .2); });
            for (const bool averages : {false, true}) {
                const LocalModelOptions o{.radius = 8, .epsilon = 1e-6, .window = window, .averages = averages};
                const Image<float> found = guided_filter(signal.view(), guide.view(), o);
                if (!averages) {
                    EXPECT_LT(error_of(found, signal, guide, o), 1e-4) << offset;
                }
                for (int y = 0; y < 9; ++y)
                    for (int x = 0; x < 40; ++x) ASSERT_LT(std::abs(found.view()(x, y)), 2) << offset;
            }
        }
}

TEST(LocalModels, ASkyInTheGuideHarmsNoWindowWithoutIt) {
    for (const WindowShape window : shapes)
        for (const int order : {1, 2}) {
            const auto is_sky = [](int x, int y) { return y < 20 + x / 8; };
            const Image<float> guide = picture(48, 70, 1, [&](int x, int y, int) {
                return is_sky(x, y) ? 1e10 : 3 + 0.01 * y + 0.003 * ((x * 7) % 11);
            });
            const Image<float> signal = noise(48, 70, 1);
            const LocalModelOptions o{.radius = 2, .epsilon = 1e-5, .window = window, .order = order};
            const Image<float> found = guided_filter(signal.view(), guide.view(), o);
            const int reach = window == WindowShape::box ? 2 : static_cast<int>(std::ceil(4 * gaussian_sigma(2)));
            for (int y = 0; y < 70; ++y)
                for (int x = 0; x < 48; ++x) {
                    ASSERT_TRUE(std::isfinite(found.view()(x, y))) << x << ',' << y;
                    if (is_sky(std::min(47, x + reach), std::max(0, y - reach))) continue;
                    ASSERT_NEAR(found.view()(x, y), expected(signal.view(), guide.view(), o, x, y, 0),
                                order == 1 || window == WindowShape::box ? 1e-4 : 1e-2)
                        << name_of(window) << ' ' << x << ',' << y;
                }
        }
}

TEST(LocalModels, HolesAreFilledByWhatIsAroundThem) {
    const Image<float> guide = noise(40, 30, 2);
    const auto g = guide.view();
    const auto relation = [&](int x, int y) { return 2.0 * g(x, y, 0) - g(x, y, 1); };
    Random random(9);
    for (const WindowShape window : shapes)
        for (const bool averages : {false, true}) {
            const Image<float> signal = picture(
                40, 30, 1, [&](int x, int y, int) { return random.uniform() < 0.2 ? double(hole) : relation(x, y); });
            const Image<float> found =
                guided_filter(signal.view(), g, {.radius = 3, .epsilon = 1e-9, .window = window, .averages = averages});
            for (int y = 0; y < 30; ++y)
                for (int x = 0; x < 40; ++x) ASSERT_NEAR(found.view()(x, y), relation(x, y), 2e-4) << x << ',' << y;
        }
    // Infinite samples are holes too, and so are those of which one channel is missing.
    Image<float> guide_hole = guide.clone(), colours = noise(40, 30, 3, 0, 1, 8);
    guide_hole.view()(20, 10, 1) = -std::numeric_limits<float>::infinity();
    colours.view()(3, 4, 2) = hole;
    for (const Edge edge : {Edge::renormalize, Edge::zero, Edge::wrap}) {
        const LocalModelOptions o{.radius = 2, .epsilon = 1e-3, .edge = edge};
        const Image<float> found = guided_filter(colours.view(), guide_hole.view(), o);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                if (x == 20 && y == 10) {
                    ASSERT_FALSE(std::isfinite(found.view()(x, y)));
                } else {
                    ASSERT_NEAR(found.view()(x, y, 2), expected(colours.view(), guide_hole.view(), o, x, y, 2), 1e-5);
                }
    }
}

TEST(LocalModels, WhereThereIsNothingTheyAreNothing) {
    const Image<float> guide = noise(12, 9, 1), none = picture(12, 9, 1, [](int, int, int) { return hole; });
    for (const WindowShape window : shapes)
        for (const bool averages : {false, true})
            for (const int order : {1, 2}) {
                const LocalModelOptions o{.radius = 2, .window = window, .order = order, .averages = averages};
                const LocalModels a = fit_local_models(none.view(), guide.view(), o);
                const LocalModels b = fit_local_models(guide.view(), none.view(), o);
                for (int y = 0; y < 9; ++y)
                    for (int x = 0; x < 12; ++x) {
                        EXPECT_TRUE(std::isnan(apply_local_models(a, guide.view()).view()(x, y)));
                        EXPECT_TRUE(std::isnan(guided_filter(guide.view(), none.view(), o).view()(x, y)));
                        EXPECT_TRUE(std::isnan(b.coefficients.view()(x, y)));
                    }
            }
    // Half of it is there: the models beside the gap answer for what is near it, at other sizes too.
    const Image<float> half = picture(12, 9, 1, [](int x, int, int) { return x < 6 ? double(hole) : 0.5; });
    const LocalModels models = fit_local_models(half.view(), guide.view(), {.radius = 1});
    const Image<float> large = apply_local_models(models, noise(48, 36, 1).view());
    EXPECT_TRUE(std::isnan(large.view()(0, 0)));
    EXPECT_NEAR(large.view()(20, 20), 0.5, 1e-6);  // between a model and none
    EXPECT_NEAR(large.view()(24, 20), 0.5, 1e-6);
    EXPECT_NEAR(large.view()(47, 35), 0.5, 1e-6);
}

TEST(LocalModels, OfALinearSceneAreExactAtEveryResolution) {
    const auto guide_at = [](double x, double y, int c) { return c == 0 ? 5 + 2 * x + y : 1 + std::sin(9 * x) * y; };
    const auto guide_of = [&](int width, int height) {
        return picture(width, height, 2,
                       [&](int x, int y, int c) { return guide_at((x + 0.5) / width, (y + 0.5) / height, c); });
    };
    const auto signal_of = [](const Image<float>& guide) {
        return picture(guide.width(), guide.height(), 1, [&](int x, int y, int) {
            return 0.5 - 0.25 * double(guide.view()(x, y, 0)) + 2 * double(guide.view()(x, y, 1));
        });
    };
    const Image<float> low = guide_of(24, 18);
    for (const bool averages : {false, true}) {
        const LocalModels models =
            fit_local_models(signal_of(low).view(), low.view(), {.radius = 3, .epsilon = 1e-12, .averages = averages});
        for (const auto& [width, height] : {std::pair{48, 36}, {96, 72}, {192, 144}, {50, 31}, {12, 9}}) {
            const Image<float> guide = guide_of(width, height), truth = signal_of(guide);
            const Image<float> found = apply_local_models(models, guide.view());
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) ASSERT_NEAR(found.view()(x, y), truth.view()(x, y), 1e-4);
        }
    }
}

TEST(LocalModels, HaveTheSameBitsForAnyThreadsTargetAndLayout) {
    const Image<float> guide = noise(45, 130, 3), signal = noise(45, 130, 2, 0, 1, 2);
    const auto interleaved_copy = [](const Image<float>& image) {
        return picture(
            image.width(), image.height(), image.channels(), [&](int x, int y, int c) { return image.view()(x, y, c); },
            Layout::interleaved);
    };
    const LocalModelOptions o{.radius = 2, .epsilon = 1e-4};
    const Image<float> one = guided_filter(signal.view(), guide.view(), o, {1});
    const auto is_same = [&](const Image<float>& other) {
        for (int c = 0; c < 2; ++c)
            for (int y = 0; y < 130; ++y)
                for (int x = 0; x < 45; ++x)
                    if (one.view()(x, y, c) != other.view()(x, y, c)) return false;
        return true;
    };
    EXPECT_TRUE(is_same(guided_filter(signal.view(), guide.view(), o, {3})));
    EXPECT_TRUE(is_same(guided_filter(interleaved_copy(signal).view(), interleaved_copy(guide).view(), o)));
    for_each_target([&](Target) { EXPECT_TRUE(is_same(guided_filter(signal.view(), guide.view(), o))); });
}

TEST(LocalModels, RefuseWhatDoesNotFit) {
    const Image<float> a = noise(8, 8, 1), b = noise(8, 9, 1), nine = noise(8, 8, 9);
    EXPECT_THROW(guided_filter(a.view(), b.view()), Error);
    EXPECT_THROW(guided_filter(Image<float>().view(), Image<float>().view()), Error);
    EXPECT_THROW(guided_filter(a.view(), a.view(), {.radius = -1}), Error);
    EXPECT_THROW(guided_filter(a.view(), a.view(), {.radius = 256, .window = WindowShape::gaussian}), Error);
    EXPECT_THROW(guided_filter(a.view(), a.view(), {.epsilon = -1}), Error);
    EXPECT_THROW(guided_filter(a.view(), a.view(), {.epsilon = double(hole)}), Error);
    EXPECT_THROW(guided_filter(a.view(), a.view(), {.order = 3}), Error);
    EXPECT_THROW(guided_filter(a.view(), nine.view(), {.order = 2}), Error);
    EXPECT_THROW(parse_window_shape("disc"), Error);
    const LocalModels models = fit_local_models(a.view(), a.view());
    EXPECT_THROW(apply_local_models(models, nine.view()), Error);
    EXPECT_THROW(apply_local_models({}, a.view()), Error);
    // A radius beyond the picture is the whole of it.
    const Image<float> whole = guided_filter(a.view(), nine.view(), {.radius = 30000, .epsilon = infinity});
    EXPECT_NEAR(whole.view()(0, 0), whole.view()(7, 7), 1e-6);
}

}  // namespace
}  // namespace bandlimit
