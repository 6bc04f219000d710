// The vector loops that resample 8-bit codes. What they compute is defined by resize_bytes_scalar() in byte_bank.h.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bandlimit/resample/byte_bank.h"

namespace bandlimit {

/// Whether this machine has the instructions that the loops need.
bool has_byte_vectors();

/// How the samples of a pixel lie: what is filtered is one channel, or four side by side.
enum class Pixel { one = 1, four = 4 };

/// Rows of bytes are worked on in columns of so many.
constexpr std::size_t byte_column = 64;
constexpr std::size_t whole_columns(std::size_t bytes) { return (bytes + byte_column - 1) / byte_column * byte_column; }

/// Puts four rows side by side, so that four taps of the vertical filter lie in the four bytes of a lane.
///
/// shapes   rows of `bytes`, which need not be aligned; out [4 * whole_columns(bytes)], zeros after the end
void interleave_bytes(const std::uint8_t* const* rows, std::size_t bytes, std::uint8_t* out);

/// One row of vertical weights, as the interleaved groups of four rows take them: weight = 128 * high + low.
struct ByteColumnTaps {
    std::vector<std::int32_t> high, low;  ///< four signed bytes each, one element per group
    int first_group = 0;                  ///< floor(first row / 4)
};
/// Reuses the memory of `taps`.
void make_column_taps(const ByteBank& bank, int output, ByteColumnTaps& taps);

/// Vertical: columns [begin, end) of `out`, in bytes of a row, from those of the groups; 6 bits of fraction.
///
/// Samples come out in pairs of pixels: for one channel as they lie, for four channels (x, x + 1) of each channel.
/// shapes   groups[g] from interleave_bytes, out [whole_columns(bytes)]; begin and end are whole columns
void combine_byte_rows(const ByteColumnTaps& taps, int bits, const std::uint8_t* const* groups, std::size_t begin,
                       std::size_t end, Pixel pixel, std::int16_t* out);

/// The rows of horizontal weights in pairs that begin at even pixels.
struct BytePairs {
    struct Output {
        int first_pair = 0, count = 0;
        std::uint32_t offset = 0;  ///< into weights
    };
    std::vector<std::int32_t> weights;  ///< two signed 16-bit weights each
    std::vector<Output> outputs;
};
/// The weights must have 14 bits.
BytePairs make_byte_pairs(const ByteBank& bank);

/// So many rows run side by side in a tile.
constexpr int tile_rows(Pixel pixel) { return pixel == Pixel::four ? 8 : 32; }
/// 16-bit samples of a tile per pair of pixels.
constexpr std::size_t tile_pair = 64;

/// Horizontal: pixels [begin, end) of tile_rows(pixel) rows; rows[r] points to pixel `begin`, or is null to leave it
/// out.
///
/// shapes   tile: pair p of pixels is at tile + (p - first_pair) * tile_pair: its rows side by side, each with the
///          lanes of one row from combine_byte_rows; all pairs that the outputs read must be there
void combine_byte_pairs(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, int first_pair,
                        Pixel pixel, std::uint8_t* const* rows);

}  // namespace bandlimit
