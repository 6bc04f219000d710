// Which vector instructions the loops over samples use.
// Stability: stable.
#pragma once
#include <string_view>
#include <vector>

namespace bandlimit {

/// The instruction sets that the loops over samples are compiled for.
///
/// All but `sse4` and `wasm` have fused multiply-add, or round like it: results on them have the same bits. Codes of 8
/// bits that run in integers, and conversions of samples, have the same bits on all.
enum class Target {
    scalar,  ///< no vectors: the definition of each loop, on every machine
    sse4,    ///< SSE4.2, AES: x86 since 2010
    avx2,    ///< AVX2, FMA, F16C: x86 since 2013
    avx512,  ///< AVX-512 with VNNI, VBMI2, BITALG: x86 since 2019 (Ice Lake, Zen 4); earlier AVX-512 runs `avx2`
    neon,    ///< ARM
    wasm,    ///< WebAssembly with vectors
};

/// "scalar", "sse4", ...
std::string_view name_of(Target target);

/// The target called `name`. Throws Error, listing the names, for any other.
Target parse_target(std::string_view name);

/// Whether sums are rounded once per tap on this target.
constexpr bool has_fused_multiply_add(Target target) { return target != Target::sse4 && target != Target::wasm; }

/// The targets that this machine can run and this build contains: scalar, then from narrow to wide.
std::vector<Target> supported_targets();

/// The target in use: the one that the environment variable BANDLIMIT_TARGETS names, or the widest supported if it is
/// not set or empty.
///
/// The variable is read once, at the first call of this or of a loop over samples. Programs should call this early, so
/// that users see an error before work begins.
/// throws  Error, listing the valid values, at every call if the variable names no supported target
/// cost    one load
Target current_target();

/// Makes `target` the one in use in all threads, whatever the variable says.
///
/// Loops already running finish on their old target, and their callers may mix the two: call it while nothing else
/// runs.
/// throws  Error if it is not supported
void use_target(Target target);

/// Uses a target until the end of its scope, then restores the previous one; see use_target().
class TargetScope {
public:
    explicit TargetScope(Target target) : before_(current_target()) { use_target(target); }
    ~TargetScope() { use_target(before_); }
    TargetScope(const TargetScope&) = delete;
    TargetScope& operator=(const TargetScope&) = delete;

private:
    Target before_;
};

}  // namespace bandlimit
