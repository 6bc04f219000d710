// Temporal antialiasing by emitted shaders, frame by frame, against accumulate(): each has its own history, which it
// alone made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Multiples of 1/64 that are odd: with motion in 32nds of a pixel, no place lies half way between two samples, where
/// a rounding would decide which is nearer.
Point jitter_of(int frame) {
    constexpr std::array<Point, frames> jitter{{{-15, 9}, {17, -21}, {5, 27}, {-27, -11}, {11, 3}, {29, -5}}};
    const Point p = jitter[static_cast<std::size_t>(frame)];
    return {p.x / 64, p.y / 64};
}

double exposure_of(int frame) { return frame < 4 ? 1 : 1.5; }

/// What is seen at a place: a block that moves in front of waves, a wire, a lamp, and a band that hardly moves.
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
    // As near as the block and hit by some frames only.
    if (std::abs(x - 15.6) < 0.25 && y > 3 && y < 13) return {{0.9, 0.1, 0.3}, 0, 0, 4};
    if (std::hypot(x - 19, y - 5) < 1.6) {
        const double glow = 1 + 0.25 * std::sin(2.3 * x + 1.9 * y);
        return {{20 * glow, 14 * glow, 9 * glow}};
    }
    if (y < 2) {
        const double wave = std::sin(2.3 * (x - frame / 32.0));
        return {{0.5 + 0.4 * wave, 0.4 - 0.2 * wave, 0.2 + 0.1 * wave}, -1 / 32.0};
    }
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
struct TemporalRun {
    std::string name;
    TemporalOptions options;
    int width, height;
};

/// Takes a frame into the history; what it shows then.
Image<float> accumulated(TemporalHistory& history, const Frame& f, const TemporalOptions& options) {
    Image<float> out(history.width(), history.height(), 4, Layout::interleaved);
    accumulate(history,
               {.color = f.color.view(),
                .depth = f.depth.view(),
                .motion = f.motion.view(),
                .reactive = f.reactive.view(),
                .jitter = jitter_of(f.index),
                .exposure = exposure_of(f.index)},
               options, out.view());
    return out;
}

void append(View<const float> image, Picture& picture) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c) picture.texels.push_back(image(x, y, c));
}

/// What accumulate() gives for each frame, without sharpening.
std::vector<Picture> by_cpu(const TemporalRun& run) {
    TemporalHistory history(run.width, run.height);
    TemporalOptions soft = run.options;
    soft.sharpening = 0;
    std::vector<Picture> results;
    for (const Frame& f : sequence()) {
        const Image<float> out = accumulated(history, f, soft);
        Picture result{run.width, 2 * run.height, {}};
        append(history.sums(), result), append(out.view(), result);
        results.push_back(std::move(result));
    }
    return results;
}

/// The first frame.
Picture shown_by_cpu(const TemporalRun& run, double sharpening) {
    TemporalHistory history(run.width, run.height);
    TemporalOptions options = run.options;
    options.sharpening = sharpening;
    Picture picture{run.width, run.height, {}};
    const Image<float> out = accumulated(history, sequence().front(), options);
    append(out.view(), picture);
    return picture;
}

/// A frame as numbers: the members of the shader's structure. A mirrored jitter is a mistake, to see it found.
Picture parameters(const TemporalRun& run, int frame, bool mirrors_jitter = false) {
    const double sign = mirrors_jitter ? -1 : 1;
    const Point jitter = jitter_of(frame), before = frame > 0 ? jitter_of(frame - 1) : Point{};
    const double exposure = frame > 0 ? exposure_of(frame) / exposure_of(frame - 1) : 1;
    Picture p{3, 1, {}};
    for (const double v :
         {double(in_width), double(in_height), double(run.width), double(run.height), sign * jitter.x, sign * jitter.y,
          double(in_width), double(in_height), sign * before.x, sign * before.y, exposure, frame > 0 ? 1.0 : 0.0})
        p.texels.push_back(static_cast<float>(v));
    return p;
}

bool compares_depth(const TemporalRun& run) { return std::isfinite(run.options.depth_tolerance); }

