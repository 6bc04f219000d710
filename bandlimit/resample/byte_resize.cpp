#include "bandlimit/resample/byte_resize.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "bandlimit/core/allocator.h"
#include "bandlimit/resample/caches.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/sliding.h"
#include "bandlimit/resample/transpose.h"

namespace bandlimit {
namespace {

template <class T>
using Samples = std::vector<T, SampleAllocator<T>>;

/// Whether the samples of channels [c, c + count) lie as the loops take them.
template <class T>
bool is_in_place(const View<T>& v, int count, Pixel pixel) {
    return v.dx == static_cast<int>(pixel) && count == static_cast<int>(pixel) && (count == 1 || v.dc == 1);
}

/// Whether 2 or 3 samples of a pixel lie side by side, and pixels too.
template <class T>
bool is_narrow(const View<T>& v, int count, Pixel pixel) {
    return pixel == Pixel::four && (count == 2 || count == 3) && v.dx == count && v.dc == 1;
}

/// Rows of source samples, in place or copied to where they lie side by side.
class SourceReader {
public:
    SourceReader(const ByteLoops& loops, View<const std::uint8_t> src, int c, int count, Pixel pixel)
        : loops_(loops),
          src_(src),
          c_(c),
          count_(count),
          lanes_(static_cast<std::size_t>(pixel)),
          in_place_(is_in_place(src, count, pixel)) {
        if (!in_place_) copies_.resize(4 * bytes());
    }
    std::size_t bytes() const { return static_cast<std::size_t>(src_.width) * lanes_; }

    /// Row y of the view, in place or in copy k of 4.
    const std::uint8_t* row(int y, int k) {
        if (in_place_) return &src_(0, y, c_);
        std::uint8_t* const copy = copies_.data() + static_cast<std::size_t>(k) * bytes();
        if (is_narrow(src_, count_, Pixel{static_cast<int>(lanes_)})) {
            loops_.spread_pixels(&src_(0, y, c_), count_, static_cast<std::size_t>(src_.width), copy);
            return copy;
        }
        for (int c = 0; c < count_; ++c) {
            const std::uint8_t* from = &src_(0, y, c_ + c);
            std::uint8_t* to = copy + c;
            for (int x = 0; x < src_.width; ++x, from += src_.dx, to += lanes_) *to = *from;
        }
        return copy;
    }

    /// Row y of the view where it is read in place, else null.
    const std::uint8_t* row_in_place(int y) const { return in_place_ ? &src_(0, y, c_) : nullptr; }

private:
    const ByteLoops& loops_;
    View<const std::uint8_t> src_;
    int c_, count_;
    std::size_t lanes_;
    bool in_place_;
    Samples<std::uint8_t> copies_;
};

/// Computes the columns of a strip from the channels [c, c + count) of the views, as samples of `pixel`.
class ByteRun {
public:
    ByteRun(const ByteLoops& loops, const BytePlan& plan, View<const std::uint8_t> src, int first_source,
            View<std::uint8_t> dst, int first_target, int c, int count, Pixel pixel, const ByteStrip& strip,
            RunMonitor& monitor)
        : loops_(loops),
          plan_(plan),
          strip_(strip),
          x_(*plan.banks.x.bank),
          y_(*plan.banks.y.bank),
          dst_(dst),
          first_source_(first_source),
          first_target_(first_target),
          c_(c),
          count_(count),
          pixel_(pixel),
          lanes_(static_cast<std::size_t>(pixel)),
          block_(tile_rows(pixel)),
          monitor_(monitor),
          reader_(loops, cropped(src, strip.stored.begin, 0, strip.stored.end - strip.stored.begin, src.height), c,
                  count, pixel),
          padded_(whole_columns(reader_.bytes())),
          left_(std::max(0, strip.stored.begin / 2 - (strip.read.begin >> 1))) {
        const std::size_t pairs =
            static_cast<std::size_t>(left_) + padded_ / lanes_ / 2 +
            static_cast<std::size_t>(std::max(0, strip.read.end - strip.stored.end) / 2 + 1 + plan.pairs.count);
        tile_.resize(pairs * tile_pair);
        if (pixel == Pixel::one) middle_.resize(2 * pairs * static_cast<std::size_t>(block_));
        pitch_ = 2 * pairs;
        if (!is_in_place(dst, count, pixel))
            out_.resize(static_cast<std::size_t>(block_) * static_cast<std::size_t>(strip.last - strip.first) * lanes_);
    }

