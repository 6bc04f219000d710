// Whether tests run under a sanitizer. It looks for errors of memory and for races, ten times slower; that numbers are
// right is seen without it. So a test may take fewer of what differs in its numbers alone.
#pragma once

namespace bandlimit {

#if defined(__SANITIZE_THREAD__)
inline constexpr bool is_thread_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool is_thread_sanitized = __has_feature(thread_sanitizer);
#else
inline constexpr bool is_thread_sanitized = false;
#endif

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool is_sanitized = is_thread_sanitized || __has_feature(address_sanitizer);
#else
inline constexpr bool is_sanitized = is_thread_sanitized;
#endif

}  // namespace bandlimit
