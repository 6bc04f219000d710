// The one checker for every operation on images. A helper of tests, tested itself with broken operators.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/core/sanitized_test.h"
#include "bandlimit/core/targets_test.h"
#include "bandlimit/core/view.h"
#include "bandlimit/math/random.h"

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

namespace checker {

/// NaNs that no arithmetic makes: what an output holds before it is written, and what lies around every sample.
inline const float marker = std::bit_cast<float>(0x7fc0beefu), guard = std::bit_cast<float>(0x7fc0deadu);

inline std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

/// A way for samples to lie in memory.
struct Memory {
    const char* name;
    bool interleaved = false, transposed = false, flipped = false;
    int spread = 1;   ///< distance of neighbours along the fastest direction, in samples
    int padding = 0;  ///< samples between rows
};
inline constexpr Memory memories[] = {
    {"planar"},
    {"interleaved", true},
    {"planar, padded", false, false, false, 1, 5},
    {"interleaved, padded", true, false, false, 1, 3},
    {"planar, spread", false, false, false, 3},
    {"interleaved, flipped", true, false, true},
    {"planar, flipped", false, false, true, 1, 2},
    {"planar, transposed", false, true},
    {"interleaved, transposed", true, true},
    {"interleaved, transposed, flipped, padded", true, true, true, 1, 4},
};

/// Samples inside a larger block of memory that is filled with guards.
class Guarded {
public:
    Guarded(const Memory& memory, Size size, int channels) {
        const bool t = memory.transposed;
        const std::ptrdiff_t columns = t ? size.height : size.width, rows = t ? size.width : size.height;
        const std::ptrdiff_t pixel = memory.spread * (memory.interleaved ? channels : 1);
        const std::ptrdiff_t line = columns * pixel + memory.padding, plane = rows * line;
        const std::ptrdiff_t all = memory.interleaved ? plane : plane * channels;
        block_.assign(static_cast<std::size_t>(all + 2 * margin), guard);
        view_ = {block_.data() + margin,
                 static_cast<int>(columns),
                 static_cast<int>(rows),
                 channels,
                 pixel,
                 line,
                 memory.interleaved ? memory.spread : plane};
        if (memory.flipped) view_ = flipped_x(flipped_y(view_));
        if (t) view_ = bandlimit::transposed(view_);
        for_each([](float& x, int, int, int) { x = marker; });
    }
    // The view points into the block.
    Guarded(Guarded&&) = default;

    View<float> view() const { return view_; }

    template <class Visit>
    void for_each(Visit visit) {
        for (int c = 0; c < view_.channels; ++c)
            for (int y = 0; y < view_.height; ++y)
                for (int x = 0; x < view_.width; ++x) visit(view_(x, y, c), x, y, c);
    }

    std::vector<std::uint32_t> memory_bits() const {
        std::vector<std::uint32_t> all;
        for (const float x : block_) all.push_back(bits(x));
        return all;
    }
    /// Whether everything but the samples is as it was.
    bool surroundings_are_whole() const {
        std::vector<float> rest = block_;
        for (int c = 0; c < view_.channels; ++c)
            for (int y = 0; y < view_.height; ++y)
                for (int x = 0; x < view_.width; ++x)
                    rest[static_cast<std::size_t>(&view_(x, y, c) - block_.data())] = guard;
        return std::all_of(rest.begin(), rest.end(), [](float x) { return bits(x) == bits(guard); });
    }

private:
    static constexpr std::ptrdiff_t margin = 70;  // more than any vector or tile of lanes
    std::vector<float> block_;
    View<float> view_;
};

/// One input and what the operator makes of it in the plainest way.
class Case {
public:
    Case(const Operator& op, Size size, int channels)
        : op_(op),
          size_(size),
          output_size_(op.output_size(size)),
          channels_(channels),
          input_(size.width, size.height, channels),
          expected_(output_size_.width, output_size_.height, channels),
          reference_(output_size_.width, output_size_.height, channels),
          bound_(output_size_.width, output_size_.height, channels) {
        Random random(static_cast<std::uint64_t>(size.width * 1000 + size.height * 10 + channels));
        for (int c = 0; c < channels; ++c)
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x) input_.view()(x, y, c) = static_cast<float>(random.uniform(-1, 2));
        // Once for all targets: this is most of the time of a check.
        for (int c = 0; c < channels; ++c)
            for (int y = 0; y < output_size_.height; ++y)
                for (int x = 0; x < output_size_.width; ++x) {
                    reference_.view()(x, y, c) = op.reference(std::as_const(input_).view(), x, y, c);
                    bound_.view()(x, y, c) = op.bound(std::as_const(input_).view(), x, y, c);
                }
    }

    /// The first problem, or nothing.
    std::optional<std::string> problem() {
        const Window whole{0, 0, output_size_.width, output_size_.height};
        if (auto p = problem_of_plain_run(whole)) return p;
        if (auto p = distance_problem()) return p;
        for (const int threads : {1, 2, 3, 7})
            if (auto p = problem_of(memories[0], memories[0], whole, threads)) return p;
        constexpr std::size_t count = std::size(memories);
        for (std::size_t from = 0; from < count; ++from)
            for (const std::size_t step : {0, 3, 7})
                if (auto p = problem_of(memories[from], memories[(from + step) % count], whole, 3)) return p;
        for (const Window& window : windows())
            for (const Memory& to : {memories[0], memories[1], memories[7]})
                if (auto p = problem_of(memories[1], to, window, 2)) return p;
        return problem_of_targets(whole);
    }

private:
    std::string where() const { return message("input ", size_.width, " x ", size_.height, " x ", channels_, ": "); }

