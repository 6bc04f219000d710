// The one checker for every operation on images. A helper of tests; it is tested itself, with broken operators.
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"

namespace bandlimit {

struct Size {
    int width = 0, height = 0;
};

/// A part of the output: cells [x, x + width) by [y, y + height) of it.
struct Window {
    int x = 0, y = 0, width = 0, height = 0;
};

/// An operation on float images, in the three ways that its checker needs.
struct Operator {
    /// Writes the part `window` of the output for `src` to `dst`, which has the size of the window.
    std::function<void(View<const float> src, View<float> dst, Window window, Parallel parallel)> run;
    /// The sample (x, y, c) of the output, by an independent way in double.
    std::function<double(View<const float> src, int x, int y, int c)> reference;
    /// How far run may be from the reference there.
    std::function<double(View<const float> src, int x, int y, int c)> bound;
    /// The size of the output; the number of channels stays.
    std::function<Size(Size)> output_size = [](Size input) { return input; };
};

/// Checks, for widths 1 to 33 and 1 to 4 channels, that an operator
/// - writes every sample of its output and nothing else, and leaves its input alone;
/// - gives the same bits when repeated, for 1, 2, 3 and 7 threads, for planar, interleaved, transposed, flipped and
///   padded samples on either side, for a window against the crop of the whole, and on every instruction set of this
///   machine that has fused multiply-add;
/// - is as near to the reference as the bound says, on every instruction set.
/// The failure tells the first thing that is wrong, and where.
[[nodiscard]] testing::AssertionResult check_operator(const Operator& op);

/// Calls body(name, has_fused_multiply_add) with each instruction set that this machine and build have, one at a time.
void for_each_instruction_set(const std::function<void(const std::string&, bool)>& body);

}  // namespace bandlimit
