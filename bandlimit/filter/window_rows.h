// Loops over rows of doubles, for sums over windows and what is fitted to them: four or eight at a time, with the same
// bits on every target.
// Stability: inner.
#pragma once
#include <cstdint>

namespace bandlimit {

/// Columns that go together: rows have memory up to a multiple of this.
constexpr int window_group = 8;

/// to = (to + in) - out, where neither is null. Notes in begins_anew[x / 8] where what went is over 2^20 times what is
/// left.
void slide_row(double* to, const double* in, const double* out, int count, std::uint8_t* begins_anew);

/// out[row][x] = the sum of in[row][x .. x + length) for x in [0, width): of the end of a block of that length, from behind,
/// and of the beginning of the next one, so that nothing is taken away.
///
/// shapes   in has width + length samples, of which the last is not used; `suffix` is room for 8 length numbers
void sum_blocks(int rows, const double* const* in, double* const* out, int length, int width, double* suffix);

/// to = a b.
void multiply_rows(const double* a, const double* b, double* to, int count);

/// to = factor from.
void scale_row(const double* from, double factor, double* to, int count);

/// to = from - offset.
void recentre_row(const float* from, double offset, double* to, int count);

/// The range of what is finite, and whether all is.
struct FiniteRange {
    float least, most;
    bool is_whole = true;
};
void widen(FiniteRange& range, const float* row, int count);

/// Of each window the sums of its samples' weights, guides, products of guides (0 0, 0 1, .., 1 1, ..), and per signal
/// those of the signal and of its products with the guides: linear models that solve_linear_row() finds.
struct LinearFit {
    int guides = 1, signals = 1;  ///< guides up to 4
    double epsilon = 0;
    const double* const* sums = nullptr;
    /// [guides]: where models are applied, about the same offset as the sums; null: coefficients are wanted.
    const double* const* at = nullptr;
};
constexpr int most_linear_guides = 4;

/// Without `at`: to[s (1 + guides)] is the constant of signal s, and the coefficients of the guides follow. With it, to[s]
/// is what the model gives. NaN where the weights are 0.
///
/// method   (covariance of the guides + epsilon) a = covariance with the signal, by LDL^T; guides that do not vary, or only
///          as those before them do, to rounding, are left out
void solve_linear_row(const LinearFit& fit, int count, float* const* to);

/// Below this share of the mean square, a variance is rounding, of sums of doubles and of floats; below this share of
/// itself, what others leave of it.
constexpr double variance_noise = 0x1p-46, float_variance_noise = 0x1p-18, dependence_noise = 0x1p-40;

}  // namespace bandlimit