    Guarded placed_input(const Memory& memory) const {
        Guarded input(memory, size_, channels_);
        input.for_each([&](float& to, int x, int y, int c) { to = input_.view()(x, y, c); });
        return input;
    }

    /// Runs once; `result` is checked for what holds whatever the values are.
    std::optional<std::string> run(const Memory& from, const Memory& to, const Window& window, int threads,
                                   std::optional<Guarded>& result) const {
        const Guarded input = placed_input(from);
        const std::vector<std::uint32_t> before = input.memory_bits();
        result.emplace(to, Size{window.width, window.height}, channels_);
        const std::string how = message(where(), from.name, " to ", to.name, ", ", threads, " threads, window ",
                                        window.x, ' ', window.y, ' ', window.width, ' ', window.height, ": ");
        op_.run(input.view(), result->view(), window, {threads});
        if (input.memory_bits() != before) return how + "the input was changed";
        if (!result->surroundings_are_whole()) return how + "written outside the output";
        bool unwritten = false;
        result->for_each([&](float x, int, int, int) { unwritten = unwritten || bits(x) == bits(marker); });
        if (unwritten) return how + "a sample was not written";
        return {};
    }

    std::optional<std::string> problem_of_plain_run(const Window& whole) {
        std::optional<Guarded> result;
        if (auto p = run(memories[0], memories[0], whole, 1, result)) return p;
        result->for_each([&](float value, int x, int y, int c) { expected_.view()(x, y, c) = value; });
        return {};
    }

    /// Compares with the reference.
    std::optional<std::string> distance_problem() const {
        for (int c = 0; c < channels_; ++c)
            for (int y = 0; y < output_size_.height; ++y)
                for (int x = 0; x < output_size_.width; ++x) {
                    const double value = expected_.view()(x, y, c), reference = reference_.view()(x, y, c);
                    const double bound = bound_.view()(x, y, c);
                    if (!(std::abs(value - reference) <= bound))
                        return message(where(), "output ", x, ' ', y, ' ', c, " is ", value, ", the reference ",
                                       reference, "; off by ", std::abs(value - reference), ", allowed ", bound);
                }
        return {};
    }

    /// Runs in some way and compares the bits with the plain run.
    std::optional<std::string> problem_of(const Memory& from, const Memory& to, const Window& window,
                                          int threads) const {
        std::optional<Guarded> result;
        if (auto p = run(from, to, window, threads, result)) return p;
        std::optional<std::string> problem;
        result->for_each([&](float value, int x, int y, int c) {
            const float expected = expected_.view()(window.x + x, window.y + y, c);
            if (problem || bits(value) == bits(expected)) return;
            problem = message(where(), from.name, " to ", to.name, ", ", threads, " threads, window ", window.x, ' ',
                              window.y, ' ', window.width, ' ', window.height, ": sample ", x, ' ', y, ' ', c, " is ",
                              value, ", in the plain run ", expected);
        });
        return problem;
    }

    std::optional<std::string> problem_of_targets(const Window& whole) {
        std::optional<std::string> problem;
        for_each_target([&](Target target) {
            if (problem) return;
            if (has_fused_multiply_add(target)) {
                for (const Memory& memory : {memories[0], memories[1], memories[7]})
                    if (!problem) problem = problem_of(memory, memory, whole, 1);
            } else {
                const Image<float> fused_result = expected_.clone();
                problem = problem_of_plain_run(whole);
                if (!problem) problem = distance_problem();
                expected_ = fused_result.clone();
            }
            if (problem) problem = message(name_of(target), ": ", *problem);
        });
        return problem;
    }

    /// Corners, sides, the middle, single samples.
    std::vector<Window> windows() const {
        const int w = output_size_.width, h = output_size_.height;
        std::vector<Window> all;
        for (const auto& [x0, x1] :
             {std::pair{0, (w + 1) / 2}, {w / 2, w}, {w / 3, std::max(w / 3 + 1, w - w / 3)}, {w - 1, w}})
            for (const auto& [y0, y1] : {std::pair{0, h}, {h / 2, h}, {h / 3, h / 3 + 1}})
                all.push_back({x0, y0, x1 - x0, y1 - y0});
        return all;
    }

    const Operator& op_;
    Size size_, output_size_;
    int channels_;
    Image<float> input_, expected_;
    Image<double> reference_, bound_;
};

}  // namespace checker

/// Checks, for widths 1 to 33 (under the thread sanitizer for some of them) and 1 to 4 channels, that an operator
/// - writes every sample of its output and nothing else, and leaves its input alone;
/// - gives the same bits when repeated, for 1, 2, 3 and 7 threads, for planar, interleaved, transposed, flipped and
///   padded samples on either side, for a window against the crop of the whole, and on every supported target that has
///   fused multiply-add, the scalar definition among them;
/// - is as near to the reference as the bound says, on every target.
/// The failure tells the first thing that is wrong, and where.
[[nodiscard]] inline testing::AssertionResult check_operator(const Operator& op) {
    for (int width = 1; width <= 33; ++width) {
        // Races need rows enough for several threads; 11 has four channels.
        if (is_thread_sanitized && width != 5 && width != 11 && width != 17 && width != 22) continue;
        const int channels = 1 + width % 4;
        // Mostly a few rows; twice enough for several threads.
        const int height = width == 5 || width == 22 ? 150 : 1 + width * 5 % 9;
        if (const auto problem = checker::Case(op, {width, height}, channels).problem())
            return testing::AssertionFailure() << *problem;
    }
    return testing::AssertionSuccess();
}

}  // namespace bandlimit
