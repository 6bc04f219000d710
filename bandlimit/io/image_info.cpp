// What a user says that codes mean.
#include <array>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit {
namespace {

constexpr std::array spaces{Space::automatic, Space::srgb, Space::linear, Space::data};
constexpr std::array<std::string_view, spaces.size()> space_names{"auto", "srgb", "linear", "data"};

}  // namespace

Space parse_space(std::string_view name) {
    for (std::size_t i = 0; i < spaces.size(); ++i)
        if (space_names[i] == name) return spaces[i];
    fail("space \"", name, "\" is unknown; choose auto, srgb, linear or data");
}

std::string_view name_of(Space space) { return space_names[static_cast<std::size_t>(space)]; }

Encoding ImageInfo::encoding(Space space) const {
    switch (space) {
        case Space::automatic: return {transfer, alpha, associated};
        case Space::srgb: return {Transfer::srgb, alpha, associated};
        case Space::linear: return {Transfer::linear, alpha, associated};
        case Space::data: break;
    }
    return {};
}

}  // namespace bandlimit
