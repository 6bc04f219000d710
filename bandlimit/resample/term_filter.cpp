#include "bandlimit/resample/term_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/bank_builder.h"
#include "bandlimit/resample/border_scale.h"
#include "bandlimit/resample/caches.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/row_loader.h"
#include "bandlimit/resample/row_store.h"
#include "bandlimit/resample/rows.h"
#include "bandlimit/resample/sliding.h"
#include "bandlimit/resample/tiles.h"

namespace bandlimit {
namespace {

constexpr int block = 16;                  // output rows computed together: their windows overlap
constexpr double most_expanded = 1 << 22;  // weights that are written out to sum them: 32 MiB
constexpr int least_columns = 32;          // of a strip: less would be more edge than strip
constexpr int chunk = 64;                  // floats: four vectors of 512 bits, all that one step of combine() takes

/// The sums of weights per output that drop nothing but what lies outside, by which BorderScale rescales.
std::vector<std::vector<double>> sums_inside(std::span<const BankTerm> terms, Bank BankTerm::*bank,
                                             double BankTerm::*whole) {
    std::vector<std::vector<double>> sums((terms[0].*bank).outputs.size(), std::vector<double>(terms.size()));
    for (std::size_t t = 0; t < terms.size(); ++t) {
        const Bank& of = terms[t].*bank;
        const double expected = terms[t].*whole;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const std::span<const float> row = of.row(static_cast<int>(i));
            const double sum = std::accumulate(row.begin(), row.end(), 0.0);
            const bool is_whole = of.edge != Edge::renormalize || std::abs(sum - expected) < 1e-6;  // of rounding
            sums[i][t] = is_whole ? expected : sum;
        }
    }
    return sums;
}

bool read_the_same(const Bank& a, const Bank& b) {
    for (int i = 0; i < a.output_count(); ++i)
        if (a.first(i) != b.first(i) || a.row_info(i).count != b.row_info(i).count) return false;
    return true;
}

/// Columns whose samples are whole chunks.
int chunk_columns(int channels) { return chunk / std::gcd(chunk, channels); }

/// Weights that are the same for `outputs` outputs: columns of several terms, sample by sample. Where they sum to 1, as
/// those of the direct convolution may, what is 1 everywhere stays exactly 1.
Bank uniform_bank(std::span<const Term> terms, int first, int inputs, int outputs, Edge edge) {
    Bank bank;
    bank.inputs = inputs;
    bank.edge = edge;
    std::vector<double> weights;
    for (std::size_t j = 0; j < terms[0].column.size(); ++j)
        for (const Term& term : terms) weights.push_back(term.column[j]);
    bank.weights = rounded_weights(weights);
    bank.rows.push_back({0, static_cast<int>(bank.weights.size()), 0, 1});
    const int count = static_cast<int>(terms.size());
    for (int i = 0; i < outputs; ++i) bank.outputs.push_back({(i + first) * count, 0});
    return bank;
}

void check(const Terms& terms, int width, int height) {
    if (width < 1 || height < 1) fail("term_filter: ", width, " x ", height, " samples; pass at least one");
    double lines = 0;
    for (const Term& term : terms) {
        lines += height + static_cast<double>(term.column.size());
        for (const std::vector<double>* weights : {&term.column, &term.row})
            for (const double w : *weights)
                if (!std::isfinite(w)) fail("term_filter: a weight is ", w, "; pass finite ones");
    }
    if (lines > std::numeric_limits<int>::max())
        fail("term_filter: ", terms.size(), " terms of ", height, " rows; pass fewer than 2^31 lines in all");
}

/// Output columns that are computed from top to bottom before the next ones.
struct TermStrip {
    int first = 0, last = 0;
    IndexRange read;                              ///< the source columns; may reach outside
    std::vector<std::vector<TileRun>> runs = {};  ///< of each term with a bank of its own
    /// Else: output b * terms + t is what term t makes of chunk b of the columns, so that neighbours read the same.
    Bank x = {};
};

/// Terms ready to run.
class TermPlan {
public:
    TermPlan(std::vector<BankTerm> terms, bool premultiply);
    TermPlan(const Terms& terms, int first_x, int first_y, const FilterDomain& domain);

    double bytes(int channels, const Parallel& parallel) const;
    IndexRange rows_read(int first, int last) const;
    std::vector<TermStrip> strips(int channels, const Parallel& parallel) const;

