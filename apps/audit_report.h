// What an audit says: findings in words, and JSON.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/plot.h"
#include "bandlimit/analysis/audit.h"

namespace bandlimit::app {

/// What was tested, beside what was found.
struct AuditSubject {
    std::string command, format, depth;
    int channels = 3;
    double seconds = 0;         ///< of the slowest run
    double channel_spread = 0;  ///< largest difference of the channels of what was grey, in codes or values
};

struct Finding {
    std::string key;        ///< stable: kernel, antialias, placement, light, alpha, edges, ...
    bool is_wrong = false;  ///< something that makes pictures worse
    std::string text;       ///< one sentence, without its dot
};

std::vector<Finding> findings_of(const AuditReport& report, const AuditSubject& subject);

/// "lanczos3", "box by equal weights", "tent, not widened", "unknown (nearest: mitchell)".
std::string kernel_text(const KernelFinding& kernel, const Ratio& ratio);
std::string ratio_text(const Ratio& ratio);

nlohmann::ordered_json json_of(const AuditReport& report, const AuditSubject& subject);
/// The report as lines for a terminal.
std::string text_of(const AuditReport& report, const AuditSubject& subject);

/// The weights that were measured, over the kernel that explains them best.
Panel kernel_panel(const AxisReport& axis, const Ratio& ratio, const std::string& title);

/// Writes index.html and its pictures into a folder that exists.
void write_audit_page(const AuditReport& report, const AuditSubject& subject, const std::string& folder);

}  // namespace bandlimit::app
