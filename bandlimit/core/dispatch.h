// For files that <hwy/foreach_target.h> compiles once per target: from one function to that of the target in use.
//
//   HWY_BEFORE_NAMESPACE();
//   namespace bandlimit::HWY_NAMESPACE {
//   #if BANDLIMIT_NO_VECTORS
//   void Work(int x) { work_scalar(x); }
//   #else
//   void Work(int x) { ... }
//   #endif
//   }
//   HWY_AFTER_NAMESPACE();
//   #if HWY_ONCE
//   namespace bandlimit {
//   BANDLIMIT_EXPORT(Work);
//   void work(int x) { BANDLIMIT_DISPATCH(Work)(x); }
//   }
//   #endif
// Stability: inner.
#pragma once
#include <cstddef>

#include "bandlimit/core/targets.h"

/// Whether this pass compiles for Target::scalar.
#define BANDLIMIT_NO_VECTORS (HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128)

/// The table of a function by Target. Highway's own choice would hold for the whole process, including other libraries.
#define BANDLIMIT_EXPORT(function)                                                           \
    constexpr decltype(&HWY_STATIC_DISPATCH(function)) function##ByTarget[] = {              \
        HWY_CHOOSE_FALLBACK(function), HWY_CHOOSE_SSE4(function), HWY_CHOOSE_AVX2(function), \
        HWY_CHOOSE_AVX3_DL(function),  HWY_CHOOSE_NEON(function), HWY_CHOOSE_WASM(function)}

/// The function of current_target().
#define BANDLIMIT_DISPATCH(function) (*function##ByTarget[static_cast<std::size_t>(bandlimit::current_target())])