    int width() const { return domain_.width; }
    int height() const { return domain_.height; }
    RowProtocol::Source source() const { return {source_width_, source_height_, domain_.edge_y}; }

private:
    friend class TermRun;
    /// What makes the line of a term from a source row.
    struct Line {
        Bank x = {};            ///< where outputs have weights of their own
        bool is_shift = false;  ///< else: the source row itself, `index` columns to the right,
        int index = 0;          ///< or what row `index` of shared_x_ makes of it
    };
    /// Terms [first, first + count) that read the same rows for each output. Sample v of term first + t is line
    /// v * count + t of the bank.
    struct Group {
        int first = 0, count = 0;
        Bank y;
    };

    void add_group(std::span<const BankTerm> terms);
    Bank bank_of_chunks(int columns, int channels) const;
    IndexRange columns_read(int first, int last) const;
    static IndexRange rows_read(const Group& group, int first, int last);
    bool is_shared() const { return taps_x_ > 0; }
    int computed() const { return static_cast<int>(lines_.size()) - shifts_; }

    std::vector<Line> lines_;  ///< of each term
    int shifts_ = 0;           ///< how many are shifts
    Bank shared_x_;            ///< a row per term that is none, where all outputs have the same weights
    std::vector<Group> groups_;
    int first_x_ = 0, taps_x_ = 0;  ///< of weights that all outputs share
    int source_width_ = 0, source_height_ = 0;
    FilterDomain domain_;  ///< the output
    BorderScale border_;
};

TermPlan::TermPlan(std::vector<BankTerm> terms, bool premultiply) {
    if (terms.empty()) fail("term_filter: no terms; pass at least one");
    const BankTerm& one = terms[0];
    domain_ = {one.x.output_count(), one.y.output_count(), one.x.edge, one.y.edge, premultiply};
    source_width_ = one.x.inputs, source_height_ = one.y.inputs;
    for (const BankTerm& t : terms)
        if (t.x.inputs != source_width_ || t.y.inputs != source_height_ || t.x.output_count() != domain_.width ||
            t.y.output_count() != domain_.height || t.x.edge != domain_.edge_x || t.y.edge != domain_.edge_y)
            fail("term_filter: banks from ", t.x.inputs, " x ", t.y.inputs, " to ", t.x.output_count(), " x ",
                 t.y.output_count(), " among those from ", source_width_, " x ", source_height_, " to ", domain_.width,
                 " x ", domain_.height, "; pass banks of one size and edge");
    std::vector<std::pair<double, double>> whole;
    for (const BankTerm& t : terms) whole.emplace_back(t.sum_x, t.sum_y);
    border_ = BorderScale(whole, sums_inside(terms, &BankTerm::x, &BankTerm::sum_x),
                          sums_inside(terms, &BankTerm::y, &BankTerm::sum_y));
    for (auto first = terms.begin(); first != terms.end();) {
        const auto last = std::stable_partition(first + 1, terms.end(),
                                                [&](const BankTerm& t) { return read_the_same(t.y, first->y); });
        add_group({first, last});
        for (; first != last; ++first) lines_.push_back({std::move(first->x), false, 0});
    }
}

void TermPlan::add_group(std::span<const BankTerm> terms) {
    Group group{static_cast<int>(lines_.size()), static_cast<int>(terms.size()), {}};
    group.y.inputs = source_height_;
    group.y.edge = domain_.edge_y;
    for (int i = 0; i < domain_.height; ++i) {
        const Bank::Row& shape = terms[0].y.row_info(i);
        group.y.outputs.push_back({terms[0].y.first(i) * group.count, i});
        group.y.rows.push_back({group.y.weights.size(), shape.count * group.count, 0, 1});
        for (int j = 0; j < shape.count; ++j)
            for (const BankTerm& t : terms) group.y.weights.push_back(t.y.row(i)[static_cast<std::size_t>(j)]);
    }
    groups_.push_back(std::move(group));
}

TermPlan::TermPlan(const Terms& terms, int first_x, int first_y, const FilterDomain& domain)
    : first_x_(first_x), source_width_(domain.width), source_height_(domain.height), domain_(domain) {
    check(terms, domain.width, domain.height);
    const auto scale = [&](const auto& weights) {
        return BorderScale(weights, first_x, first_y, domain.width, domain.height, domain.edge_x, domain.edge_y);
    };
    border_ = size_of(terms).count() <= most_expanded ? scale(expanded(terms)) : scale(terms);
    taps_x_ = static_cast<int>(terms[0].row.size());
    shared_x_.inputs = taps_x_;
    Terms columns;
    for (const Term& term : terms) {
        const auto is_used = [](double w) { return w != 0; };
        columns.push_back({term.column, {}});
        const auto used = std::find_if(term.row.begin(), term.row.end(), is_used);
        if (used != term.row.end() && std::none_of(used + 1, term.row.end(), is_used)) {
            lines_.push_back({{}, true, static_cast<int>(used - term.row.begin())});
            for (double& w : columns.back().column) w *= *used;
            ++shifts_;
            continue;
        }
        lines_.push_back({{}, false, static_cast<int>(shared_x_.rows.size())});
        shared_x_.rows.push_back({shared_x_.weights.size(), taps_x_, 0, 1});
        const std::vector<float> row = rounded_weights(term.row);
        shared_x_.weights.insert(shared_x_.weights.end(), row.begin(), row.end());
    }
    groups_.push_back({0, static_cast<int>(terms.size()),
                       uniform_bank(columns, first_y, domain.height, domain.height, domain.edge_y)});
}

IndexRange TermPlan::rows_read(const Group& group, int first, int last) {
    const IndexRange lines = indices_read(group.y, first, last);
    return {lines.begin / group.count, lines.end / group.count};
}

IndexRange TermPlan::rows_read(int first, int last) const {
    IndexRange all = rows_read(groups_[0], first, last);
    for (const Group& group : groups_) {
        const IndexRange read = rows_read(group, first, last);
        all = {std::min(all.begin, read.begin), std::max(all.end, read.end)};
    }
    return all;
}

IndexRange TermPlan::columns_read(int first, int last) const {
    if (is_shared()) return {first + first_x_, last - 1 + first_x_ + taps_x_};
    IndexRange all = indices_read(lines_[0].x, first, last);
    for (const Line& line : lines_) {
        const IndexRange read = indices_read(line.x, first, last);
        all = {std::min(all.begin, read.begin), std::max(all.end, read.end)};
    }
    return all;
}

double TermPlan::bytes(int channels, const Parallel& parallel) const {
    const std::vector<TermStrip> all = strips(channels, parallel);
    const TermStrip& widest = all.front();
    const IndexRange rows = rows_read(domain_.height / 2, std::min(domain_.height, domain_.height / 2 + block));
    const double lines =
        double(computed()) * (widest.last - widest.first) + (shifts_ > 0 ? widest.read.end - widest.read.begin : 0);
    return parallel.count() * 1.25 * rows.count() * lines * channels * double(sizeof(float));
}

Bank TermPlan::bank_of_chunks(int columns, int channels) const {
    Bank bank = shared_x_;
    const int step = chunk_columns(channels);
    for (int x = 0; x < columns; x += step)
        for (int t = 0; t < computed(); ++t) bank.outputs.push_back({x, t});
    return bank;
}

std::vector<TermStrip> TermPlan::strips(int channels, const Parallel& parallel) const {
    const IndexRange rows = rows_read(domain_.height / 2, std::min(domain_.height, domain_.height / 2 + block));
    const IndexRange some = columns_read(domain_.width / 2, domain_.width / 2 + 1);
    const double columns_of_cache = strip_bytes / ((rows.end - rows.begin) * channels * double(sizeof(float)));
    const double beside = shifts_ > 0 ? some.end - some.begin : 0;
    const double fitting = (columns_of_cache - beside) / (computed() + (shifts_ > 0 ? 1 : 0));
    // Each thread gets one, if they do not get too narrow.
    const double share = std::ceil(static_cast<double>(domain_.width) / parallel.count());
    const int step = chunk_columns(channels);
    const int columns =
        (static_cast<int>(std::max<double>(std::min(fitting, share), least_columns)) - 1) / step * step + step;
    std::vector<TermStrip> all;
    for (int first = 0; first < domain_.width; first += columns) {
        const int last = first + std::min(columns, domain_.width - first);
        TermStrip strip{first, last, columns_read(first, last)};
        if (is_shared()) strip.x = bank_of_chunks(last - first, channels);
        else
            for (const Line& line : lines_) strip.runs.push_back(tile_runs(line.x, strip.first, strip.last));
        all.push_back(std::move(strip));
    }
    return all;
}

/// Computes the output columns of one strip in one thread.
class TermRun {
public:
    TermRun(const TermPlan& plan, const RowRun& run, const TermStrip& strip)
        : plan_(plan),
          run_(run),
          strip_(strip),
          channels_(run.channels),
          outputs_(strip.last - strip.first),
          columns_(strip.read.end - strip.read.begin),
          step_(chunk_columns(channels_)),
          padding_((outputs_ + step_ - 1) / step_ * step_ - outputs_),
          loader_(run.sources[0], strip.read, plan.source_height_, plan.domain_.edge_x, plan.domain_.edge_y,
                  plan.domain_.premultiply),
          store_(run, strip.first, outputs_, plan.domain_.premultiply),
          decoded_(keeps_source() ? 0 : block, length(columns_ + padding_)),
          out_(block, length(outputs_ + padding_)),
          part_(plan.groups_.size() > 1 ? block : 0, length(outputs_ + padding_)),
          nothing_(length(columns_ + padding_)) {}

