// What the words of the neutral form are in each shading language: tables, and nothing else.
// Stability: inner.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "bandlimit/shader/dialect.h"

namespace bandlimit {

/// A word and what stands for it. In the pattern of a call {0}, {1}, ... are its arguments, {2*} all from the third on.
struct Word {
    std::string_view name, pattern;
};

/// The words of one dialect.
struct Words {
    std::array<std::span<const Word>, 3> calls;  ///< the first that knows a word says it: its own, then its family's
    std::span<const Word> words;
    std::string_view float_suffix;   ///< after a real number
    std::string_view before, after;  ///< around what is pasted

    std::optional<std::string_view> call(std::string_view name) const;
    std::string_view word(std::string_view name) const;  ///< `name` itself where there is no other
};

const Words& words_of(Dialect dialect);

}  // namespace bandlimit
