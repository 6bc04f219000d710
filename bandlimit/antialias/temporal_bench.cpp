// Speed of accumulate(): a picture of glyphs whose parts move at several speeds, 960 x 540 to 1920 x 1080 and others.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

struct Sequence {
    Image<float> color, depth, motion;
};

/// Blocks of 64 x 64 pixels: one in four stands still, the others move by up to 4 pixels.
Sequence blocks(int width, int height) {
    Sequence s{Image<float>(width, height, 4, Layout::interleaved), Image<float>(width, height),
               Image<float>(width, height, 2, Layout::interleaved)};
    Random random(7);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int block = x / 64 + 3 * (y / 64);
            const double speed = block % 4;
            for (int c = 0; c < 3; ++c)
                s.color.view()(x, y, c) =
                    static_cast<float>(0.5 + 0.3 * std::sin(0.7 * x + c) * std::cos(0.4 * y) + 0.1 * random.uniform());
            s.color.view()(x, y, 3) = 1;
            s.depth.view()(x, y) = static_cast<float>(1 + block % 5);
            s.motion.view()(x, y, 0) = static_cast<float>(1.3 * speed);
            s.motion.view()(x, y, 1) = static_cast<float>(-0.7 * speed);
        }
    return s;
}

void temporal(benchmark::State& state, const std::string& preset, int width, int height, int scale, int threads) {
    const Sequence s = blocks(width, height);
    TemporalHistory history(width * scale, height * scale);
    Image<float> out(width * scale, height * scale, 4, Layout::interleaved);
    const TemporalOptions options = temporal_preset(preset);
    int frame = 0;
    const auto step = [&] {
        const Point jitter{(frame * 5 % 16 - 7.5) / 16, (frame * 7 % 16 - 7.5) / 16};
        ++frame;
        accumulate(history,
                   {.color = s.color.view(), .depth = s.depth.view(), .motion = s.motion.view(), .jitter = jitter},
                   options, out.view(), {threads});
    };
    for (int i = 0; i < 4; ++i) step();  // all memory is there, and has been written
    for (auto _ : state) step();
    const double pixels = static_cast<double>(state.iterations()) * out.width() * out.height();
    // History is read and written, the output written, the frame and the surfaces read, and these written.
    const double bytes = 16 + 16 + 16 + (16 + 4 + 8 + 16 + 16) / double(scale * scale);
    state.SetBytesProcessed(static_cast<std::int64_t>(pixels * bytes));
    state.counters["pixel"] = benchmark::Counter(pixels, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

const int registered = [] {
    for (const std::string preset : {"fast", "balanced", "sharp", "reference"})
        for (const int threads : {1, 2})
            for (const int scale : {1, 2})
                benchmark::RegisterBenchmark(
                    ("temporal/" + preset + "/" + std::to_string(scale) + "x/threads:" + std::to_string(threads))
                        .c_str(),
                    temporal, preset, 1920 / scale, 1080 / scale, scale, threads)
                    ->Unit(benchmark::kMillisecond)
                    ->UseRealTime();
    return 0;
}();

}  // namespace
}  // namespace bandlimit
