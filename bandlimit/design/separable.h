// Sums of separable weights that avoid what the best ones in the mean of squares suffer from: negative weights, and
// weights where the shape has none.
// Stability: evolving.
#pragma once
#include <functional>

#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// What counts beside the mean of squares.
struct SeparableLoss {
    double non_negative = 0;  ///< times the mean of max(-weight, 0): negative weights ring
    double keep_zeros = 0;    ///< times the mean of |weight| where the shape is 0, else 0: what leaks out of it
};

/// The mean over the grid of (weight - shape)^2, and what `loss` adds.
///
/// units    squares of the shape's units for the first part, the shape's for the others: a shape with a peak of 1 needs
///          other factors than one with a sum of 1
/// throws   Error for grids of different sizes or without weights, and factors that are negative or not finite
/// source   Wronski 2020, "Using JAX, numpy, and optimization techniques to improve separable image filters"
double separable_loss(const WeightGrid& shape, const WeightGrid& weights, const SeparableLoss& loss);

struct SeparableFit {
    Terms terms;
    double loss = 0;        ///< of the terms, as separable_loss()
    double start_loss = 0;  ///< of those it began with
    int iterations = 0;
};

/// Terms of less loss than `start`, as many as there: a local minimum near it. low_rank() gives a good start.
///
/// What is minimised is the loss with sqrt(w^2 + e^2) for |w|, by L-BFGS, in 15 rounds with e falling from 0.3 to 2e-5
/// of the shape's peak: a descent of the loss itself gets stuck in its kinks. Derivatives of the loss are automatic.
///
/// progress   called after each round with the part of all rounds that is done, 1 after the last; may be empty
/// error      the loss is never above that of `start`; 50 x 50 weights of the circle at rank 4 come to 0.021365 with
///            keep_zeros 0.3 and non_negative 0.5, where gradient descent of 5000 steps comes to 0.02167
/// cost       about 1500 iterations of 10 * terms * width * height multiplications; 0.2 s for that circle
/// throws     Error as separable_loss and expanded, and for weights that are not finite
SeparableFit optimise_separable(const WeightGrid& shape, const Terms& start, const SeparableLoss& loss,
                                const std::function<void(double done)>& progress = {});

}  // namespace bandlimit