    /// Makes `rows` of the target; returns whether something not finite was lost.
    bool make(IndexRange rows) {
        bool lost = false;
        for (int first = rows.begin; first < rows.end; first += block) {
            const int last = std::min(first + block, rows.end);
            hold(plan_.rows_read(first, last));
            for (const TermPlan::Group& group : plan_.groups_) sum(group, first, last);
            for (int i = first; i < last; ++i) {
                const std::span<float> row{out_[i - first], length(outputs_)};
                plan_.border_.apply(row, strip_.first, i, channels_);
                lost |= store_.store(row, i);
            }
            run_.monitor.made(std::int64_t{last - first} * outputs_ * channels_);
        }
        return lost;
    }

private:
    std::size_t length(int width) const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels_);
    }
    bool keeps_source() const { return plan_.shifts_ > 0; }

    /// What the window knows row v by: rows that an edge leads to are not made twice, but for a wrap, whose rows would
    /// not be neighbours. -1 for rows of zeros.
    int held_row(int v) const {
        return plan_.domain_.edge_y == Edge::wrap ? v : resolve(v, plan_.source_height_, plan_.domain_.edge_y);
    }

    void hold(IndexRange read) {
        if (plan_.domain_.edge_y != Edge::wrap) read = stored_indices(read, plan_.source_height_, plan_.domain_.edge_y);
        if (read.begin >= read.end) return;  // rows of zeros
        window_.hold(
            read,
            [&](int slots) {
                if (plan_.computed() > 0) held_ = Rows(slots * plan_.computed(), length(outputs_ + padding_));
                if (keeps_source()) decoded_ = Rows(slots, length(columns_ + padding_));
            },
            [&](int v, int slot, int count) {
                for (int done = 0; done < count; done += block)
                    filter_x(v + done, slot + done, std::min(block, count - done));
            });
    }

    /// Makes the lines of rows [v, v + count) in slots of the window.
    void filter_x(int v, int slot, int count) {
        const int at = keeps_source() ? slot : 0;
        for (int i = 0; i < count; ++i) loader_.load(v + i, decoded_[at + i]);
        if (plan_.computed() == 0) return;
        if (plan_.is_shared()) {
            for (int i = 0; i < count; ++i) filter_shared(decoded_[at + i], slot + i);
            return;
        }
        const int terms = plan_.computed();
        for (int t = 0; t < terms; ++t)
            apply_by_tiles(plan_.lines_[static_cast<std::size_t>(t)].x, strip_.runs[static_cast<std::size_t>(t)],
                           decoded_.view(at, count, columns_, channels_), strip_.read.begin,
                           held_.view(slot * terms + t, count, outputs_, channels_, terms), strip_.first, 0);
    }

    /// Where all outputs have the same weights, a filter along x is a sum of the row with itself, shifted.
    void filter_shared(const float* row, int slot) {
        const int terms = plan_.computed();
        shifted_.clear();
        for (int x = 0; x < columns_ + padding_; ++x) shifted_.push_back(row + length(x));
        chunks_.clear();
        for (int x = 0; x < outputs_; x += step_)
            for (int t = 0; t < terms; ++t) chunks_.push_back(held_[slot * terms + t] + length(x));
        combine(strip_.x, 0, strip_.x.output_count(), 0, shifted_.data(), chunks_.data(), length(step_));
    }

    const float* line_of(const TermPlan::Line& line, int term, int v) {
        const int row = held_row(v);
        if (row < 0 && plan_.domain_.edge_y != Edge::wrap) return nothing_.data();
        const int slot = window_.slot_of(row);
        if (line.is_shift) return decoded_[slot] + length(line.index);
        return held_[slot * plan_.computed() + (plan_.is_shared() ? line.index : term)];
    }

    /// Adds output rows [first, last) of a group to those before.
    void sum(const TermPlan::Group& group, int first, int last) {
        const IndexRange read = TermPlan::rows_read(group, first, last);
        lines_.clear();
        for (int v = read.begin; v < read.end; ++v)
            for (int t = group.first; t < group.first + group.count; ++t)
                lines_.push_back(line_of(plan_.lines_[static_cast<std::size_t>(t)], t, v));
        const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(read.begin) * group.count;
        Rows& to = group.first == 0 ? out_ : part_;
        combine(group.y, first, last, 0, lines_.data() - begin, to.lines(), length(outputs_ + padding_));
        if (group.first == 0) return;
        for (int i = 0; i < last - first; ++i)
            for (std::size_t k = 0; k < length(outputs_); ++k) out_[i][k] += part_[i][k];
    }

    const TermPlan& plan_;
    const RowRun& run_;
    const TermStrip& strip_;
    int channels_, outputs_, columns_;
    int step_, padding_;  ///< columns of a chunk, and how many outputs fill up the last one
    RowLoader loader_;
    RowStore store_;
    SlidingWindow window_;
    Rows decoded_;  ///< source rows: those of the window where terms are shifts of them, else the last ones
    Rows held_;     ///< what terms made of each row of the window
    Rows out_, part_;
    std::vector<float> nothing_;
    std::vector<const float*> shifted_, lines_;
    std::vector<float*> chunks_;
};

