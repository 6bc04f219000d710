#include "bandlimit/antialias/temporal_shader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "bandlimit/antialias/frame_gather.h"
#include "bandlimit/antialias/history_weights.h"
#include "bandlimit/antialias/temporal_rows.h"
#include "bandlimit/core/error.h"
#include "bandlimit/shader/text.h"

namespace bandlimit {
namespace {

// ---- The neutral source. The words in capitals are replaced.

constexpr std::string_view textures = R"(// The textures, read at whole texels:
//   color           the frame, rendered with the jitter: linear light, opaque, finite
//   surface         of its size: x and y where a point was in the frame before, minus where it is, in pixels of the
//                   frame, y down, without the jitter; z linear depth, the same everywhere if there is none; w how much
//                   history is to be forgotten, as of particles, 0 to 1
//   history         what NAME_step returned for the frame before, as 32-bit floats
)";

constexpr std::string_view texture_before = R"(//   surface_before  surface of the frame before
)";

constexpr std::string_view frame_begin = R"(
structure(NAME_frame) {
    field(float2, size)           // of the frame, in pixels
    field(float2, result_size)    // of the result and the history: as large, or larger
    field(float2, jitter)         // pixel (i, j) shows the scene at (i, j) + 1/2 + jitter
)";

constexpr std::string_view frame_before = R"(    field(float2, size_before)    // of the frame before
    field(float2, jitter_before)
)";

constexpr std::string_view frame_end =
    R"(    field(float, exposure)        // that color was multiplied by, divided by that of the frame before
    field(float, has_history)     // 1; 0 for the first frame and after cuts
};

)";

constexpr std::string_view gaussian_weight = R"(function(float, NAME_weight, in(float, distance)) {
    return exp(FACTOR * distance * distance);
}

)";

constexpr std::string_view highlights =
    R"(// The largest channel v becomes 1 + log(v) if it is above 1, for means that look like means on a display.
function(float4, NAME_compressed, in(float4, v)) {
    let(float, most) = max(max(v.x, v.y), v.z);
    let(float, scale) = choose(most > 1.0, (1.0 + log(max(most, 1.0))) / max(most, 1.0), 1.0);
    return float4(scale * v.x, scale * v.y, scale * v.z, v.w);
}

function(float4, NAME_restored, in(float4, v)) {
    let(float, most) = max(max(v.x, v.y), v.z);
    let(float, scale) = choose(most > 1.0, exp(max(most, 1.0) - 1.0) / max(most, 1.0), 1.0);
    return float4(scale * v.x, scale * v.y, scale * v.z, v.w);
}

)";

constexpr std::string_view reads = R"(function(float4, NAME_colour, texture(color), in(int2, at)) {
    let(float4, v) = load(color, at);
    return COMPRESSED(float4(v.x, v.y, v.z, 1.0));
}

// Where a pixel of the result lies among the samples of the frame.
function(float2, NAME_place, in(NAME_frame, frame), in(int2, at)) {
    return (float2(at) + 0.5) * (frame.size / frame.result_size) - 0.5 - frame.jitter;
}

)";

constexpr std::string_view gather = R"(// The samples about a pixel times their weights, and the sum of these.
function(float4, NAME_gather, texture(color), in(NAME_frame, frame), in(int2, at)) {
    let(float2, scale) = frame.result_size / frame.size;
    let(float2, reach) = RADIUS / scale;
    let(float2, place) = NAME_place(frame, at);
    let(int2, first) = int2(max(ceil(place - reach), float2(0.0, 0.0)));
    let(int2, last) = int2(min(floor(place + reach), frame.size - 1.0));
    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);
    loop(y, first.y, last.y + 1, 1) {
        let(float, weight_y) = NAME_weight((float(y) - place.y) * scale.y);
        loop(x, first.x, last.x + 1, 1) {
            sum += weight_y * NAME_weight((float(x) - place.x) * scale.x) * NAME_colour(color, int2(x, y));
        }
    }
    return sum;
}

)";

