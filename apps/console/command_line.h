// Verbs and their options. Only command_line.cpp includes the parser, CLI11, which takes ten seconds to compile.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bandlimit::app {

/// Something that the command line alone shows to be wrong: exit 2. While the command line is parsed and checked, an
/// Error of the library means the same; once a verb runs, every other exception is exit 1.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An option of a verb: a handle, valid as long as its CommandLine. What changes an option returns it, so that calls
/// chain.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option type_name(const std::string& name) const;  ///< what stands for its value in the help
    Option description(const std::string& text) const;
    Option required() const;
    /// For several strings: each time that it is given it takes one, and it may be given again.
    Option one_at_a_time() const;
    /// For numbers: accepts only `least` to `most`, both included.
    Option in_range(int least, int most) const;
    Option in_range(double least, double most) const;
    Option needs(Option other) const;
    Option excludes(Option other) const;

    std::string name() const;
    bool is_given() const;  ///< once the command line is parsed

private:
    CLI::Option* option_;
};

/// A verb, a subcommand of one, or the program itself: a handle, as Option is.
class Verb {
public:
    explicit Verb(CLI::App* app) : app_(app) {}

    /// Adds an option that sets `target`, which must outlive the parsing: a std::string, int, std::uint64_t, double,
    /// std::optional<int>, std::optional<double> or std::vector<std::string>. Others do not link.
    template <class T>
    Option add_option(const std::string& name, T& target, const std::string& help) const;
    /// Adds an option that calls `set` with its value: a std::string, int or double. It may throw UsageError, or Error.
    template <class T>
    Option add_option_function(const std::string& name, std::function<void(const T&)> set,
                               const std::string& help) const;
    Option add_flag(const std::string& name, bool& target, const std::string& help) const;
    Option option(const std::string& name) const;  ///< one that was added

    Verb add_subcommand(const std::string& name, const std::string& summary) const;
    /// Requires exactly one of the subcommands added so far; the error lists them and calls each a `noun`.
    void require_one_subcommand(const std::string& noun) const;
    /// Adds an example to the help: a command line that works as pasted. Further lines begin with two blanks.
    void example(const std::string& text) const;
    /// Calls `selected` when the command line names this verb and is parsed.
    void on(std::function<void()> selected) const;

private:
    CLI::App* app_;
};

/// "512MB" or "4G": bytes, at least 1; units are powers of 1024. Throws UsageError, naming the option.
std::uint64_t parse_bytes(const std::string& option, const std::string& text);

/// What follows the name of the program on the command line.
class CommandLine {
public:
    explicit CommandLine(const std::string& version);
    ~CommandLine();

    Verb program() const;  ///< whose subcommands are the verbs
    /// Sets the targets of options, and calls what was given to Verb::on().
    /// returns  the text to print instead, where help or the version is asked for
    /// throws   UsageError; and what the functions of options throw
    std::optional<std::string> parse(std::span<const char* const> arguments);

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace bandlimit::app