RowWork start(const TermPlan& plan, const RowRun& run) {
    const auto strips = std::make_shared<const std::vector<TermStrip>>(plan.strips(run.channels, run.parallel));
    const int strip_count = static_cast<int>(strips->size());
    // Strips by themselves filter each row once. Where there are fewer than threads, rows at borders are made twice.
    const RowParts parts(run.rows(), 4 * block, (run.parallel.count() - 1) / strip_count + 1);
    return {strip_count * parts.count(), [&plan, &run, strips, parts](int piece) {
                const TermStrip& strip = (*strips)[static_cast<std::size_t>(piece / parts.count())];
                return TermRun(plan, run, strip).make(parts[piece % parts.count()]);
            }};
}

RowFilter filter_of(std::shared_ptr<const TermPlan> plan) {
    return RowFilter(
        {.name = "term_filter",
         .sources = {plan->source()},
         .width = plan->width(),
         .height = plan->height(),
         .rows_read = [plan](std::size_t, int first, int last) { return plan->rows_read(first, last); },
         .bytes = [plan](int channels, const Parallel& parallel) { return plan->bytes(channels, parallel); },
         .start = [plan](const RowRun& run) { return start(*plan, run); }});
}

}  // namespace

RowFilter term_filter(std::vector<BankTerm> terms, bool premultiply) {
    return filter_of(std::make_shared<const TermPlan>(std::move(terms), premultiply));
}

RowFilter term_filter(const Terms& terms, int first_x, int first_y, const FilterDomain& domain) {
    return filter_of(std::make_shared<const TermPlan>(terms, first_x, first_y, domain));
}

Terms direct_terms(const WeightGrid& weights) {
    Terms terms;
    for (int x = 0; x < weights.width; ++x) {
        Term term{std::vector<double>(static_cast<std::size_t>(weights.height)),
                  std::vector<double>(static_cast<std::size_t>(weights.width))};
        for (int y = 0; y < weights.height; ++y) term.column[static_cast<std::size_t>(y)] = weights.at(x, y);
        term.row[static_cast<std::size_t>(x)] = 1;
        const bool is_last_hope = terms.empty() && x + 1 == weights.width;
        if (is_last_hope || std::any_of(term.column.begin(), term.column.end(), [](double w) { return w != 0; }))
            terms.push_back(std::move(term));
    }
    return terms;
}

}  // namespace bandlimit
