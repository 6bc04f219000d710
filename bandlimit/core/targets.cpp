#include "bandlimit/core/targets.h"

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr const char* variable = "BANDLIMIT_TARGETS";

struct Entry {
    Target target;
    std::string_view name;
    std::int64_t highway;  ///< its bit in the masks of Highway
};
/// In the order of the enum.
constexpr std::array entries{
    Entry{Target::scalar, "scalar", 0},    Entry{Target::sse4, "sse4", HWY_SSE4},
    Entry{Target::avx2, "avx2", HWY_AVX2}, Entry{Target::avx512, "avx512", HWY_AVX3_DL},
    Entry{Target::neon, "neon", HWY_NEON}, Entry{Target::wasm, "wasm", HWY_WASM},
};

/// "a, b or c"
std::string listed(const std::vector<Target>& targets) {
    std::string list;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (i > 0) list += i + 1 < targets.size() ? ", " : " or ";
        list += name_of(targets[i]);
    }
    return list;
}

bool is_supported(Target target) {
    const std::vector<Target> supported = supported_targets();
    return std::find(supported.begin(), supported.end(), target) != supported.end();
}

Target target_of_environment() {
    const std::vector<Target> supported = supported_targets();
    const char* const value = std::getenv(variable);
    if (!value || !*value) return supported.back();
    for (const Target target : supported)
        if (name_of(target) == value) return target;
    const bool is_known =
        std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.name == value; });
    fail("the environment variable ", variable, " is \"", value, "\", which ",
         is_known ? "this machine or build lacks" : "is not an instruction set", "; set it to ", listed(supported),
         ", or unset it for the widest");
}

/// A Target, or -1 as long as the variable has not been read.
std::atomic<int> in_use = -1;

}  // namespace

std::string_view name_of(Target target) { return entries[static_cast<std::size_t>(target)].name; }

Target parse_target(std::string_view name) {
    std::vector<Target> all;
    for (const Entry& entry : entries) {
        if (entry.name == name) return entry.target;
        all.push_back(entry.target);
    }
    fail("target \"", name, "\" is unknown; choose ", listed(all));
}

std::vector<Target> supported_targets() {
    std::vector<Target> supported;
    for (const Entry& entry : entries)
        if (entry.target == Target::scalar || (entry.highway & HWY_TARGETS & hwy::SupportedTargets()) != 0)
            supported.push_back(entry.target);
    return supported;
}

Target current_target() {
    if (in_use.load(std::memory_order_relaxed) < 0) {
        int unread = -1;  // a call of use_target() in between has the last word
        in_use.compare_exchange_strong(unread, static_cast<int>(target_of_environment()));
    }
    return static_cast<Target>(in_use.load(std::memory_order_relaxed));
}

void use_target(Target target) {
    if (!is_supported(target))
        fail("use_target: this machine or build lacks ", name_of(target), "; pass ", listed(supported_targets()));
    in_use = static_cast<int>(target);
}

}  // namespace bandlimit
