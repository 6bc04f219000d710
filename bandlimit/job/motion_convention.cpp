#include "bandlimit/job/motion_convention.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "bandlimit/job/option_error.h"

namespace bandlimit::job {
namespace {

using Units = MotionConvention::Units;

constexpr std::array<NamedConvention, 4> conventions{{
    {"bandlimit", {}, "Vector"},
    {"blender", {.is_y_up = true}, "Vector"},
    {"unreal", {.units = Units::ndc, .is_previous_minus_current = false, .is_y_up = true}, "Velocity"},
    {"unity", {.units = Units::uv, .is_previous_minus_current = false, .is_y_up = true}, "MotionVectors"},
}};

}  // namespace

Point MotionConvention::motion_of(Point stored, int width, int height) const {
    if (are_axes_swapped) std::swap(stored.x, stored.y);
    const double sign = is_previous_minus_current ? 1 : -1, sign_y = is_y_up ? -sign : sign;
    const auto unit = [&](int length) {
        return units == Units::pixels ? 1.0 : units == Units::uv ? double(length) : length / 2.0;
    };
    return {stored.x * sign * unit(width), stored.y * sign_y * unit(height)};
}

Point MotionConvention::jitter_of(Point stored) const {
    const double sign = jitter_sign == JitterSign::plus ? 1 : jitter_sign == JitterSign::minus ? -1 : 0;
    return {sign * stored.x, (is_jitter_y_up ? -sign : sign) * stored.y};
}

std::vector<std::string_view> convention_names() {
    std::vector<std::string_view> names{"auto"};
    for (const NamedConvention& c : conventions) names.push_back(c.name);
    return names;
}

const NamedConvention& convention_called(std::string_view name) {
    const auto found = std::ranges::find(conventions, name, &NamedConvention::name);
    if (found == conventions.end())
        throw OptionError("conventions", fmt::format("\"{}\" is unknown; choose one of: {}", name,
                                                     fmt::join(convention_names(), ", ")));
    return *found;
}

std::vector<ConventionSetting> settings_of(const MotionConvention& c) {
    constexpr std::array<std::string_view, 3> units{"pixels", "uv", "ndc"}, signs{"plus", "minus", "none"};
    return {{"motion-units", units[static_cast<std::size_t>(c.units)]},
            {"motion-direction", c.is_previous_minus_current ? "previous-current" : "current-previous"},
            {"motion-y", c.is_y_up ? "up" : "down"},
            {"motion-axes", c.are_axes_swapped ? "yx" : "xy"},
            {"motion-jitter", c.includes_jitter ? "included" : "excluded"},
            {"jitter-sign", signs[static_cast<std::size_t>(c.jitter_sign)]},
            {"jitter-y", c.is_jitter_y_up ? "up" : "down"}};
}

std::vector<std::string> flags_between(const MotionConvention& from, const MotionConvention& to) {
    const std::vector<ConventionSetting> old = settings_of(from), wanted = settings_of(to);
    std::vector<std::string> flags;
    for (std::size_t i = 0; i < old.size(); ++i)
        if (old[i].value != wanted[i].value) flags.push_back(fmt::format("--{} {}", wanted[i].option, wanted[i].value));
    return flags;
}

}  // namespace bandlimit::job
