// Speed of blurring 1920 x 1080 RGBA by discs of radius 25 and 100, in every way that there is, beside copying as many
// bytes. One thread, whose own time counts.
#include <benchmark/benchmark.h>

#include <cstring>
#include <string>

#include "bandlimit/filter/bokeh.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr int width = 1920, height = 1080;

template <class T>
struct Pictures {
    Image<T> from{width, height, 4, Layout::interleaved}, to{width, height, 4, Layout::interleaved};
};

template <class T>
Pictures<T>& pictures() {
    static Pictures<T> both = [] {
        Pictures<T> made;
        Random random(1);
        for (int i = 0; i < width * height * 4; ++i)
            made.from.view().data[i] =
                static_cast<T>(std::is_same_v<T, float> ? random.uniform() : 255 * random.uniform());
        return made;
    }();
    return both;
}

template <class T>
void blur(benchmark::State& state, const ConvolutionWeights& weights, Method method, const Encoding& encoding) {
    Pictures<T>& p = pictures<T>();
    const Convolution convolution(weights, width, height, {.method = method});
    for (auto _ : state)
        convolution.run({std::as_const(p.from).view(), 0, encoding}, {p.to.view(), 0, encoding, {}}, {1});
    state.counters["multiply_adds"] = convolution.chosen().multiply_adds;
    state.counters["rank"] = convolution.chosen().rank;
    state.counters["Mpixel/s"] =
        benchmark::Counter(double(width) * height / 1e6, benchmark::Counter::kIsIterationInvariantRate);
}

void add(const std::string& name, const ConvolutionWeights& weights, Method method) {
    const auto run = [&](const std::string& of, auto function) {
        benchmark::internal::Benchmark* const b = benchmark::RegisterBenchmark((name + of).c_str(), function);
        b->Unit(benchmark::kMillisecond);
    };
    run("/float", [=](benchmark::State& s) { blur<float>(s, weights, method, {}); });
    run("/srgb8", [=](benchmark::State& s) { blur<std::uint8_t>(s, weights, method, {Transfer::srgb, 3, false}); });
}

/// The products of so many phasors, which cost the same whatever is fitted: those of Niemitalo 2011 for two components,
/// repeated, as wide as reach_for() makes fitted ones.
Terms phasors(int count, double radius) {
    const Components two{{0.886528, 5.268909, 0.411259, -0.548794}, {1.960518, 1.558213, 0.513282, 4.56111}};
    Components components;
    for (int i = 0; i < count; ++i) components.push_back(two[static_cast<std::size_t>((i + 1) % 2)]);
    return separable_terms(components, radius, static_cast<int>(1.65 * radius));
}

void copy(benchmark::State& state) {
    Pictures<float>& p = pictures<float>();
    for (auto _ : state) {
        std::memcpy(p.to.view().data, std::as_const(p.from).view().data, sizeof(float) * 4 * width * height);
        benchmark::ClobberMemory();
    }
}

const bool registered = [] {
    benchmark::RegisterBenchmark("copy/float", copy)->Unit(benchmark::kMillisecond);
    for (const int radius : {25, 100}) {
        const std::string name = "radius:" + std::to_string(radius);
        const WeightGrid disc = aperture("disc:1", radius);
        add(name + "/direct", centred(disc), Method::direct);
        add(name + "/fft", centred(disc), Method::fft);
        add(name + "/auto", centred(disc), Method::automatic);
        for (const int rank : {1, 2, 4, 8})
            add(name + "/rank:" + std::to_string(rank), centred(low_rank(disc, rank)), Method::low_rank);
        for (const int count : {1, 2, 3})
            add(name + "/components:" + std::to_string(count), centred(phasors(count, radius)), Method::low_rank);
    }
    return true;
}();

}  // namespace
}  // namespace bandlimit