constexpr std::string_view guide =
    R"(// The motion and depth of the nearest of 3 x 3 samples: edges move with what is in front.
function(float4, NAME_guide, texture(surface), in(int2, near), in(int2, last)) {
    let(float4, middle) = load(surface, near);
    var(float4, front) = middle;
    loop(i, 0, 3, 1) {
        loop(j, 0, 3, 1) {
            // In the order 0, -1, 1: of equally near ones the first counts.
            let(int2, beside) = int2(i * (3 * i - 5) / 2, j * (3 * j - 5) / 2);
            let(float4, seen) = load(surface, clamp(near + beside, int2(0, 0), last));
            if (seen.z < front.z) {
                front = seen;
            }
        }
    }
    return float4(front.x, front.y, front.z, middle.w);
}

)";

constexpr std::string_view lanczos_weights = R"(function(float4, NAME_history_weights, in(float, x)) {
    let(float4, w) = float4(WEIGHT(1.0 + x), WEIGHT(x), WEIGHT(1.0 - x), WEIGHT(2.0 - x));
    return w / (w.x + w.y + w.z + w.w);
}

)";

constexpr std::string_view past_begin =
    R"(// The history where a pixel was: the colour, kept within those of the four texels about it, times how much it weighs.
function(float4, NAME_past, texture(history), in(NAME_frame, frame), in(int2, at), in(float2, motion)) {
    let(float2, whole) = floor(motion);
    let(float2, t) = motion - whole;
    let(int2, base) = at + int2(whole);
    let(int2, last) = int2(frame.result_size) - int2(1, 1);
)";

constexpr std::string_view past_exact = R"(    if (t.x == 0.0 && t.y == 0.0) {
        return load(history, clamp(base, int2(0, 0), last));
    }
)";

constexpr std::string_view past_bilinear = R"(    var(float4, low) = float4(3e38, 3e38, 3e38, 3e38);
    var(float4, high) = float4(-3e38, -3e38, -3e38, -3e38);
    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);
    loop(j, 0, 2, 1) {
        loop(i, 0, 2, 1) {
            let(float4, seen) = load(history, clamp(base + int2(i, j), int2(0, 0), last));
            sum += choose(i == 0, 1.0 - t.x, t.x) * choose(j == 0, 1.0 - t.y, t.y) * seen;
            if (seen.w > LEAST) {
                low = min(low, seen / seen.w);
                high = max(high, seen / seen.w);
            }
        }
    }
    let(float, weight) = max(sum.w, 0.0);
)";

constexpr std::string_view past_cubic = R"(    let(float4, weights_x) = NAME_history_weights(t.x);
    let(float4, weights_y) = NAME_history_weights(t.y);
    var(float4, low) = float4(3e38, 3e38, 3e38, 3e38);
    var(float4, high) = float4(-3e38, -3e38, -3e38, -3e38);
    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);
    var(float, weight) = 0.0;
    loop(j, 0, 4, 1) {
        loop(i, 0, 4, 1) {
            let(float4, seen) = load(history, clamp(base + int2(i - 1, j - 1), int2(0, 0), last));
            let(bool, inner_x) = i == 1 || i == 2;
            let(bool, inner_y) = j == 1 || j == 2;
SUM            if (inner_x && inner_y) {
                weight += choose(i == 1, 1.0 - t.x, t.x) * choose(j == 1, 1.0 - t.y, t.y) * seen.w;
                if (seen.w > LEAST) {
                    low = min(low, seen / seen.w);
                    high = max(high, seen / seen.w);
                }
            }
        }
    }
    weight = max(weight, 0.0);
)";

constexpr std::string_view past_end = R"(    if (low.x > high.x) {
        return float4(0.0, 0.0, 0.0, 0.0);
    }
    var(float4, colour) = 0.5 * (low + high);
    if (sum.w > LEAST) {
        colour = min(max(sum / sum.w, low), high);
    }
    return weight * float4(colour.x, colour.y, colour.z, 1.0);
}

)";

constexpr std::string_view mismatch =
    R"(// 0 for a depth between `near` and `far`, or near these, 1 for others. What does not move has not come in front of what
