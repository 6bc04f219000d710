// The loops of vectors that resample 8-bit codes. What they compute is defined by resize_bytes_scalar() in byte_bank.h.
// Stability: inner.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bandlimit/resample/byte_bank.h"

namespace bandlimit {

/// Whether codes of 8 bits run in integers, as they do on x86, for whose vectors the loops are written. Elsewhere
/// floats, which have vectors, are faster than resize_bytes_scalar().
#if defined(__x86_64__) || defined(_M_X64)
constexpr bool runs_bytes_in_integers = true;
#else
constexpr bool runs_bytes_in_integers = false;
#endif

/// How the samples of a pixel lie: what is filtered is one channel, or four side by side.
enum class Pixel { one = 1, four = 4 };

/// Rows of bytes are worked on in columns of so many.
constexpr std::size_t byte_column = 64;
constexpr std::size_t whole_columns(std::size_t bytes) { return (bytes + byte_column - 1) / byte_column * byte_column; }

/// One row of vertical weights, as the interleaved groups of four rows take them: weight = 128 * high + low.
struct ByteColumnTaps {
    std::vector<std::int32_t> high, low;  ///< four signed bytes each, one element per group
    int first_group = 0;                  ///< which holds rows 4 * first_group + origin and on
};
/// Reuses the memory of `taps`. `origin`, 0 to 3, is the first row of group 0.
void make_column_taps(const ByteBank& bank, int output, int origin, ByteColumnTaps& taps);

/// The origin with which outputs read the fewest groups.
int best_origin(const Bank& bank);

/// So many rows run side by side along x.
constexpr int tile_rows(Pixel pixel) { return pixel == Pixel::four ? 8 : 32; }
/// 16-bit samples of a tile per pair of pixels: the rows of a tile lie side by side, each with its pair of samples, or
/// its pairs of the four channels.
constexpr std::size_t tile_pair = 64;

/// The rows of horizontal weights in pairs that begin at even pixels, filled up with zeros to the same count.
struct BytePairs {
    struct Output {
        int first_pair = 0;
        std::uint32_t offset = 0;  ///< into weights
    };
    int count = 0;                      ///< pairs per output
    std::vector<std::int32_t> weights;  ///< two signed 16-bit weights each
    std::vector<Output> outputs;
};
/// Of rows that do not fit, and have no weights, nothing is to be computed.
BytePairs make_byte_pairs(const ByteBank& bank);

/// Whether the outputs are the means of two samples each, from the first on.
bool halves_by_box(const Bank& bank);

/// The loops of a target.
struct ByteLoops {
    /// The means of 2 x 2 pixels, rounded to nearest, half up: what the loops below come to for two such banks.
    ///
    /// shapes   rows[0], rows[1] [2 * pixels], out [pixels], in pixels of so many samples
    void (*halve_bytes)(const std::uint8_t* const* rows, std::size_t pixels, Pixel pixel, std::uint8_t* out);

    /// Spreads pixels of 2 or 3 samples to 4, the others 0, and back.
    ///
    /// shapes   narrow [pixels * channels], wide [pixels * 4]
    void (*spread_pixels)(const std::uint8_t* narrow, int channels, std::size_t pixels, std::uint8_t* wide);
    void (*narrow_pixels)(const std::uint8_t* wide, int channels, std::size_t pixels, std::uint8_t* narrow);

    /// Puts four rows side by side, so that four taps of the vertical filter lie in the four bytes of a lane.
    ///
    /// shapes   rows of `bytes`, which need not be aligned; out [4 * whole_columns(bytes)], zeros after the end
    void (*interleave_bytes)(const std::uint8_t* const* rows, std::size_t bytes, std::uint8_t* out);

    /// Vertical: columns [begin, end), in bytes of a row, from those of the groups; 6 bits of fraction.
    ///
    /// One channel comes out as a row of samples. Of four channels, pair p of pixels comes out at out + p * tile_pair:
    /// 8 samples, (x, x + 1) of each channel.
    /// The same columns of the rows `ahead` are asked for meanwhile, so that they are in the second cache when their
    /// turn comes: reading memory takes as long as the arithmetic.
    /// shapes   groups[g] from interleave_bytes; begin and end are whole columns, out has room for them
    void (*combine_rows)(const ByteColumnTaps& taps, int bits, const std::uint8_t* const* groups, std::size_t begin,
                         std::size_t end, std::span<const std::uint8_t* const> ahead, Pixel pixel, std::int16_t* out);

    /// Horizontal: pixels [begin, end) of tile_rows(pixel) rows; rows[r] points to pixel `begin`, or is null to leave
    /// it out.
    ///
    /// shapes   tile: pair 0 of pixels is at `tile`, pair p at tile + p * tile_pair; all pairs that the outputs read
    ///          are there, which may begin before 0
    void (*combine_pairs)(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, Pixel pixel,
                          std::uint8_t* const* rows);
};

/// Those of current_target(), or null where it has none: resize_bytes_scalar() does the work then.
const ByteLoops* byte_loops();

}  // namespace bandlimit
