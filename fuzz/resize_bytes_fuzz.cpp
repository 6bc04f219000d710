// 8-bit codes of any shape and layout through any pair of banks: the vector form gives the codes of its definition.
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/byte_resize.h"
#include "fuzz/bytes.h"

namespace {

using namespace bandlimit;

Bank any_bank(Bytes& bytes, int inputs, int outputs) {
    const auto list = kernel_list();
    const auto chosen = static_cast<std::size_t>(bytes.below(static_cast<int>(list.size())));
    const Edge edge = all_edges()[static_cast<std::size_t>(bytes.below(5))];
    const double begin = bytes.below(16) / 16.0, end = bytes.below(40) / 16.0;
    return make_bank(parse_kernel(list[chosen].example), Axis{inputs}, Axis{outputs, begin, end}, edge);
}

Image<std::uint8_t> any_image(Bytes& bytes, int width, int height, int channels) {
    Image<std::uint8_t> image(width, height, channels, bytes.below(2) ? Layout::interleaved : Layout::planar);
    Random random(static_cast<std::uint64_t>(bytes.below(256)));
    const std::uint64_t mask = bytes.below(2) ? 0xff : 0;  // or runs of the largest code alone
    for (std::ptrdiff_t i = 0; i < std::ptrdiff_t{width} * height * channels; ++i)
        image.view().data[i] = static_cast<std::uint8_t>(mask ? random.bits() & mask : 255 * (random.bits() & 1));
    return image;
}

void check(Bytes bytes) {
    const int width = 1 + bytes.below(200), height = 1 + bytes.below(60), channels = 1 + bytes.below(5);
    const int new_width = 1 + bytes.below(200), new_height = 1 + bytes.below(60);
    const Bank x = any_bank(bytes, width, new_width), y = any_bank(bytes, height, new_height);
    const ByteBanks banks = make_byte_banks(x, y);
    const Image<std::uint8_t> src = any_image(bytes, width, height, channels);
    Image<std::uint8_t> fast = any_image(bytes, new_width, new_height, channels),
                        exact(new_width, new_height, channels);
    resize_bytes_scalar(banks, src.view(), 0, exact.view(), 0);
    const int cut = bytes.below(new_height + 1);
    const BytePlan plan = make_byte_plan(banks);
    RunMonitor nobody;
    for (const auto& [begin, end] : {std::pair{0, cut}, {cut, new_height}})
        for_each_run(banks.y, begin, end, [&](int first, int last, bool fits) {
            if (fits) resize_bytes(plan, src.view(), 0, fast.view(), 0, first, last, nobody);
        });
    for (int c = 0; c < channels; ++c)
        for (int v = 0; v < new_height; ++v)
            for (int u = 0; u < new_width; ++u)
                if (banks.x.fits(u) && banks.y.fits(v) && fast.view()(u, v, c) != exact.view()(u, v, c)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        check({data, size});
    } catch (const Error&) {  // axes that do not overlap, radial kernels
    }
    return 0;
}