/// In neutral form: the structure from these numbers.
std::string frame_reader(const TemporalRun& run) {
    return message(
        "function(temporal_frame, frame_of, texture(numbers)) {\n    let(float4, p) = load(numbers, int2(0, 0));\n"
        "    let(float4, q) = load(numbers, int2(1, 0));\n    let(float4, r) = load(numbers, int2(2, 0));\n"
        "    declare(temporal_frame, frame);\n    frame.size = float2(p.x, p.y);\n"
        "    frame.result_size = float2(p.z, p.w);\n    frame.jitter = float2(q.x, q.y);\n",
        compares_depth(run) ? "    frame.size_before = float2(q.z, q.w);\n    frame.jitter_before = float2(r.x, r.y);\n"
                            : "",
        "    frame.exposure = r.z;\n    frame.has_history = r.w;\n    return frame;\n}\n");
}

std::string functions(const TemporalRun& run, Dialect dialect) {
    return temporal_shader(run.options, {.name = "temporal"}, dialect);
}

/// A compute shader of all functions: the next history, and below it what that shows.
std::string wrapper(const TemporalRun& run, Dialect dialect) {
    const bool compares = compares_depth(run);
    const std::string text = message(
        "input_binding(0, color)\nresult_binding(2, result)\ninput_binding(3, surface)\ninput_binding(4, history)\n"
        "input_binding(5, numbers)\n",
        compares ? "input_binding(6, surface_before)\n" : "", frame_reader(run),
        "kernel(every_pixel, 8, 8) {\n    let(int2, at) = group_position * 8 + thread_position;\n"
        "    let(temporal_frame, frame) = frame_of(numbers);\n    let(int2, size) = int2(frame.result_size);\n"
        "    let(int2, pixel) = int2(at.x, choose(at.y < size.y, at.y, at.y - size.y));\n"
        "    if (at.x < size.x && at.y < 2 * size.y) {\n"
        "        var(float4, value) = temporal_step(color, surface, history,",
        compares ? " surface_before," : "",
        " frame, pixel);\n"
        "        if (at.y >= size.y) {\n            value = temporal_show(color, frame, value, pixel);\n        }\n"
        "        store(result, at, value);\n    }\n}\n");
    std::string translated = translate(text, dialect);
    if (const std::size_t at = translated.find("rgba16"); at != std::string::npos) translated.replace(at, 6, "rgba32");
    const std::string version = dialect == Dialect::glsl ? "#version 450\n" : "";
    return version + functions(run, dialect) + translated;
}

/// A frame, `history`, and `numbers`.
std::vector<const Picture*> textures_of(const TemporalRun& run, int frame, const Picture& history,
                                        const Picture& numbers) {
    const auto at = [](int f) -> const Frame& { return sequence()[static_cast<std::size_t>(f)]; };
    std::vector<const Picture*> textures{&at(frame).color_texture, &at(frame).surface, &history, &numbers};
    if (compares_depth(run)) textures.push_back(&at(std::max(0, frame - 1)).surface);
    return textures;
}

Dispatch dispatch_of(const TemporalRun& run, const std::string& entry, bool combined,
                     std::vector<const Picture*> textures) {
    return {.entry = entry,
            .combined = combined,
            .textures = std::move(textures),
            .width = run.width,
            .height = 2 * run.height,
            .groups_x = (run.width + 7) / 8,
            .groups_y = (2 * run.height + 7) / 8,
            .loads_floats = true};
}

/// The most that the sum of |kernel| or of its slopes is along an axis, over all phases of samples `pitch` apart.
double most_along(const Kernel& kernel, double pitch, bool of_slopes) {
    constexpr double phases = 64, h = 1e-4;
    double most = 0;
    for (int i = 0; i < phases; ++i) {
        double sum = 0;
        for (double x = (i / phases - 8) * pitch; x < 8 * pitch; x += pitch) {
            // Not across the end of the kernel, where a Gaussian jumps by 3e-4.
            if (of_slopes && std::abs(std::abs(x) - kernel.radius) < 2 * h) continue;
            sum += std::abs(of_slopes ? (kernel.value(x + h) - kernel.value(x - h)) / (2 * h) : kernel.value(x));
        }
        most = std::max(most, sum);
    }
    return most;
}

