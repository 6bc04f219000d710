// The cases: what is resized to what, by which filter, in which light.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace bandlimit::bench {

enum class Filter { lanczos3, box };

/// Source and target are interleaved and without padding; random samples. Four channels are RGBA of 8 bits with
/// straight alpha, one channel is float.
struct Case {
    std::string name;   ///< as --cases takes it
    std::string title;  ///< of a column
    int width, height, new_width, new_height;
    int channels = 4;
    Filter filter = Filter::lanczos3;
    bool chain =
        false;  ///< the target holds all levels down to 1 x 1, each made from the one before, one after another
    bool linear = false;  ///< in linear light of colour premultiplied by alpha; else in codes, all channels alike

    std::size_t sample_bytes() const { return channels == 1 ? 4 : 1; }
};

std::span<const Case> all_cases();

/// A picture in the target of a case.
struct Level {
    int width, height;
    std::size_t offset;  ///< in the target, bytes
};

/// The one target, or the levels of a chain from the largest on.
std::vector<Level> levels_of(const Case& c);

std::size_t source_bytes(const Case& c);
std::size_t target_bytes(const Case& c);

}  // namespace bandlimit::bench
