// Speed of bilateral filters on 1024 x 1024 samples, on one thread and on two.
#include <benchmark/benchmark.h>

#include <string>

#include "bandlimit/filter/bilateral_upsample.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr int side = 1024;

Image<float> noise(int width, int height, int channels) {
    Random random(1);
    Image<float> image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.view()(x, y, c) = static_cast<float>(random.uniform());
    return image;
}

void joint(benchmark::State& state, int signals, int guides, bool separable, int threads) {
    const Image<float> signal = noise(side, side, signals), guide = noise(side, side, guides);
    const RowFilter filter = bilateral_filter(
        side, side, {.sigma_space = 3, .sigma_range = {0.2}, .radius = 8, .separable = separable}, guide.view());
    Image<float> out = signal.clone();  // whose memory has been written
    for (auto _ : state) filter.run({signal.view(), 0, {}}, {out.view(), 0, {}, {}}, {threads});
    state.SetItemsProcessed(state.iterations() * side * side);
}

void upsample(benchmark::State& state, int threads) {
    const Image<float> low = noise(side / 2, side / 2, 1), guide = noise(side / 2, side / 2, 1);
    const Image<float> full = noise(side, side, 1);
    const RowFilter filter = bilateral_upsampler(side / 2, side / 2, {.sigma_range = {0.2}}, full.view(), guide.view());
    Image<float> out = full.clone();
    for (auto _ : state) filter.run({low.view(), 0, {}}, {out.view(), 0, {}, {}}, {threads});
    state.SetItemsProcessed(state.iterations() * side * side);
}

const int registered = [] {
    for (const int threads : {1, 2}) {
        const std::string on = "/threads:" + std::to_string(threads);
        const auto add = [&](const std::string& name, int signals, int guides, bool separable) {
            benchmark::RegisterBenchmark(("bilateral/" + name + on).c_str(), joint, signals, guides, separable, threads)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        };
        add("17x17", 1, 1, false);
        add("17x17/guide:3", 1, 3, false);
        add("17x17/signal:3/guide:3", 3, 3, false);
        add("separable", 1, 1, true);
        benchmark::RegisterBenchmark(("bilateral/upsample" + on).c_str(), upsample, threads)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
    }
    return 0;
}();

}  // namespace
}  // namespace bandlimit
