#include "bandlimit/texture/fetches.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/mapping.h"

namespace bandlimit {
namespace {

constexpr int band = 16;  // output rows that are computed together

bool cuts(Edge edge) { return edge == Edge::zero || edge == Edge::renormalize; }

double sum_of(std::span<const LinearRead> reads) {
    return std::accumulate(reads.begin(), reads.end(), 0.0, [](double s, const LinearRead& r) { return s + r.weight; });
}

/// The weights of an output, from source sample `first` on.
struct Weights {
    int first = 0;
    std::vector<double> weights;
};

/// What the reads come to for an output that lies `fraction` right of a sample.
Weights weights_of(std::span<const LinearRead> reads, double fraction, double stretch) {
    std::map<int, double> found;
    for (const LinearRead& read : reads) {
        const double at = fraction + read.offset * stretch, whole = std::floor(at);
        found[static_cast<int>(whole)] += read.weight * (1 - (at - whole));
        if (at > whole) found[static_cast<int>(whole) + 1] += read.weight * (at - whole);
    }
    Weights result{found.begin()->first, {}};
    for (const auto& [i, w] : found) {
        result.weights.resize(static_cast<std::size_t>(i - result.first + 1));
        result.weights.back() = w;
    }
    return result;
}

/// Drops what lies outside `inputs` samples; at least one weight stays, if of 0.
Weights cut(const Weights& row, int inputs) {
    const int end = row.first + static_cast<int>(row.weights.size());
    const int from = std::clamp(row.first, 0, inputs), to = std::clamp(end, 0, inputs);
    if (from >= to) return {0, {0}};
    return {from, {row.weights.begin() + (from - row.first), row.weights.begin() + (to - row.first)}};
}

Bank bank_of_reads(std::span<const LinearRead> reads, const Axis& src, const Axis& dst, Edge edge) {
    const Mapping mapping(src, dst);
    Bank bank;
    bank.inputs = src.count;
    bank.edge = edge;
    std::map<std::int64_t, int> row_of_phase;
    const auto append = [&](const Weights& row) {
        bank.rows.push_back({bank.weights.size(), static_cast<int>(row.weights.size()), 0, 1});
        for (const double w : row.weights) bank.weights.push_back(static_cast<float>(w));
        return static_cast<int>(bank.rows.size()) - 1;
    };
    for (int i = 0; i < dst.count; ++i) {
        const Position at = mapping(i);
        Weights row = weights_of(reads, at.fraction, std::abs(mapping.step()) / 2);
        row.first += static_cast<int>(at.whole);
        const bool reaches_out = row.first < 0 || row.first + static_cast<int>(row.weights.size()) > src.count;
        if (cuts(edge) && reaches_out) {
            const Weights inside = cut(row, src.count);
            bank.outputs.push_back({inside.first, append(inside)});
            continue;
        }
        const auto known = row_of_phase.find(at.phase);
        const int index = known == row_of_phase.end() ? append(row) : known->second;
        row_of_phase[at.phase] = index;
        bank.outputs.push_back({row.first, index});
    }
    return bank;
}

/// Outputs [first, last) of a bank, whose inputs are those from `begin` on.
Bank part_of(const Bank& bank, int first, int last, IndexRange read) {
    Bank part{read.end - read.begin, Edge::clamp, bank.weights, bank.rows, {}};
    for (int i = first; i < last; ++i) {
        Bank::Output output = bank.outputs[static_cast<std::size_t>(i)];
        output.first -= read.begin;
        part.outputs.push_back(output);
    }
    return part;
}

}  // namespace

Fetches downsample8() {
    constexpr double inner = 0.75777, arm = 2.907, inner_weight = 0.37487566, arm_weight = -0.12487566;
    return {{-inner, -inner, inner_weight}, {inner, -inner, inner_weight}, {inner, inner, inner_weight},
            {-inner, inner, inner_weight},  {-arm, 0, arm_weight},         {arm, 0, arm_weight},
            {0, -arm, arm_weight},          {0, arm, arm_weight}};
}

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

TermFilter::TermFilter(const Fetches& fetches, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y,
                       bool premultiply)
    : edge_x_(edge_x), edge_y_(edge_y), premultiply_(premultiply) {
    const bool is_valid = std::all_of(fetches.begin(), fetches.end(), [](const Fetch& f) {
        return std::abs(f.x) <= 1 << 20 && std::abs(f.y) <= 1 << 20 && std::isfinite(f.weight);
    });
    if (fetches.empty() || !is_valid)
        fail("make_mips: ", fetches.size(), " fetches; pass at least one, all finite and within 2^20 texels");
    Fetches present;
    for (const Fetch& f : fetches)
        if (f.weight != 0) present.push_back(f);
    for (const FetchTerm& term : separate(present))
        add_term(bank_of_reads(term.x, src.x, dst.x, edge_x), bank_of_reads(term.y, src.y, dst.y, edge_y),
                 sum_of(term.x), sum_of(term.y));
    find_borders();
}

TermFilter::TermFilter(const Taps& taps, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y, bool premultiply)
    : edge_x_(edge_x), edge_y_(edge_y), premultiply_(premultiply) {
    const auto bank_of = [&](const Axis& from, const Axis& to, Edge edge) {
        return from.count == to.count ? make_bank(Taps{0, {1}, 1}, from, to, edge) : make_bank(taps, from, to, edge);
    };
    // Such banks are renormalized by themselves.
    add_term(bank_of(src.x, dst.x, edge_x), bank_of(src.y, dst.y, edge_y), 1, 1);
    border_x_.assign(border_x_.size(), false);
    border_y_.assign(border_y_.size(), false);
}

void TermFilter::add_term(Bank x, Bank y, double whole_x, double whole_y) {
    // What is not dropped of each output's weights, and where that is not all.
    const auto sums = [](const Bank& bank, double whole, std::vector<char>& is_border) {
        std::vector<double> result(bank.outputs.size(), whole);
        is_border.resize(result.size());
        if (bank.edge != Edge::renormalize) return result;
        for (std::size_t i = 0; i < result.size(); ++i) {
            const std::span<const float> row = bank.row(static_cast<int>(i));
            const double sum = std::accumulate(row.begin(), row.end(), 0.0);
            if (std::abs(sum - whole) < 1e-6) continue;  // the rounding of weights
            result[i] = sum;
            is_border[i] = true;
        }
        return result;
    };
    Term term{std::move(x), std::move(y), {}, {}};
    term.sum_x = sums(term.x, whole_x, border_x_);
    term.sum_y = sums(term.y, whole_y, border_y_);
    whole_ += whole_x * whole_y;
    terms_.push_back(std::move(term));
}

double TermFilter::sum_at(int x, int y) const {
    double sum = 0;
    for (const Term& term : terms_)
        sum += term.sum_x[static_cast<std::size_t>(x)] * term.sum_y[static_cast<std::size_t>(y)];
    return sum;
}

void TermFilter::find_borders() {
    if (edge_x_ != Edge::renormalize && edge_y_ != Edge::renormalize) return;
    if (terms_.empty() || std::abs(whole_) < 1e-9)
        fail("make_mips: fetches that sum to ", whole_, " cannot be renormalized; use Edge::reflect");
    for (int y = 0; y < static_cast<int>(border_y_.size()); ++y)
        for (int x = 0; x < static_cast<int>(border_x_.size()); ++x)
            if ((border_x_[static_cast<std::size_t>(x)] || border_y_[static_cast<std::size_t>(y)]) &&
                !(std::abs(sum_at(x, y)) > 1e-6 * std::abs(whole_)))
                fail("make_mips: output (", x, ", ", y,
                     ") has no weight inside the level above; use Edge::clamp or Edge::reflect");
}

Image<float> TermFilter::source_rows(const SourceRows& source, int begin, int end) const {
    const Bank& y_bank = terms_[0].y;
    const int channels = shape_of(source.samples).channels;
    Image<float> rows(terms_[0].x.inputs, end - begin, channels, Layout::interleaved);
    const auto length = static_cast<std::size_t>(rows.width()) * static_cast<std::size_t>(channels);
    for (int v = begin; v < end; ++v) {
        const int y = resolve(v, y_bank.inputs, y_bank.edge);  // where nothing is read, rows stay zero
        if (y >= 0)
            decode_row(source.samples, y - source.first_row, source.encoding, premultiply_,
                       {&rows.view()(0, v - begin), length});
    }
    return rows;
}

void TermFilter::rescale(std::span<float> row, int y, int channels) const {
    const bool all = border_y_[static_cast<std::size_t>(y)] != 0;
    const auto count = static_cast<std::size_t>(channels);
    for (std::size_t x = 0; x < border_x_.size(); ++x) {
        if (!all && !border_x_[x]) continue;
        const auto scale = static_cast<float>(whole_ / sum_at(static_cast<int>(x), y));
        for (float& sample : row.subspan(x * count, count)) sample *= scale;
    }
}

bool TermFilter::rows(const SourceRows& source, const TargetRows& target, int first, int last) const {
    IndexRange read = indices_read(terms_[0].y, first, last);
    for (const Term& term : terms_) {
        const IndexRange more = indices_read(term.y, first, last);
        read = {std::min(read.begin, more.begin), std::max(read.end, more.end)};
    }
    const Image<float> from = source_rows(source, read.begin, read.end);
    const int channels = from.channels(), count = last - first, width = terms_[0].x.output_count();
    Image<float> sum(width, count, channels, Layout::interleaved), part(width, count, channels, Layout::interleaved);
    Image<float> middle(from.width(), count, channels, Layout::interleaved);
    const std::size_t length = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    for (const Term& term : terms_) {
        const bool is_first = &term == &terms_[0];
        apply(part_of(term.y, first, last, read), transposed(from.view()), transposed(middle.view()), {1});
        apply(term.x, middle.view(), is_first ? sum.view() : part.view(), {1});
        if (is_first) continue;
        for (std::size_t i = 0; i < length * static_cast<std::size_t>(count); ++i)
            sum.view().data[i] += part.view().data[i];
    }
    bool lost = false;
    for (int i = 0; i < count; ++i) {
        const std::span<float> row{&sum.view()(0, i), length};
        rescale(row, first + i, channels);
        const int y = first + i - target.first_row;
        lost |= encode_row(row, premultiply_ || source.encoding.associated, target.samples, y, target.encoding);
    }
    return lost;
}

bool TermFilter::run(const SourceRows& source, const TargetRows& target, Parallel parallel) const {
    const int height = terms_[0].y.output_count();
    std::atomic<bool> lost = false;
    parallel_for(height, band, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int first = static_cast<int>(begin); first < end; first += band)
            if (rows(source, target, first, std::min(first + band, static_cast<int>(end)))) lost = true;
    });
    return lost;
}

}  // namespace bandlimit
