#include "bandlimit/design/fold.h"

#include <cstddef>

namespace bandlimit {
namespace {

/// The read of `count` (1 or 2) weights from index j on.
LinearRead read_of(const Taps& taps, std::size_t j, std::size_t count) {
    const double at = taps.first + static_cast<double>(j) - output_offset(taps);
    if (count == 1) return {at, taps.weights[j]};
    const double sum = taps.weights[j] + taps.weights[j + 1];
    return {at + taps.weights[j + 1] / sum, sum};
}

}  // namespace

std::vector<LinearRead> fold(const Taps& taps) {
    const std::vector<double>& w = taps.weights;
    std::vector<LinearRead> reads;
    for (std::size_t begin = 0; begin < w.size();) {
        std::size_t end = begin + 1;
        while (end < w.size() && w[end] * w[begin] > 0) ++end;
        const std::size_t length = end - begin, middle = begin + length / 2;
        // Left of what stays alone there must be whole pairs.
        const std::size_t alone = length % 2 == 0 ? end : (length / 2) % 2 == 0 ? middle : end - 1;
        for (std::size_t j = begin; j < end && w[begin] != 0;) {
            const std::size_t count = j == alone ? 1 : 2;
            reads.push_back(read_of(taps, j, count));
            j += count;
        }
        begin = end;
    }
    return reads;
}

}  // namespace bandlimit
