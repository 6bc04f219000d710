// The report of an audit as text, JSON and a page.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/page/plot.h"
#include "bandlimit/job/audit.h"

namespace bandlimit::app {

nlohmann::ordered_json json_of(const job::CommandAudit& audit);
/// The report as lines for a terminal.
std::string text_of(const job::CommandAudit& audit);

/// The measured weights, with the kernel that explains them best drawn over them.
Panel kernel_panel(const AxisReport& axis, const Ratio& ratio, const std::string& title);

/// Writes index.html and its pictures into a folder that exists.
void write_audit_page(const job::CommandAudit& audit, const std::string& folder);

}  // namespace bandlimit::app
