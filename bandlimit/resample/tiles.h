// Horizontal filters by tiles: some lines of an image, transposed for a run of x, so that the loop over lines serves.
// Stability: inner.
#pragma once
#include <span>
#include <vector>

#include "bandlimit/core/view.h"
#include "bandlimit/resample/lines.h"

namespace bandlimit {

/// Samples side by side in a tile: four vectors of 512 bits.
constexpr int tile_lanes = 64;

/// A run of outputs [first, last) whose inputs fit a tile.
struct TileRun {
    int first = 0, last = 0;
    IndexRange read;
};
std::vector<TileRun> tile_runs(const Bank& bank);
/// Of outputs [first, last) only.
std::vector<TileRun> tile_runs(const Bank& bank, int first, int last);

/// Runs the rows of src through the bank, by way of tiles of `runs`, which are some of tile_runs(bank).
///
/// shapes   src holds inputs from first_input on: all that the runs read, or all there are; dst holds outputs from
///          first_output on; heights and channels are equal; src and dst must not overlap
/// cost     beside the multiply-adds, about three moves per sample read and two per sample written
void apply_by_tiles(const Bank& bank, std::span<const TileRun> runs, View<const float> src, int first_input,
                    View<float> dst, int first_output, float antiring);

}  // namespace bandlimit
