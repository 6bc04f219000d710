// Random numbers that are the same on every machine.
// Stability: evolving.
#pragma once
#include <cstdint>

namespace bandlimit {

/// 64 random bits as a number, uniform in [0, 1), a multiple of 2^-53.
inline double uniform_from(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// SplitMix64 (Steele, Lea & Flood 2014): small, fast, and the same sequence on every machine and compiler, which the
/// distributions of the standard library do not promise.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniform() { return uniform_from(bits()); }
    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniform in [low, high], both included. The bias is below 2^-32 for ranges of an int.
    int integer(int low, int high) {
        const auto count = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
        return static_cast<int>(low + static_cast<std::int64_t>(((bits() >> 32) * count) >> 32));
    }

private:
    std::uint64_t state_;
};

/// 64 random bits that depend on the arguments alone: a seed, and indices such as those of a pixel. For numbers that
/// are needed in any order, or again. Each index is stirred into the sequence that the arguments before it began.
inline std::uint64_t hash_of(std::uint64_t seed) { return Random(seed).bits(); }
template <class... Indices>
std::uint64_t hash_of(std::uint64_t seed, std::uint64_t index, Indices... more) {
    return hash_of(hash_of(seed) + index, static_cast<std::uint64_t>(more)...);
}

}  // namespace bandlimit
