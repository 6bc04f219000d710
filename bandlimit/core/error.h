// Errors and how their messages are written.
// Stability: stable.
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>

namespace bandlimit {

/// A caller's mistake. what() names the function, the value it got, and what to pass instead:
/// "lanczos: lobes = 0; pass 1 or more (3 is the usual choice)".
struct Error : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Joins its arguments into one string, each formatted as by a stream.
template <class... Parts>
std::string message(const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    return text.str();
}

/// Throws Error with the joined parts.
template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
    throw Error(message(parts...));
}

}  // namespace bandlimit
