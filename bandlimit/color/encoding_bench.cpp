// Speed of decode_row and encode_row, one thread: rows of 4096 and 2048 pixels as they come in halving 4096 x 4096.
#include <benchmark/benchmark.h>

#include <string>
#include <type_traits>
#include <vector>

#include "bandlimit/color/encoding.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr int rows = 256;  // enough that an image of bytes does not stay in the first two caches

struct Case {
    int channels;
    Encoding encoding;
    bool premultiplied = false;
    Layout layout = Layout::interleaved;
};

template <class T>
Image<T> random_image(int width, const Case& c) {
    Image<T> image(width, rows, c.channels, c.layout);
    Random random(1);
    const auto v = image.view();
    for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(width) * rows * c.channels; ++i) {
        if constexpr (std::is_integral_v<T>) v.data[i] = static_cast<T>(random.bits());
        else if constexpr (std::is_same_v<T, Half>) v.data[i] = to_half(static_cast<float>(random.uniform()));
        else v.data[i] = static_cast<T>(random.uniform());
    }
    return image;
}

/// Bytes of stored samples a second, and the time for a sample.
template <class T>
void report(benchmark::State& state, int width, int channels) {
    const auto samples = static_cast<double>(state.iterations()) * width * rows * channels;
    state.SetBytesProcessed(static_cast<std::int64_t>(samples) * static_cast<std::int64_t>(sizeof(T)));
    state.counters["sample"] = benchmark::Counter(samples, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class T>
void decode(benchmark::State& state, const Case& c) {
    constexpr int width = 4096;
    const Image<T> image = random_image<T>(width, c);
    std::vector<float> row(static_cast<std::size_t>(width * c.channels));
    for (auto _ : state)
        for (int y = 0; y < rows; ++y) {
            decode_row(image.view(), y, c.encoding, c.premultiplied, row);
            benchmark::ClobberMemory();
        }
    report<T>(state, width, c.channels);
}

/// The rows are what decoding random samples gives, so every code and alpha occurs.
template <class T>
void encode(benchmark::State& state, const Case& c) {
    constexpr int width = 2048;
    Image<T> image = random_image<T>(width, c);
    std::vector<float> row(static_cast<std::size_t>(width * c.channels));
    decode_row(image.view(), 0, c.encoding, c.premultiplied, row);
    for (auto _ : state)
        for (int y = 0; y < rows; ++y) {
            benchmark::DoNotOptimize(encode_row(row, c.premultiplied, image.view(), y, c.encoding));
            benchmark::ClobberMemory();
        }
    report<T>(state, width, c.channels);
}

void composite(benchmark::State& state, int channels) {
    constexpr int width = 2048;
    std::vector<float> row(static_cast<std::size_t>(width * channels), 0.5f);
    std::vector<float> background(static_cast<std::size_t>(channels - 1), 0.25f);
    std::vector<float> out(static_cast<std::size_t>(width * (channels - 1)));
    for (auto _ : state)
        for (int y = 0; y < rows; ++y) {
            composite_row(row, true, channels, channels - 1, background, out);
            benchmark::ClobberMemory();
        }
    report<float>(state, width, channels);
}

using u8 = std::uint8_t;
using u16 = std::uint16_t;

constexpr Encoding codes{}, srgb{Transfer::srgb}, srgb_alpha{Transfer::srgb, 3}, linear_alpha{Transfer::linear, 3};

template <class T>
void both_ways(const std::string& name, const Case& c) {
    benchmark::RegisterBenchmark(("decode/" + name).c_str(), decode<T>, c);
    benchmark::RegisterBenchmark(("encode/" + name).c_str(), encode<T>, c);
}

const bool registered = [] {
    both_ways<u8>("u8/srgb_4_premultiplied", {4, srgb_alpha, true});
    both_ways<u8>("u8/srgb_4_straight", {4, srgb_alpha});
    both_ways<u8>("u8/codes_1", {1, codes});
    both_ways<u8>("u8/codes_4", {4, codes});
    both_ways<u8>("u8/codes_4_premultiplied", {4, linear_alpha, true});
    both_ways<u8>("u8/srgb_3", {3, srgb});
    both_ways<u8>("u8/srgb_1", {1, srgb});
    both_ways<u8>("u8/srgb_3_alpha", {3, {Transfer::srgb, 2}, true});
    both_ways<u8>("u8/srgb_2_premultiplied", {2, {Transfer::srgb, 1}, true});
    both_ways<u8>("u8/srgb_4_premultiplied_planar", {4, srgb_alpha, true, Layout::planar});
    both_ways<u8>("u8/srgb_3_planar", {3, srgb, false, Layout::planar});
    both_ways<u8>("u8/srgb_5_premultiplied", {5, srgb_alpha, true});
    both_ways<u16>("u16/codes_4", {4, codes});
    both_ways<u16>("u16/codes_4_premultiplied", {4, linear_alpha, true});
    both_ways<u16>("u16/srgb_3", {3, srgb});
    both_ways<u16>("u16/srgb_4_premultiplied", {4, srgb_alpha, true});
    both_ways<Half>("half/linear_4", {4, codes});
    both_ways<Half>("half/linear_4_premultiplied", {4, linear_alpha, true});
    both_ways<float>("float/linear_1", {1, codes});
    both_ways<float>("float/linear_4", {4, codes});
    both_ways<float>("float/linear_4_premultiplied", {4, linear_alpha, true});
    both_ways<float>("float/linear_4_planar", {4, codes, false, Layout::planar});
    for (const int channels : {2, 4})
        benchmark::RegisterBenchmark(("composite/" + std::to_string(channels)).c_str(), composite, channels);
    return true;
}();

}  // namespace
}  // namespace bandlimit