/// By how much the sums of `frame` may differ, where they are 1 or less, else in parts of them. In each frame
///   places     are below 32 and rounded four times on the way, the weights move with them, along both axes; at 1x and
///              2x nothing is rounded, as jitter is in 64ths
///   weights    are off by 1e-7 by polynomials, exp() by 3 + 2 |x| units of the last place, x to -8 where weights are
///              small; a sum of up to 16 adds as many roundings
///   history    weights of Lanczos-2 are tables on the CPU, to 1e-6
///   boxes      are roots of variances, which are off by 12 roundings; nothing here is flat: deviations are 1/50 of the
///              colour at least
/// and a frame passes on what the history was off by: as much at most as its kernel's weights sum to without signs, 1.27
/// along each axis.
double allowed_of_sums(const TemporalRun& run, int frame) {
    constexpr double unit = 0x1p-24, passed_on = 1.27 * 1.27;
    const TemporalOptions& o = run.options;
    const double scale = double(run.width) / in_width;
    const double brightest = o.compresses_highlights ? 1 + std::log(25 * 1.5) : 25 * 1.5;
    const double sum = most_along(o.kernel, scale, false), slopes = most_along(o.kernel, scale, true);
    const double places = scale == std::floor(scale) ? 0 : 2 * slopes * sum * scale * 4 * 0x1p-20;
    const double weights = sum * sum * (2e-7 + (2 * 7 + 16) * unit);
    const double history = o.history_kernel == HistoryKernel::lanczos2 ? 4e-6 : 16 * unit;
    const double boxes = o.rectification == Rectification::none ? 0 : o.box_size * 12 * unit / (2 * 0.02);
    double allowed = 0;
    for (int f = 0; f <= frame; ++f) allowed = passed_on * allowed + brightest * (places + weights + history + boxes);
    return allowed;
}

/// The largest difference in parts of what is allowed. Pixels are sums divided by weights of .3 or more, half of what is
/// allowed for both.
double worst_difference(const TemporalRun& run, const std::vector<Picture>& results) {
    const std::vector<Picture> expected = by_cpu(run);
    double worst = 0;
    for (int f = 0; f < frames; ++f) {
        const auto frame = static_cast<std::size_t>(f);
        const std::size_t half = expected[frame].texels.size() / 2;
        const double sums = allowed_of_sums(run, f), shown = 2 / 0.3 * sums;
        for (std::size_t i = 0; i < 2 * half; ++i) {
            const double v = expected[frame].texels[i], error = std::abs(v - double(results[frame].texels[i]));
            const double part = error / std::max(1.0, std::abs(v)) / (i < half ? sums : shown);
            if (!(part <= worst)) worst = part;
        }
    }
    return worst;
}

/// Frame by frame: run(textures) is given the history that it returned before.
template <class RunFrame>
std::vector<Picture> frame_by_frame(const TemporalRun& run, bool mirrors_jitter, const RunFrame& run_frame) {
    std::vector<Picture> results{both(run.width, run.height)};
    for (int f = 0; f < frames; ++f) {
        const Picture numbers = parameters(run, f, mirrors_jitter);
        Picture next{run.width, 2 * run.height, run_frame(textures_of(run, f, results.back(), numbers))};
        results.push_back(std::move(next));
    }
    results.erase(results.begin());
    return results;
}

std::vector<Picture> executed(const Vulkan& vulkan, const TemporalRun& run, Compiler compiler, Dialect dialect,
                              bool mirrors_jitter = false) {
    const std::vector<std::uint32_t> spirv = compile(compiler, dialect, wrapper(run, dialect), "every_pixel");
    const std::string entry = dialect == Dialect::glsl || compiler == Compiler::slang ? "main" : "every_pixel";
    return frame_by_frame(run, mirrors_jitter, [&](std::vector<const Picture*> textures) {
        return vulkan.run(spirv, dispatch_of(run, entry, dialect == Dialect::glsl, std::move(textures)));
    });
}