    void rows(int begin, int end) {
        rows_read_ = indices_read(y_, begin, end);
        rows_end_ = end;
        for (int first = begin; first < end; first += block_) {
            const int last = std::min(first + block_, end);
            hold(indices_read(y_, first, last));
            filter_y(first, last);
            for (int r = 0; r < last - first; ++r) fill_margins(r);
            filter_x(first, last);
            monitor_.made(std::int64_t{last - first} * (strip_.last - strip_.first) * count_);
        }
    }

private:
    int group_of(int v) const { return (v - plan_.origin) >> 2; }
    std::uint8_t* group(int slot) { return ring_.data() + static_cast<std::size_t>(slot) * padded_ * 4; }

    /// Makes the ring hold the groups of source rows in `read`.
    void hold(IndexRange read) {
        window_.hold(
            {group_of(read.begin), group_of(read.end - 1) + 1},
            [&](int slots) { ring_.resize(static_cast<std::size_t>(slots) * padded_ * 4); },
            [&](int g, int slot, int count) {
                for (int i = 0; i < count; ++i) interleave(g + i, slot + i);
            });
    }

    /// The row of the source view that is read as row v; rows that no output of this run reads have no weight: any row
    /// stands for them.
    int stored_row(int v) const {
        return resolve(std::clamp(v, rows_read_.begin, rows_read_.end - 1), y_.inputs, y_.edge) - first_source_;
    }

    void interleave(int g, int slot) {
        const std::uint8_t* rows[4];
        for (int k = 0; k < 4; ++k) rows[k] = reader_.row(stored_row(4 * g + plan_.origin + k), k);
        loops_.interleave_bytes(rows, reader_.bytes(), group(slot));
    }

    void filter_y(int first, int last) {
        const ByteBank& bank = plan_.banks.y;
        taps_.resize(static_cast<std::size_t>(last - first));
        std::size_t most = 1;
        for (int i = first; i < last; ++i) {
            ByteColumnTaps& taps = taps_[static_cast<std::size_t>(i - first)];
            make_column_taps(bank, i, plan_.origin, taps);
            most = std::max(most, taps.high.size());
        }
        // Output rows that lie together read mostly the same groups: a strip of those stays in the first cache.
        const std::size_t tile_bytes_per_column_byte = tile_pair / 4;
        const std::size_t strip =
            std::max<std::size_t>(
                std::size_t{first_cache_bytes} / (4 * most + tile_bytes_per_column_byte) / (2 * byte_column), 1) *
            2 * byte_column;
        for (std::size_t k = 0; k < padded_; k += strip)
            for (int r = 0; r < last - first; ++r) {
                const ByteColumnTaps& taps = taps_[static_cast<std::size_t>(r)];
                lines_.clear();
                for (int g = 0; g < static_cast<int>(taps.high.size()); ++g)
                    lines_.push_back(group(window_.slot_of(taps.first_group + g)));
                loops_.combine_rows(taps, bank.bits_of(first + r), lines_.data(), k, std::min(k + strip, padded_),
                                    ahead_of(first + r, last), pixel_, row(r));
            }
    }

    /// The source rows that output row i + block_ is the first to read.
    std::span<const std::uint8_t* const> ahead_of(int i, int last) {
        ahead_.clear();
        const int next = std::min(i + block_, rows_end_ - 1);
        if (next < last) return {};
        const int begin = indices_read(y_, next - 1, next).end, end = indices_read(y_, next, next + 1).end;
        for (int v = begin; v < end; ++v)
            if (const std::uint8_t* row = reader_.row_in_place(stored_row(v))) ahead_.push_back(row);
        return ahead_;
    }

