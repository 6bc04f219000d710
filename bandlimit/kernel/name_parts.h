// Names with parameters after colons, as "cubic:0.25:0.375", taken apart.
// Stability: inner.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace bandlimit {

/// The word before the first colon, and what lies between and after colons. Views of the name.
struct NameParts {
    std::string_view whole, head;
    std::vector<std::string_view> parameters = {};
};

NameParts split_name(std::string_view name);

/// The number that `text` is, all of it.
std::optional<double> parse_number(std::string_view text);

/// Throws Error unless `parts` has `count` parameters. It begins with `kind`, as "kernel", and ends "write FORM".
void expect_parameters(const NameParts& parts, std::string_view kind, std::size_t count, std::string_view form);

/// The parameters of `parts` as `count` numbers.
/// throws  Error as expect_parameters, and for what is not a number
std::vector<double> number_parameters(const NameParts& parts, std::string_view kind, std::size_t count,
                                      std::string_view form);

}  // namespace bandlimit
