#include "bandlimit/shader/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/shader/text.h"

namespace bandlimit {
namespace {

// ---- The neutral source. Positions count texels; texel i of an axis lies at i + 1/2.

/// `base` is the texel at or before uv, `t` how far uv lies from there to the next, `s` the rest of the way.
constexpr std::string_view between_texels = R"(
    let(float2, position) = uv / texel - 0.5;
    let(float2, base) = floor(position);
    let(float2, t) = position - base;
    let(float2, s) = 1.0 - t;
)";

constexpr std::string_view function_2d =
    "function(float4, NAME, texture(source), sampler(source_sampler), in(float2, uv), in(float2, texel)) {";

/// Weights of the texels base - 1 and base, and, mirrored, of base + 2 and base + 1.
constexpr std::string_view bspline_weights =
    R"(    // Texels base - 1 and base in one read, base + 1 and base + 2 in another.
    let(float2, w0) = s * s * s / 6.0;
    let(float2, w3) = t * t * t / 6.0;
    let(float2, low) = w0 + (4.0 - 3.0 * t * t * (1.0 + s)) / 6.0;
    let(float2, high) = 1.0 - low;
    let(float2, a) = (base + 0.5 - w0 / low) * texel;
    let(float2, b) = (base + 1.5 + w3 / high) * texel;
)";

constexpr std::string_view four_reads = R"(    return low.y * (low.x * sample(source, source_sampler, float2(a.x, a.y))
            + high.x * sample(source, source_sampler, float2(b.x, a.y)))
        + high.y * (low.x * sample(source, source_sampler, float2(a.x, b.y))
            + high.x * sample(source, source_sampler, float2(b.x, b.y)));
}
)";

constexpr std::string_view bspline_1d =
    R"(function(float4, NAME, texture(source), sampler(source_sampler), in(float2, uv), in(float2, texel), in(float2, axis)) {
    let(float, position) = dot(uv / texel, axis) - 0.5;
    let(float, t) = position - floor(position);
    let(float, s) = 1.0 - t;
    let(float, w0) = s * s * s / 6.0;
    let(float, w3) = t * t * t / 6.0;
    let(float, low) = w0 + (4.0 - 3.0 * t * t * (1.0 + s)) / 6.0;
    let(float, high) = 1.0 - low;
    let(float2, along) = axis * texel;
    return low * sample(source, source_sampler, uv - (t + w0 / low) * along)
        + high * sample(source, source_sampler, uv + (s + w3 / high) * along);
}
)";

constexpr std::string_view quadratic = R"(
    // Two reads an axis, between the nearest texel and those beside it.
    let(float2, position) = uv / texel;
    let(float2, base) = floor(position);
    let(float2, high) = position - base;
    let(float2, low) = 1.0 - high;
    let(float2, a) = (base + 0.5 * high) * texel;
    let(float2, b) = (base + 0.5 + 0.5 * high) * texel;
)";

constexpr std::string_view catmull_rom_weights = R"(    let(float2, w0) = -0.5 * t * s * s;
    let(float2, w1) = 1.0 + t * t * (1.5 * t - 2.5);
    let(float2, w2) = 1.0 + s * s * (1.5 * s - 2.5);
    let(float2, w3) = -0.5 * s * t * t;
)";

constexpr std::string_view mitchell_weights = R"(    let(float2, w0) = s * s * (7.0 * s - 6.0) / 18.0;
    let(float2, w1) = (16.0 + t * t * (21.0 * t - 36.0)) / 18.0;
    let(float2, w2) = (16.0 + s * s * (21.0 * s - 36.0)) / 18.0;
    let(float2, w3) = t * t * (7.0 * t - 6.0) / 18.0;
)";

