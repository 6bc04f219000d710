#include "bandlimit/shader/text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// One line that ends no comment and continues on no other.
std::string harmless(const std::string& line) {
    std::string out;
    for (const char c : line) out += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? ' ' : c;
    while (!out.empty() && (out.back() == ' ' || out.back() == '\\')) out.pop_back();
    return out;
}

/// `text` as lines of a comment, broken between words.
void comment(const std::string& text, std::string& out) {
    constexpr std::size_t width = 110;
    std::string rest = harmless(text);
    while (rest.size() > width) {
        std::size_t cut = rest.rfind(' ', width);
        if (cut == std::string::npos || cut == 0) cut = rest.find(' ', width);
        if (cut == std::string::npos) break;
        out += "// " + harmless(rest.substr(0, cut)) + "\n";
        rest = rest.substr(cut + 1);
    }
    out += rest.empty() ? "//\n" : "// " + rest + "\n";
}

void describe_parameters(Header::Reads reads, Dialect dialect, std::string& out) {
    if (reads == Header::Reads::colours || reads == Header::Reads::own) return;
    const bool apart = dialect != Dialect::glsl && dialect != Dialect::cpp;
    comment("", out);
    if (reads == Header::Reads::compute) {
        out += "// binding 0  source, read at the centres of texels: edges are its sampler's\n";
        if (apart) out += "// binding 1  its sampler, linear or nearest\n";
        out += "// binding 2  result; change the format here if it has another\n";
        return;
    }
    out += "// source   the picture to read, its level 0";
    if (dialect == Dialect::cpp) out += "; anything with float4 sample(float2 uv) const and float4 load(int2) const";
    else if (reads == Header::Reads::samples && !apart) out += ", filtered linearly; edges are its sampler's";
    out += "\n";
    if (reads == Header::Reads::samples && apart) out += "// sampler  linear; it decides about edges\n";
    out +=
        "// uv       where the output lies in it: 0 and 1 are its outer edges, (i + 1/2) * texel the centre of texel "
        "i\n"
        "// texel    1 / its size\n";
}

}  // namespace

void check_shader_name(const std::string& name) {
    // Words of the neutral form, and of languages that it becomes.
    constexpr std::array<std::string_view, 52> taken{
        "float",  "float2",    "float3", "float4",   "int",     "int2",    "let",    "var",   "declare",
        "table",  "structure", "field",  "function", "texture", "sampler", "in",     "loop",  "choose",
        "sample", "load",      "tile",   "kernel",   "barrier", "store",   "source", "other", "uv",
        "texel",  "floor",     "dot",    "min",      "max",     "clamp",   "sqrt",   "pow",   "main",
        "out",    "inout",     "const",  "static",   "struct",  "return",  "if",     "else",  "for",
        "while",  "do",        "switch", "void",     "bool",    "fn",      "vec4"};
    const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto allowed = [&](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; };
    const bool plain = !name.empty() && lower(name.front()) && std::all_of(name.begin(), name.end(), allowed);
    // GLSL keeps double underscores and gl_ for itself.
    if (!plain || name.find("__") != std::string::npos || name.ends_with('_') || name.starts_with("gl_") ||
        std::find(taken.begin(), taken.end(), name) != taken.end())
        fail("shader: \"", name,
             "\" is not a name for a function; pass small letters, digits and single underscores, e.g. blur_25");
}

std::string with(std::string text, std::string_view word, std::string_view value) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + value.size()))
        text.replace(at, word.size(), value);
    return text;
}

std::string polynomial(const KernelPiece& piece) {
    const std::string variable = piece.begin == 0 ? "x" : message("(x - ", number(piece.begin), ")");
    const std::vector<double>& c = piece.coefficients;
    std::string text = number(c.back());
    for (std::size_t k = c.size() - 1; k-- > 0;) text = message(number(c[k]), " + ", variable, " * (", text, ")");
    return text;
}

std::string weight_function(const KernelPieces& pieces) {
    std::string text =
        "function(float, NAME_weight, in(float, distance)) {\n    let(float, x) = max(distance, -distance);\n";
    for (const KernelPiece& piece : pieces)
        text += message("    if (x < ", number(piece.end), ") {\n        return ", polynomial(piece), ";\n    }\n");
    return text + "    return 0.0;\n}\n\n";
}

std::string number(double value, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    std::string out = text;
    if (out.find_first_of(".e") == std::string::npos) out += ".0";
    return out;
}

std::string shader_text(const ShaderInfo& info, const Header& header, const std::string& source, Dialect dialect) {
    check_shader_name(info.name);
    std::string out;
    comment(info.name + ": " + with(header.what, "NAME", info.name), out);
    for (const std::string& line : info.notes) comment(line, out);
    comment("Cost: " + header.cost + ".", out);
    if (!info.command.empty()) comment("Made by: " + info.command, out);
    describe_parameters(header.reads, dialect, out);
    const bool whole = header.reads == Header::Reads::compute;
    const std::string version = whole && dialect == Dialect::glsl ? "#version 450\n" : "";
    return version + out + "\n" + in_context(translate(source, dialect), dialect);
}

}  // namespace bandlimit
