// Figures of patterns of samples.
#pragma once
#include "apps/page/plot.h"
#include "bandlimit/sampling/pattern.h"

namespace bandlimit::app {

/// Where the points lie in the pixel, y down.
Panel points_panel(const SamplePattern& pattern);
/// Coverage as an edge goes over the pixel, along x and in the two directions that differ most where patterns lean.
Panel coverage_panel(const SamplePattern& pattern);
/// pattern_spectrum() up to 12 cycles per pixel: white is 0, the deepest colour 4 and above.
Panel spectrum_panel(const SamplePattern& pattern);

}  // namespace bandlimit::app
