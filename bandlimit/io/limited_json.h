// JSON from outside, with limits. What should tell the line of an error reads located_json.h instead.
// Stability: inner.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace bandlimit {

constexpr std::uint64_t most_json_bytes = 16 << 20;

/// `text`, which `name` names in errors; `wanted`, as "a file of rules", what the user should name instead.
/// throws   std::runtime_error "NAME: what is wrong; what to do" for what is not JSON, has more than 16 MB or 16 levels
nlohmann::json parse_limited_json(std::string_view text, const std::string& name, std::string_view wanted);

}  // namespace bandlimit
