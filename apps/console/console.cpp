#include "apps/console/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace bandlimit::app {
namespace {

/// A character of UTF-8: its length in bytes, 0 where the bytes are none, and its number.
struct Character {
    std::size_t length = 0;
    std::uint32_t code = 0;
};

Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
    const std::uint32_t lead = byte(0);
    if (lead < 0x80) return {1, lead};
    const std::size_t length = lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead >= 0xf0 ? 4 : 0;
    if (length == 0 || lead > 0xf4 || text.size() < length) return {};
    std::uint32_t code = lead & (0x7f >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3f);
    }
    const bool is_too_long = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    return is_too_long || is_surrogate || code > 0x10ffff ? Character{} : Character{length, code};
}

/// Control characters, and what separates lines or turns the direction of writing.
bool acts_on_terminals(std::uint32_t code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x200e || code == 0x200f ||
           (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(std::string_view text, bool keeps_lines, bool is_json) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const auto [length, code] = first_character(text);
        if (length == 0) {
            out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        } else if (code == '\n') {
            out += keeps_lines ? "\n" : "\\n";
        } else if (acts_on_terminals(code)) {
            out += code < 0x80 && !is_json ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
        } else {
            out += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(1, length));
    }
    return out;
}

[[noreturn]] void fail_stdout() {
    throw std::runtime_error("stdout cannot be written; is it closed, or the disk full?");
}

}  // namespace

std::string visible(std::string_view text, bool keeps_lines) { return escaped(text, keeps_lines, false); }

void Console::print_json(const nlohmann::ordered_json& report) {
    const std::string text = report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    write(escaped(text, true, true) + "\n");  // JSON by itself leaves some as they are, inside of strings
}

void Console::write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), streams_.out) != text.size()) fail_stdout();
}

void Console::finish() {
    if (std::fflush(streams_.out) != 0 || std::ferror(streams_.out)) fail_stdout();
}

void Console::note(std::string_view text) const noexcept {
    if (!quiet) say("note", text);
}

void Console::error(std::string_view text) const noexcept { say("error", text); }

void Console::say(const char* kind, std::string_view text) const noexcept {
    while (!text.empty() && (text.back() == ' ' || text.back() == '.' || text.back() == '\n')) text.remove_suffix(1);
    try {
        write_error(fmt::format("bandlimit: {}: {}\n", kind, visible(text)));
    } catch (const std::bad_alloc&) {
        write_error("bandlimit: error: memory is exhausted; close other programs\n");
    } catch (...) {  // nothing else is thrown
    }
}

bool Console::shows_progress() const noexcept { return !quiet && ::isatty(::fileno(streams_.err)) != 0; }

void Console::write_error(std::string_view text) const noexcept {
    (void)!std::fwrite(text.data(), 1, text.size(), streams_.err);
}

Progress::Progress(const Console& console, std::string label, double total, std::string unit)
    : console_(console),
      label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      visible_(console.shows_progress()) {}

Progress::~Progress() {
    if (drawn_ != Clock::time_point{}) console_.write_error("\r\x1b[K");
}

void Progress::advance_to(double done) {
    using namespace std::chrono_literals;
    const auto now = Clock::now();
    if (!visible_ || now - start_ < 2s || now - drawn_ < 100ms || done <= 0) return;
    drawn_ = now;
    constexpr int width = 30;
    const double share = std::min(1.0, done / total_);
    const auto filled = static_cast<std::size_t>(share * width);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string rate = unit_.empty() ? "" : fmt::format("{:.1f} {}/s  ", done / elapsed, unit_);
    console_.write_error(fmt::format("\r\x1b[K{} [{:<{}}] {:3.0f} %  {}{:.0f} s left", label_, std::string(filled, '#'),
                                     width, 100 * share, rate, elapsed * (1 / share - 1)));
}

}  // namespace bandlimit::app
