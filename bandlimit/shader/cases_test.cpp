#include "bandlimit/shader/cases_test.h"

#include "bandlimit/color/transfer.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/shader/kernels.h"
#include "bandlimit/shader/shader.h"

namespace bandlimit::test {
namespace {

constexpr double rounding = 0x1p-23;  // of one operation; values are below 1

// ---- What is emitted. The weights are no filter's: nothing about them is symmetric, so that no swap goes unseen.

const Fetches& few_reads() {
    static const Fetches reads{{0.75, 0.5, 0.5}, {-1.25, -0.2, 0.375}, {2.1, -1.6, -0.25}, {-0.4, 3.3, 0.375}};
    return reads;
}

/// More reads than are written one by one.
const Fetches& many_reads() {
    static const Fetches reads = [] {
        Fetches out;
        for (int i = 0; i < 70; ++i) out.push_back({0.31 * (i % 9) - 1.2, 0.27 * (i % 7) - 0.7, (i % 5 - 1.5) / 60.0});
        return out;
    }();
    return reads;
}

const std::vector<LinearRead>& line_reads() {
    static const std::vector<LinearRead> reads{{-2.3, 0.125}, {-0.4, 0.5}, {1, 0.3125}, {2.2, 0.0625}};
    return reads;
}

const WeightGrid& grid() {
    static const WeightGrid weights = [] {
        WeightGrid w(4, 3);
        for (int i = 0; i < 12; ++i) w.weights[static_cast<std::size_t>(i)] = (i * 7 % 12 - 3) / 30.0;
        return w;
    }();
    return weights;
}

const Terms& pair_of_terms() {
    static const Terms terms{{{0.1, 0.5, 0.4}, {0.3, 0.2, 0.1, 0.4, -0.1}},
                             {{-0.2, 0.6, 0.1}, {0.5, -0.3, 0.2, 0.1, 0.3}}};
    return terms;
}

const Components& phasor() {
    static const Components components{{0.862325, 1.624835, 0.767583, 1.862321}};
    return components;
}

Terms phasor_terms() { return with_unit_sum(separable_terms(phasor(), 4, 6)); }

/// A parabola, then straight down to 0 at 2: not smooth, nor of sum 1 at every phase.
KernelPieces two_pieces() { return {{0, 0.75, {1, 0, -0.5}}, {0.75, 2, {0.71875, -0.575}}}; }

// ---- What they must return

Expected sum_of_reads(const Fetches& reads, const Picture& picture, const Place& at) {
    Expected out;
    double absolute = 0;
    const double off = at.precision.fraction + at.precision.coordinate;
    for (const Fetch& r : reads) {
        add(out.value, r.weight, bilinear(picture, at.edge, at.x + r.x, at.y + r.y));
        out.bound += std::abs(r.weight) * off * slope(picture, at.edge, at.x + r.x, at.y + r.y, 1);
        absolute += std::abs(r.weight);
    }
    out.bound += (static_cast<double>(reads.size()) + 4) * rounding * absolute;
    return out;
}

Fetches along(const std::vector<LinearRead>& reads, bool x) {
    Fetches out;
    for (const LinearRead& r : reads) out.push_back({x ? r.offset : 0, x ? 0 : r.offset, r.weight});
    return out;
}

Fetches along(const std::vector<double>& weights, bool x) {
    std::vector<LinearRead> reads;
    for (std::size_t i = 0; i < weights.size(); ++i)
        reads.push_back({centred_first(static_cast<int>(weights.size())) + static_cast<double>(i), weights[i]});
    return along(reads, x);
}

/// The texels within 3 of (x, y), weighted by `weight` of their distances and normalised.
Expected weighted(const Place& at, const std::function<double(double, double)>& weight) {
    const Axis across{at.source.width, 0, double(at.source.width)}, down{at.source.height, 0, double(at.source.height)};
    const int i0 = static_cast<int>(std::floor(across.index(at.x))),
              j0 = static_cast<int>(std::floor(down.index(at.y)));
    Colour sum{};
    double total = 0, absolute = 0;
    for (int j = j0 - 3; j <= j0 + 4; ++j)
        for (int i = i0 - 3; i <= i0 + 4; ++i) {
            const double w = weight(across.position(i) - at.x, down.position(j) - at.y);
            add(sum, w, at.source.texel(i, j, at.edge));
            total += w, absolute += std::abs(w);
        }
    Expected out;
    add(out.value, 1 / total, sum);
    // Reads that are off move what they read; weights of a position that is off change by at most 5 in sum per texel,
    // and what they weigh differs by three slopes at most.
    const double s = absolute / std::abs(total), steep = slope(at.source, at.edge, at.x, at.y, 3);
    out.bound = steep * (s * (at.precision.fraction + at.precision.coordinate) + 15 * at.precision.coordinate) +
                60 * rounding * s;
    return out;
}

Expected separable(const Place& at, const Kernel& kernel) {
    return weighted(at, [&](double dx, double dy) { return kernel.value(dx) * kernel.value(dy); });
}

/// Catmull-Rom without the four corners, each axis normalised as it is anyway.
Expected without_corners(const Place& at) {
    const Kernel kernel = catmull_rom();
    return weighted(at, [&](double dx, double dy) {
        return std::abs(dx) > 1 && std::abs(dy) > 1 ? 0.0 : kernel.value(dx) * kernel.value(dy);
    });
}

/// Only the texels of one row or column count, but read between rows or columns: this is a kernel times a tent.
Expected along_axis(const Place& at, const Kernel& kernel, bool x) {
    const Kernel linear = tent();
    return weighted(at, [&](double dx, double dy) {
        return x ? kernel.value(dx) * linear.value(dy) : linear.value(dx) * kernel.value(dy);
    });
}

/// The kernel over the squared distance as 256 straight pieces.
double jinc2_by_table(double squared) {
    static const Kernel kernel = jinc_lanczos(2);
    static const double end = kernel.radius * kernel.radius;
    const double place = squared / end * 256;
    if (place >= 256) return 0;
    const auto at = [](double i) { return i >= 256 ? 0 : kernel.value(std::sqrt(end * i / 256)); };
    const double i = std::floor(place);
    return at(i) + (place - i) * (at(i + 1) - at(i));
}

Expected loaded(const Place& at) {
    const WeightGrid& weights = grid();
    const int i0 = static_cast<int>(std::floor(at.x)) + centred_first(weights.width);
    const int j0 = static_cast<int>(std::floor(at.y)) + centred_first(weights.height);
    Expected out;
    for (int j = 0; j < weights.height; ++j)
        for (int i = 0; i < weights.width; ++i)
            add(out.value, weights.at(i, j), at.source.texel(i0 + i, j0 + j, Edge::clamp));
    // Which texel holds a place at the border of two is open.
    const double border = std::min(std::abs(at.x - std::round(at.x)), std::abs(at.y - std::round(at.y)));
    out.bound = border < 2 * at.precision.coordinate ? 10 : 20 * rounding;
    return out;
}

/// A curve over a plain read. Its power may be off by 6e-6: of Vulkan's, log2 of down to 2^-9 and exp2, times 2.4.
Expected curved(const Place& at, double (*curve)(double), double steepest) {
    Expected out = sum_of_reads({{0, 0, 1}}, at.source, at);
    for (std::size_t c = 0; c < 3; ++c) out.value[c] = curve(out.value[c]);
    out.bound = steepest * out.bound + 6e-6;
    return out;
}

std::vector<Case> make_cases() {
    std::vector<Case> cases;
    const auto reads = [&](const char* name, const char* call, const Fetches& list) {
        cases.push_back({name, call, [list](const Place& at) { return sum_of_reads(list, at.source, at); }});
    };
    const auto kernel = [&](const char* name, std::function<Expected(const Place&)> expected) {
        cases.push_back({name, std::string(name) + "(source@, uv, texel)", std::move(expected)});
    };
    reads("plain", "sample(source, source_sampler, uv)", {{0, 0, 1}});
    reads("few", "few(source@, uv, texel)", few_reads());
    reads("many", "many(source@, uv, texel)", many_reads());
    reads("line_horizontal", "line_horizontal(source@, uv, texel)", along(line_reads(), true));
    reads("line_vertical", "line_vertical(source@, uv, texel)", along(line_reads(), false));
    reads("pair_rows 0", "pair_rows(source@, uv, texel).part0", along(pair_of_terms()[0].row, true));
    reads("pair_rows 1", "pair_rows(source@, uv, texel).part1", along(pair_of_terms()[1].row, true));
    reads("phasor_rows 1", "phasor_rows(source@, uv, texel).part1", along(phasor_terms()[1].row, true));
    const auto columns = [&](const char* name, const Terms& terms) {
        cases.push_back({name, std::string(name) + "(source, other@, uv, texel)", [terms](const Place& at) {
                             Expected sum = sum_of_reads(along(terms[0].column, false), at.source, at);
                             const Expected more = sum_of_reads(along(terms[1].column, false), at.other, at);
                             add(sum.value, 1, more.value);
                             sum.bound += more.bound + rounding;
                             return sum;
                         }});
    };
    columns("pair_columns", pair_of_terms());
    columns("phasor_columns", phasor_terms());
    cases.push_back({"grid", "grid(source, uv, texel)", loaded});
    for (const KernelShader& s : kernel_shaders()) {
        if (s.kernel.empty() || s.name == "sample_catmull_rom_5" || s.name == "sample_bspline_1d" ||
            s.name == "sample_jinc2")
            continue;
        const Kernel k = parse_kernel(s.kernel);
        kernel(std::string(s.name).c_str(), [k](const Place& at) { return separable(at, k); });
    }
    kernel("fitted", [k = piecewise_kernel(two_pieces(), "fitted")](const Place& at) { return separable(at, k); });
    kernel("sample_catmull_rom_5", without_corners);
    kernel("sample_jinc2", [](const Place& at) {
        return weighted(at, [](double dx, double dy) { return jinc2_by_table(dx * dx + dy * dy); });
    });
    cases.push_back({"sample_bspline_1d x", "sample_bspline_1d(source@, uv, texel, float2(1.0, 0.0))",
                     [](const Place& at) { return along_axis(at, bspline(), true); }});
    cases.push_back({"sample_bspline_1d y", "sample_bspline_1d(source@, uv, texel, float2(0.0, 1.0))",
                     [](const Place& at) { return along_axis(at, bspline(), false); }});
    cases.push_back({"srgb_from_linear", "srgb_from_linear(sample(source, source_sampler, uv))",
                     [](const Place& at) { return curved(at, linear_to_srgb, 12.92); }});
    cases.push_back({"linear_from_srgb", "linear_from_srgb(sample(source, source_sampler, uv))",
                     [](const Place& at) { return curved(at, srgb_to_linear, 2.3); }});
    for (Case& c : cases)
        for (const char* name : {"plain", "few", "pair_columns", "grid", "sample_jinc2"})
            c.at_all_edges = c.at_all_edges || c.name == name;
    return cases;
}

}  // namespace

std::string functions_of_all_cases(Dialect dialect) {
    std::string text = fetch_shader(few_reads(), {"few"}, dialect) + fetch_shader(many_reads(), {"many"}, dialect) +
                       separable_shader(line_reads(), {"line"}, dialect) +
                       low_rank_shader(pair_of_terms(), {"pair"}, dialect) +
                       low_rank_shader(phasor_terms(), {"phasor"}, dialect) + load_shader(grid(), {"grid"}, dialect) +
                       pieces_shader(two_pieces(), {"fitted"}, dialect);
    for (const KernelShader& s : kernel_shaders()) text += kernel_shader(s.name, "a test", dialect);
    return text;
}

const std::vector<Case>& all_cases() {
    static const std::vector<Case> cases = make_cases();
    return cases;
}

}  // namespace bandlimit::test
