#include "bandlimit/resample/byte_combine.h"

#include <algorithm>
#include <array>
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

void make_column_taps(const ByteBank& bank, int output, int origin, ByteColumnTaps& taps) {
    const std::span<const std::int16_t> row = bank.row(output);
    const int first = bank.bank->first(output) - origin, count = static_cast<int>(row.size());
    taps.first_group = first >> 2;
    taps.high.clear();
    taps.low.clear();
    for (int g = taps.first_group; g <= (first + count - 1) >> 2; ++g) {
        int high[4] = {}, low[4] = {};
        for (int k = 0; k < 4; ++k) {
            const int j = 4 * g + k - first;
            if (j < 0 || j >= count) continue;
            const int weight = row[static_cast<std::size_t>(j)];
            high[k] = (weight + 64) >> 7;
            low[k] = weight - 128 * high[k];
        }
        taps.high.push_back(bytes_in_lane(high));
        taps.low.push_back(bytes_in_lane(low));
    }
}

int best_origin(const Bank& bank) {
    std::array<std::int64_t, 4> groups{};
    for (int i = 0; i < bank.output_count(); ++i)
        for (int origin = 0; origin < 4; ++origin) {
            const int first = bank.first(i) - origin, last = first + bank.row_info(i).count - 1;
            groups[static_cast<std::size_t>(origin)] += (last >> 2) - (first >> 2);
        }
    return static_cast<int>(std::min_element(groups.begin(), groups.end()) - groups.begin());
}

bool halves_by_box(const Bank& bank) {
    for (int i = 0; i < bank.output_count(); ++i) {
        const std::span<const float> row = bank.row(i);
        if (row.size() != 2 || row[0] != 0.5f || row[1] != 0.5f || bank.first(i) != 2 * i) return false;
    }
    return true;
}

BytePairs make_byte_pairs(const ByteBank& bank) {
    const auto pairs_of = [&](int i) {
        if (!bank.fits(i)) return 0;
        const int first = bank.bank->first(i), last = first + static_cast<int>(bank.row(i).size()) - 1;
        return (last >> 1) - (first >> 1) + 1;
    };
    const int outputs = bank.bank->output_count();
    BytePairs pairs;
    for (int i = 0; i < outputs; ++i) pairs.count = std::max(pairs.count, pairs_of(i));
    std::map<std::pair<int, int>, std::uint32_t> known;  // by row and parity
    for (int i = 0; i < outputs; ++i) {
        const std::span<const std::int16_t> row = bank.row(i);
        const int first = bank.bank->first(i), odd = first & 1;
        const auto at = [&](int j) {
            const bool is_there = j >= 0 && j < static_cast<int>(row.size());
            return is_there ? static_cast<std::uint32_t>(row[static_cast<std::size_t>(j)] & 0xffff) : 0u;
        };
        const auto next = static_cast<std::uint32_t>(pairs.weights.size());
        const auto entry = known.try_emplace({bank.bank->outputs[static_cast<std::size_t>(i)].row, odd}, next);
        for (int p = 0; entry.second && p < pairs.count; ++p)
            pairs.weights.push_back(static_cast<std::int32_t>(at(2 * p - odd) | at(2 * p + 1 - odd) << 16));
        pairs.outputs.push_back({first >> 1, entry.first->second});
    }
    return pairs;
}

}  // namespace bandlimit
