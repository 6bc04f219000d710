// The program as a function.
#pragma once
#include <span>

#include "apps/console/console.h"

namespace bandlimit::app {

/// Runs the command line `bandlimit ARGUMENTS...`, and returns its exit code: 0; 1 for what files, pictures or memory
/// do not allow; 2 for what the command line alone shows to be wrong. Errors are one line on streams.err.
///
/// Nothing outlasts a run. Two at a time are not supported: a command that `audit` starts is known to the whole
/// process.
int run(std::span<const char* const> arguments, const Streams& streams) noexcept;

}  // namespace bandlimit::app
