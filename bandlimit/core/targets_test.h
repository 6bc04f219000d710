// For tests of what must hold on every target.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "bandlimit/core/targets.h"

namespace bandlimit {

/// Calls body(target) with each supported target in use, until one fails fatally.
template <class Body>
void for_each_target(Body body) {
    for (const Target target : supported_targets()) {
        const TargetScope scope(target);
        SCOPED_TRACE(std::string(name_of(target)));
        body(target);
        if (testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace bandlimit
