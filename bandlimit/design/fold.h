// Weights as linear reads between samples.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/kernel/fetches.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

/// The fewest linear reads that are exactly `taps`: neighbours of one sign become a read between them. Weights of 0 are
/// left out. Of an odd run of one sign the middle one stays alone where that costs no read more, so that symmetric taps
/// have symmetric reads then.
///
/// units    offsets in source samples from the output's position, see output_offset()
/// cost     linear
/// example  fold({-1, {1, 2, 1}})    // three taps in two reads: at -1/3 of weight 3, at 1 of weight 1
std::vector<LinearRead> fold(const Taps& taps);

}  // namespace bandlimit
