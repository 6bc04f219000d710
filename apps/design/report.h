// Lines and panels that designs of one dimension share.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/page/plot.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit::app {

/// "weights       from -1: 0.25 0.5 0.25": the position of the first, then all; or, for very many, how to see them.
std::string weights_line(const Taps& taps);

/// Two lines: frequencies from 0 to 1/2, and what `value` is there.
std::vector<std::string> response_lines(const std::string& label, const std::function<double(double)>& value);

/// Weights at their positions, relative to `output`, in samples.
Panel weights_panel(const Taps& taps, double output);

/// Curves over 0 to 1/2 cycles per sample.
Panel response_panel(const std::string& title, const std::string& y_label, std::vector<Series> series);

}  // namespace bandlimit::app