// was farther: the samples of that frame missed it.
function(float, NAME_unlike, in(float, then), in(float, near), in(float, far), in(bool, is_still)) {
    let(float, beyond) = choose(is_still, 0.0, then - far);
    let(float, relative) = max(max(beyond, near - then), 0.0) / max(min(then, far), 1e-6);
    return clamp(relative * PER_TOLERANCE - 1.0, 0.0, 1.0);
}

// How much the frame before saw something else there, by the depth of any of the four samples about the place, or by
// that of the nearest one if it moved otherwise: of a thin line that does not move, the nearest sample often misses it.
// `depth` is that of the sample itself, which may lie on a slope.
function(float, NAME_mismatch, texture(surface_before), in(NAME_frame, frame), in(float4, guide), in(float, depth),
    in(float2, before)) {
    let(bool, is_still) = max(abs(guide.x), abs(guide.y)) < STILL_MOTION;
    let(float2, place) = (before + 0.5) * (frame.size_before / frame.result_size) - 0.5 - frame.jitter_before;
    let(int2, base) = int2(floor(place));
    let(int2, last) = int2(frame.size_before) - int2(1, 1);
    var(float, closest) = 1.0;
    loop(j, 0, 2, 1) {
        loop(i, 0, 2, 1) {
            let(float4, about) = load(surface_before, clamp(base + int2(i, j), int2(0, 0), last));
            closest = min(closest, NAME_unlike(about.z, guide.z, depth, is_still));
        }
    }
    let(float4, seen) = load(surface_before, clamp(int2(floor(place + 0.5)), int2(0, 0), last));
    let(float2, change) = float2(seen.x - guide.x, seen.y - guide.y);
    let(float, otherwise) = clamp(sqrt(dot(change, change)) - VELOCITY_TOLERANCE, 0.0, 1.0);
    return max(closest, min(NAME_unlike(seen.z, guide.z, depth, is_still), otherwise));
}

)";

constexpr std::string_view ycocg = R"(function(float4, NAME_ycocg, in(float4, v)) {
    return float4(0.25 * v.x + 0.5 * v.y + 0.25 * v.z, 0.5 * v.x - 0.5 * v.z, 0.5 * v.y - 0.25 * v.x - 0.25 * v.z, v.w);
}

function(float4, NAME_rgb, in(float4, v)) {
    return float4(v.x + v.y - v.z, v.x + v.z, v.x - v.y - v.z, v.w);
}

)";

constexpr std::string_view rectified_begin =
    R"(// History moved towards what the 3 x 3 samples about the pixel are, and in w how far it was outside of that.
function(float4, NAME_rectified, texture(color), in(NAME_frame, frame), in(int2, near), in(float4, past),
    in(float, moving), in(float, mismatch)) {
    let(int2, last) = int2(frame.size) - int2(1, 1);
    let(int2, first) = clamp(near - int2(1, 1), int2(0, 0), last);
    let(int2, end) = clamp(near + int2(1, 1), int2(0, 0), last);
)";

constexpr std::string_view box_by_variance = R"(    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);
    var(float4, squares) = float4(0.0, 0.0, 0.0, 0.0);
    loop(y, first.y, end.y + 1, 1) {
        loop(x, first.x, end.x + 1, 1) {
            let(float4, v) = YCOCG(NAME_colour(color, int2(x, y)));
            sum += v;
            squares += v * v;
        }
    }
    let(float4, centre) = sum / sum.w;
    let(float4, extent) = sqrt(max(squares / sum.w - centre * centre, float4(0.0, 0.0, 0.0, 0.0)));
)";

constexpr std::string_view box_by_range = R"(    var(float4, low) = YCOCG(NAME_colour(color, near));
    var(float4, high) = low;
    loop(y, first.y, end.y + 1, 1) {
        loop(x, first.x, end.x + 1, 1) {
            let(float4, v) = YCOCG(NAME_colour(color, int2(x, y)));
            low = min(low, v);
            high = max(high, v);
        }
    }
    let(float4, centre) = 0.5 * (low + high);
    let(float4, extent) = 0.5 * (high - low);
)";

