#include "apps/console/command_line.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <string_view>
#include <vector>

namespace bandlimit::app {
namespace {

template <class Number>
CLI::Validator between(Number least, Number most) {
    const std::string range = fmt::format("{} to {}", least, most);
    return {[=](std::string& text) {
                Number value{};
                if (!CLI::detail::lexical_cast(text, value) || !(value >= least && value <= most))
                    return fmt::format("\"{}\" is out of range; pass {}", text, range);
                return std::string();
            },
            range};
}

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
    if (is_a<CLI::RequiresError>(error)) {
        const auto [option, other] = parted(words, " requires ");
        return fmt::format("{} works only with {}", option, other);
    }
    if (is_a<CLI::ExcludesError>(error)) {
        const auto [option, other] = parted(words, " excludes ");
        return fmt::format("{} and {} cannot be used together", option, other);
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

std::string explanation(const CLI::ParseError& error, const CLI::App& cli) {
    const bool has_extras = is_a<CLI::ExtrasError>(error);  // which lists all of them, the last first
    const std::string words =
        has_extras ? fmt::format("unexpected argument \"{}\"", cli.remaining(true).front()) : reworded(error);
    return words + (words.find("; ") == words.npos ? "; see " : ", or see ") + help_of(cli);
}

}  // namespace

Option Option::type_name(const std::string& name) const { return Option(option_->type_name(name)); }
Option Option::description(const std::string& text) const { return Option(option_->description(text)); }
Option Option::required() const { return Option(option_->required()); }
Option Option::one_at_a_time() const { return Option(option_->allow_extra_args(false)); }
Option Option::in_range(int least, int most) const { return Option(option_->check(between(least, most))); }
Option Option::in_range(double least, double most) const { return Option(option_->check(between(least, most))); }
Option Option::needs(Option other) const { return Option(option_->needs(other.option_)); }
Option Option::excludes(Option other) const { return Option(option_->excludes(other.option_)); }
std::string Option::name() const { return option_->get_name(); }
bool Option::is_given() const { return option_->count() > 0; }

template <class T>
Option Verb::add_option(const std::string& name, T& target, const std::string& help) const {
    return Option(app_->add_option(name, target, help));
}
template Option Verb::add_option(const std::string&, std::string&, const std::string&) const;
template Option Verb::add_option(const std::string&, int&, const std::string&) const;
template Option Verb::add_option(const std::string&, std::uint64_t&, const std::string&) const;
template Option Verb::add_option(const std::string&, double&, const std::string&) const;
template Option Verb::add_option(const std::string&, std::optional<int>&, const std::string&) const;
template Option Verb::add_option(const std::string&, std::optional<double>&, const std::string&) const;
template Option Verb::add_option(const std::string&, std::vector<std::string>&, const std::string&) const;

template <class T>
Option Verb::add_option_function(const std::string& name, std::function<void(const T&)> set,
                                 const std::string& help) const {
    return Option(app_->add_option_function<T>(name, set, help));
}
template Option Verb::add_option_function(const std::string&, std::function<void(const std::string&)>,
                                          const std::string&) const;
template Option Verb::add_option_function(const std::string&, std::function<void(const int&)>,
                                          const std::string&) const;
template Option Verb::add_option_function(const std::string&, std::function<void(const double&)>,
                                          const std::string&) const;

Option Verb::add_flag(const std::string& name, bool& target, const std::string& help) const {
    return Option(app_->add_flag(name, target, help));
}
Option Verb::option(const std::string& name) const { return Option(app_->get_option(name)); }

Verb Verb::add_subcommand(const std::string& name, const std::string& summary) const {
    return Verb(app_->add_subcommand(name, summary));
}

void Verb::require_one_subcommand(const std::string& noun) const {
    app_->require_subcommand(0, 1);
    app_->allow_extras();
    app_->callback([app = app_, noun] {
        const std::vector<std::string> words = app->remaining();
        if (words.empty() && !app->get_subcommands().empty()) return;
        std::string names;
        for (const CLI::App* command : app->get_subcommands({}))
            names += (names.empty() ? "" : ", ") + command->get_name();
        const std::string what = words.empty() ? fmt::format("a {} is missing", noun)
                                               : fmt::format("\"{}\" is not a {}", words.front(), noun);
        throw UsageError(fmt::format("{}; choose one of: {}", what, names));
    });
}

void Verb::example(const std::string& text) const { app_->footer("Example:\n  " + text); }
void Verb::on(std::function<void()> selected) const { app_->callback(std::move(selected)); }

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
    std::string digits = text;
    try {
        const bool is_known = text.find_first_of("0123456789") == 0 &&  // a unit alone would be one of it
                              CLI::AsSizeValue(false)(digits).empty();  // multiplies by the unit
        std::uint64_t bytes = 0;
        const char* const end = digits.data() + digits.size();
        // It stays 0 where the number does not fit.
        if (is_known && std::from_chars(digits.data(), end, bytes).ptr == end && bytes >= 1) return bytes;
    } catch (const CLI::Error&) {  // an unknown unit
    }
    throw UsageError(fmt::format("{}: \"{}\" is not an amount of memory; use e.g. 512MB or 4GB", option, text));
}

CommandLine::CommandLine(const std::string& version)
    : app_(std::make_unique<CLI::App>("bandlimit: sampling done right, for graphics", "bandlimit")) {
    app_->set_version_flag("--version", version);
    app_->footer("bandlimit VERB --help shows the options of a verb, and an example.");
}
CommandLine::~CommandLine() = default;

Verb CommandLine::program() const { return Verb(app_.get()); }

std::optional<std::string> CommandLine::parse(std::span<const char* const> arguments) {
    try {
        app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        return std::nullopt;
    } catch (const CLI::CallForVersion& version) {
        return std::string(version.what()) + "\n";
    } catch (const CLI::Success&) {  // for help
        return app_->help();
    } catch (const CLI::ParseError& e) {
        throw UsageError(explanation(e, *app_));
    }
}

}  // namespace bandlimit::app
