// Running banks over images.
// Stability: stable.
#pragma once
#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit {

/// Applies `bank` to every row of `src`; pass transposed() views to run along y.
///
/// shapes   src [inputs x h x c], dst [outputs x h x c]; they must not overlap
/// units    linear light, or whatever may be averaged
/// range    any float; a NaN reaches only the outputs whose row covers it
/// error    |err| <= dot_bound(taps, sum |w x|), see combine.h; same bits for any strides and number of threads, and on
///          every instruction set with fused multiply-add
/// cost     outputs * h * c * taps multiply-adds; scratch of 32 rows per thread unless y (with its channels) is the
///          contiguous direction, where there is none
/// throws   Error if the shapes disagree, and where src and dst overlap
/// example  apply(make_bank(mitchell(), Axis{640}, Axis{320}, Edge::reflect), src, dst);
void apply(const Bank& bank, View<const float> src, View<float> dst, Parallel parallel = {}, double antiring = 0);

/// The definition of apply(): plain loops, one thread.
void apply_scalar(const Bank& bank, View<const float> src, View<float> dst, double antiring = 0);

/// The adjoint: <A u, v> = <u, adjoint v>. Runs a bank backwards, spreading each output over the inputs it was made of.
///
/// shapes   src [outputs x h x c], dst [inputs x h x c]
/// error    as apply(), with the number of outputs that read an input for taps
/// throws   Error if the shapes disagree, and where src and dst overlap
void apply_adjoint(const Bank& bank, View<const float> src, View<float> dst, Parallel parallel = {});

}  // namespace bandlimit
