#include "bandlimit/shader/shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/shader/kernels.h"
#include "bandlimit/shader/text.h"

namespace bandlimit {
namespace {

const Taps blur{-1, {0.25, 0.5, 0.25}, 1};
const std::vector<LinearRead> reads{{-1.0 / 3, 0.75}, {1, 0.25}};

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Dialect, NamesAreReadBack) {
    for (const Dialect d : all_dialects()) EXPECT_EQ(parse_dialect(name_of(d)), d);
    EXPECT_THROW(parse_dialect("GLSL"), Error);
}

TEST(Dialect, EachHasItsWords) {
    const std::string source =
        "function(float4, f, texture(t), sampler(s), in(float2, uv)) {\n    return 0.5 * sample(t, s, uv);\n}\n";
    EXPECT_EQ(translate(source, Dialect::glsl),
              "vec4 f(sampler2D t, vec2 uv) {\n    return 0.5 * textureLod(t, uv, 0.0);\n}\n");
    EXPECT_EQ(
        translate(source, Dialect::hlsl),
        "float4 f(Texture2D<float4> t, SamplerState s, float2 uv) {\n    return 0.5 * t.SampleLevel(s, uv, 0.0);\n}\n");
    EXPECT_EQ(translate(source, Dialect::wgsl),
              "fn f(t: texture_2d<f32>, s: sampler, uv: vec2f) -> vec4f {\n"
              "    return 0.5 * textureSampleLevel(t, s, uv, 0.0);\n}\n");
    EXPECT_EQ(translate(source, Dialect::msl),
              "inline float4 f(texture2d<float> t, sampler s, float2 uv) {\n    return 0.5f * t.sample(s, uv, "
              "level(0.0));\n}\n");
    EXPECT_EQ(translate(source, Dialect::cpp),
              "inline float4 f(const auto& t, float2 uv) {\n    return 0.5f * t.sample(uv);\n}\n");
    EXPECT_EQ(translate(source, Dialect::slang), translate(source, Dialect::hlsl));
}

TEST(Dialect, CommentsStayAndUnusedWordsLeaveNoLine) {
    EXPECT_EQ(translate("// float2 sample(x)\nlet(float2, a) = b;\n", Dialect::wgsl),
              "// float2 sample(x)\nlet a: vec2f = b;\n");
    EXPECT_EQ(translate("{\n    tile_here(t, 8)\n    barrier();\n}\n", Dialect::glsl), "{\n    barrier();\n}\n");
    EXPECT_THROW(translate("let x = 1;", Dialect::glsl), Error);
    EXPECT_THROW(translate("loop(i, 0) {}", Dialect::glsl), Error);
    EXPECT_THROW(translate("sample(t, s, uv", Dialect::glsl), Error);
}

TEST(Shader, NumbersLeadBackToTheFloat) {
    for (const double v : {1.0, -2.5e-5, 0.1, 1.0 / 3, 123456.789, 1e-30, 3e20}) {
        const std::string text = number(v);
        EXPECT_EQ(std::stof(text), static_cast<float>(v)) << text;
        EXPECT_TRUE(contains(text, ".") || contains(text, "e")) << text << " is an integer to GLSL";
    }
}

/// All texts of one dialect.
std::vector<ShaderFile> everything(Dialect dialect) {
    std::vector<ShaderFile> files = shaders_of(
        {.fetches = {{0.5, 0.5, 1}}, .reads = reads, .taps = blur, .terms = {{{1, 2}, {3, 4}}, {{1, 1}, {1, 1}}}},
        {"blur", "bandlimit design gaussian --sigma 1", {"error 0.5"}}, dialect);
    for (const KernelShader& k : kernel_shaders())
        files.push_back({std::string(k.name), kernel_shader(k.name, "bandlimit analyze", dialect)});
    return files;
}

TEST(Shader, NothingNeutralIsLeft) {
    const std::regex word(
        R"(\b(let|var|declare|table|structure|field|function|loop|choose|\w+_binding|tile_here|NAME)\()");
    for (const Dialect d : all_dialects())
        for (const ShaderFile& file : everything(d)) EXPECT_FALSE(std::regex_search(file.text, word)) << file.text;
}

TEST(Shader, TheCommentSaysWhatMadeIt) {
    for (const Dialect d : all_dialects()) {
        const std::string text = fetch_shader({{0.5, 0.5, 1}}, {"half", "bandlimit design", {"error 0.5", "a \\"}}, d);
        for (const char* part : {"// half: ", "// error 0.5\n", "// a\n", "// Cost: 1 bilinear reads",
                                 "// Made by: bandlimit design\n", "// texel "})
            EXPECT_TRUE(contains(text, part)) << part << " is missing in " << text;
    }
}

/// A line break or a backslash in a file's name must not end the comment or swallow the next line.
TEST(Shader, TheCommentCannotBeLeft) {
    const std::string text = fetch_shader({{0, 0, 1}}, {"f", "design a\nfloat evil;\\", {"x\r\ny\\\\"}}, Dialect::glsl);
    EXPECT_FALSE(contains(text, "\nfloat evil"));
    EXPECT_FALSE(contains(text, "\\\n"));
    EXPECT_FALSE(contains(text, "\ny"));
}

TEST(Shader, FilesOfADesign) {
    std::vector<std::string> names;
    for (const ShaderFile& f : everything(Dialect::wgsl)) names.push_back(f.name);
    names.resize(5);
    EXPECT_EQ(names, (std::vector<std::string>{"blur.wgsl", "blur_separable.wgsl", "blur_compute_horizontal.wgsl",
                                               "blur_compute_vertical.wgsl", "blur_low_rank.wgsl"}));
    EXPECT_EQ(shaders_of({.reads = reads, .taps = blur}, {"blur"}, Dialect::cpp).size(), 1u) << "C++ has no workgroups";
    EXPECT_EQ(shaders_of({.reads = reads}, {"blur"}, Dialect::glsl).front().name, "blur.glsl");
    EXPECT_THROW(shaders_of({}, {"blur"}, Dialect::glsl), Error);
}

TEST(Shader, BadArgumentsAreRefused) {
    for (const char* name : {"", "Blur", "2x", "a-b", "a__b", "gl_x", "x_", "a b", "kernel", "for"})
        EXPECT_THROW(fetch_shader({{0, 0, 1}}, {name}, Dialect::glsl), Error) << name;
    EXPECT_THROW(fetch_shader({}, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(fetch_shader({{std::nan(""), 0, 1}}, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(separable_shader({{0, std::numeric_limits<double>::infinity()}}, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(load_shader({}, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(low_rank_shader({}, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(low_rank_shader({{{1}, {1, 2}}, {{1}, {1}}}, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(compute_shader(blur, PassDirection::vertical, {"f"}, Dialect::cpp), Error);
    EXPECT_THROW(compute_shader({0, {1}, 0}, PassDirection::vertical, {"f"}, Dialect::glsl), Error);
    EXPECT_THROW(compute_shader({0, std::vector<double>(1100, 1), 1}, PassDirection::vertical, {"f"}, Dialect::glsl),
                 Error);
    EXPECT_THROW(kernel_shader("bspline", "", Dialect::glsl), Error);
}

/// The shared memory that a text declares is what every device has, however many taps there are.
TEST(Shader, ComputeFitsSharedMemory) {
    const std::regex tile(R"(shared vec4 \w+\[(\d+)\])");
    for (const int factor : {1, 2, 3, 8, 30})
        for (const std::size_t count : {1u, 60u, 97u, 300u, 800u}) {
            const Taps taps{0, std::vector<double>(count, 0.1), factor};
            if (!compute_fits(taps)) continue;
            for (const PassDirection d : {PassDirection::horizontal, PassDirection::vertical}) {
                const std::string text = compute_shader(taps, d, {"f"}, Dialect::glsl);
                std::smatch found;
                ASSERT_TRUE(std::regex_search(text, found, tile)) << text;
                EXPECT_LE(std::stoi(found[1]), 1024) << factor << ", " << count;
            }
        }
}

TEST(KernelShaders, AreKernelsWithNamesOfTheirOwn) {
    std::set<std::string_view> names;
    for (const KernelShader& k : kernel_shaders()) {
        EXPECT_TRUE(names.insert(k.name).second) << k.name;
        if (!k.kernel.empty()) {
            EXPECT_EQ(parse_kernel(k.kernel).name, k.kernel);
        }
    }
}

/// What kernels.h says of sample_jinc2's table, whose pieces the executed shader is compared with.
TEST(KernelShaders, TheTableOfJincIsFineEnough) {
    const Kernel kernel = jinc_lanczos(2);
    const double end = kernel.radius * kernel.radius;
    const auto at = [&](int i) { return i >= 256 ? 0 : kernel.value(std::sqrt(end * i / 256)); };
    double worst = 0;
    for (int i = 0; i < 25600; ++i) {
        const double place = i / 100.0;
        const int k = i / 100;
        const double line = at(k) + (place - k) * (at(k + 1) - at(k));
        worst = std::max(worst, std::abs(line - kernel.value(std::sqrt(end * place / 256))));
    }
    EXPECT_LE(worst, 1e-4 * kernel.value(0));
    RecordProperty("error", std::to_string(worst / kernel.value(0)));
}

}  // namespace
}  // namespace bandlimit