constexpr std::string_view rectified_beyond = R"(    let(float4, now) = YCOCG(past);
    let(float4, away) = now - centre;
    let(float4, room) = BOX_SIZE * extent;
    let(float4, beyond) = max(abs(away) - room, float4(0.0, 0.0, 0.0, 0.0));
    if (max(max(beyond.x, beyond.y), beyond.z) <= 0.0) {
        return float4(past.x, past.y, past.z, 0.0);
    }
    let(float, outside) = max(max(beyond.x / (extent.x + LEAST_EXTENT), beyond.y / (extent.y + LEAST_EXTENT)),
        beyond.z / (extent.z + LEAST_EXTENT));
)";

constexpr std::string_view inside_by_channel =
    R"(    let(float4, inside) = RGB(min(max(now, centre - room), centre + room));
)";

constexpr std::string_view inside_by_clip =
    R"(    let(float, part_x) = choose(beyond.x > 0.0, room.x / max(abs(away.x), 1e-30), 1.0);
    let(float, part_y) = choose(beyond.y > 0.0, room.y / max(abs(away.y), 1e-30), 1.0);
    let(float, part_z) = choose(beyond.z > 0.0, room.z / max(abs(away.z), 1e-30), 1.0);
    let(float4, inside) = RGB(centre + min(min(part_x, part_y), part_z) * away);
)";

constexpr std::string_view rectified_end = R"(    let(float, least) = RECTIFY_SHARE * moving;
    let(float4, rectified) = past + (least + (1.0 - least) * mismatch) * (inside - past);
    return float4(rectified.x, rectified.y, rectified.z, outside * max(moving, mismatch));
}

)";

constexpr std::string_view step_begin =
    R"(// The history at a pixel of the result after this frame: red, green, blue and 1, each times what it weighs.
function(float4, NAME_step, texture(color), texture(surface), texture(history),BEFORE_PARAMETER
    in(NAME_frame, frame), in(int2, at)) {
    let(float4, gathered) = NAME_gather(color, frame, at);
    let(int2, last) = int2(frame.size) - int2(1, 1);
    let(int2, near) = clamp(int2(floor(NAME_place(frame, at) + 0.5)), int2(0, 0), last);
    let(float4, guide) = GUIDE;
    let(float2, motion) = float2(guide.x, guide.y) * (frame.result_size / frame.size);
    let(float2, before) = float2(at) + motion;
    if (frame.has_history == 0.0 || before.x < -0.5 || before.y < -0.5 || before.x > frame.result_size.x - 0.5
        || before.y > frame.result_size.y - 0.5) {
        return gathered;
    }
)";

constexpr std::string_view step_past = R"(    if (past.w <= 0.0) {
        return gathered + past;
    }
)";

constexpr std::string_view follow_exposure = R"(    if (frame.exposure != 1.0 && past.w > LEAST) {
        let(float4, seen) = RESTORED(past / past.w);
        let(float, e) = frame.exposure;
        past = past.w * COMPRESSED(float4(e * seen.x, e * seen.y, e * seen.z, 1.0));
    }
)";

constexpr std::string_view step_rectify =
    R"(    // What is still is left alone: of a line thinner than a pixel, the samples of one frame know nothing.
    let(float, moving) = min(1.0, FASTER * speed);
    if (max(moving, mismatch) > 0.0 && past.w > LEAST) {
        let(float4, rectified) = NAME_rectified(color, frame, near, past / past.w, moving, mismatch);
        past = past.w * float4(rectified.x, rectified.y, rectified.z, 1.0);
        memory = memory / (1.0 + DOUBT * rectified.w);
    }
)";

constexpr std::string_view show_begin =
    R"(// The pixel of the result that a history shows, or, as far as that is too little, the frame itself between its samples.
