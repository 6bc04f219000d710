#include "bandlimit/job/audit.h"

#include <gtest/gtest.h>

#include "bandlimit/core/error.h"

namespace bandlimit::job {
namespace {

TEST(AuditJob, NeedsAllPlaceholdersAndTime) {
    EXPECT_THROW(check_audit({.command = "cp {in} {width}"}), Error);
    EXPECT_THROW(check_audit({.command = "cp {in} {out}"}), Error);
    EXPECT_THROW(check_audit({.command = "cp {in} {out}.png {width}"}), Error);
    EXPECT_THROW(check_audit({.command = "cp {in} {out} {scale}", .timeout = 0}), Error);
    EXPECT_NO_THROW(check_audit({.command = "cp {in} {out} {scale}"}));
}

TEST(AuditJob, ACommandThatFailsIsNamedWithItsLastWords) {
    try {
        audit({.command = "echo no such size >&2; exit 3 # {in} {out} {scale}"}, {});
        FAIL() << "it must throw";
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("exit code 3"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("no such size"), std::string::npos) << e.what();
    }
}

TEST(AuditJob, StopsBetweenRuns) {
    std::stop_source stop;
    stop.request_stop();
    Context context;
    context.parallel.stop = stop.get_token();
    EXPECT_THROW(audit({.command = "cp {in} {out} # {scale}"}, context), Stopped);
}

}  // namespace
}  // namespace bandlimit::job
