#include "apps/parse_error.h"

#include <fmt/core.h>

#include <string_view>

namespace bandlimit::app {
namespace {

/// `text` in two, about the first `middle`; the second part is empty if there is none.
std::pair<std::string, std::string> parted(std::string_view text, std::string_view middle) {
    const auto at = text.find(middle);
    if (at == text.npos) return {std::string(text), ""};
    return {std::string(text.substr(0, at)), std::string(text.substr(at + middle.size()))};
}

/// "bandlimit pattern box --help", of the verbs that were recognised.
std::string help_of(const CLI::App& cli) {
    std::string command = "bandlimit";
    for (const CLI::App* app = &cli; !app->get_subcommands().empty();) {
        app = app->get_subcommands().front();
        command += " " + app->get_name();
    }
    return command + " --help";
}

template <class Kind>
bool is_a(const CLI::ParseError& error) {
    return dynamic_cast<const Kind*>(&error) != nullptr;
}

/// What the parser says, which has the names and values only inside of its sentences, in other words.
std::string reworded(const CLI::ParseError& error) {
    const std::string words = error.what();
    if (is_a<CLI::ValidationError>(error)) return words;  // of our own validators
    if (is_a<CLI::RequiredError>(error)) return parted(words, " is required").first + " is missing";
    if (is_a<CLI::ExtrasError>(error)) return "\"" + parted(words, " not expected: ").second + "\" has no place here";
    if (is_a<CLI::RequiresError>(error)) {
        const auto [option, other] = parted(words, " requires ");
        return fmt::format("{} works only with {}", option, other);
    }
    if (is_a<CLI::ExcludesError>(error)) {
        const auto [option, other] = parted(words, " excludes ");
        return fmt::format("{} and {} do not go together", option, other);
    }
    if (is_a<CLI::ConversionError>(error) && words.starts_with("Could not convert: ")) {
        const auto [option, value] = parted(parted(words, "convert: ").second, " = ");
        return fmt::format("{}: \"{}\" is not a number that fits", option, value);
    }
    const std::string option = parted(parted(words, ":").first, " was given").first;
    if (is_a<CLI::ArgumentMismatch>(error) && words.find("At Most") != words.npos)
        return option + " is given more than once";
    if (is_a<CLI::ArgumentMismatch>(error) && words.find(" required ") != words.npos)
        return option + ": its value is missing";
    return option + " cannot be used like this";  // such as a flag with a value
}

}  // namespace

std::string explanation(const CLI::ParseError& error, const CLI::App& cli) {
    const std::string words = reworded(error);
    return words + (words.find("; ") == words.npos ? "; see " : ", or see ") + help_of(cli);
}

}  // namespace bandlimit::app
