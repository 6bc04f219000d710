#include "bandlimit/resample/fetch_banks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/bank_builder.h"
#include "bandlimit/resample/mapping.h"

namespace bandlimit {
namespace {

double sum_of(std::span<const LinearRead> reads) {
    return std::accumulate(reads.begin(), reads.end(), 0.0, [](double s, const LinearRead& r) { return s + r.weight; });
}

/// What the reads come to for an output that lies `fraction` right of a sample.
PhaseRow row_of(std::span<const LinearRead> reads, double fraction, double stretch) {
    std::map<int, double> found;
    for (const LinearRead& read : reads) {
        const double at = fraction + read.offset * stretch, whole = std::floor(at);
        found[static_cast<int>(whole)] += read.weight * (1 - (at - whole));
        if (at > whole) found[static_cast<int>(whole) + 1] += read.weight * (at - whole);
    }
    const int first = found.begin()->first;
    PhaseRow row{first, {}, first, first};
    for (const auto& [i, w] : found) {
        row.weights.resize(static_cast<std::size_t>(i - first + 1));
        row.weights.back() = w;
    }
    return row;
}

Bank bank_of_reads(std::span<const LinearRead> reads, const Axis& src, const Axis& dst, Edge edge) {
    const Mapping mapping(src, dst);
    BankBuilder builder(src.count, dst.count, edge, CutRows::unfinished);
    for (int i = 0; i < dst.count; ++i) {
        const Position at = mapping(i);
        builder.add(at, row_of(reads, at.fraction, std::abs(mapping.step()) / 2));
    }
    return builder.take();
}

}  // namespace

std::vector<FetchTerm> separate(const Fetches& fetches) {
    std::map<double, std::map<double, double>> rows;  // weights by y, then x
    for (const Fetch& f : fetches) rows[f.y][f.x] += f.weight;
    std::vector<FetchTerm> terms;
    for (const auto& [y, row] : rows) {
        FetchTerm term{{}, {{y, row.begin()->second}}};
        for (const auto& [x, weight] : row) term.x.push_back({x, weight / row.begin()->second});
        const auto is_alike = [&](const FetchTerm& other) {
            return std::equal(term.x.begin(), term.x.end(), other.x.begin(), other.x.end(),
                              [](const LinearRead& a, const LinearRead& b) {
                                  return a.offset == b.offset && std::abs(a.weight - b.weight) <= 1e-12;
                              });
        };
        const auto same = std::find_if(terms.begin(), terms.end(), is_alike);
        if (same == terms.end()) terms.push_back(std::move(term));
        else same->y.push_back(term.y.front());
    }
    return terms;
}

std::vector<BankTerm> bank_terms(const Fetches& fetches, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y) {
    const bool is_valid = std::all_of(fetches.begin(), fetches.end(), [](const Fetch& f) {
        return std::abs(f.x) <= 1 << 20 && std::abs(f.y) <= 1 << 20 && std::isfinite(f.weight);
    });
    if (fetches.empty() || !is_valid)
        fail("make_mips: ", fetches.size(), " fetches; pass at least one, all finite and within 2^20 texels");
    Fetches present;
    for (const Fetch& f : fetches)
        if (f.weight != 0) present.push_back(f);
    std::vector<BankTerm> terms;
    for (const FetchTerm& term : separate(present))
        terms.push_back({bank_of_reads(term.x, src.x, dst.x, edge_x), bank_of_reads(term.y, src.y, dst.y, edge_y),
                         sum_of(term.x), sum_of(term.y)});
    return terms;
}

std::vector<BankTerm> bank_terms(const Taps& taps, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y) {
    const auto bank_of = [&](const Axis& from, const Axis& to, Edge edge) {
        return from.count == to.count ? make_bank(Taps{0, {1}, 1}, from, to, edge) : make_bank(taps, from, to, edge);
    };
    const double sum = std::accumulate(taps.weights.begin(), taps.weights.end(), 0.0);
    return {{bank_of(src.x, dst.x, edge_x), bank_of(src.y, dst.y, edge_y), src.x.count == dst.x.count ? 1 : sum,
             src.y.count == dst.y.count ? 1 : sum}};
}

}  // namespace bandlimit
