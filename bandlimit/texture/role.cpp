#include "bandlimit/texture/role.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

using enum LevelFinish;
constexpr std::array<RoleTraits, 8> table{{
    // role, name, is_light, may_be_srgb, least_channels, finish
    {Role::color, "color", true, true, 1, none},
    {Role::color_linear, "color-linear", true, false, 1, none},
    {Role::normal, "normal", false, false, 2, unit_length},
    {Role::roughness, "roughness", false, false, 1, lost_variance},
    {Role::height, "height", false, false, 1, none},
    {Role::mask, "mask", false, false, 1, clamp},
    {Role::alpha_tested, "alpha-tested", true, true, 2, coverage},
    {Role::data, "data", false, false, 1, none},
}};

/// The words that end the names of textures, in lower case. The table in the header says the same.
struct Words {
    Role role;
    std::vector<std::string_view> words;
};
const std::vector<Words>& vocabulary() {
    static const std::vector<Words> words{
        {Role::normal, {"n", "nrm", "nor", "nml", "norm", "normal", "normals", "ddn"}},
        {Role::roughness, {"r", "rgh", "rough", "roughness"}},
        {Role::height, {"h", "bump", "height", "disp", "displace", "displacement", "parallax"}},
        {Role::mask,
         {"ao", "occ", "occlusion", "mask", "metal", "metallic", "metalness", "opacity", "alpha", "transparency",
          "cavity"}},
        {Role::data,
         {"orm", "arm", "rma", "mra", "mrao", "rmo", "data", "lut", "flow", "id", "gloss", "glossiness", "smoothness"}},
        {Role::color,
         {"d", "diff", "diffuse", "albedo", "alb", "base", "basecolor", "color", "colour", "col", "spec", "specular",
          "emissive", "emission"}}};
    return words;
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

/// The file name without folders and without its extension.
std::string_view stem_of(std::string_view path) {
    if (const auto slash = path.find_last_of("/\\"); slash != path.npos) path.remove_prefix(slash + 1);
    if (const auto dot = path.find_last_of('.'); dot != path.npos && dot > 0) path = path.substr(0, dot);
    return path;
}

/// Split at everything but letters and digits, and where a capital follows a small letter or a digit, or begins a word
/// after capitals: "WallBaseColor", "wall.AOMap".
std::vector<std::string_view> tokens_of(std::string_view stem) {
    const auto is = [&](std::size_t i, int (*test)(int)) {
        return i < stem.size() && test(static_cast<unsigned char>(stem[i])) != 0;
    };
    std::vector<std::string_view> tokens;
    for (std::size_t i = 0, begin = 0; i <= stem.size(); ++i) {
        const bool ends = !is(i, std::isalnum);
        const bool breaks = !ends && i > begin && is(i, std::isupper) &&
                            (!is(i - 1, std::isupper) || (is(i + 1, std::islower) && is(i - 1, std::isalpha)));
        if ((ends || breaks) && i > begin) tokens.push_back(stem.substr(begin, i - begin));
        if (ends) begin = i + 1;
        else if (breaks) begin = i;
    }
    return tokens;
}

/// What may follow the word that decides: numbers and sizes ("01", "2k", "v3"), conventions of normals, "map".
bool is_qualifier(std::string_view token) {
    static constexpr std::array<std::string_view, 8> words{"gl",  "dx",      "opengl", "directx",
                                                           "map", "texture", "tex",    "raw"};
    if (std::find(words.begin(), words.end(), token) != words.end()) return true;
    if (token.size() > 1 && token.front() == 'v') token.remove_prefix(1);
    if (token.size() > 1 && token.back() == 'k') token.remove_suffix(1);
    return std::all_of(token.begin(), token.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::optional<Role> role_of_word(std::string_view word) {
    for (const Words& entry : vocabulary())
        if (std::find(entry.words.begin(), entry.words.end(), word) != entry.words.end()) return entry.role;
    return {};
}

}  // namespace

std::span<const RoleTraits> role_table() { return table; }

const RoleTraits& traits_of(Role role) { return table[static_cast<std::size_t>(role)]; }

Role parse_role(std::string_view name) {
    std::string list;
    for (const RoleTraits& traits : table) {
        if (traits.name == name) return traits.role;
        list += (list.empty() ? "" : ", ") + std::string(traits.name);
    }
    fail("role \"", name, "\" is unknown; choose one of: ", list);
}

RoleGuess guess_role(std::string_view path) {
    std::vector<std::string_view> tokens = tokens_of(stem_of(path));
    while (tokens.size() > 1 && is_qualifier(lower(tokens.back()))) tokens.pop_back();
    if (tokens.empty()) return {};
    // A picture called "normal.png" or "r.png" ends in its only word: letters alone say nothing then.
    const std::string last = lower(tokens.back());
    if (tokens.size() == 1 && last.size() == 1) return {};
    const std::optional<Role> role = role_of_word(last);
    if (!role) return {};
    if (tokens.size() > 1 && *role != Role::color) {
        const std::string before = lower(tokens[tokens.size() - 2]);
        if (before == "metallic" || before == "occlusion")  // packed side by side, as glTF does
            return {Role::data, std::string(tokens[tokens.size() - 2]) + std::string(tokens.back())};
    }
    return {*role, std::string(tokens.back())};
}

}  // namespace bandlimit
