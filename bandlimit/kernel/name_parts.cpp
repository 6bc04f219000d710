#include "bandlimit/kernel/name_parts.h"

#include <charconv>

#include "bandlimit/core/error.h"

namespace bandlimit {

NameParts split_name(std::string_view name) {
    NameParts parts{name, name.substr(0, name.find(':'))};
    for (auto colon = name.find(':'); colon != std::string_view::npos;) {
        const auto next = name.find(':', colon + 1);
        const auto word = name.substr(colon + 1, next == std::string_view::npos ? next : next - colon - 1);
        parts.parameters.push_back(word);
        colon = next;
    }
    return parts;
}

std::optional<double> parse_number(std::string_view text) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

void expect_parameters(const NameParts& parts, std::string_view kind, std::size_t count, std::string_view form) {
    if (parts.parameters.size() != count)
        fail(kind, " \"", parts.whole, "\": ", parts.parameters.size(), " parameters; write ", form);
}

std::vector<double> number_parameters(const NameParts& parts, std::string_view kind, std::size_t count,
                                      std::string_view form) {
    expect_parameters(parts, kind, count, form);
    std::vector<double> numbers;
    for (const std::string_view word : parts.parameters) {
        const auto value = parse_number(word);
        if (!value) fail(kind, " \"", parts.whole, "\": \"", word, "\" is not a number; use ", form);
        numbers.push_back(*value);
    }
    return numbers;
}

}  // namespace bandlimit