    /// Where the first pixel that is inside the image lies in row r after filter_y().
    std::int16_t* row(int r) {
        return pixel_ == Pixel::one ? middle_.data() + static_cast<std::size_t>(r) * pitch_ + 2 * left_
                                    : tile() + 8 * r;
    }
    std::int16_t* tile() { return tile_.data() + static_cast<std::size_t>(left_) * tile_pair; }
    std::ptrdiff_t place(int x, int c) const {
        const int v = x - strip_.stored.begin;
        return pixel_ == Pixel::one ? v : (v >> 1) * static_cast<std::ptrdiff_t>(tile_pair) + 2 * c + (v & 1);
    }

    void fill_margins(int r) {
        std::int16_t* const samples = row(r);
        const auto fill = [&](int v) {
            const int from = resolve(v, x_.inputs, x_.edge);
            for (int c = 0; c < static_cast<int>(lanes_); ++c) samples[place(v, c)] = samples[place(from, c)];
        };
        for (int v = strip_.read.begin; v < std::min(0, strip_.read.end); ++v) fill(v);
        for (int v = std::max(x_.inputs, strip_.read.begin); v < strip_.read.end; ++v) fill(v);
    }

    void filter_x(int first, int last) {
        if (pixel_ == Pixel::one)  // a pair of 16-bit samples moves like one float
            rows_to_lanes(reinterpret_cast<const float*>(middle_.data()), static_cast<std::ptrdiff_t>(pitch_ / 2),
                          block_, static_cast<int>(pitch_ / 2), reinterpret_cast<float*>(tile_.data()), tile_pair / 2);
        std::array<std::uint8_t*, tile_rows(Pixel::one)> rows{};
        const std::size_t length = static_cast<std::size_t>(strip_.last - strip_.first) * lanes_;
        for (int i = first; i < last; ++i) {
            const auto r = static_cast<std::size_t>(i - first);
            rows[r] = out_.empty() ? &dst_(strip_.first, i - first_target_, c_) : out_.data() + r * length;
        }
        const std::ptrdiff_t first_pair = strip_.stored.begin / 2;
        loops_.combine_pairs(plan_.pairs, strip_.first, strip_.last,
                             tile() - first_pair * static_cast<std::ptrdiff_t>(tile_pair), pixel_, rows.data());
        if (out_.empty()) return;
        for (int i = first; i < last; ++i) scatter(rows[static_cast<std::size_t>(i - first)], i - first_target_);
    }

    void scatter(const std::uint8_t* samples, int y) const {
        if (is_narrow(dst_, count_, pixel_))
            return loops_.narrow_pixels(samples, count_, static_cast<std::size_t>(strip_.last - strip_.first),
                                        &dst_(strip_.first, y, c_));
        for (int c = 0; c < count_; ++c) {
            std::uint8_t* to = &dst_(strip_.first, y, c_ + c);
            const std::uint8_t* from = samples + c;
            for (int x = strip_.first; x < strip_.last; ++x, to += dst_.dx, from += lanes_) *to = *from;
        }
    }