function(float4, NAME_show, texture(color), in(NAME_frame, frame), in(float4, sums), in(int2, at)) {
    var(float4, shown) = sums / max(sums.w, LEAST);
LIMIT    if (sums.w < SHOWN_ALONE) {
        let(float2, place) = NAME_place(frame, at);
        let(float2, t) = place - floor(place);
        let(int2, base) = int2(floor(place));
        let(int2, last) = int2(frame.size) - int2(1, 1);
        let(float4, a) = NAME_colour(color, clamp(base, int2(0, 0), last));
        let(float4, b) = NAME_colour(color, clamp(base + int2(1, 0), int2(0, 0), last));
        let(float4, c) = NAME_colour(color, clamp(base + int2(0, 1), int2(0, 0), last));
        let(float4, d) = NAME_colour(color, clamp(base + int2(1, 1), int2(0, 0), last));
        let(float4, above) = a + t.x * (b - a);
        let(float4, below) = c + t.x * (d - c);
        let(float4, alone) = above + t.y * (below - above);
        shown = alone + clamp((sums.w - LEAST) * PER_TRUST, 0.0, 1.0) * (shown - alone);
DERINGED    }
    return RESTORED(float4(shown.x, shown.y, shown.z, 1.0));
}
)";

constexpr std::string_view deringing_limit =
    R"(    let(float2, pitch) = frame.size / frame.result_size;
    let(float, rings) = DERINGING * pitch.x * pitch.y;
)";

constexpr std::string_view deringed = R"(        // Until there is more history, nothing rings beyond the samples.
        if (sums.w < rings) {
            let(float4, held) = clamp(shown, min(min(a, b), min(c, d)), max(max(a, b), max(c, d)));
            shown = held + (max(sums.w, 0.0) / rings) * (shown - held);
        }
)";

constexpr std::string_view steadiness =
    R"(// What a frame weighs beside history of another luma.
function(float, NAME_steadiness, in(float4, gathered), in(float4, past)) {
    if (gathered.w <= LEAST || past.w <= LEAST) {
        return 1.0;
    }
    let(float, now) = (0.25 * gathered.x + 0.5 * gathered.y + 0.25 * gathered.z) / gathered.w;
    let(float, then) = (0.25 * past.x + 0.5 * past.y + 0.25 * past.z) / past.w;
    return 1.0 / (1.0 + ANTI_FLICKER * abs(now - then) / max(max(now, then), LEAST_LUMA));
}

)";

constexpr std::string_view sharpening = R"(
// The shown picture, each pixel moved away from the mean of its four neighbours as far as the range of the five allows.
function(float4, NAME_sharpen, texture(shown), in(NAME_frame, frame), in(int2, at)) {
    let(int2, last) = int2(frame.result_size) - int2(1, 1);
    let(float4, v) = load(shown, at);
    let(float4, l) = load(shown, clamp(at - int2(1, 0), int2(0, 0), last));
    let(float4, r) = load(shown, clamp(at + int2(1, 0), int2(0, 0), last));
    let(float4, u) = load(shown, clamp(at - int2(0, 1), int2(0, 0), last));
    let(float4, d) = load(shown, clamp(at + int2(0, 1), int2(0, 0), last));
    let(float4, low) = min(v, min(min(l, r), min(u, d)));
    let(float4, high) = max(v, max(max(l, r), max(u, d)));
    return min(max(v + SHARPENING * (v - 0.25 * (l + r + u + d)), low), high);
}
)";

// ---- The kernel

/// If `kernel` is exp(c x^2) up to its radius, c, which is below 0; else 0.
double gaussian_factor(const Kernel& kernel) {
    const auto factor_at = [&](double x) { return std::log(kernel.value(x)) / (x * x); };
    const double factor = factor_at(kernel.radius / 2);
    for (int i = 1; i < 16; ++i)
        if (!(std::abs(factor_at(kernel.radius * i / 16) - factor) <= 1e-9 * std::abs(factor))) return 0;
    return factor < 0 ? factor : 0;
}

