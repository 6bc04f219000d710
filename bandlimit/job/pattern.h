// Test signals as picture files.
//
//     job::PatternJob plate{.signal = job::named_signal("zoneplate"), .size = {512, 512}, .out = "zoneplate.png"};
//     plate.sampling = Sampling::exact();
//     job::pattern(plate);
// Stability: evolving.
#pragma once
#include <optional>
#include <string>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/job/signals.h"
#include "bandlimit/signal/render.h"

namespace bandlimit::job {

struct PatternJob {
    NamedSignal signal;
    PatternSize size;
    std::string out{};  ///< the extension names the format
    Sampling sampling = Sampling::point();
    double low = 0, high = 1;      ///< linear light where the signal is 0 and 1
    int channels = 0;              ///< 1 to 4, colours all alike, alpha opaque; 0: grey, or RGB where there is no grey
    std::optional<Depth> depth{};  ///< default: f32 for formats of linear light, else u8
    Space space = Space::automatic;  ///< what codes shall mean
    int tile = 0;                    ///< as ImageTarget
};

struct PatternReport {
    int channels = 0;
    Depth depth = Depth::u8;
    Transfer transfer = Transfer::linear;
    double seconds_rendering = 0, seconds_writing = 0;
};

/// Throws Error for what the options alone show to be wrong, before anything of the size is allocated.
void check(const PatternJob& job);

/// Draws a signal into a file, a band of rows at a time.
///
/// memory   that of render() and of the signal, and 16 MB
/// throws   OptionError for options as check(); std::runtime_error for files; Stopped. The file appears whole or not
///          at all
PatternReport pattern(const PatternJob& job, const Context& context = {});

}  // namespace bandlimit::job
