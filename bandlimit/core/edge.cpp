#include "bandlimit/core/edge.h"

#include <algorithm>
#include <array>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr std::array edges{Edge::clamp, Edge::reflect, Edge::wrap, Edge::zero, Edge::renormalize};
constexpr std::array<std::string_view, edges.size()> names{"clamp", "reflect", "wrap", "zero", "renormalize"};

int wrapped(int i, int n) {
    const int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/// Period 2n, in 64 bits because 2n may not fit an int.
int reflected(long long i, long long n) {
    const long long rest = ((i % (2 * n)) + 2 * n) % (2 * n);
    return static_cast<int>(rest < n ? rest : 2 * n - 1 - rest);
}

}  // namespace

std::span<const Edge> all_edges() { return edges; }

std::string_view name_of(Edge edge) { return names[static_cast<std::size_t>(edge)]; }

Edge parse_edge(std::string_view name) {
    for (const Edge edge : edges)
        if (name_of(edge) == name) return edge;
    fail("edge \"", name, "\" is unknown; choose clamp, reflect, wrap, zero or renormalize");
}

int resolve(int i, int n, Edge edge) {
    if (i >= 0 && i < n) return i;
    switch (edge) {
        case Edge::clamp: return i < 0 ? 0 : n - 1;
        case Edge::reflect: return reflected(i, n);
        case Edge::wrap: return wrapped(i, n);
        case Edge::zero:
        case Edge::renormalize: break;
    }
    return -1;
}

IndexRange stored_indices(IndexRange read, int n, Edge edge) {
    if (read.begin >= 0 && read.end <= n) return read;
    if (edge == Edge::wrap || read.count() >= n) return {0, n};
    IndexRange range{n, 0};
    for (int v = read.begin; v < read.end; ++v) {
        const int i = resolve(v, n, edge);
        if (i < 0) continue;
        range.begin = std::min(range.begin, i);
        range.end = std::max(range.end, i + 1);
    }
    return range.begin < range.end ? range : IndexRange{};
}

}  // namespace bandlimit
