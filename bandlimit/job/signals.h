// Test signals by name, each with the parameters that it has.
//
//     job::NamedSignal plate = job::named_signal("zoneplate");
//     job::set(plate, "max-frequency", {0.25});
//     job::set(plate, "center", {100, 80});
//     Signal signal = plate.make({512, 512});
// Stability: evolving.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bandlimit/signal/signal.h"

namespace bandlimit::job {

/// Width and height in pixels.
struct PatternSize {
    int width = 0, height = 0;
};

/// Where a parameter is kept: it has its default until it is written to.
using ParameterValue = std::variant<double*, std::optional<double>*, int*, std::uint64_t*, bool*, std::optional<Point>*,
                                    std::optional<Cell>*>;

struct SignalParameter {
    std::string name, type, help;  ///< "max-frequency", "F", "Cycles per pixel at ..."
    ParameterValue value;
};

/// A signal of signal/signal.h whose parameters can still be set. Copies share them.
struct NamedSignal {
    std::string name, summary;
    std::string example;  ///< arguments after the name: "zoneplate.png --size 512x512"
    std::vector<SignalParameter> parameters;
    std::function<Signal(PatternSize)> make;
    std::function<std::uint64_t(PatternSize)> bytes = [](PatternSize) { return 0; };  ///< that the signal takes
    std::shared_ptr<void> options = {};                                               ///< what `parameters` point into
};

/// All signals, with defaults of their own.
std::vector<NamedSignal> named_signals();
/// One of them. Throws Error, listing the names.
NamedSignal named_signal(std::string_view name);

/// Sets a parameter: one number, 0 or 1 for a switch, x and y for a point, x, y, width and height for a rectangle.
/// Throws Error for another name or another count of numbers.
void set(NamedSignal& signal, std::string_view parameter, const std::vector<double>& numbers);

}  // namespace bandlimit::job
