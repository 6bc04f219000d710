#include "bandlimit/design/fold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// What the reads come to at each sample.
std::map<int, double> unfolded(const std::vector<LinearRead>& reads, const Taps& taps) {
    std::map<int, double> weights;
    for (const LinearRead& read : reads) {
        const double at = read.offset + output_offset(taps), whole = std::floor(at);
        weights[static_cast<int>(whole)] += read.weight * (1 - (at - whole));
        weights[static_cast<int>(whole) + 1] += read.weight * (at - whole);
    }
    return weights;
}

TEST(Fold, ReadsComeToTheWeights) {
    Random random(1);
    for (int count = 1; count <= 24; ++count) {
        for (const int factor : {1, 2, 3}) {
            Taps taps{-count / 2, {}, factor};
            for (int j = 0; j < count; ++j) taps.weights.push_back(j % 5 == 4 ? 0 : random.uniform() - 0.3);
            const auto reads = fold(taps);
            EXPECT_LE(reads.size(), taps.weights.size());
            const auto weights = unfolded(reads, taps);
            for (const auto& [i, w] : weights) {
                const int j = i - taps.first;
                const double expected = j >= 0 && j < count ? taps.weights[static_cast<std::size_t>(j)] : 0;
                EXPECT_NEAR(w, expected, 1e-14 * count) << count << " " << i;
            }
        }
    }
}

TEST(Fold, PositiveWeightsTakeHalfAsManyReads) {
    for (int count = 1; count <= 16; ++count) {
        Taps taps{-count / 2, std::vector<double>(static_cast<std::size_t>(count), 0.5), 1};
        EXPECT_EQ(fold(taps).size(), static_cast<std::size_t>((count + 1) / 2));
    }
}

TEST(Fold, SymmetricTapsHaveSymmetricReadsWhereThatIsCheap) {
    for (const int count : {5, 9, 13}) {
        Taps taps{-count / 2, {}, 1};
        for (int j = 0; j < count; ++j) taps.weights.push_back(std::exp(-0.1 * (j - count / 2) * (j - count / 2)));
        const auto reads = fold(taps);
        for (std::size_t i = 0; i < reads.size(); ++i) {
            EXPECT_NEAR(reads[i].offset, -reads[reads.size() - 1 - i].offset, 1e-14);
            EXPECT_NEAR(reads[i].weight, reads[reads.size() - 1 - i].weight, 1e-14);
        }
    }
}

}  // namespace
}  // namespace bandlimit
