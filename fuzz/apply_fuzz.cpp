// Any bank on any shape: the vector form gives what the scalar definition gives, and writes nothing else.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/combine.h"
#include "fuzz/bytes.h"

namespace {

using namespace bandlimit;

/// Fused and separate multiply-adds differ by rounding; with fused ones both forms have the same bits.
bool is_close(float a, float b, int taps) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
    return std::abs(a - b) <= dot_bound(taps, 8.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes{data, size};
    const auto list = kernel_list();
    const Kernel kernel =
        parse_kernel(list[static_cast<std::size_t>(bytes.below(static_cast<int>(list.size())))].example);
    if (is_radial(kernel)) return 0;
    const int inputs = 1 + bytes.below(64), outputs = 1 + bytes.below(64), height = 1 + bytes.below(20),
              channels = 1 + bytes.below(5);
    const Edge edge = all_edges()[static_cast<std::size_t>(bytes.below(5))];
    const double begin = bytes.below(16) / 16.0, length = (1 + bytes.below(32)) / 16.0, antiring = bytes.below(3) / 2.0;
    try {
        const Bank bank = make_bank(kernel, Axis{inputs}, Axis{outputs, begin, begin + length}, edge);
        Image<float> src(inputs, height, channels, bytes.below(2) ? Layout::interleaved : Layout::planar);
        Image<float> fast(outputs, height, channels, bytes.below(2) ? Layout::interleaved : Layout::planar),
            exact(outputs, height, channels);
        Random random(static_cast<std::uint64_t>(bytes.below(256)));
        for (int c = 0; c < channels; ++c)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < inputs; ++x) src.view()(x, y, c) = static_cast<float>(random.uniform(-1, 1));
        apply(bank, src.view(), fast.view(), {1 + bytes.below(3)}, antiring);
        apply_scalar(bank, src.view(), exact.view(), antiring);
        for (int c = 0; c < channels; ++c)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < outputs; ++x)
                    if (!is_close(fast.view()(x, y, c), exact.view()(x, y, c), bank.row_info(x).count)) std::abort();
    } catch (const Error&) {  // axes that do not overlap
    }
    return 0;
}
