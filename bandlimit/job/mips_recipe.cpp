#include "bandlimit/job/mips_recipe.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "bandlimit/io/taps_json.h"

namespace bandlimit::job {

namespace {

void set_role(MipsRecipe& recipe, const std::string& text) {
    recipe.role = text == "auto" ? std::nullopt : std::optional(parse_role(text));
}

/// A file of taps is not looked at yet.
void set_filter(MipsRecipe& recipe, const std::string& text) {
    if (text != "auto" && text != "downsample8" && !is_taps_file(text)) parse_kernel(text);
    recipe.filter = text;
}

void set_from(MipsRecipe& recipe, const std::string& text) {
    if (text != "base" && text != "previous")
        throw OptionError("from", "\"" + text + "\" is unknown; choose base or previous");
    recipe.from = text == "base" ? MipSource::base : MipSource::previous;
}

void set_edge(MipsRecipe& recipe, const std::string& text) {
    const std::size_t comma = text.find(',');
    recipe.edge_x = parse_edge(text.substr(0, comma));
    recipe.edge_y = comma == std::string::npos ? recipe.edge_x : parse_edge(text.substr(comma + 1));
}

void set_threshold(MipsRecipe& recipe, double threshold) {
    if (!(threshold > 0 && threshold <= 1))
        throw OptionError("alpha-threshold",
                          fmt::format("{} is out of range; pass more than 0 and at most 1, e.g. 0.5", threshold));
    recipe.alpha_threshold = threshold;
}

void set_levels(MipsRecipe& recipe, int levels) {
    if (levels < 1 || levels > most_levels)
        throw OptionError("levels", fmt::format("{} is out of range; pass 1 to {}", levels, most_levels));
    recipe.levels = levels;
}

void set_channels(MipsRecipe& recipe, int channels) {
    if (channels != 1 && channels != 2 && channels != 4)
        throw OptionError("channels", fmt::format("texels of {} channels do not exist; choose 1, 2 or 4", channels));
    recipe.channels = channels;
}

void set_normal(MipsRecipe& recipe, const std::string& text) { recipe.normal = text; }
void set_space(MipsRecipe& recipe, const std::string& text) { recipe.space = parse_space(text); }
void set_depth(MipsRecipe& recipe, const std::string& text) { recipe.depth = parse_depth(text); }

constexpr std::array options{
    RecipeOption{
        "role", "auto|ROLE", set_role,
        "What the texels are, which decides what their mean is; auto (default) guesses from the file's name\n"
        "color: light in sRGB codes, weighted by alpha; color-linear: the same in linear codes\n"
        "alpha-tested: color; at each level as many texels pass the threshold as at level 0\n"
        "normal: unit vectors; roughness: grows by what the normal map loses; height, mask, data: as they are"},
    RecipeOption{"normal", "FILE", set_normal, "The normal map of the same surface, for the role roughness"},
    RecipeOption{"alpha-threshold", "T", set_threshold, "Alpha that passes, for the role alpha-tested; default 0.5"},
    RecipeOption{"filter", "K|auto|downsample8", set_filter,
                 "A kernel (bandlimit analyze --list), auto (default: shrink3), downsample8 (eight\n"
                 "bilinear reads, as shaders run it), or a taps.json of factor 2"},
    RecipeOption{"from", "base|previous", set_from,
                 "Make each level from the level above, before rounding (previous, the default), or\n"
                 "from level 0 (base: exact, and slower)"},
    RecipeOption{"edge", "EDGE|X,Y", set_edge,
                 "What lies beyond the borders: wrap for textures that tile, else clamp, reflect, zero\n"
                 "or renormalize (the default); one for both axes, or two as wrap,clamp"},
    RecipeOption{"levels", "N", set_levels, "How many levels, level 0 included; default: all"},
    RecipeOption{"space", "auto|srgb|linear|data", set_space,
                 "What the input's codes mean: auto (default: what role and file say), srgb,\n"
                 "linear, or data"},
    RecipeOption{"depth", "u8|u16|f16|f32", set_depth, "Depth of the texels; default: that of the input"},
    RecipeOption{"channels", "1|2|4", set_channels,
                 "Channels of the texels; default: what picture and role need (RGB becomes RGBA, grey\n"
                 "data one channel, grey sRGB colour RGBA)"},
    RecipeOption{"two-channel", "", &MipsRecipe::two_channel,
                 "Keep x and y of normals, for shaders and encoders (BC5) that make z of them"},
    RecipeOption{"premultiplied", "", &MipsRecipe::premultiplied,
                 "Store colour multiplied by alpha, and say so in the file"},
};

}  // namespace

std::span<const RecipeOption> recipe_options() { return options; }

const RecipeOption* find_option(std::string_view name) {
    const auto* const found =
        std::find_if(options.begin(), options.end(), [&](const RecipeOption& o) { return o.name == name; });
    return found == options.end() ? nullptr : found;
}

bool is_taps_file(const std::string& filter) { return filter.ends_with(".json"); }

void check_recipe(const MipsRecipe& recipe, Role role) {
    const auto require = [&](bool fits, std::string_view option, std::string_view roles) {
        if (!fits)
            throw OptionError(option,
                              fmt::format("the role is {}; choose the role {}, or leave it out", name_of(role), roles));
    };
    require(recipe.normal.empty() || role == Role::roughness, "normal", "roughness");
    require(!recipe.alpha_threshold || role == Role::alpha_tested, "alpha-threshold", "alpha-tested");
    require(!recipe.two_channel || role == Role::normal, "two-channel", "normal");
    require(!recipe.premultiplied || traits_of(role).is_light, "premultiplied", "color");
    require(recipe.space != Space::data || !traits_of(role).is_light, "space", "data");
    if (recipe.from == MipSource::base && (recipe.filter == "downsample8" || is_taps_file(recipe.filter)))
        throw OptionError("from", fmt::format("base does not go with {}, which makes a level from the one above; "
                                              "choose a kernel, or leave it out",
                                              recipe.filter));
}

RoleChoice choose_role(const MipsRecipe& recipe, const std::string& path, bool is_linear) {
    if (recipe.role) return {*recipe.role, "option", {}};
    const RoleGuess guess = guess_role(path);
    if (!guess.because.empty()) return {guess.role, "name", guess.because};
    return {is_linear ? Role::color_linear : guess.role, "default", {}};
}

MipFilter filter_of(const MipsRecipe& recipe) {
    const std::string& name = recipe.filter;
    if (name == "auto") return Auto{};
    if (name == "downsample8") return downsample8();
    if (!is_taps_file(name)) return parse_kernel(name);
    const TapsFile file = read_taps(name);
    if (is_kernel(file)) return kernel_of(file, name);
    if (file.factor != 2)
        throw OptionError("filter", fmt::format("the taps of {} are made for a factor of {}, and every level halves; "
                                                "give taps of factor 2",
                                                name, file.factor));
    if (!file.taps && !file.fetches.empty()) return file.fetches;
    return taps_of(file, name);
}

std::string name_of(const MipFilter& filter, int length) {
    if (const Kernel* kernel = std::get_if<Kernel>(&filter)) return kernel->name;
    if (std::holds_alternative<Taps>(filter)) return "taps";
    if (const Fetches* fetches = std::get_if<Fetches>(&filter)) {
        const Fetches known = downsample8();
        const bool is_known =
            std::equal(fetches->begin(), fetches->end(), known.begin(), known.end(),
                       [](const Fetch& a, const Fetch& b) { return a.x == b.x && a.y == b.y && a.weight == b.weight; });
        return is_known ? "downsample8" : fmt::format("{} fetches", fetches->size());
    }
    return auto_kernel({length, 0, 1}, {mip_length(length, 1), 0, 1}).name;
}

}  // namespace bandlimit::job