/// The polynomial of degree 7 through `value` at the Chebyshev points of [begin, end].
KernelPiece interpolated_piece(const std::function<double(double)>& value, double begin, double end) {
    constexpr std::size_t count = 8;
    std::array<double, count> at{}, newton{};
    for (std::size_t i = 0; i < count; ++i) {
        at[i] = 0.5 - 0.5 * std::cos((static_cast<double>(i) + 0.5) * std::numbers::pi / count);
        newton[i] = value(begin + at[i] * (end - begin));
    }
    for (std::size_t level = 1; level < count; ++level)
        for (std::size_t i = count - 1; i >= level; --i)
            newton[i] = (newton[i] - newton[i - 1]) / (at[i] - at[i - level]);
    std::vector<double> c{newton[count - 1]};  // by powers of the way through the piece
    for (std::size_t k = count - 1; k-- > 0;) {
        c.insert(c.begin(), 0);
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= at[k] * c[i + 1];
        c[0] += newton[k];
    }
    while (c.size() > 1 && std::abs(c.back()) < 1e-10) c.pop_back();
    double power = 1;
    for (double& v : c) v /= power, power *= end - begin;
    return {begin, end, c};
}

/// Polynomials that follow a kernel between two of its knots to 3e-8 of its peak: a float knows no better.
void add_pieces(const Kernel& kernel, double begin, double end, KernelPieces& pieces) {
    constexpr int checks = 40;
    const KernelPiece piece = interpolated_piece(kernel.value, begin, end);
    double error = 0;
    for (int i = 0; i < checks; ++i) {
        const double x = begin + (end - begin) * (i + 0.5) / checks;
        error = std::max(error, std::abs(value_of({piece}, x) - kernel.value(x)));
    }
    if (error <= 3e-8 * std::abs(kernel.value(0))) return pieces.push_back(piece);
    if (end - begin < 1.0 / 64)
        fail("temporal_shader: ", kernel.name, " is too rough to become polynomials; pass e.g. gaussian or lanczos2");
    add_pieces(kernel, begin, (begin + end) / 2, pieces);
    add_pieces(kernel, (begin + end) / 2, end, pieces);
}

KernelPieces pieces_of(const Kernel& kernel) {
    std::vector<double> borders{0};
    for (const double knot : kernel.knots) borders.push_back(knot);
    borders.push_back(kernel.radius);
    KernelPieces pieces;
    for (std::size_t i = 1; i < borders.size(); ++i) add_pieces(kernel, borders[i - 1], borders[i], pieces);
    return pieces;
}

std::string kernel_source(const Kernel& kernel) {
    const double factor = gaussian_factor(kernel);
    return factor < 0 ? with(std::string(gaussian_weight), "FACTOR", number(factor))
                      : weight_function(pieces_of(kernel));
}

// ---- Reading the history

/// NAME_history_weights(x): the weights of four texels.
std::string history_weights_source(const TemporalOptions& o) {
    if (o.history_kernel == HistoryKernel::lanczos2) {
        if (o.kernel.name == "lanczos2") return with(std::string(lanczos_weights), "WEIGHT", "NAME_weight");
        return with(weight_function(pieces_of(lanczos(2))), "NAME_weight", "NAME_history_weight") +
               with(std::string(lanczos_weights), "WEIGHT", "NAME_history_weight");
    }
    const CubicPart& part = history_weights(o.history_kernel).front();
    std::string text = "function(float4, NAME_history_weights, in(float, x)) {\n    return float4(";
    for (std::size_t k = 0; k < 4; ++k) {
        KernelPiece piece{0, 1, {part[0][k], part[1][k], part[2][k], part[3][k]}};
        while (piece.coefficients.size() > 1 && piece.coefficients.back() == 0) piece.coefficients.pop_back();
        text += message(k == 0 ? "" : ",\n        ", polynomial(piece));
    }
    return text + ");\n}\n\n";
}