/// sinc(x) sinc(x / 2) at the four distances is, but for a factor that they share and that the sum removes, cos(h) / (1
/// + t)^2, sin(h) / t^2, ... with h = pi t / 2. Times t^2 s^2 nothing is divided by 0. P(t) = sin(pi t / 2) / t.
constexpr std::string_view lanczos2_weights =
    R"(    // sinc(x) sinc(x / 2), normalised, without sines: p is sin(pi t / 2) / t and q is sin(pi s / 2) / s, to 1e-7.
    let(float2, tt) = t * t;
    let(float2, ss) = s * s;
    let(float2, p) = SINE_OF_TT;
    let(float2, q) = SINE_OF_SS;
    let(float2, v0) = -t * ss * q / ((1.0 + t) * (1.0 + t));
    let(float2, v1) = s * p;
    let(float2, v2) = t * q;
    let(float2, v3) = -s * tt * p / ((1.0 + s) * (1.0 + s));
    let(float2, total) = v0 + v1 + v2 + v3;
    let(float2, w0) = v0 / total;
    let(float2, w1) = v1 / total;
    let(float2, w2) = v2 / total;
    let(float2, w3) = v3 / total;
)";

/// The two texels in the middle, whose weights have one sign, in one read.
constexpr std::string_view three_places = R"(    // The two texels in the middle in one read.
    let(float2, w12) = w1 + w2;
    let(float2, a) = (base - 0.5) * texel;
    let(float2, b) = (base + 0.5 + w2 / w12) * texel;
    let(float2, c) = (base + 2.5) * texel;
)";

constexpr std::string_view nine_reads = R"(    return w0.y * (w0.x * sample(source, source_sampler, float2(a.x, a.y))
            + w12.x * sample(source, source_sampler, float2(b.x, a.y))
            + w3.x * sample(source, source_sampler, float2(c.x, a.y)))
        + w12.y * (w0.x * sample(source, source_sampler, float2(a.x, b.y))
            + w12.x * sample(source, source_sampler, float2(b.x, b.y))
            + w3.x * sample(source, source_sampler, float2(c.x, b.y)))
        + w3.y * (w0.x * sample(source, source_sampler, float2(a.x, c.y))
            + w12.x * sample(source, source_sampler, float2(b.x, c.y))
            + w3.x * sample(source, source_sampler, float2(c.x, c.y)));
}
)";

constexpr std::string_view five_reads =
    R"(    // Without the corners, whose weights are small; the others are scaled to sum 1.
    let(float, sides) = w12.x * w12.y + w12.y * (w0.x + w3.x) + w12.x * (w0.y + w3.y);
    return (w12.x * w0.y * sample(source, source_sampler, float2(b.x, a.y))
        + w12.y * (w0.x * sample(source, source_sampler, float2(a.x, b.y))
            + w12.x * sample(source, source_sampler, float2(b.x, b.y))
            + w3.x * sample(source, source_sampler, float2(c.x, b.y)))
        + w12.x * w3.y * sample(source, source_sampler, float2(b.x, c.y))) / sides;
}
)";

/// Three texels an axis around the nearest, at its centre and one to each side; reads a, b and c with w0, w12 and w3.
constexpr std::string_view quadratic_interp = R"(
    let(float2, position) = uv / texel;
    let(float2, base) = floor(position);
    let(float2, t) = position - base - 0.5;
    let(float2, w0) = t * (t - 0.5);
    let(float2, w12) = 1.0 - 2.0 * t * t;
    let(float2, w3) = t * (t + 0.5);
    let(float2, a) = (base - 0.5) * texel;
    let(float2, b) = (base + 0.5) * texel;
    let(float2, c) = (base + 1.5) * texel;
)";

constexpr std::string_view jinc2 = R"(
    let(float2, position) = uv / texel - 0.5;
    let(float2, base) = floor(position);
    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);
    var(float, total) = 0.0;
    loop(y, -2, 4, 1) {
        loop(x, -2, 4, 1) {
            let(float2, at) = base + float2(float(x), float(y));
            let(float2, away) = at - position;
            // The table has the kernel over the squared distance; its last two entries are 0, as all beyond.
            let(float, place) = min(dot(away, away) * SCALE, LAST);
            let(int, i) = int(place);
            let(float, low) = NAME_table[i];
            let(float, weight) = low + (place - float(i)) * (NAME_table[i + 1] - low);
            sum += weight * sample(source, source_sampler, (at + 0.5) * texel);
            total += weight;
        }
    }
    return sum / total;
}
)";