    const ByteLoops& loops_;
    const BytePlan& plan_;
    const ByteStrip& strip_;
    const Bank &x_, &y_;
    View<std::uint8_t> dst_;
    int first_source_, first_target_, c_, count_;
    Pixel pixel_;
    std::size_t lanes_;
    int block_;  ///< output rows computed together
    RunMonitor& monitor_;
    SourceReader reader_;
    std::size_t padded_;
    IndexRange rows_read_;
    int rows_end_ = 0;
    int left_;  ///< pairs of pixels left of the picture
    std::size_t pitch_ = 0;
    SlidingWindow window_;
    Samples<std::uint8_t> ring_, out_;
    Samples<std::int16_t> middle_, tile_;
    std::vector<ByteColumnTaps> taps_;
    std::vector<const std::uint8_t*> lines_, ahead_;
};

IndexRange stored_columns(const Bank& x, IndexRange read) {
    IndexRange stored{x.inputs, 0};
    const auto include = [&](int v) {
        const int at = resolve(v, x.inputs, x.edge);
        stored = {std::min(stored.begin, at), std::max(stored.end, at + 1)};
    };
    for (int v = read.begin; v < std::min(0, read.end); ++v) include(v);
    for (int v = std::max(x.inputs, read.begin); v < read.end; ++v) include(v);
    const int begin = std::max(0, read.begin), end = std::min(x.inputs, read.end);
    if (begin < end) stored = {std::min(stored.begin, begin), std::max(stored.end, end)};
    return {stored.begin & ~1, stored.end};
}

/// Strips of the columns that fit integers, whose source rows, as many as a block of output rows reads, fit the second
/// cache.
std::vector<ByteStrip> make_strips(const ByteBanks& banks, Pixel pixel) {
    const Bank &x = *banks.x.bank, &y = *banks.y.bank;
    const auto ratio = [](const Bank& bank) { return static_cast<double>(bank.inputs) / bank.output_count(); };
    int most_rows = 0, most_columns = 0;
    for (const Bank::Row& row : y.rows) most_rows = std::max(most_rows, row.count);
    for (const Bank::Row& row : x.rows) most_columns = std::max(most_columns, row.count);
    const double rows = tile_rows(pixel) * ratio(y) + most_rows + 3;
    const double columns = std::max(byte_strip_bytes / (rows * static_cast<int>(pixel)), 16.0 * most_columns);
    // Pixels beyond one border are those of the other under wrap: they must be in the same strip.
    const int outputs = x.edge == Edge::wrap || columns >= x.inputs
                            ? x.output_count()
                            : std::max(64, static_cast<int>(columns / ratio(x)) & ~15);
    std::vector<ByteStrip> strips;
    for_each_run(banks.x, 0, x.output_count(), [&](int begin, int end, bool fits) {
        for (int first = begin, last = begin; fits && first < end; first = last) {
            last = first + std::min(outputs, end - first);
            const IndexRange read = indices_read(x, first, last);
            strips.push_back({first, last, read, stored_columns(x, read)});
        }
    });
    return strips;
}

/// The same for means of 2 x 2 pixels, which need no rows in between.
void halve_rows(const ByteLoops& loops, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
                int first_target, int c, Pixel pixel, int begin, int end, RunMonitor& monitor) {
    for (int i = begin; i < end; ++i) {
        const std::uint8_t* const rows[] = {&src(0, 2 * i - first_source, c), &src(0, 2 * i + 1 - first_source, c)};
        loops.halve_bytes(rows, static_cast<std::size_t>(dst.width), pixel, &dst(0, i - first_target, c));
        monitor.made(std::int64_t{dst.width} * static_cast<int>(pixel));
    }
}

}  // namespace

BytePlan make_byte_plan(const ByteBanks& banks) {
    const Bank &x = *banks.x.bank, &y = *banks.y.bank;
    return {banks,
            make_byte_pairs(banks.x),
            make_strips(banks, Pixel::one),
            make_strips(banks, Pixel::four),
            best_origin(y),
            halves_by_box(x) && halves_by_box(y)};
}

void resize_bytes(const BytePlan& plan, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
                  int first_target, int begin, int end, RunMonitor& monitor) {
    const ByteLoops* const loops = byte_loops();
    if (!loops)
        return resize_bytes_scalar(plan.banks, src, first_source,
                                   cropped(dst, 0, begin - first_target, dst.width, end - begin), begin);
    // Channels side by side run together, four by four with some lanes idle; a single one, or a plane, by itself.
    const bool together = src.channels > 1 && (src.dc == 1 || dst.dc == 1);
    const int step = together ? 4 : 1;
    for (int c = 0; c < src.channels; c += step) {
        const int count = std::min(step, src.channels - c);
        const Pixel pixel = count == 1 ? Pixel::one : Pixel::four;
        if (plan.is_half_box && is_in_place(src, count, pixel) && is_in_place(dst, count, pixel)) {
            halve_rows(*loops, src, first_source, dst, first_target, c, pixel, begin, end, monitor);
            continue;
        }
        for (const ByteStrip& strip : pixel == Pixel::one ? plan.strips_of_one : plan.strips_of_four)
            ByteRun(*loops, plan, src, first_source, dst, first_target, c, count, pixel, strip, monitor)
                .rows(begin, end);
    }
}

}  // namespace bandlimit
