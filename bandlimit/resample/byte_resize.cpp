#include "bandlimit/resample/byte_resize.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "bandlimit/core/allocator.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/sliding.h"
#include "bandlimit/resample/transpose.h"

namespace bandlimit {
namespace {

template <class T>
using Samples = std::vector<T, SampleAllocator<T>>;

constexpr std::size_t strip_bytes = 1 << 15;  // of interleaved rows: they stay in the first cache
constexpr int tile_pixels = 256;

/// Rows of `pixel` samples from rows of any strides: channels [c, c + count) of the view.
class SourceReader {
public:
    SourceReader(View<const std::uint8_t> src, int c, int count, Pixel pixel)
        : src_(src), c_(c), count_(count), lanes_(static_cast<int>(pixel)) {
        in_place_ = src.dx == lanes_ && (count == 1 || (count == 4 && src.dc == 1));
        if (!in_place_) copies_.resize(4 * bytes());
    }
    std::size_t bytes() const { return static_cast<std::size_t>(src_.width) * static_cast<std::size_t>(lanes_); }

    /// Row y of the view, in place or in copy k of 4.
    const std::uint8_t* row(int y, int k) {
        if (in_place_) return &src_(0, y, c_);
        std::uint8_t* const copy = copies_.data() + static_cast<std::size_t>(k) * bytes();
        for (int c = 0; c < count_; ++c) {
            const std::uint8_t* from = &src_(0, y, c_ + c);
            std::uint8_t* to = copy + c;
            for (int x = 0; x < src_.width; ++x, from += src_.dx, to += lanes_) *to = *from;
        }
        return copy;
    }

private:
    View<const std::uint8_t> src_;
    int c_, count_, lanes_;
    bool in_place_;
    Samples<std::uint8_t> copies_;
};

/// Computes rows of the output from the channels [c, c + count) of the views, as samples of `pixel`.
class ByteRun {
public:
    ByteRun(const BytePlan& plan, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
            int first_target, int c, int count, Pixel pixel)
        : plan_(plan),
          dst_(dst),
          first_source_(first_source),
          first_target_(first_target),
          c_(c),
          count_(count),
          pixel_(pixel),
          lanes_(static_cast<std::size_t>(pixel)),
          reader_(src, c, count, pixel),
          padded_(whole_columns(reader_.bytes())) {
        const Bank& x = *plan.banks.x.bank;
        reads_ = indices_read(x, 0, x.output_count());
        // Room for pixels left and right of the picture, in whole pairs and whole columns.
        margin_ = whole_columns(static_cast<std::size_t>(std::max(0, -reads_.begin) + 1) * lanes_);
        const std::size_t right = static_cast<std::size_t>(std::max(0, reads_.end - x.inputs) + 2) * lanes_;
        pitch_ = margin_ + padded_ + whole_columns(right) + byte_column / 2;
        middle_.resize(pitch_ * static_cast<std::size_t>(tile_rows(pixel)));
        in_place_ = dst.dx == static_cast<std::ptrdiff_t>(lanes_) && (count == 1 || (count == 4 && dst.dc == 1));
    }

    void rows(int begin, int end) {
        rows_read_ = indices_read(*plan_.banks.y.bank, begin, end);
        for (int first = begin; first < end; first += tile_rows(pixel_)) {
            const int last = std::min(first + tile_rows(pixel_), end);
            filter_y(first, last);
            for (int r = 0; r < last - first; ++r) fill_margins(middle_row(r));
            filter_x(first, last);
        }
    }

private:
    std::int16_t* middle_row(int r) { return middle_.data() + static_cast<std::size_t>(r) * pitch_ + margin_; }

    void filter_y(int first, int last) {
        const ByteBank& bank = plan_.banks.y;
        const IndexRange read = indices_read(*bank.bank, first, last);
        const IndexRange groups{read.begin >> 2, ((read.end - 1) >> 2) + 1};
        window_.hold(
            groups, [&](int slots) { ring_.resize(static_cast<std::size_t>(slots) * padded_ * 4); },
            [&](int g, int slot, int count) {
                for (int i = 0; i < count; ++i) interleave(g + i, slot + i);
            });
        // Output rows that lie together read mostly the same groups: a strip of those stays in the first cache.
        const std::size_t strip =
            std::max<std::size_t>(
                strip_bytes / 4 / static_cast<std::size_t>(groups.end - groups.begin) / (2 * byte_column), 1) *
            2 * byte_column;
        taps_.resize(static_cast<std::size_t>(last - first));
        for (int i = first; i < last; ++i) make_column_taps(bank, i, taps_[static_cast<std::size_t>(i - first)]);
        for (std::size_t k = 0; k < padded_; k += strip)
            for (int i = first; i < last; ++i) {
                const ByteColumnTaps& taps = taps_[static_cast<std::size_t>(i - first)];
                lines_.clear();
                for (int g = 0; g < static_cast<int>(taps.high.size()); ++g)
                    lines_.push_back(group(window_.slot_of(taps.first_group + g)));
                combine_byte_rows(taps, bank.bits, lines_.data(), k, std::min(k + strip, padded_), pixel_,
                                  middle_row(i - first));
            }
    }

    std::uint8_t* group(int slot) { return ring_.data() + static_cast<std::size_t>(slot) * padded_ * 4; }

    /// Rows that no output of this run reads have no weight: any row stands for them.
    void interleave(int g, int slot) {
        const Bank& bank = *plan_.banks.y.bank;
        const std::uint8_t* rows[4];
        for (int k = 0; k < 4; ++k) {
            const int v = std::clamp(4 * g + k, rows_read_.begin, rows_read_.end - 1);
            const int y = resolve(v, bank.inputs, bank.edge) - first_source_;
            rows[k] = reader_.row(y, k);
        }
        interleave_bytes(rows, reader_.bytes(), group(slot));
    }

