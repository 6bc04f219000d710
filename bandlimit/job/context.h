// What every job is given besides its options.
// Stability: evolving.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "bandlimit/core/parallel.h"

namespace bandlimit::job {

/// How far a job is.
struct Progress {
    std::string_view doing;      ///< "resizing": another word where another piece of the work begins
    double done = 0, total = 0;  ///< in units
    std::string_view unit = {};  ///< "MPix", where the speed in units per second tells something
};

/// The machine and the caller. Nothing of a job prints.
///
/// Both functions may be left empty. They are called from any thread, but by one at a time, and should be quick.
struct Context {
    Parallel parallel = {};                                ///< threads, whose, and when to stop
    std::function<void(std::string_view text)> note = {};  ///< something that the user should know
    std::function<void(const Progress&)> progress = {};

    void say(std::string_view text) const {
        if (note) note(text);
    }
    void report(const Progress& p) const {
        if (progress) progress(p);
    }
};

}  // namespace bandlimit::job
