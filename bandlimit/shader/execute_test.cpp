// Emitted shaders, compiled, executed, and compared with what an exact sampler and exact kernels give.
#include <gtest/gtest.h>

#include "bandlimit/core/error.h"
#include "bandlimit/shader/cases_test.h"
#include "bandlimit/shader/compilers_test.h"
#include "bandlimit/shader/library_test.h"
#include "bandlimit/shader/need_test.h"
#include "bandlimit/shader/shader.h"
#include "bandlimit/shader/text.h"
#include "bandlimit/shader/vulkan_test.h"
#include "bandlimit/shader/wgpu_test.h"

namespace bandlimit::test {
namespace {

// Odd sizes of source and result, which share no factor; each case has a band of the result.
constexpr int source_width = 61, source_height = 37, width = 43, height = 29;
// From outside the source on one side to outside on the other, so that edges are read far beyond where taps reach.
constexpr double first_uv = -0.3, step_x = 1.6 / width, step_y = 1.6 / height;

const Picture& source() {
    static const Picture picture = procedural(source_width, source_height, 1);
    return picture;
}

const Picture& other() {
    static const Picture picture = procedural(source_width, source_height, 2);
    return picture;
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
    return text;
}

std::string call_of(const Case& c, Dialect dialect) {
    const bool apart = dialect != Dialect::glsl && dialect != Dialect::cpp;
    return replaced(c.call, "@", apart ? ", source_sampler" : "");
}

/// A compute shader that evaluates every case, or only some, each in its band, with results in float. Software drivers
/// compile every read anew for each edge mode, which takes longer than all the rest.
std::string wrapper(Dialect dialect, bool only_some) {
    std::string text = message(
        "input_binding(0, source)\nsampler_binding(1, source_sampler)\nresult_binding(2, result)\n"
        "input_binding(3, other)\nkernel(every_case, 8, 8) {\n    image_size(result_size, result)\n"
        "    let(int2, at) = group_position * 8 + thread_position;\n    let(int, band) = at.y / ",
        height, ";\n    let(float2, uv) = float2(", number(first_uv), " + (float(at.x) + 0.5) * ", number(step_x), ", ",
        number(first_uv), " + (float(at.y - band * ", height, ") + 0.5) * ", number(step_y),
        ");\n    let(float2, texel) = float2(", number(1.0 / source_width), ", ", number(1.0 / source_height),
        ");\n    var(float4, value) = float4(0.0, 0.0, 0.0, 0.0);\n");
    for (std::size_t i = 0; i < all_cases().size(); ++i)
        if (!only_some || all_cases()[i].at_all_edges)
            text +=
                message("    if (band == ", i, ") {\n        value = ", call_of(all_cases()[i], dialect), ";\n    }\n");
    text += "    if (at.x < result_size.x && at.y < result_size.y) {\n        store(result, at, value);\n    }\n}\n";
    const std::string translated =
        replaced(replaced(translate(text, dialect), "rgba16float", "rgba32float"), "rgba16f", "rgba32f");
    const std::string version = dialect == Dialect::glsl ? "#version 450\n" : "";
    return version + functions_of_all_cases(dialect) + translated;
}

/// The bands of all cases.
Dispatch bands(Edge edge, Dialect dialect, const std::string& entry) {
    const int rows = height * static_cast<int>(all_cases().size());
    return {.entry = entry,
            .combined = dialect == Dialect::glsl,
            .edge = edge,
            .textures = {&source(), &other()},
            .width = width,
            .height = rows,
            .groups_x = (width + 7) / 8,
            .groups_y = (rows + 7) / 8};
}

/// The first band shows how exact the sampler is: largest error of plain reads per slope, in texels.
double sampler_error(const std::vector<float>& result, Edge edge) {
    double error = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double at_x = (first_uv + (x + 0.5) * step_x) * source_width;
            const double at_y = (first_uv + (y + 0.5) * step_y) * source_height;
            const Colour exact = bilinear(source(), edge, at_x, at_y);
            const double steep = slope(source(), edge, at_x, at_y, 1);
            const float* got = result.data() + (y * width + x) * 4;
            for (std::size_t c = 0; c < 4; ++c)
                if (steep > 0) error = std::max(error, std::abs(got[c] - exact[c]) / steep);
        }
    return error;
}

/// Compares all bands with what is expected of an exact sampler. A sampler that keeps `bits` of a fraction may place a
/// read 2^-bits beside where it should be; one that shows itself to be finer, in the first band, is held to that.
void expect_right(const std::vector<float>& result, Edge edge, bool only_some, int bits, const std::string& where) {
    // A coordinate is rounded when it is computed, shifted, and multiplied by the size: a few roundings of at most 2.
    const double coordinate = 8 * 0x1p-24 * 2 * source_width;
    const double observed = sampler_error(result, edge);
    ASSERT_LE(observed, std::ldexp(1, -bits) + coordinate) << where << ": plain reads, " << name_of(edge);
    const Precision precision{std::min(std::ldexp(1, -bits), 2 * observed + 1e-6), coordinate};
    for (std::size_t i = 0; i < all_cases().size(); ++i) {
        const Case& c = all_cases()[i];
        if (only_some && !c.at_all_edges) continue;
        double worst = -1, worst_error = 0, worst_bound = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Place at{source(),
                               other(),
                               edge,
                               (first_uv + (x + 0.5) * step_x) * source_width,
                               (first_uv + (y + 0.5) * step_y) * source_height,
                               precision};
                const Expected expected = c.expected(at);
                const float* got = result.data() + ((static_cast<int>(i) * height + y) * width + x) * 4;
                for (std::size_t k = 0; k < 4; ++k) {
                    const double error = std::abs(got[k] - expected.value[k]);
                    if (!(error / expected.bound <= worst))
                        worst = error / expected.bound, worst_error = error, worst_bound = expected.bound;
                }
            }
        EXPECT_LE(worst, 1) << where << ": " << c.name << ", edge " << name_of(edge) << ", off by " << worst_error
                            << " where " << worst_bound << " is allowed";
        ::testing::Test::RecordProperty(message(c.name, ", ", name_of(edge)), message(worst));
    }
}