constexpr std::string_view pieces = R"(
    let(float2, position) = uv / texel - 0.5;
    let(float2, base) = floor(position);
    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);
    var(float, total) = 0.0;
    loop(y, FROM, TO, 1) {
        let(float, weight_y) = NAME_weight(base.y + float(y) - position.y);
        loop(x, FROM, TO, 1) {
            let(float2, at) = base + float2(float(x), float(y));
            let(float, weight) = weight_y * NAME_weight(at.x - position.x);
            sum += weight * sample(source, source_sampler, (at + 0.5) * texel);
            total += weight;
        }
    }
    return sum / total;
}
)";

constexpr std::string_view srgb = R"(function(float, srgb_from_linear_channel, in(float, v)) {
    return choose(v <= 0.0031308, 12.92 * v, 1.055 * pow(max(v, 0.0031308), 0.416666667) - 0.055);
}

function(float, linear_from_srgb_channel, in(float, v)) {
    return choose(v <= 0.04045, v / 12.92, pow((max(v, 0.04045) + 0.055) / 1.055, 2.4));
}

function(float4, srgb_from_linear, in(float4, colour)) {
    return float4(srgb_from_linear_channel(colour.x), srgb_from_linear_channel(colour.y),
        srgb_from_linear_channel(colour.z), colour.w);
}

function(float4, linear_from_srgb, in(float4, colour)) {
    return float4(linear_from_srgb_channel(colour.x), linear_from_srgb_channel(colour.y),
        linear_from_srgb_channel(colour.z), colour.w);
}
)";

// ---- Putting it together

std::string joined(std::initializer_list<std::string_view> parts) {
    std::string out;
    for (const std::string_view part : parts) out += part;
    return out;
}

/// sin(pi x / 2) / x as a polynomial of x^2 = `variable`, in Horner's form: the Taylor series, whose sixth term is
/// below 4e-6 and seventh below 6e-8 for x <= 1.
std::string sine_over(const std::string& variable) {
    constexpr int terms = 7;
    std::array<double, terms> c{};
    c[0] = std::numbers::pi / 2;
    for (std::size_t k = 1; k < terms; ++k) {
        const auto n = static_cast<double>(2 * k);
        c[k] = -c[k - 1] * (std::numbers::pi * std::numbers::pi / 4) / (n * (n + 1));
    }
    std::string text = number(c[terms - 1]);
    for (std::size_t k = terms - 1; k-- > 0;) {
        text = message(number(c[k]), " + ", variable, " * ", "(", text, ")");
    }
    return text;
}

constexpr int jinc_intervals = 256;

/// The kernel over the squared distance, from 0 to the square of its radius, and two zeros at the end.
std::string jinc2_source() {
    const Kernel kernel = jinc_lanczos(2);
    const double squared = kernel.radius * kernel.radius;
    std::string table = message("table(float, NAME_table, ", jinc_intervals + 2, ",");
    for (int i = 0; i <= jinc_intervals + 1; ++i) {
        const double value = i < jinc_intervals ? kernel.value(std::sqrt(squared * i / jinc_intervals)) : 0.0;
        table += message(i == 0 ? "" : ",", i % 6 == 0 ? "\n    " : " ", number(value));
    }
    std::string body = with(std::string(jinc2), "SCALE", number(jinc_intervals / squared));
    body = with(body, "LAST", number(jinc_intervals));
    return joined({table, ");\n\n", function_2d, body});
}

