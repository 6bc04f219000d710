#include "bandlimit/texture/normals.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "bandlimit/color/encoding.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {
namespace {

constexpr int grain = 16;              // rows per thread at least
constexpr float no_direction = 0.01f;  // a mean shorter than this points nowhere: codes of 8 bits err by 0.007

struct Vector {
    float x, y, z;
    float length() const { return std::sqrt(x * x + y * y + z * z); }
};

Vector unit(Vector v) {
    const float length = v.length();
    if (length <= no_direction) return {0, 0, 1};
    return {v.x / length, v.y / length, v.z / length};
}

/// What is left of a component once it is stored.
float rounded(float n, Depth depth) {
    const auto as_code = [&](float largest) { return 2 * std::round((n + 1) / 2 * largest) / largest - 1; };
    switch (depth) {
        case Depth::u8: return as_code(255);
        case Depth::u16: return as_code(65535);
        case Depth::f16: return to_float(to_half(n));
        default: return n;
    }
}

/// How far rounding takes a unit vector from length 1: half a step in each of three components.
float rounding_of_length(Depth depth) {
    constexpr float sqrt3 = 1.7320508f;
    switch (depth) {
        case Depth::u8: return sqrt3 / 255;
        case Depth::u16: return sqrt3 / 65535;
        case Depth::f16: return sqrt3 * 0x1p-12f;
        default: return sqrt3 * 0x1p-24f;
    }
}

Vector stored_unit(Vector mean, Depth depth, float rounding) {
    const Vector code{rounded(mean.x, depth), rounded(mean.y, depth), rounded(mean.z, depth)};
    return std::abs(code.length() - 1) <= rounding ? mean : unit(mean);
}

}  // namespace

Image<float> decode_normals(const AnyConstView& map, bool make_unit, Parallel parallel) {
    const bool are_codes = is_integer(depth_of(map));
    const ViewShape shape = shape_of(map);
    const int step = shape.channels;
    Image<float> vectors(shape.width, shape.height, 3, Layout::interleaved);
    parallel_for(shape.height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<float> row(static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(step));
        for (int y = static_cast<int>(begin); y < end; ++y) {
            decode_row(map, y, {}, false, row);
            if (are_codes)
                for (float& v : row) v = 2 * v - 1;
            float* to = &vectors.view()(0, y);
            for (const float* from = row.data(); from != row.data() + row.size(); from += step, to += 3) {
                const float z =
                    step > 2 ? from[2] : std::sqrt(std::max(0.0f, 1 - (from[0] * from[0] + from[1] * from[1])));
                const Vector v = make_unit ? unit({from[0], from[1], z}) : Vector{from[0], from[1], z};
                to[0] = v.x, to[1] = v.y, to[2] = v.z;
            }
        }
    });
    return vectors;
}

bool encode_normals(const NormalMeans& means, const AnyView& target, Parallel parallel) {
    const View<const float> from = means.samples;
    const Depth depth = depth_of(const_view(target));
    const bool to_codes = is_integer(depth);
    const float rounding = rounding_of_length(depth);
    const int channels = shape_of(target).channels;
    std::atomic<bool> lost = false;
    parallel_for(from.height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<float> row(static_cast<std::size_t>(from.width) * static_cast<std::size_t>(channels));
        for (int y = static_cast<int>(begin); y < end; ++y) {
            float* to = row.data();
            for (int x = 0; x < from.width; ++x, to += channels) {
                const float* const m = &from(x, y);
                const Vector mean =
                    means.are_codes ? Vector{2 * m[0] - 1, 2 * m[1] - 1, 2 * m[2] - 1} : Vector{m[0], m[1], m[2]};
                const Vector n = stored_unit(mean, depth, rounding);
                const auto sample = [&](float v) { return to_codes ? (v + 1) / 2 : v; };
                to[0] = sample(n.x), to[1] = sample(n.y);
                if (channels == 2) continue;
                to[2] = sample(n.z);
                to[3] = from.channels > 3 ? m[3] : 1;
            }
            if (encode_row(row, false, target, y, {})) lost = true;
        }
    });
    return lost;
}

NormalMoments::NormalMoments(const AnyConstView& map, Parallel parallel) : base_(decode_normals(map, true, parallel)) {}

View<const float> NormalMoments::means(int width, int height, Parallel parallel) {
    const auto divides = [&](const Image<float>& image) {
        return image.width() > 0 && image.width() % width == 0 && image.height() % height == 0;
    };
    // Boxes of boxes are exact where their borders meet.
    const Image<float>& from = divides(last_) ? last_ : base_;
    last_ = resample(from.view(), width, height, {.reconstruction = box()}, parallel, Layout::interleaved);
    return last_.view();
}

}  // namespace bandlimit
