// Speed of Resizer, as a ratio to copying the bytes that must be read and written.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstring>
#include <vector>

#include "bandlimit/math/random.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {
namespace {

/// Seconds for moving `bytes`, read once and written once, when they are not in a cache: the floor of every case.
double copy_seconds(std::size_t read, std::size_t written) {
    const std::size_t bytes = (read + written) / 2;
    std::vector<char> from(bytes, 1), to(bytes, 2);
    double best = 1e9;
    for (int repeat = 0; repeat < 5; ++repeat) {
        const auto start = std::chrono::steady_clock::now();
        std::memcpy(to.data(), from.data(), bytes);
        benchmark::ClobberMemory();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

template <class T>
Image<T> random_image(int width, int height, int channels) {
    Image<T> image(width, height, channels, Layout::interleaved);
    Random random(1);
    const auto v = image.view();
    for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(width) * height * channels; ++i) {
        if constexpr (std::is_integral_v<T>) v.data[i] = static_cast<T>(random.bits());
        else v.data[i] = static_cast<T>(random.uniform());
    }
    return image;
}

struct Case {
    int width, height, new_width, new_height, channels;
    Kernel kernel;
    Encoding encoding;
};

template <class T>
void run(benchmark::State& state, const Case& c) {
    const Image<T> src = random_image<T>(c.width, c.height, c.channels);
    Image<T> dst(c.new_width, c.new_height, c.channels, Layout::interleaved);
    const Resizer resizer({{c.width}, {c.height}}, {{c.new_width}, {c.new_height}}, c.channels,
                          {.reconstruction = c.kernel});
    const Parallel parallel{static_cast<int>(state.range(0))};
    double seconds = 0;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        resizer.run({src.view(), 0, c.encoding}, {dst.view(), 0, c.encoding, {}}, parallel);
        const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        state.SetIterationTime(taken);
        seconds += taken;
    }
    const auto bytes = [&](int w, int h) {
        return sizeof(T) * static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(c.channels);
    };
    const std::size_t read = bytes(c.width, c.height), written = bytes(c.new_width, c.new_height);
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(read + written));
    state.counters["floor_ms"] = 1e3 * copy_seconds(read, written);
    state.counters["floor"] = seconds / static_cast<double>(state.iterations()) / copy_seconds(read, written);
}

void u8(benchmark::State& state, const Case& c) { run<std::uint8_t>(state, c); }
void f32(benchmark::State& state, const Case& c) { run<float>(state, c); }

const Encoding codes{}, srgb_alpha{Transfer::srgb, 3, false}, linear{};

void setup(benchmark::internal::Benchmark* b) { b->Arg(1)->Arg(2)->UseManualTime()->Unit(benchmark::kMillisecond); }

BENCHMARK_CAPTURE(u8, a_half_codes_lanczos3, Case{4096, 4096, 2048, 2048, 4, lanczos(3), codes})->Apply(setup);
BENCHMARK_CAPTURE(u8, b_1000x700_codes_lanczos3, Case{4096, 4096, 1000, 700, 4, lanczos(3), codes})->Apply(setup);
BENCHMARK_CAPTURE(u8, c_double_codes_lanczos3, Case{1920, 1080, 3840, 2160, 4, lanczos(3), codes})->Apply(setup);
BENCHMARK_CAPTURE(f32, d_half_float_lanczos3, Case{4096, 4096, 2048, 2048, 1, lanczos(3), linear})->Apply(setup);
BENCHMARK_CAPTURE(u8, e_half_codes_box, Case{4096, 4096, 2048, 2048, 4, box(), codes})->Apply(setup);
BENCHMARK_CAPTURE(u8, g_half_linear_light_lanczos3, Case{4096, 4096, 2048, 2048, 4, lanczos(3), srgb_alpha})
    ->Apply(setup);

}  // namespace
}  // namespace bandlimit

BENCHMARK_MAIN();