    /// Where pixel v lies in a row of pairs.
    std::ptrdiff_t place(int v, int c) const {
        return pixel_ == Pixel::one ? v : static_cast<std::ptrdiff_t>(v >> 1) * 8 + 2 * c + (v & 1);
    }

    void fill_margins(std::int16_t* row) const {
        const Bank& bank = *plan_.banks.x.bank;
        const auto fill = [&](int v) {
            const int from = resolve(v, bank.inputs, bank.edge);
            for (int c = 0; c < static_cast<int>(lanes_); ++c) row[place(v, c)] = row[place(from, c)];
        };
        for (int v = reads_.begin; v < 0; ++v) fill(v);
        for (int v = bank.inputs; v < reads_.end; ++v) fill(v);
    }

    void filter_x(int first, int last) {
        const Bank& bank = *plan_.banks.x.bank;
        if (!in_place_)
            out_.resize(static_cast<std::size_t>(tile_rows(pixel_)) * static_cast<std::size_t>(bank.output_count()) *
                        lanes_);
        const auto row_of = [&](int i, int x) {
            return in_place_ ? &dst_(x, i - first_target_, c_)
                             : out_.data() + (static_cast<std::size_t>(i - first) *
                                                  static_cast<std::size_t>(bank.output_count()) +
                                              static_cast<std::size_t>(x)) *
                                                 lanes_;
        };
        std::array<std::uint8_t*, 32> rows{};
        for (int x = 0, count = 0; x < bank.output_count(); x += count) {
            count = outputs_of_tile(x);
            const IndexRange read = indices_read(bank, x, x + count);
            const int first_pair = read.begin >> 1;
            fill_tile(first_pair, ((read.end + 1) >> 1) - first_pair + 1);
            for (int i = first; i < last; ++i) rows[static_cast<std::size_t>(i - first)] = row_of(i, x);
            combine_byte_pairs(plan_.pairs, x, x + count, tile_.data(), first_pair, pixel_, rows.data());
        }
        if (!in_place_)
            for (int i = first; i < last; ++i) scatter(row_of(i, 0), i - first_target_);
    }

    /// How many outputs from x on read about tile_pixels pixels: a multiple of 16, but at the end.
    int outputs_of_tile(int x) const {
        const Bank& bank = *plan_.banks.x.bank;
        const int left = bank.output_count() - x;
        const double step = static_cast<double>(bank.inputs) / bank.output_count();
        const int wanted = static_cast<int>(std::max(tile_pixels, 3 * bank.row_info(x).count) / step);
        return std::min(left, std::max(16, wanted & ~15));
    }

    void fill_tile(int first_pair, int pairs) {
        if (tile_.size() < static_cast<std::size_t>(pairs) * tile_pair)
            tile_.resize(static_cast<std::size_t>(pairs) * tile_pair);
        if (pixel_ == Pixel::one) {
            // A pair of 16-bit samples moves like one float.
            const auto pitch = static_cast<std::ptrdiff_t>(pitch_ / 2);
            return rows_to_lanes(reinterpret_cast<const float*>(middle_row(0)) + first_pair, pitch, tile_rows(pixel_),
                                 pairs, reinterpret_cast<float*>(tile_.data()), tile_pair / 2);
        }
        for (int r = 0; r < tile_rows(pixel_); ++r) {
            const std::int16_t* from = middle_row(r) + static_cast<std::ptrdiff_t>(first_pair) * 8;
            std::int16_t* to = tile_.data() + r * 8;
            for (int p = 0; p < pairs; ++p, from += 8, to += tile_pair) std::memcpy(to, from, 16);
        }
    }

    void scatter(const std::uint8_t* row, int y) const {
        for (int c = 0; c < count_; ++c) {
            std::uint8_t* to = &dst_(0, y, c_ + c);
            const std::uint8_t* from = row + c;
            for (int x = 0; x < dst_.width; ++x, to += dst_.dx, from += lanes_) *to = *from;
        }
    }

    const BytePlan& plan_;
    View<std::uint8_t> dst_;
    int first_source_, first_target_, c_, count_;
    Pixel pixel_;
    std::size_t lanes_;
    SourceReader reader_;
    std::size_t padded_, margin_ = 0, pitch_ = 0;
    bool in_place_ = false;
    IndexRange reads_, rows_read_;
    SlidingWindow window_;
    Samples<std::uint8_t> ring_, out_;
    Samples<std::int16_t> middle_, tile_;
    std::vector<ByteColumnTaps> taps_;
    std::vector<const std::uint8_t*> lines_;
};

}  // namespace

BytePlan make_byte_plan(const ByteBanks& banks) { return {banks, make_byte_pairs(banks.x)}; }

void resize_bytes(const BytePlan& plan, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
                  int first_target, int begin, int end) {
    // Channels side by side run together, four by four with some lanes idle; a single one, or a plane, by itself.
    const bool together = src.channels > 1 && (src.dc == 1 || dst.dc == 1);
    const int step = together ? 4 : 1;
    for (int c = 0; c < src.channels; c += step) {
        const int count = std::min(step, src.channels - c);
        const Pixel pixel = count == 1 ? Pixel::one : Pixel::four;
        ByteRun(plan, src, first_source, dst, first_target, c, count, pixel).rows(begin, end);
    }
}

}  // namespace bandlimit