std::string source_of(std::string_view name) {
    const auto lanczos2 = [] {
        const std::string text = with(std::string(lanczos2_weights), "SINE_OF_TT", sine_over("tt"));
        return with(text, "SINE_OF_SS", sine_over("ss"));
    };
    if (name == "sample_bspline") return joined({function_2d, between_texels, bspline_weights, four_reads});
    if (name == "sample_bspline_1d") return std::string(bspline_1d);
    if (name == "sample_quadratic") return joined({function_2d, quadratic, four_reads});
    if (name == "sample_quadratic_interp") return joined({function_2d, quadratic_interp, nine_reads});
    if (name == "sample_catmull_rom")
        return joined({function_2d, between_texels, catmull_rom_weights, three_places, nine_reads});
    if (name == "sample_catmull_rom_5")
        return joined({function_2d, between_texels, catmull_rom_weights, three_places, five_reads});
    if (name == "sample_mitchell")
        return joined({function_2d, between_texels, mitchell_weights, three_places, nine_reads});
    if (name == "sample_lanczos2") return joined({function_2d, between_texels, lanczos2(), three_places, nine_reads});
    if (name == "sample_jinc2") return jinc2_source();
    return std::string(srgb);
}

constexpr KernelShader shaders[] = {
    {"sample_bspline", "bspline", "cubic B-spline, smooth and blurring", "4 bilinear reads"},
    {"sample_bspline_1d", "bspline", "cubic B-spline along one axis, (1, 0) or (0, 1)", "2 bilinear reads"},
    {"sample_quadratic", "quadratic", "quadratic B-spline, smooth, blurs less than the cubic", "4 bilinear reads"},
    {"sample_quadratic_interp", "quadratic-interp", "Dodgson's interpolating quadratic",
     "9 reads at centres of texels"},
    {"sample_catmull_rom", "catmull-rom", "Catmull-Rom, interpolating and sharp", "9 bilinear reads"},
    {"sample_catmull_rom_5", "catmull-rom", "Catmull-Rom without its corners, not quite interpolating diagonals",
     "5 bilinear reads"},
    {"sample_mitchell", "mitchell", "Mitchell and Netravali's cubic, between blur and ringing", "9 bilinear reads"},
    {"sample_lanczos2", "lanczos2", "Lanczos-2, normalised", "9 bilinear reads"},
    {"sample_jinc2", "jinc2", "radial Lanczos-2 of jincs, normalised, by a table over the squared distance",
     "36 reads at centres of texels"},
    {"srgb", "", "the sRGB curve, exact in two pieces, and its inverse; alpha stays", "a power per channel"},
};

}  // namespace

std::span<const KernelShader> kernel_shaders() { return shaders; }

std::string kernel_shader(std::string_view name, const std::string& command, Dialect dialect) {
    const auto found =
        std::find_if(std::begin(shaders), std::end(shaders), [&](const KernelShader& s) { return s.name == name; });
    if (found == std::end(shaders)) {
        std::string known;
        for (const KernelShader& s : shaders) known += message(known.empty() ? "" : ", ", s.name);
        fail("kernel_shader: there is no \"", name, "\"; pass one of ", known);
    }
    const Header header{std::string(found->summary) + ".", std::string(found->cost),
                        found->kernel.empty() ? Header::Reads::colours : Header::Reads::samples};
    const ShaderInfo info{std::string(name), command, {}};
    return shader_text(info, header, with(source_of(name), "NAME", name), dialect);
}

std::string pieces_shader(const KernelPieces& kernel, const ShaderInfo& info, Dialect dialect) {
    constexpr double largest_radius = 16;
    const double radius = piecewise_kernel(kernel, info.name).radius;
    if (radius > largest_radius)
        fail("pieces_shader: a kernel of radius ", radius, " reads too many texels; pass at most ", largest_radius);
    const int reach = static_cast<int>(std::ceil(radius)), reads = 4 * reach * reach;
    const Header header{"A kernel of polynomial pieces that reads a picture anywhere between its texels.",
                        message(reads, " reads at centres of texels, and their weights, of ", kernel.size(),
                                " polynomials along each axis"),
                        Header::Reads::samples};
    std::string source = joined({weight_function(kernel), function_2d, pieces});
    source = with(with(source, "FROM", message(1 - reach)), "TO", message(reach + 1));
    return shader_text(info, header, with(source, "NAME", info.name), dialect);
}

}  // namespace bandlimit
