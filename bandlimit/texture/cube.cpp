#include "bandlimit/texture/cube.h"

#include <algorithm>
#include <cassert>

namespace bandlimit {
namespace {

int dot(const IntVector& a, const IntVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

IntVector scaled(const IntVector& a, int by) { return {a[0] * by, a[1] * by, a[2] * by}; }

IntVector sum(const IntVector& a, const IntVector& b, const IntVector& c) {
    return {a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]};
}

int face_towards(const IntVector& outward) {
    const auto& faces = cube_faces();
    return static_cast<int>(
        std::find_if(faces.begin(), faces.end(), [&](const CubeFace& f) { return f.outward == outward; }) -
        faces.begin());
}

bool is_inside(int i, int size) { return i >= 0 && i < size; }

}  // namespace

const std::array<CubeFace, 6>& cube_faces() {
    static constexpr std::array<CubeFace, 6> faces{{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                                    {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                                    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                                    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                                    {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                                    {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};
    return faces;
}

CubeTexel cube_texel(int face, int x, int y, int size) {
    if (is_inside(x, size) && is_inside(y, size)) return {face, x, y};
    assert(is_inside(x, size) || is_inside(y, size));
    const CubeFace& from = cube_faces()[static_cast<std::size_t>(face)];
    // In units in which the cube reaches from -size to size, and centres of texels are whole numbers.
    const auto place = [&](int i) { return 2 * i + 1 - size; };
    const bool along_x = !is_inside(x, size);
    const int across = place(along_x ? x : y), along = place(along_x ? y : x);
    const int sign = across > 0 ? 1 : -1;
    const IntVector outward = scaled(along_x ? from.right : from.down, sign);
    // What lies beyond the edge in the plane lies as far down the side.
    const int depth = sign * across - size;
    const IntVector point =
        sum(scaled(outward, size), scaled(from.outward, size - depth), scaled(along_x ? from.down : from.right, along));
    const int neighbour = face_towards(outward);
    const CubeFace& to = cube_faces()[static_cast<std::size_t>(neighbour)];
    const auto index = [&](const IntVector& axis) { return (dot(point, axis) + size - 1) / 2; };
    return {neighbour, index(to.right), index(to.down)};
}

Image<float> extended_face(std::span<const View<const float>> faces, int face, int margin, Parallel parallel) {
    const View<const float>& middle = faces[static_cast<std::size_t>(face)];
    const int n = middle.width, channels = middle.channels, size = n + 2 * margin;
    Image<float> result(size, size, channels, Layout::interleaved);
    const View<float> out = result.view();
    const auto texel = [&](int x, int y) {
        const CubeTexel at = cube_texel(face, x, y, n);
        return &faces[static_cast<std::size_t>(at.face)](at.x, at.y);
    };
    parallel_for(size, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int v = static_cast<int>(begin); v < end; ++v) {
            const int y = v - margin;
            const auto copy = [&](int x) { std::copy_n(texel(x, y), channels, &out(x + margin, v)); };
            const auto turn = [&](int x) {
                // Distances from the corner, exchanged: a quarter turn, into the one neighbour and into the other.
                const int right = x < 0 ? -1 - x : x - n, down = y < 0 ? -1 - y : y - n;
                const float* a = texel(x < 0 ? -1 - down : n + down, y < 0 ? right : n - 1 - right);
                const float* b = texel(x < 0 ? down : n - 1 - down, y < 0 ? -1 - right : n + right);
                for (int c = 0; c < channels; ++c) out(x + margin, v, c) = (a[c] + b[c]) / 2;
            };
            const bool is_corner_row = y < 0 || y >= n;
            if (!is_corner_row) std::copy_n(&middle(0, y), n * channels, &out(margin, v));
            else
                for (int x = 0; x < n; ++x) copy(x);
            for (int k = 0; k < margin; ++k)
                for (const int x : {-1 - k, n + k}) {
                    if (is_corner_row) turn(x);
                    else copy(x);
                }
        }
    });
    return result;
}

}  // namespace bandlimit
