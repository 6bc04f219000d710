// Temporal antialiasing by emitted shaders, frame by frame, against accumulate(): each has its own history, which it
// alone made.
#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/antialias/temporal_shader.h"
#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/shader/compilers_test.h"
#include "bandlimit/shader/library_test.h"
#include "bandlimit/shader/need_test.h"
#include "bandlimit/shader/vulkan_test.h"
#include "bandlimit/shader/wgpu_test.h"

namespace bandlimit::test {
namespace {

constexpr int in_width = 24, in_height = 16, frames = 6;

/// Multiples of 1/64 that are odd: with motion in eighths of a pixel, no place lies half way between two samples, where
/// a rounding would decide which is nearer.
Point jitter_of(int frame) {
    constexpr std::array<Point, frames> jitter{{{-15, 9}, {17, -21}, {5, 27}, {-27, -11}, {11, 3}, {29, -5}}};
    const Point p = jitter[static_cast<std::size_t>(frame)];
    return {p.x / 64, p.y / 64};
}

double exposure_of(int frame) { return frame < 4 ? 1 : 1.5; }

/// What is seen at a place: a block that moves in front of waves, and a lamp.
struct Seen {
    std::array<double, 3> color;
    double motion_x = 0, motion_y = 0, depth = 10, reactive = 0;
};

Seen scene(double x, double y, int frame) {
    const double block_x = x - 5 - 1.25 * frame, block_y = y - 4 - 0.5 * frame;
    const bool is_block = block_x >= 0 && block_x < 7 && block_y >= 0 && block_y < 6;
    if (is_block) {
        const double wave = std::sin(2.1 * block_x) * std::sin(1.7 * block_y);
        return {{0.6 + 0.3 * wave, 0.3 - 0.2 * wave, 0.2 + 0.1 * std::sin(3 * block_y)}, -1.25, -0.5, 4};
    }
    if (std::hypot(x - 19, y - 5) < 1.6) return {{20, 14, 9}};
    const double wave = std::sin(1.3 * x + 0.4 * y), other = std::sin(0.7 * x - 1.9 * y);
    return {{0.5 + 0.3 * wave, 0.5 + 0.3 * other, 0.4 + 0.2 * wave * other}, 0, 0, 10, y > 13 ? 0.5 : 0};
}

/// A frame as both get it.
struct Frame {
    Image<float> color{in_width, in_height, 3}, depth{in_width, in_height}, motion{in_width, in_height, 2},
        reactive{in_width, in_height};
    Picture color_texture{in_width, in_height, {}}, surface{in_width, in_height, {}};
    int index;

