// Skipping, visibly, what a machine cannot run.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "bandlimit/core/sanitized_test.h"

/// Skips the test where `reason`, what is missing, is not empty, and under sanitizers: drivers and compilers that are
/// loaded know nothing of them.
#define BANDLIMIT_NEED(reason)                                                                     \
    do {                                                                                           \
        if (is_sanitized) GTEST_SKIP() << "not under sanitizers, with which a driver does not go"; \
        if (const std::string missing_ = reason; !missing_.empty()) GTEST_SKIP() << missing_;      \
    } while (false)
