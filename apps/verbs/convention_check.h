// bandlimit temporal --check-conventions: what files mean, by what explains the pictures.
#pragma once
#include <string>

#include "apps/console/common.h"
#include "bandlimit/job/frame_sequence.h"

namespace bandlimit::app {

/// Prints the readings of the sequence in `folder` and their errors.
/// throws   std::runtime_error, naming the options to change, unless the current reading is right; and as
///          job::check_conventions()
void check_conventions(const std::string& folder, job::SequenceJob sequence, const Parallel& parallel, bool json,
                       Console& console);

}  // namespace bandlimit::app
