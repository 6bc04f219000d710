#include "bandlimit/texture/cube.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "bandlimit/core/error.h"
#include "bandlimit/texture/pictures_test.h"

namespace bandlimit {
namespace {

using Point = std::array<double, 3>;

/// The point of the cube's surface under a place of a face's plane, in texels.
Point point_of(int face, double x, double y, int size) {
    const CubeFace& f = cube_faces()[std::size_t(face)];
    const double u = 2 * x / size - 1, v = 2 * y / size - 1;
    Point p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = f.outward[k] + u * f.right[k] + v * f.down[k];
    return p;
}

Point centre(const CubeTexel& t, int size) { return point_of(t.face, t.x + 0.5, t.y + 0.5, size); }

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// Table 15.1 of the OpenGL 4.6 specification, and the same of Vulkan and Direct3D: s_c and t_c by major axis.
TEST(CubeFaces, LieAsInTheSpecifications) {
    const auto looked_up = [](const Point& r) {
        const double m = std::max({std::abs(r[0]), std::abs(r[1]), std::abs(r[2])});
        int face = 0;
        double s = 0, t = 0;
        if (std::abs(r[0]) == m) face = r[0] > 0 ? 0 : 1, s = r[0] > 0 ? -r[2] : r[2], t = -r[1];
        else if (std::abs(r[1]) == m) face = r[1] > 0 ? 2 : 3, s = r[0], t = r[1] > 0 ? r[2] : -r[2];
        else face = r[2] > 0 ? 4 : 5, s = r[2] > 0 ? r[0] : -r[0], t = -r[1];
        return std::tuple{face, (s / m + 1) / 2, (t / m + 1) / 2};
    };
    constexpr int n = 8;
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto [f, s, t] = looked_up(centre({face, x, y}, n));
                EXPECT_EQ(f, face);
                EXPECT_DOUBLE_EQ(s * n, x + 0.5);
                EXPECT_DOUBLE_EQ(t * n, y + 0.5);
            }
}

// Unfolding keeps lengths: the k-th texel beyond an edge is k - 1/2 texels from it, and neighbours are neighbours.
TEST(CubeTexel, UnfoldsTheNeighbours) {
    constexpr int n = 5;
    const double texel = 2.0 / n;
    for (int face = 0; face < 6; ++face) {
        std::set<int> neighbours;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const std::array<std::pair<int, int>, 4> outside{{{-1 - k, i}, {n + k, i}, {i, -1 - k}, {i, n + k}}};
                for (const auto& [x, y] : outside) {
                    const CubeTexel t = cube_texel(face, x, y, n);
                    EXPECT_NE(t.face, face);
                    neighbours.insert(t.face);
                    // The foot on the edge that is crossed, at the same place along it.
                    const Point foot =
                        point_of(face, std::clamp(x + 0.5, 0.0, double(n)), std::clamp(y + 0.5, 0.0, double(n)), n);
                    EXPECT_NEAR(distance(centre(t, n), foot), (k + 0.5) * texel, 1e-12);
                }
            }
        EXPECT_EQ(neighbours.size(), 4u);
    }
}

Image<float> numbered_face(int face, int n) {
    return picture<float>(n, n, 1, [&](int x, int y, int) { return (face * n + y) * n + x; });
}

TEST(ExtendedFace, TurnsBothNeighboursIntoCorners) {
    constexpr int n = 4, margin = 4;
    std::vector<Image<float>> images;
    std::vector<View<const float>> views;
    for (int f = 0; f < 6; ++f) images.push_back(numbered_face(f, n));
    for (const auto& image : images) views.push_back(image.view());
    for (int f = 0; f < 6; ++f) {
        const Image<float> extended = extended_face(views, f, margin, {});
        const auto at = [&](int x, int y) { return extended.view()(x + margin, y + margin); };
        for (int j = 0; j < margin; ++j)
            for (int i = 0; i < margin; ++i) {
                // At the corner (0, 0): a quarter turn takes (-1 - i, -1 - j) to (-1 - j, i) and to (j, -1 - i).
                EXPECT_EQ(at(-1 - i, -1 - j), (at(-1 - j, i) + at(j, -1 - i)) / 2);
                EXPECT_EQ(at(n + i, -1 - j), (at(n + j, i) + at(n - 1 - j, -1 - i)) / 2);
                EXPECT_EQ(at(-1 - i, n + j), (at(-1 - j, n - 1 - i) + at(j, n + i)) / 2);
                EXPECT_EQ(at(n + i, n + j), (at(n + j, n - 1 - i) + at(n - 1 - j, n + i)) / 2);
            }
    }
}

template <class F>
std::vector<Image<float>> cube_of(int n, F f) {
    std::vector<Image<float>> faces;
    for (int face = 0; face < 6; ++face)
        faces.push_back(picture<float>(n, n, 1, [&](int x, int y, int) { return f(centre({face, x, y}, n)); }));
    return faces;
}

std::vector<MipChain> mips_of(const std::vector<Image<float>>& faces, const MipOptions& options) {
    std::vector<AnyConstView> views;
    for (const auto& face : faces) views.push_back(face.view());
    return make_cube_mips(views, plain, r32f, options);
}

double smooth(const Point& p) {
    const double length = std::hypot(p[0], p[1], p[2]);
    return (p[0] * 0.7 - p[1] * 0.4 + p[2] * 0.9 + 0.5 * p[0] * p[1] / length) / length;
}

