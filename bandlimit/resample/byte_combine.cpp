#include "bandlimit/resample/byte_combine.h"

#include <algorithm>
#include <map>
#include <utility>

namespace bandlimit {
namespace {

std::int32_t bytes_in_lane(const int (&bytes)[4]) {
    std::uint32_t lane = 0;
    for (int k = 0; k < 4; ++k) lane |= static_cast<std::uint32_t>(bytes[k] & 0xff) << (8 * k);
    return static_cast<std::int32_t>(lane);
}

}  // namespace

void make_column_taps(const ByteBank& bank, int output, ByteColumnTaps& taps) {
    const std::span<const std::int16_t> row = bank.row(output);
    const int first = bank.bank->first(output), count = static_cast<int>(row.size());
    taps.first_group = first >> 2;
    const int groups = ((first + count - 1) >> 2) - taps.first_group + 1;
    taps.high.clear();
    taps.low.clear();
    for (int g = 0; g < groups; ++g) {
        int high[4] = {}, low[4] = {};
        for (int k = 0; k < 4; ++k) {
            const int j = 4 * (taps.first_group + g) + k - first;
            if (j < 0 || j >= count) continue;
            const int weight = row[static_cast<std::size_t>(j)];
            high[k] = (weight + 64) >> 7;
            low[k] = weight - 128 * high[k];
        }
        taps.high.push_back(bytes_in_lane(high));
        taps.low.push_back(bytes_in_lane(low));
    }
}

BytePairs make_byte_pairs(const ByteBank& bank) {
    BytePairs pairs;
    std::map<std::pair<int, int>, std::uint32_t> known;  // by row and parity
    for (int i = 0; i < bank.bank->output_count(); ++i) {
        const std::span<const std::int16_t> row = bank.row(i);
        const int first = bank.bank->first(i), begin = first >> 1, odd = first & 1;
        const int count = (static_cast<int>(row.size()) + odd + 1) / 2;
        const auto at = [&](int j) {
            return j < 0 || j >= static_cast<int>(row.size())
                       ? 0u
                       : static_cast<std::uint32_t>(row[static_cast<std::size_t>(j)] & 0xffff);
        };
        const int row_index = bank.bank->outputs[static_cast<std::size_t>(i)].row;
        const auto [entry, is_new] =
            known.try_emplace({row_index, odd}, static_cast<std::uint32_t>(pairs.weights.size()));
        for (int p = 0; is_new && p < count; ++p)
            pairs.weights.push_back(static_cast<std::int32_t>(at(2 * p - odd) | at(2 * p + 1 - odd) << 16));
        pairs.outputs.push_back({begin, count, entry->second});
    }
    return pairs;
}

}  // namespace bandlimit
