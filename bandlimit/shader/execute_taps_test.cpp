// Emitted compute shaders, executed, and compared with the engine that runs the same taps on the CPU.
#include <gtest/gtest.h>

#include <cstdio>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/shader/compilers_test.h"
#include "bandlimit/shader/library_test.h"
#include "bandlimit/shader/need_test.h"
#include "bandlimit/shader/shader.h"
#include "bandlimit/shader/vulkan_test.h"
#include "bandlimit/shader/wgpu_test.h"

namespace bandlimit::test {
namespace {

constexpr int source_width = 61, source_height = 37;

const Picture& source() {
    static const Picture picture = procedural(source_width, source_height, 1);
    return picture;
}

/// Taps without symmetry, for 1, 2 and 9 texels per output; the last need a vertical group of fewer columns.
const std::vector<Taps>& all_taps() {
    static const std::vector<Taps> taps{
        {-2, {0.1, 0.3, 0.45, 0.25, -0.1}, 1},
        {-1, {-0.05, 0.5, 0.4, 0.15}, 2},
        {-3, {-0.1, 0.05, 0.1, 0.3, 0.1, 0.05, 0.15, 0.1, 0.2, 0.05, 0.1, 0.05, -0.15}, 9}};
    return taps;
}

ShaderInfo named(std::size_t i, PassDirection direction) {
    return {message("taps_", i, direction == PassDirection::horizontal ? "_horizontal" : "_vertical"), "a test", {}};
}

/// A compute shader of taps, what it runs on, and what the engine makes of the same.
struct TapsRun {
    std::size_t index;
    PassDirection direction;
    Edge edge;

    const Taps& taps() const { return all_taps()[index]; }
    bool horizontal() const { return direction == PassDirection::horizontal; }

    Dispatch dispatch(Dialect dialect, const std::string& text, const std::string& entry) const {
        // The comment says what a workgroup makes.
        int x = 0, y = 0;
        const std::size_t at = text.find("one for each");
        std::string words;
        for (const char c : text.substr(at + 12, 40)) words += c == '/' || c == '\n' ? ' ' : c;
        if (at == std::string::npos || std::sscanf(words.c_str(), " %d x %d", &x, &y) != 2) ADD_FAILURE() << text;
        const int w = horizontal() ? source_width / taps().factor : source_width;
        const int h = horizontal() ? source_height : source_height / taps().factor;
        return {.entry = entry,
                .combined = dialect == Dialect::glsl,
                .edge = edge,
                .textures = {&source()},
                .width = w,
                .height = h,
                .groups_x = (w + x - 1) / x,
                .groups_y = (h + y - 1) / y,
                .half_result = dialect != Dialect::hlsl};
    }

    /// The engine's result, from which the shader may be off by rounding to half and by what the sampler reads beside
    /// the centre of a texel.
    void expect_right(const std::vector<float>& result, const Dispatch& d, const std::string& where) const {
        Image<float> in(source_width, source_height, 4, Layout::interleaved), out(d.width, d.height, 4);
        std::copy(source().texels.begin(), source().texels.end(), in.view().data);
        const Bank bank = make_bank(taps(), horizontal() ? source_width : source_height, edge);
        const View<const float> from = std::as_const(in).view();
        if (horizontal()) apply(bank, from, out.view());
        else apply(bank, transposed(from), transposed(out.view()));
        double worst = 0;
        for (int y = 0; y < d.height; ++y)
            for (int x = 0; x < d.width; ++x)
                for (int c = 0; c < 4; ++c)
                    worst = std::max(
                        worst, std::abs(double(out.view()(x, y, c)) - result[std::size_t((y * d.width + x) * 4 + c)]));
        EXPECT_LE(worst, 0x1p-11 + 4e-4) << where << ": taps " << index << (horizontal() ? " horizontal" : " vertical")
                                         << ", edge " << name_of(edge);
    }
};

/// All taps both ways, with edges in turn: what drivers compile for an edge takes longer than to run it.
std::vector<TapsRun> taps_runs(std::size_t edges) {
    std::vector<TapsRun> runs;
    for (std::size_t i = 0; i < all_taps().size(); ++i)
        for (const PassDirection d : {PassDirection::horizontal, PassDirection::vertical})
            runs.push_back({i, d, sampler_edges[runs.size() % edges]});
    return runs;
}

void execute_taps_by(Compiler compiler, Dialect dialect) {
    BANDLIMIT_NEED(missing(compiler));
    BANDLIMIT_NEED(Vulkan::missing());
    const Vulkan vulkan;
    for (const TapsRun& run : taps_runs(4)) {
        const ShaderInfo info = named(run.index, run.direction);
        const std::string text = compute_shader(run.taps(), run.direction, info, dialect);
        const std::string entry = dialect == Dialect::glsl || compiler == Compiler::slang ? "main" : info.name;
        const Dispatch dispatch = run.dispatch(dialect, text, entry);
        run.expect_right(vulkan.run(compile(compiler, dialect, text, info.name), dispatch), dispatch, vulkan.device());
    }
}

TEST(ExecuteTaps, GlslByGlslang) { execute_taps_by(Compiler::glslang, Dialect::glsl); }
TEST(ExecuteTaps, HlslByGlslang) { execute_taps_by(Compiler::glslang, Dialect::hlsl); }
TEST(ExecuteTaps, SlangBySlang) { execute_taps_by(Compiler::slang, Dialect::slang); }

TEST(ExecuteTaps, WgslByWgpu) {
    BANDLIMIT_NEED(missing_wgpu());
    BANDLIMIT_NEED(Vulkan::missing());
    const std::vector<TapsRun> runs = taps_runs(3);
    std::vector<WgpuJob> jobs;
    for (const TapsRun& run : runs) {
        const ShaderInfo info = named(run.index, run.direction);
        const std::string text = compute_shader(run.taps(), run.direction, info, Dialect::wgsl);
        jobs.push_back({text, run.dispatch(Dialect::wgsl, text, info.name)});
    }
    const std::vector<std::vector<float>> results = run_by_wgpu(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) runs[i].expect_right(results[i], jobs[i].dispatch, "wgpu");
}

/// No compiler of Metal runs here: a C++ compiler reads the text, by a header that stands in for Metal's.
TEST(CompileTaps, MetalAsCpp) {
    if (is_sanitized) GTEST_SKIP() << "not under sanitizers, which a library without them cannot be loaded into";
    std::string text;
    for (std::size_t i = 0; i < all_taps().size(); ++i)
        for (const PassDirection d : {PassDirection::horizontal, PassDirection::vertical})
            text += compute_shader(all_taps()[i], d, named(i, d), Dialect::msl);
    EXPECT_NO_THROW(Library(Dialect::msl, text, {"source.sample(source_sampler, uv, level(0.0f))"}));
}

}  // namespace
}  // namespace bandlimit::test