void expect_close(const TemporalRun& run, const std::vector<Picture>& results, const std::string& where) {
    const double worst = worst_difference(run, results);
    EXPECT_LE(worst, 1) << where << ": " << run.name;
    std::string key = run.name;
    std::replace(key.begin(), key.end(), ' ', '_');
    ::testing::Test::RecordProperty(key, message(worst));
}

TemporalRun made(const std::string& name, const TemporalOptions& options, double scale) {
    return {name, options, static_cast<int>(scale * in_width), static_cast<int>(scale * in_height)};
}

TemporalRun balanced() { return made("balanced", temporal_preset("balanced"), 1.5); }

/// Every kernel of the history and every rectification.
std::vector<TemporalRun> all_runs() {
    TemporalOptions smooth = temporal_preset("balanced"), five = smooth, steady = temporal_preset("sharp");
    steady.anti_flicker = 1, steady.deringing_frames = 6;
    smooth.kernel = mitchell();
    smooth.history_kernel = HistoryKernel::bspline;
    smooth.rectification = Rectification::clip;
    smooth.rectifies_ycocg = true;
    smooth.dilates_motion = false;
    five.kernel = tent();
    five.history_kernel = HistoryKernel::catmull_rom5;
    five.rectification = Rectification::clamp;
    five.still_frames = 3;
    return {balanced(),
            made("balanced at 1x", temporal_preset("balanced"), 1),
            made("balanced at 2x", temporal_preset("balanced"), 2),
            made("fast", temporal_preset("fast"), 1.5),
            made("sharp", temporal_preset("sharp"), 1.5),
            made("reference", temporal_preset("reference"), 1.5),
            made("steady and deringed", steady, 1.5),
            made("clip smooth", smooth, 1.5),
            made("clamp five", five, 2)};
}

void execute_by(Compiler compiler, Dialect dialect, const std::vector<TemporalRun>& runs) {
    BANDLIMIT_NEED(missing(compiler));
    BANDLIMIT_NEED(Vulkan::missing());
    const Vulkan vulkan;
    for (const TemporalRun& run : runs) expect_close(run, executed(vulkan, run, compiler, dialect), vulkan.device());
}

TEST(ExecuteTemporal, GlslByGlslang) { execute_by(Compiler::glslang, Dialect::glsl, all_runs()); }
TEST(ExecuteTemporal, HlslByGlslang) { execute_by(Compiler::glslang, Dialect::hlsl, all_runs()); }
TEST(ExecuteTemporal, SlangBySlang) { execute_by(Compiler::slang, Dialect::slang, {balanced()}); }

/// wgpu has naga in it; where only naga itself is at hand, that does.
TEST(ExecuteTemporal, WgslByNaga) {
    if (missing_wgpu().empty()) GTEST_SKIP() << "wgpu is there, which executes the same";
    execute_by(Compiler::naga, Dialect::wgsl, all_runs());
}

TEST(ExecuteTemporal, WgslByWgpu) {
    BANDLIMIT_NEED(missing_wgpu());
    BANDLIMIT_NEED(Vulkan::missing());
    constexpr int history = 2;
    for (const TemporalRun& run : {balanced(), made("sharp", temporal_preset("sharp"), 1.5)}) {
        const Picture nothing = both(run.width, run.height);
        std::vector<Picture> numbers;
        for (int f = 0; f < frames; ++f) numbers.push_back(parameters(run, f));
        std::vector<WgpuJob> jobs;
        for (int f = 0; f < frames; ++f) {
            const Dispatch d = dispatch_of(run, "every_pixel", false,
                                           textures_of(run, f, nothing, numbers[static_cast<std::size_t>(f)]));
            jobs.push_back({wrapper(run, Dialect::wgsl), d, f > 0 ? history : -1});
        }
        std::vector<Picture> results;
        for (std::vector<float>& texels : run_by_wgpu(jobs))
            results.push_back({run.width, 2 * run.height, std::move(texels)});
        expect_close(run, results, "wgpu");
    }
}

/// What the tests above would say of a mistake: the jitter of another sign.
TEST(ExecuteTemporal, AMistakeIsFarBeyondTheBound) {
    BANDLIMIT_NEED(missing(Compiler::glslang));
    BANDLIMIT_NEED(Vulkan::missing());
    EXPECT_GE(worst_difference(balanced(), executed(Vulkan(), balanced(), Compiler::glslang, Dialect::glsl, true)), 50);
}