std::string past_source(const TemporalOptions& o) {
    std::string text(past_begin);
    if (o.history_kernel != HistoryKernel::bspline) text += past_exact;
    if (o.history_kernel == HistoryKernel::bilinear) return text.append(past_bilinear).append(past_end);
    const bool drops_corners = o.history_kernel == HistoryKernel::catmull_rom5;
    const std::string_view sum = drops_corners ? "            if (inner_x || inner_y) {\n"
                                                 "                sum += weights_x[i] * weights_y[j] * seen;\n"
                                                 "            }\n"
                                               : "            sum += weights_x[i] * weights_y[j] * seen;\n";
    return history_weights_source(o) + text + with(std::string(past_cubic), "SUM", sum) + std::string(past_end);
}

// ---- Putting it together

/// Calls of WORD become calls of `function`, or, if that is empty, their argument alone.
std::string with_call(std::string text, std::string_view word, std::string_view function) {
    if (!function.empty()) return with(std::move(text), word, function);
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
        const std::size_t open = at + word.size();
        std::size_t close = open;
        for (int depth = 0; close < text.size(); ++close) {
            depth += text[close] == '(' ? 1 : text[close] == ')' ? -1 : 0;
            if (depth == 0) break;
        }
        text.erase(close, 1);
        text.erase(at, word.size() + 1);
    }
    return text;
}

bool compares_depth(const TemporalOptions& o) { return std::isfinite(o.depth_tolerance); }
bool rectifies(const TemporalOptions& o) { return o.rectification != Rectification::none; }

std::string rectified_source(const TemporalOptions& o) {
    std::string text(o.rectifies_ycocg ? ycocg : "");
    const bool is_variance = o.rectification == Rectification::variance;
    text.append(rectified_begin).append(is_variance ? box_by_variance : box_by_range).append(rectified_beyond);
    text.append(o.rectification == Rectification::clip ? inside_by_clip : inside_by_channel).append(rectified_end);
    text = with_call(std::move(text), "YCOCG", o.rectifies_ycocg ? "NAME_ycocg" : "");
    return with_call(std::move(text), "RGB", o.rectifies_ycocg ? "NAME_rgb" : "");
}

std::string step_source(const TemporalOptions& o) {
    std::string text(step_begin);
    text = with(text, "BEFORE_PARAMETER", compares_depth(o) ? " texture(surface_before)," : "");
    text = with(text, "GUIDE", o.dilates_motion ? "NAME_guide(surface, near, last)" : "load(surface, near)");
    text.append("    var(float4, past) = NAME_past(history, frame, at, motion);\n").append(step_past);
    text += message(
        "    let(float, mismatch) = ",
        compares_depth(o) ? "NAME_mismatch(surface_before, frame, guide, load(surface, near).z, before)" : "0.0",
        ";\n");
    text += follow_exposure;
    if (rectifies(o) || o.forget_by_motion > 0) text += "    let(float, speed) = sqrt(dot(motion, motion));\n";
    text += "    var(float, memory) = past.w * (1.0 - FORGETTING * mismatch);\n";
    if (rectifies(o)) text += step_rectify;
    text += "    memory = memory * (1.0 - clamp(guide.w, 0.0, 1.0));\n";
    if (std::isfinite(o.still_frames)) {
        text +=
            "    let(float2, pitch) = frame.size / frame.result_size;\n    memory = min(memory, MOST * pitch.x * "
            "pitch.y";
        text += o.forget_by_motion > 0 ? " / (1.0 + FORGET_BY_MOTION * speed));\n" : ");\n";
    }
    const char* const frame = o.anti_flicker > 0 ? "NAME_steadiness(gathered, past) * gathered" : "gathered";
    return text + message("    return ", frame, " + memory / past.w * past;\n}\n\n");
}

std::string show_source(const TemporalOptions& o) {
    const bool derings = o.deringing_frames > 0;
    std::string text = with(std::string(show_begin), "LIMIT", derings ? deringing_limit : "");
    text = with(text, "SHOWN_ALONE", derings ? "max(ENOUGH, rings)" : "ENOUGH");
    return with(text, "DERINGED", derings ? deringed : "");
}