// A function of direction has no seams. After each level, neighbours across the twelve edges differ no more than
// neighbours within faces do.
TEST(MakeCubeMips, HaveNoSeams) {
    for (const MipFilter& filter :
         {MipFilter(Auto{}), MipFilter(box()), MipFilter(downsample8()), MipFilter(lanczos(3))}) {
        const auto chains = mips_of(cube_of(32, smooth), {.role = Role::height, .filter = filter});
        for (std::size_t level = 0; level < 5; ++level) {
            const int n = 32 >> level;
            double within = 0, across = 0;
            for (int face = 0; face < 6; ++face)
                for (int i = 0; i < n; ++i)
                    for (int k = -1; k < n; ++k)
                        for (const bool along_x : {true, false}) {
                            const CubeTexel a = along_x ? cube_texel(face, k, i, n) : cube_texel(face, i, k, n);
                            const CubeTexel b = along_x ? cube_texel(face, k + 1, i, n) : cube_texel(face, i, k + 1, n);
                            const auto value = [&](const CubeTexel& t) {
                                return sample(chains[std::size_t(t.face)].images[level], t.x, t.y);
                            };
                            double& most = k < 0 || k + 1 == n ? across : within;
                            most = std::max(most, std::abs(value(a) - value(b)));
                        }
            EXPECT_LT(across, n > 1 ? 1.25 * within : 2) << level;
            // What is made is near the function itself: orientation and all.
            for (int face = 0; face < 6; ++face)
                for (int y = 0; y < n; ++y)
                    for (int x = 0; x < n; ++x)
                        ASSERT_NEAR(sample(chains[std::size_t(face)].images[level], x, y),
                                    smooth(centre({face, x, y}, n)), n > 1 ? 0.4 / n : 0.3)
                            << level;
        }
    }
}

TEST(MakeCubeMips, KeepConstants) {
    for (const Role role : all_roles())
        for (const int n : {1, 2, 3, 7, 16}) {
            std::vector<Image<std::uint8_t>> faces;
            std::vector<AnyConstView> views;
            const std::array<int, 4> codes{128, 128, 255, 200};
            for (int f = 0; f < 6; ++f)
                faces.push_back(picture<std::uint8_t>(n, n, 4, [&](int, int, int c) { return codes[std::size_t(c)]; }));
            for (const auto& face : faces) views.push_back(face.view());
            const bool is_srgb = role == Role::color || role == Role::alpha_tested;
            for (const MipSource from : {MipSource::base, MipSource::previous}) {
                const auto chains = make_cube_mips(views, is_srgb ? srgb_alpha : linear_alpha,
                                                   is_srgb ? rgba8_srgb : rgba8, {.role = role, .from = from});
                for (const MipChain& chain : chains)
                    for (const AnyImage& image : chain.images)
                        for (int y = 0; y < height_of(image); ++y)
                            for (int x = 0; x < width_of(image); ++x)
                                for (int c = 0; c < 4; ++c)
                                    ASSERT_EQ(sample(image, x, y, c), codes[std::size_t(c)]) << name_of(role) << n;
            }
        }
}

/// A quarter turn about y and one about x, and the mirror image x to -x, generate all symmetries of the cube.
std::vector<Image<float>> moved(const std::vector<Image<float>>& faces, const std::array<IntVector, 3>& matrix) {
    const int n = faces[0].width();
    std::vector<Image<float>> result;
    for (int face = 0; face < 6; ++face)
        result.push_back(picture<float>(n, n, 1, [&](int x, int y, int) {
            const Point p = centre({face, x, y}, n);
            Point q{};
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t k = 0; k < 3; ++k) q[r] += matrix[r][k] * p[k];
            for (int f = 0; f < 6; ++f) {
                const CubeFace& to = cube_faces()[std::size_t(f)];
                double out = 0, u = 0, v = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    out += q[k] * to.outward[k], u += q[k] * to.right[k], v += q[k] * to.down[k];
                if (out == 1) return faces[std::size_t(f)].view()(int((u + 1) / 2 * n), int((v + 1) / 2 * n));
            }
            return NAN;
        }));
    return result;
}

TEST(MakeCubeMips, TurnWithTheCube) {
    Random random(4);
    std::vector<Image<float>> faces;
    for (int f = 0; f < 6; ++f)
        faces.push_back(picture<float>(16, 16, 1, [&](int, int, int) { return random.uniform(); }));
    const std::array<std::array<IntVector, 3>, 3> symmetries{{{{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}},
                                                              {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},
                                                              {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}};
    for (const MipFilter& filter : {MipFilter(Auto{}), MipFilter(downsample8()), MipFilter(jinc_lanczos(2))}) {
        const MipOptions options{.role = Role::height, .filter = filter};
        const auto chains = mips_of(faces, options);
        for (const auto& matrix : symmetries) {
            const auto turned = mips_of(moved(faces, matrix), options);
            for (std::size_t level = 1; level < chains[0].images.size(); ++level) {
                std::vector<Image<float>> images;
                for (const MipChain& chain : chains)
                    images.push_back(std::get<Image<float>>(chain.images[level]).clone());
                const auto expected = moved(images, matrix);
                for (std::size_t f = 0; f < 6; ++f)  // sums in another order
                    ASSERT_LT(difference(AnyImage(expected[f].clone()), turned[f].images[level]), 1e-5) << level;
            }
        }
    }
}

TEST(MakeCubeMips, RefuseWhatIsNoCube) {
    const Image<float> a(4, 4, 1), b(4, 2, 1), c(8, 8, 1);
    const auto refuses = [](const std::vector<AnyConstView>& faces, const MipOptions& options) {
        EXPECT_THROW(make_cube_mips(faces, plain, r32f, options), Error);
    };
    const AnyConstView f = a.view();
    refuses({f, f, f, f, f}, {.role = Role::data});
    refuses({f, f, f, f, f, b.view()}, {.role = Role::data});
    refuses({f, f, f, f, f, c.view()}, {.role = Role::data});
    refuses({f, f, f, f, f, f}, {.role = Role::roughness, .normals = f});
}

}  // namespace
}  // namespace bandlimit