/// What a CPU calls in C++ and in Metal: step, then what it shows, and sharpening.
std::vector<std::string> calls_of(const TemporalRun& run) {
    const std::string step = message("temporal_step(texture(0), texture(1), texture(2), ",
                                     compares_depth(run) ? "texture(4), " : "", "frame_of(texture(3)), int2(uv))");
    std::vector<std::string> calls{step, "temporal_show(texture(0), frame_of(texture(3)), " + step + ", int2(uv))"};
    if (run.options.sharpening > 0) calls.push_back("temporal_sharpen(texture(0), frame_of(texture(3)), int2(uv))");
    return calls;
}

std::string callable(const TemporalRun& run, Dialect dialect) {
    const std::string reader = translate(frame_reader(run), dialect);
    return functions(run, dialect) + (dialect == Dialect::cpp ? in_context(reader, dialect) : reader);
}

void append_pixels(const Library& library, int call, const std::vector<const Picture*>& textures,
                   const TemporalRun& run, std::vector<float>& texels) {
    for (int y = 0; y < run.height; ++y)
        for (int x = 0; x < run.width; ++x)
            for (const double v :
                 library(call, textures, Edge::clamp, 0, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f))
                texels.push_back(static_cast<float>(v));
}

TEST(ExecuteTemporal, CppAndItsSharpening) {
    if (is_sanitized) GTEST_SKIP() << "not under sanitizers, which a library without them cannot be loaded into";
    const TemporalRun run = made("sharp", temporal_preset("sharp"), 1.5);
    const Library library(Dialect::cpp, callable(run, Dialect::cpp), calls_of(run));
    expect_close(run,
                 frame_by_frame(run, false,
                                [&](const std::vector<const Picture*>& textures) {
                                    std::vector<float> texels;
                                    for (const int call : {0, 1}) append_pixels(library, call, textures, run, texels);
                                    return texels;
                                }),
                 "C++");
    // The same sums and products, but for their order.
    const Picture soft = shown_by_cpu(run, 0), sharp = shown_by_cpu(run, run.options.sharpening);
    const Picture numbers = parameters(run, 0);
    std::vector<float> sharpened;
    append_pixels(library, 2, {&soft, &soft, &soft, &numbers}, run, sharpened);
    for (std::size_t i = 0; i < sharpened.size(); ++i)
        EXPECT_NEAR(sharpened[i], sharp.texels[i], 4e-7 * std::max(1.0f, std::abs(sharp.texels[i]))) << i;
}

/// No compiler of Metal runs here: a C++ compiler reads the text, by a header that stands in for Metal's.
TEST(CompileTemporal, MetalAsCpp) {
    if (is_sanitized) GTEST_SKIP() << "not under sanitizers, which a library without them cannot be loaded into";
    for (const TemporalRun& run : {balanced(), made("sharp", temporal_preset("sharp"), 1)})
        EXPECT_NO_THROW(Library(Dialect::msl, callable(run, Dialect::msl), calls_of(run)));
}

/// Fragment shaders of OpenGL ES, too, may call the functions.
TEST(CompileTemporal, GlslForEs) {
    BANDLIMIT_NEED(missing(Compiler::glslang));
    const Folder folder;
    for (const TemporalRun& run : all_runs()) {
        write_text(folder / "all.frag", "#version 300 es\nprecision highp float;\nprecision highp int;\n" +
                                            functions(run, Dialect::glsl) + "void main() {}\n");
        EXPECT_NO_THROW(run_command("glslangValidator " + (folder / "all.frag").string()));
    }
}

/// A second opinion on what HLSL is.
TEST(CompileTemporal, HlslBySlang) {
    BANDLIMIT_NEED(missing(Compiler::slang));
    EXPECT_NO_THROW(compile(Compiler::slang, Dialect::hlsl, wrapper(balanced(), Dialect::hlsl), "every_pixel"));
}

}  // namespace
}  // namespace bandlimit::test
