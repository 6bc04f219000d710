#include "bandlimit/shader/dialect.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/shader/words.h"

namespace bandlimit {
namespace {

constexpr std::array dialects{Dialect::glsl, Dialect::hlsl, Dialect::wgsl, Dialect::msl, Dialect::slang, Dialect::cpp};
constexpr std::array<std::string_view, dialects.size()> names{"glsl", "hlsl", "wgsl", "msl", "slang", "cpp"};
constexpr std::array<std::string_view, dialects.size()> extensions{".glsl", ".hlsl", ".wgsl", ".metal", ".slang", ".h"};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\n'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

/// The arguments between the parenthesis at `open` and its partner; `end` becomes what follows that.
std::vector<std::string_view> arguments_at(std::string_view text, std::size_t open, std::size_t& end) {
    std::vector<std::string_view> arguments;
    std::size_t start = open + 1;
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
        if (text[i] == '(') ++depth;
        if (text[i] == ')') --depth;
        if (depth == 0 || (depth == 1 && text[i] == ',')) {
            arguments.push_back(text.substr(start, i - start));
            start = i + 1;
        }
        if (depth == 0) {
            end = i + 1;
            return arguments;
        }
    }
    fail("translate: a parenthesis is not closed: ", text.substr(open, 60));
}

/// One pass over neutral text, which calls itself for arguments.
class Translator {
public:
    explicit Translator(const Words& words) : words_(words) {}

    std::string operator()(std::string_view text) const {
        std::string out;
        for (std::size_t at = 0; at < text.size();) {
            if (text.substr(at, 2) == "//") {
                const std::size_t end = std::min(text.find('\n', at), text.size());
                out += text.substr(at, end - at);
                at = end;
            } else if (is_letter(text[at])) {
                at = word(text, at, out);
            } else if (is_digit(text[at])) {
                at = number(text, at, out);
            } else {
                out += text[at++];
            }
        }
        return out;
    }

private:
    std::size_t word(std::string_view text, std::size_t at, std::string& out) const {
        std::size_t end = at;
        while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
        const std::string_view name = text.substr(at, end - at);
        if (const auto pattern = words_.call(name)) {
            if (end == text.size() || text[end] != '(') fail("translate: ", name, " without its arguments");
            const std::vector<std::string_view> arguments = arguments_at(text, end, end);
            fill(*pattern, arguments, out);
        } else {
            out += words_.word(name);
        }
        return end;
    }

    std::size_t number(std::string_view text, std::size_t at, std::string& out) const {
        std::size_t end = at;
        bool real = false;
        while (end < text.size() && (is_digit(text[end]) || text[end] == '.' || text[end] == 'e' ||
                                     (text[end - 1] == 'e' && (text[end] == '-' || text[end] == '+')))) {
            real = real || !is_digit(text[end]);
            ++end;
        }
        out += text.substr(at, end - at);
        if (real) out += words_.float_suffix;
        return end;
    }

    /// `pattern` with {2} replaced by argument 2, and {2*} by all from there on that are not empty.
    void fill(std::string_view pattern, const std::vector<std::string_view>& arguments, std::string& out) const {
        for (std::size_t at = 0; at < pattern.size(); ++at) {
            const bool slot = pattern[at] == '{' && at + 1 < pattern.size() && is_digit(pattern[at + 1]);
            if (!slot) {
                out += pattern[at];
                continue;
            }
            const auto first = static_cast<std::size_t>(pattern[at + 1] - '0');
            const bool rest = pattern[at + 2] == '*';
            at += rest ? 3 : 2;
            if (!rest && first >= arguments.size()) fail("translate: too few arguments for ", pattern);
            if (rest) fill_rest(arguments, first, out);
            else out += trimmed((*this)(arguments[first]));
        }
    }

    void fill_rest(const std::vector<std::string_view>& arguments, std::size_t first, std::string& out) const {
        bool any = false;
        for (std::size_t i = first; i < arguments.size(); ++i) {
            const std::string argument = (*this)(arguments[i]);
            if (trimmed(argument).empty()) continue;
            if (any) out += ',';
            out += any || argument.front() == '\n' ? std::string_view(argument) : trimmed(argument);
            any = true;
        }
    }

    const Words& words_;
};

/// Without the lines that hold blanks only, as those of words that a dialect has no use for, and with at most one empty
/// line in a row.
std::string without_gaps(const std::string& text) {
    std::string out;
    bool after_empty = true;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = std::string_view(text).substr(at, end - at);
        const bool blank = trimmed(line).empty();
        if (!blank || (line.empty() && !after_empty)) out.append(line) += '\n';
        if (!blank || line.empty()) after_empty = blank;
        at = end + 1;
    }
    return out;
}

}  // namespace

std::span<const Dialect> all_dialects() { return dialects; }

std::string_view name_of(Dialect dialect) { return names.at(static_cast<std::size_t>(dialect)); }

std::string_view extension_of(Dialect dialect) { return extensions.at(static_cast<std::size_t>(dialect)); }

Dialect parse_dialect(std::string_view name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        fail("parse_dialect: unknown shading language \"", name, "\"; pass glsl, hlsl, wgsl, msl, slang or cpp");
    return dialects.at(static_cast<std::size_t>(found - names.begin()));
}

std::string translate(std::string_view source, Dialect dialect) {
    return without_gaps(Translator(words_of(dialect))(source));
}

std::string in_context(std::string code, Dialect dialect) {
    const Words& words = words_of(dialect);
    return std::string(words.before) + std::move(code) + std::string(words.after);
}

}  // namespace bandlimit
