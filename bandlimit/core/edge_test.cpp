#include "bandlimit/core/edge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// One period of the endless row that an edge mode makes of n samples.
std::vector<int> period_of(int n, Edge edge) {
    std::vector<int> period;
    for (int i = 0; i < n; ++i) period.push_back(i);
    if (edge == Edge::reflect)
        for (int i = n - 1; i >= 0; --i) period.push_back(i);
    return period;
}

TEST(Edge, FourSamplesByHand) {
    // Indices -5 to 8 of [a b c d] = [0 1 2 3].
    const std::vector<int> clamp{0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3};
    const std::vector<int> reflect{3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0};
    const std::vector<int> wrap{3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0};
    for (int i = -5; i <= 8; ++i) {
        const auto at = static_cast<std::size_t>(i + 5);
        EXPECT_EQ(resolve(i, 4, Edge::clamp), clamp[at]) << i;
        EXPECT_EQ(resolve(i, 4, Edge::reflect), reflect[at]) << i;
        EXPECT_EQ(resolve(i, 4, Edge::wrap), wrap[at]) << i;
        const int inside = i >= 0 && i < 4 ? i : -1;
        EXPECT_EQ(resolve(i, 4, Edge::zero), inside) << i;
        EXPECT_EQ(resolve(i, 4, Edge::renormalize), inside) << i;
    }
}

TEST(Edge, RepeatsItsPeriodHoweverFarOutside) {
    for (const Edge edge : {Edge::reflect, Edge::wrap})
        for (int n = 1; n <= 40; ++n) {
            const std::vector<int> period = period_of(n, edge);
            const int length = static_cast<int>(period.size());
            for (int k = 0; k < length; ++k)
                for (const int turns : {-1000, -3, -2, -1, 0, 1, 2, 3, 1000})
                    ASSERT_EQ(resolve(k + turns * length, n, edge), period[static_cast<std::size_t>(k)])
                        << name_of(edge) << " n " << n << " k " << k << " turns " << turns;
        }
}

TEST(Edge, ExtremeIndicesDoNotOverflow) {
    for (const Edge edge : all_edges())
        for (const int n : {1, 2, 7, 1 << 30, INT_MAX})
            for (const int i : {INT_MIN, INT_MIN + 1, -1, 0, INT_MAX - 1, INT_MAX}) {
                const int at = resolve(i, n, edge);
                const bool drops = edge == Edge::zero || edge == Edge::renormalize;
                ASSERT_TRUE((at >= 0 && at < n) || (drops && at == -1)) << name_of(edge) << ' ' << i << ' ' << n;
            }
    EXPECT_EQ(resolve(-INT_MAX, INT_MAX, Edge::reflect), INT_MAX - 1);
    EXPECT_EQ(resolve(INT_MIN, INT_MAX, Edge::wrap), INT_MAX - 1);
}

TEST(Edge, NamesReadBack) {
    EXPECT_EQ(all_edges().size(), 5u);
    for (const Edge edge : all_edges()) EXPECT_EQ(parse_edge(name_of(edge)), edge);
    try {
        parse_edge("mirror");
        FAIL() << "an unknown name must throw";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("mirror"), std::string::npos);
        for (const Edge edge : all_edges()) EXPECT_NE(text.find(name_of(edge)), std::string::npos) << text;
    }
}

TEST(StoredIndices, HoldWhatIsReadAndNothingElse) {
    for (const Edge edge : all_edges())
        for (int n = 1; n <= 9; ++n)
            for (int begin = -12; begin < 20; ++begin)
                for (int end = begin + 1; end < 22; ++end) {
                    IndexRange least{n, 0};
                    for (int i = begin; i < end; ++i)
                        if (const int at = resolve(i, n, edge); at >= 0)
                            least = {std::min(least.begin, at), std::max(least.end, at + 1)};
                    if (least.count() < 0) least = {0, 0};
                    const IndexRange found = stored_indices({begin, end}, n, edge);
                    const bool is_exact = end - begin < n && (edge != Edge::wrap || (begin >= 0 && end <= n));
                    ASSERT_TRUE(is_exact ? found.begin == least.begin && found.end == least.end
                                         : found.begin <= least.begin && found.end >= least.end && found.end <= n)
                        << name_of(edge) << ' ' << n << ": " << begin << " to " << end << " gives " << found.begin
                        << " to " << found.end;
                }
}

}  // namespace
}  // namespace bandlimit
