// How much of the caches a run may fill with rows between source and output.
// Stability: inner.
#pragma once

namespace bandlimit {

/// Of the second cache, of 2 MiB these days, by floats; the other half is for what comes and goes.
constexpr double strip_bytes = 1 << 20;
/// The same by bytes, whose loops leave more to come and go.
constexpr double byte_strip_bytes = 768 << 10;
/// Of the first cache: parts of rows that several outputs read.
constexpr int first_cache_bytes = 32 << 10;

}  // namespace bandlimit
