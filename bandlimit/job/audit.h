// What another program does when it resizes, measured by running it on test pictures.
// Stability: evolving.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/analysis/audit.h"
#include "bandlimit/color/depth.h"
#include "bandlimit/job/audit_findings.h"
#include "bandlimit/job/context.h"

namespace bandlimit::job {

struct AuditJob {
    /// A line for /bin/sh that resizes the picture {in} to {out}. {width}, {height} and {scale} stand for the size.
    std::string command;
    std::vector<Ratio> scales = AuditOptions{}.scales;
    std::string format = "png";       ///< extension of the files
    std::optional<Depth> depth = {};  ///< of the files: the nearest that the format has; u8 if empty
    bool grey = false;                ///< files of one channel instead of RGB; alpha is not tested then
    double timeout = 30;              ///< seconds that each run may take
    std::string keep = {};            ///< folder for the pictures; empty: a temporary one, removed at the end
};

struct CommandAudit {
    AuditReport report;
    AuditSubject subject;
    std::vector<Finding> findings;
};

/// Throws Error for a command that lacks a placeholder, OptionError for a timeout that is not above 0.
void check_audit(const AuditJob& job);

/// Runs the command on test pictures, 16 times for the default scales, and reports what it does to them.
///
/// throws   OptionError and Error as check_audit(), and as audit() of analysis/audit.h; std::runtime_error if the command fails, takes
///          too long, or writes no picture of the size asked for; Stopped between two runs if the context says so
/// example  job::audit({.command = "convert {in} -resize {width}x{height}! {out}"}, {}).findings
CommandAudit audit(const AuditJob& job, const Context& context);

}  // namespace bandlimit::job