void execute_by(Compiler compiler, Dialect dialect, bool only_some_cases = false) {
    BANDLIMIT_NEED(missing(compiler));
    BANDLIMIT_NEED(Vulkan::missing());
    const Vulkan vulkan;
    const std::string entry = dialect == Dialect::glsl || compiler == Compiler::slang ? "main" : "every_case";
    const std::vector<std::uint32_t> all = compile(compiler, dialect, wrapper(dialect, false), "every_case");
    const std::vector<std::uint32_t> some = compile(compiler, dialect, wrapper(dialect, true), "every_case");
    for (const Edge edge : sampler_edges) {
        const bool only_some = only_some_cases || edge != Edge::clamp;
        expect_right(vulkan.run(only_some ? some : all, bands(edge, dialect, entry)), edge, only_some,
                     vulkan.fraction_bits(), vulkan.device());
    }
}

TEST(Execute, GlslByGlslang) { execute_by(Compiler::glslang, Dialect::glsl); }
TEST(Execute, HlslByGlslang) { execute_by(Compiler::glslang, Dialect::hlsl); }
/// The text of functions is HLSL's: it is compiled here, and some of it is executed.
TEST(Execute, SlangBySlang) { execute_by(Compiler::slang, Dialect::slang, true); }

/// wgpu has naga in it; where only naga itself is at hand, that does.
TEST(Execute, WgslByNaga) {
    if (missing_wgpu().empty()) GTEST_SKIP() << "wgpu is there, which executes the same";
    execute_by(Compiler::naga, Dialect::wgsl);
}

/// A second opinion on what HLSL is.
TEST(Compile, HlslBySlang) {
    BANDLIMIT_NEED(missing(Compiler::slang));
    EXPECT_NO_THROW(compile(Compiler::slang, Dialect::hlsl, wrapper(Dialect::hlsl, false), "every_case"));
}

/// Fragment shaders of OpenGL ES, too, may call the functions.
TEST(Compile, GlslForEs) {
    BANDLIMIT_NEED(missing(Compiler::glslang));
    const Folder folder;
    write_text(folder / "all.frag", "#version 300 es\nprecision highp float;\nprecision highp int;\n" +
                                        functions_of_all_cases(Dialect::glsl) + "void main() {}\n");
    EXPECT_NO_THROW(run_command("glslangValidator " + (folder / "all.frag").string()));
}

/// Dawn's compiler, where it is at hand: it wants an entry point, which the wrapper has.
TEST(Compile, WgslByTint) {
    BANDLIMIT_NEED(on_path("tint") ? "" : "no tint on PATH");
    const Folder folder;
    write_text(folder / "all.wgsl", wrapper(Dialect::wgsl, false));
    EXPECT_NO_THROW(
        run_command("tint --format wgsl -o " + (folder / "out.wgsl").string() + " " + (folder / "all.wgsl").string()));
}

TEST(Execute, WgslByWgpu) {
    BANDLIMIT_NEED(missing_wgpu());
    BANDLIMIT_NEED(Vulkan::missing());
    std::vector<WgpuJob> jobs;
    for (const Edge edge : {Edge::clamp, Edge::wrap, Edge::reflect})
        jobs.push_back({wrapper(Dialect::wgsl, edge != Edge::clamp), bands(edge, Dialect::wgsl, "every_case")});
    const std::vector<std::vector<float>> results = run_by_wgpu(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) expect_right(results[i], jobs[i].dispatch.edge, i > 0, 8, "wgpu");
}

/// No software driver has fractions of 8 bits, as GPUs have: here they are.
void execute_with_8_bits(Dialect dialect) {
    if (is_sanitized) GTEST_SKIP() << "not under sanitizers, which a library without them cannot be loaded into";
    std::vector<std::string> calls;
    for (const Case& c : all_cases()) calls.push_back(translate(call_of(c, dialect), dialect));
    const Library library(dialect, functions_of_all_cases(dialect), calls);
    for (const Edge edge : sampler_edges) {
        std::vector<float> result;
        for (int call = 0; call < static_cast<int>(calls.size()); ++call)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const auto u = static_cast<float>(first_uv + (x + 0.5) * step_x);
                    const auto v = static_cast<float>(first_uv + (y + 0.5) * step_y);
                    for (const double c : library(call, source(), other(), edge, 8, u, v))
                        result.push_back(static_cast<float>(c));
                }
        expect_right(result, edge, false, 8, std::string(name_of(dialect)));
    }
}

TEST(Execute, CppWithFractionsOf8Bits) { execute_with_8_bits(Dialect::cpp); }
TEST(Execute, MetalAsCppWithFractionsOf8Bits) { execute_with_8_bits(Dialect::msl); }

}  // namespace
}  // namespace bandlimit::test
