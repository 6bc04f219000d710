// What a run over frames tells, for people.
#pragma once
#include <string>

#include "bandlimit/job/temporal.h"

namespace bandlimit::app {

/// Writes index.html and its pictures to a folder: the convergence, the measures, the animation, and what the last
/// frame found out.
void write_temporal_page(const std::string& folder, const job::TemporalJob& job, const job::TemporalReport& report,
                         const std::string& command);

/// The mean over the frames that were made now; 0 if there are none.
double mean_milliseconds(const job::TemporalReport& report);

/// That of the last frame as a multiple of its truth's.
std::optional<double> sharpness(const job::TemporalReport& report);

}  // namespace bandlimit::app
