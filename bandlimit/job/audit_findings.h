// What an audit found, in sentences.
// Stability: evolving.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/analysis/audit.h"

namespace bandlimit::job {

/// What was tested.
struct AuditSubject {
    std::string command, format, depth;
    int channels = 3;
    double seconds = 0;         ///< of the slowest run
    double channel_spread = 0;  ///< largest difference between the channels of what was grey, as stored
};

struct Finding {
    std::string key;        ///< stable: kernel, antialias, placement, light, alpha, edges, ...
    bool is_wrong = false;  ///< it makes pictures worse
    std::string text;       ///< one sentence, without its full stop
};

/// What `report` says about the subject, most important first.
std::vector<Finding> findings_of(const AuditReport& report, const AuditSubject& subject);

/// "lanczos3", "box by equal weights", "tent, not widened", "unknown (nearest: mitchell, 7 % off)".
std::string kernel_text(const KernelFinding& kernel, const Ratio& ratio);
/// "1/2" for an image that is halved.
std::string ratio_text(const Ratio& ratio);

/// The axis along which the image moves more.
const AxisReport& larger_shift(const ScaleReport& scale);

/// The mean error, in codes or, for floats, in values, over the scales at which fractions of codes are spread evenly
/// (all scales if all are whole numbers). Empty if every kernel is nearest.
std::optional<double> bias_of(const AuditReport& report);

}  // namespace bandlimit::job
