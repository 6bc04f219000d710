// Options that a job cannot run with.
// Stability: evolving.
#pragma once
#include <string>
#include <string_view>

#include "bandlimit/core/error.h"

namespace bandlimit::job {

/// An option of a job is wrong, alone or beside what else it is to go with: another option is what helps. Errors of
/// files and pictures are std::runtime_error.
struct OptionError : Error {
    /// what() is "levels: 0 is out of range; pass 1 to 31". Command lines write the option in their own way before it.
    OptionError(std::string_view option_, const std::string& text)
        : Error(std::string(option_) + ": " + text), option(option_) {}
    /// Of no one option.
    explicit OptionError(const std::string& text) : Error(text) {}

    std::string option;  ///< "levels"; empty where no one option is to blame
};

}  // namespace bandlimit::job
