// Speed of make_mips: all levels of 4096 x 4096 RGBA of 8 bits down to 1 x 1, beside copying as many bytes.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "bandlimit/math/random.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {
namespace {

constexpr int size = 4096;

const Image<std::uint8_t>& base() {
    static const Image<std::uint8_t> image = [] {
        Image<std::uint8_t> noise(size, size, 4, Layout::interleaved);
        Random random(1);
        std::uint8_t* const data = noise.view().data;
        for (std::size_t i = 0; i < std::size_t{4} * size * size; i += 8) {
            const std::uint64_t bits = random.bits();
            std::memcpy(data + i, &bits, sizeof bits);
        }
        return noise;
    }();
    return image;
}

/// Copies what a chain at least reads and writes: level 0, and as much as a third of it. The counter `floor` is the
/// time of a chain over that of this, measured in turn.
double copy_seconds() {
    static std::vector<std::uint8_t> target(std::size_t{4} * size * size, 1);
    const auto start = std::chrono::steady_clock::now();
    std::memcpy(target.data(), base().view().data, target.size());
    std::memcpy(target.data(), base().view().data, target.size() / 3);
    benchmark::ClobberMemory();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void copy(benchmark::State& state) {
    for (auto _ : state) state.SetIterationTime(copy_seconds());
}

struct Case {
    std::string name;
    Encoding stored;
    TexelFormat target;
    MipOptions options;
};

void mips(benchmark::State& state, const Case& c, int threads) {
    double all = 0, floor = 0;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        const MipChain chain = make_mips(base().view(), c.stored, c.target, c.options, {threads});
        benchmark::DoNotOptimize(chain.images.data());
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        state.SetIterationTime(seconds);
        all += seconds;
        floor += copy_seconds();
    }
    state.counters["floor"] = all / floor;
}

void add(const Case& c) {
    for (const int threads : {1, 2})
        benchmark::RegisterBenchmark(("mips/" + c.name + "/threads:" + std::to_string(threads)).c_str(),
                                     [c, threads](benchmark::State& state) { mips(state, c, threads); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
}

const bool registered = [] {
    const Encoding srgb{Transfer::srgb, 3, false}, codes{};
    const TexelFormat rgba8_srgb{4, Depth::u8, true, false}, rgba8{4, Depth::u8, false, false};
    benchmark::RegisterBenchmark("copy", copy)->UseManualTime()->Unit(benchmark::kMillisecond);
    for (const MipSource from : {MipSource::previous, MipSource::base}) {
        const std::string source = from == MipSource::base ? "/base" : "/previous";
        add({"srgb/box" + source, srgb, rgba8_srgb, {.filter = box(), .from = from}});
        add({"srgb/shrink3" + source, srgb, rgba8_srgb, {.from = from}});
        add({"codes/box" + source, codes, rgba8, {.role = Role::data, .filter = box(), .from = from}});
        add({"codes/shrink3" + source, codes, rgba8, {.role = Role::data, .from = from}});
    }
    add({"srgb/shrink3/level_1", srgb, rgba8_srgb, {.levels = 2}});
    add({"srgb/downsample8/previous", srgb, rgba8_srgb, {.filter = downsample8()}});
    add({"normal/shrink3/previous", codes, rgba8, {.role = Role::normal}});
    add({"alpha-tested/shrink3/previous", srgb, rgba8_srgb, {.role = Role::alpha_tested}});
    return true;
}();

}  // namespace
}  // namespace bandlimit
