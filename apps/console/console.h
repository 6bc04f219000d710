// What a run says: on stdout, on stderr, and on a terminal.
#pragma once
#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <type_traits>

namespace bandlimit::app {

/// Where a run writes. Both must be open as far as C is concerned; what is written may fail all the same.
struct Streams {
    std::FILE* out;
    std::FILE* err;
};

/// `text` so that a terminal shows it and does nothing else: control characters, bytes that are not UTF-8, and marks
/// that change the direction of writing become \x1b, \xff or \u202e. Line breaks become \n, unless `keeps_lines`.
/// It is for people: a backslash stays as it is.
std::string visible(std::string_view text, bool keeps_lines = false);

/// A value to be formatted: if it is text, what is visible() of it.
template <class T>
constexpr bool is_text = std::is_convertible_v<const T&, std::string_view>;
template <class T>
using Shown = std::conditional_t<is_text<T>, std::string, T>;
template <class T>
std::conditional_t<is_text<T>, std::string, const T&> shown(const T& value) {
    if constexpr (is_text<T>) return visible(value);
    else return value;
}

/// What one run says. All names and values that users, files and other programs give go through here to the terminal.
class Console {
public:
    bool quiet = false;  ///< no notes, no progress

    explicit Console(const Streams& streams) : streams_(streams) {}

    /// Writes to stdout. Line breaks of `format` are line breaks; those in text that is filled in are shown as \n.
    /// throws   std::runtime_error where stdout cannot be written, as all below that write there
    template <class... T>
    void print(fmt::format_string<Shown<T>...> format, const T&... values) {
        print_lines(fmt::vformat(format, fmt::make_format_args(static_cast<const Shown<T>&>(shown(values))...)));
    }
    /// Writes lines to stdout, visible() except for line breaks.
    void print_lines(std::string_view text) { write(visible(text, true)); }
    /// Writes the report, and nothing else, to stdout. It has control characters and the like as \u001b, and the
    /// replacement character for what is not UTF-8.
    void print_json(const nlohmann::ordered_json& report);
    /// Writes to stdout as it is: source text, help.
    void write(std::string_view text);
    /// Hands over what is still in buffers.
    void finish();

    /// A line on stderr for something the user should know, unless quiet.
    void note(std::string_view text) const noexcept;
    /// A line on stderr.
    void error(std::string_view text) const noexcept;

    /// Whether stderr is a terminal on which a progress bar is wanted.
    bool shows_progress() const noexcept;
    /// Writes to stderr as it is; what cannot be written is lost.
    void write_error(std::string_view text) const noexcept;

private:
    void say(const char* kind, std::string_view text) const noexcept;

    Streams streams_;
};

/// A bar on a terminal, once the work has lasted two seconds; with the rate where the work has a `unit`.
class Progress {
public:
    Progress(const Console& console, std::string label, double total, std::string unit = {});
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance_to(double done);

private:
    using Clock = std::chrono::steady_clock;
    const Console& console_;
    std::string label_, unit_;
    double total_;
    Clock::time_point start_ = Clock::now(), drawn_{};
    bool visible_ = false;
};

}  // namespace bandlimit::app