/// The constants of all parts.
std::string with_constants(std::string text, const TemporalOptions& o, double mean_weight) {
    const WeightLimits limits = weight_limits(o.kernel);
    const double box = o.rectification == Rectification::variance ? o.box_size : 1;
    const std::pair<const char*, double> constants[] = {{"RADIUS", o.kernel.radius},
                                                        {"PER_TOLERANCE", 1 / o.depth_tolerance},
                                                        {"VELOCITY_TOLERANCE", velocity_tolerance},
                                                        {"STILL_MOTION", still_motion},
                                                        {"LEAST_EXTENT", least_extent},
                                                        {"LEAST_LUMA", least_luma},
                                                        {"ANTI_FLICKER", o.anti_flicker},
                                                        {"DERINGING", o.deringing_frames * mean_weight},
                                                        {"LEAST", limits.least},
                                                        {"ENOUGH", limits.enough},
                                                        {"PER_TRUST", 1 / (limits.enough - limits.least)},
                                                        {"BOX_SIZE", box},
                                                        {"RECTIFY_SHARE", o.rectify_share},
                                                        {"FASTER", 1 / full_doubt_speed},
                                                        {"DOUBT", o.doubt},
                                                        {"FORGETTING", 1 - o.disocclusion_keep},
                                                        {"MOST", o.still_frames * mean_weight},
                                                        {"FORGET_BY_MOTION", o.forget_by_motion},
                                                        {"SHARPENING", o.sharpening}};
    for (const auto& [word, value] : constants) text = with(text, word, number(value, 7));
    text = with_call(std::move(text), "COMPRESSED", o.compresses_highlights ? "NAME_compressed" : "");
    return with_call(std::move(text), "RESTORED", o.compresses_highlights ? "NAME_restored" : "");
}

std::string source_of(const TemporalOptions& o, double mean_weight) {
    std::string text(textures);
    if (compares_depth(o)) text += texture_before;
    text += frame_begin;
    if (compares_depth(o)) text += frame_before;
    text.append(frame_end).append(kernel_source(o.kernel));
    if (o.compresses_highlights) text += highlights;
    text.append(reads).append(gather);
    if (o.dilates_motion) text += guide;
    text += past_source(o);
    if (compares_depth(o)) text += mismatch;
    if (rectifies(o)) text += rectified_source(o);
    if (o.anti_flicker > 0) text += steadiness;
    text.append(step_source(o)).append(show_source(o));
    if (o.sharpening > 0) text += sharpening;
    return with_constants(text, o, mean_weight);
}

std::string cost_of(const TemporalOptions& o) {
    const double samples = 4 * o.kernel.radius * o.kernel.radius;
    std::string text =
        message("reads per pixel: about ", number(samples, 3), " / scale^2 of color, ", o.dilates_motion ? 10 : 1,
                " of surface, ", o.history_kernel == HistoryKernel::bilinear ? 4 : 16, " of history");
    if (compares_depth(o)) text += ", 5 of surface_before";
    if (rectifies(o)) text += ", 9 of color where something moves";
    if (o.sharpening > 0) text += "; NAME_sharpen 5";
    return text;
}

}  // namespace

std::string temporal_shader(const TemporalOptions& options, const ShaderInfo& info, Dialect dialect) {
    check_options(options);
    if (options.rule != Accumulation::weighted)
        fail("temporal_shader: only the rule `weighted` has a shader; pass e.g. temporal_preset(\"balanced\")");
    if (options.lock_frames > 0) fail("temporal_shader: locks have no shader; pass lock_frames = 0");
    const double mean_weight = frame_gather(options.kernel, false, 8, 8, 8, 8, {}).mean_weight;  // at 1x
    const Header header{options.sharpening > 0
                            ? "Antialiasing and upscaling over time. NAME_step makes the next history, NAME_show the "
                              "picture that it shows, which NAME_sharpen sharpens in a pass of its own."
                            : "Antialiasing and upscaling over time. NAME_step makes the next history, NAME_show the "
                              "picture that it shows.",
                        with(cost_of(options), "NAME", info.name), Header::Reads::own};
    return shader_text(info, header, with(source_of(options, mean_weight), "NAME", info.name), dialect);
}

}  // namespace bandlimit
