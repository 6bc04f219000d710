// A window of rows that slides over an image.
// Stability: inner.
#pragma once
#include <algorithm>

#include "bandlimit/resample/lines.h"

namespace bandlimit {

/// Which rows a ring of slots holds: what is there already is not made again. Row v lies in slot v mod slots().
class SlidingWindow {
public:
    /// Makes the window hold `range`, calling fill(row, slot, count) for runs of missing rows whose slots adjoin.
    /// Where the ring is too short, enlarge(slots) is called before, and all it held is lost.
    template <class Enlarge, class Fill>
    void hold(IndexRange range, Enlarge enlarge, Fill fill) {
        const int wanted = range.end - range.begin;
        if (wanted > slots_) {
            slots_ = wanted + wanted / 4;
            enlarge(slots_);
            held_ = {range.begin, range.begin};
        }
        if (range.begin < held_.begin || range.begin > held_.end) held_ = {range.begin, range.begin};
        for (int v = std::max(held_.end, range.begin); v < range.end;) {
            const int slot = slot_of(v), count = std::min(range.end - v, slots_ - slot);
            fill(v, slot, count);
            v += count;
        }
        held_ = {range.begin, std::max(held_.end, range.end)};
        // Rows further back than the ring is long have been written over.
        held_.begin = std::max(held_.begin, held_.end - slots_);
    }

    int slots() const { return slots_; }
    int slot_of(int v) const { return ((v % slots_) + slots_) % slots_; }

private:
    int slots_ = 0;
    IndexRange held_;
};

}  // namespace bandlimit