    explicit Frame(int frame) : index(frame) {
        for (int y = 0; y < in_height; ++y)
            for (int x = 0; x < in_width; ++x) {
                const Seen seen = scene(x + 0.5 + jitter_of(frame).x, y + 0.5 + jitter_of(frame).y, frame);
                for (int c = 0; c < 3; ++c) {
                    const double v = exposure_of(frame) * seen.color[static_cast<std::size_t>(c)];
                    color_texture.texels.push_back(color.view()(x, y, c) = static_cast<float>(v));
                }
                color_texture.texels.push_back(1);
                motion.view()(x, y, 0) = static_cast<float>(seen.motion_x);
                motion.view()(x, y, 1) = static_cast<float>(seen.motion_y);
                depth.view()(x, y) = static_cast<float>(seen.depth);
                reactive.view()(x, y) = static_cast<float>(seen.reactive);
                for (const double v : {seen.motion_x, seen.motion_y, seen.depth, seen.reactive})
                    surface.texels.push_back(static_cast<float>(v));
            }
    }
};

const std::vector<Frame>& sequence() {
    static const std::vector<Frame> all = [] {
        std::vector<Frame> made;
        for (int f = 0; f < frames; ++f) made.emplace_back(f);
        return made;
    }();
    return all;
}

/// The history after a frame, and below it what it shows: the result of the test's shader, too.
Picture both(int width, int height) {
    return {width, 2 * height, std::vector<float>(static_cast<std::size_t>(8 * width * height))};
}

/// An options struct, and the size of the result.
struct Run {
    std::string name;
    TemporalOptions options;
    int width, height;
};

std::vector<Picture> by_cpu(const Run& run) {
    TemporalHistory history(run.width, run.height);
    std::vector<Picture> results;
    for (const Frame& f : sequence()) {
        Image<float> out(run.width, run.height, 4, Layout::interleaved);
        TemporalOptions soft = run.options;
        soft.sharpening = 0;
        accumulate(history,
                   {.color = f.color.view(),
                    .depth = f.depth.view(),
                    .motion = f.motion.view(),
                    .reactive = f.reactive.view(),
                    .jitter = jitter_of(f.index),
                    .exposure = exposure_of(f.index)},
                   soft, out.view());
        Picture result = both(run.width, run.height);
        for (int y = 0; y < run.height; ++y)
            for (int x = 0; x < run.width; ++x)
                for (int c = 0; c < 4; ++c) {
                    float* const to = result.texels.data() + (y * run.width + x) * 4 + c;
                    to[0] = history.sums()(x, y, c);
                    to[4 * run.width * run.height] = out.view()(x, y, c);
                }
        results.push_back(std::move(result));
    }
    return results;
}

/// Members of the shader's frame, in order; surface_before's are left out where there is none.
std::vector<double> members_of(const Run& run, int frame) {
    const Point jitter = jitter_of(frame), before = frame > 0 ? jitter_of(frame - 1) : Point{};
    const double exposure = frame > 0 ? exposure_of(frame) / exposure_of(frame - 1) : 1;
    return {in_width, in_height, double(run.width), double(run.height), jitter.x, jitter.y,
            in_width, in_height, before.x,          before.y,           exposure, frame > 0 ? 1.0 : 0.0};
}

Picture parameters(const Run& run, int frame) {
    Picture p{3, 1, {}};
    for (const double v : members_of(run, frame)) p.texels.push_back(static_cast<float>(v));
    return p;
}

bool compares_depth(const Run& run) { return std::isfinite(run.options.depth_tolerance); }

/// A compute shader of all functions: the next history, and below it what that shows.
std::string wrapper(const Run& run, Dialect dialect) {
    const bool compares = compares_depth(run);
    std::string text = message(
        "input_binding(0, color)\nresult_binding(2, result)\ninput_binding(3, surface)\ninput_binding(4, history)\n"
        "input_binding(5, parameters)\n",
        compares ? "input_binding(6, surface_before)\n" : "",
        "kernel(every_pixel, 8, 8) {\n    let(int2, at) = group_position * 8 + thread_position;\n"
        "    let(float4, p) = load(parameters, int2(0, 0));\n    let(float4, q) = load(parameters, int2(1, 0));\n"
        "    let(float4, r) = load(parameters, int2(2, 0));\n    declare(temporal_frame, frame);\n"
        "    frame.size = float2(p.x, p.y);\n    frame.result_size = float2(p.z, p.w);\n"
        "    frame.jitter = float2(q.x, q.y);\n",
        compares ? "    frame.size_before = float2(q.z, q.w);\n    frame.jitter_before = float2(r.x, r.y);\n" : "",
        "    frame.exposure = r.z;\n    frame.has_history = r.w;\n    let(int, height) = int(p.w);\n"
        "    let(int2, pixel) = int2(at.x, choose(at.y < height, at.y, at.y - height));\n"
        "    if (at.x < int(p.z) && at.y < 2 * height) {\n"
        "        var(float4, value) = temporal_step(color, surface, history,",
        compares ? " surface_before," : "",
        " frame, pixel);\n"
        "        if (at.y >= height) {\n            value = temporal_show(color, frame, value, pixel);\n        }\n"
        "        store(result, at, value);\n    }\n}\n");
    std::string translated = translate(text, dialect);
    for (const char* format : {"rgba16float", "rgba16f"})
        if (const std::size_t at = translated.find(format); at != std::string::npos)
            translated.replace(at, 6, "rgba32");
    const std::string version = dialect == Dialect::glsl ? "#version 450\n" : "";
    return version + temporal_shader(run.options, {.name = "temporal"}, dialect) + translated;
}

/// The textures of a frame, but the history and the parameters.
Dispatch dispatch_of(const Run& run, Dialect dialect, int frame) {
    const Frame& now = sequence()[static_cast<std::size_t>(frame)];
    Dispatch d{.entry = dialect == Dialect::glsl ? "main" : "every_pixel",
               .combined = dialect == Dialect::glsl,
               .textures = {&now.color_texture, &now.surface, nullptr, nullptr},
               .width = run.width,
               .height = 2 * run.height,
               .groups_x = (run.width + 7) / 8,
               .groups_y = (2 * run.height + 7) / 8,
               .loads_floats = true};
    if (compares_depth(run))
        d.textures.push_back(&sequence()[static_cast<std::size_t>(std::max(0, frame - 1))].surface);
    return d;
}

void expect_close(const Run& run, const std::vector<Picture>& results, const std::string& where) {
    const std::vector<Picture> expected = by_cpu(run);
    for (std::size_t f = 0; f < results.size(); ++f) {
        double sums = 0, shown = 0;
        const std::size_t half = expected[f].texels.size() / 2;
        for (std::size_t i = 0; i < 2 * half; ++i) {
            const double v = expected[f].texels[i], error = std::abs(v - double(results[f].texels[i]));
            double& worst = i < half ? sums : shown;
            if (!(error / std::max(1.0, std::abs(v)) <= worst)) worst = error / std::max(1.0, std::abs(v));
        }
        std::printf("%s %s frame %d: sums %.2e shown %.2e\n", run.name.c_str(), where.c_str(), int(f), sums, shown);
    }
}

void execute_by(const Run& run, Compiler compiler, Dialect dialect) {
    BANDLIMIT_NEED(missing(compiler));
    BANDLIMIT_NEED(Vulkan::missing());
    const Vulkan vulkan;
    const std::vector<std::uint32_t> spirv = compile(compiler, dialect, wrapper(run, dialect), "every_pixel");
    std::vector<Picture> results{both(run.width, run.height)};
    for (int f = 0; f < frames; ++f) {
        const Picture numbers = parameters(run, f);
        Dispatch d = dispatch_of(run, dialect, f);
        d.textures[2] = &results.back(), d.textures[3] = &numbers;
        Picture next{run.width, 2 * run.height, vulkan.run(spirv, d)};
        results.push_back(std::move(next));
    }
    results.erase(results.begin());
    expect_close(run, results, vulkan.device());
}

Run balanced(int scale_halves) {
    return {"balanced", temporal_preset("balanced"), in_width * scale_halves / 2, in_height * scale_halves / 2};
}

TEST(ExecuteTemporal, GlslByGlslang) { execute_by(balanced(3), Compiler::glslang, Dialect::glsl); }
TEST(ExecuteTemporal, GlslAtOnce) { execute_by(balanced(2), Compiler::glslang, Dialect::glsl); }
TEST(ExecuteTemporal, HlslByGlslang) { execute_by(balanced(3), Compiler::glslang, Dialect::hlsl); }
TEST(ExecuteTemporal, WgslByNaga) { execute_by(balanced(3), Compiler::naga, Dialect::wgsl); }

}  // namespace
}  // namespace bandlimit::test
