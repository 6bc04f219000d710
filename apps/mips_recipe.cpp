#include "apps/mips_recipe.h"

#include <fmt/core.h>

#include <algorithm>

#include "apps/common.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit::app {

bool is_taps_file(const std::string& filter) { return filter.ends_with(".json"); }

void set_role(MipsRecipe& recipe, const std::string& text) {
    recipe.role = text == "auto" ? std::nullopt : std::optional(parse_role(text));
}

void set_filter(MipsRecipe& recipe, const std::string& text) {
    if (text != "auto" && text != "downsample8" && !is_taps_file(text)) parse_kernel(text);
    recipe.filter = text;
}

void set_from(MipsRecipe& recipe, const std::string& text) {
    if (text != "base" && text != "previous")
        throw UsageError("--from: \"" + text + "\" is unknown; choose base or previous");
    recipe.from = text == "base" ? MipSource::base : MipSource::previous;
}

void set_edge(MipsRecipe& recipe, const std::string& text) {
    const std::size_t comma = text.find(',');
    recipe.edge_x = parse_edge(text.substr(0, comma));
    recipe.edge_y = comma == std::string::npos ? recipe.edge_x : parse_edge(text.substr(comma + 1));
}

void set_threshold(MipsRecipe& recipe, double threshold) {
    if (!(threshold > 0 && threshold <= 1))
        throw UsageError(
            fmt::format("--alpha-threshold: {} is out of range; pass more than 0 and at most 1, e.g. 0.5", threshold));
    recipe.alpha_threshold = threshold;
}

void set_channels(MipsRecipe& recipe, int channels) {
    if (channels != 1 && channels != 2 && channels != 4)
        throw UsageError(fmt::format("--channels: texels of {} channels do not exist; choose 1, 2 or 4", channels));
    recipe.channels = channels;
}

bool is_data(Role role) { return role != Role::color && role != Role::color_linear && role != Role::alpha_tested; }

void check_recipe(const MipsRecipe& recipe, Role role) {
    const auto require = [&](bool fits, const std::string& option, const std::string& roles) {
        if (!fits)
            throw UsageError(
                fmt::format("{}: the role is {}; give --role {}, or leave it out", option, name_of(role), roles));
    };
    require(recipe.normal.empty() || role == Role::roughness, "--normal", "roughness");
    require(!recipe.alpha_threshold || role == Role::alpha_tested, "--alpha-threshold", "alpha-tested");
    require(!recipe.two_channel || role == Role::normal, "--two-channel", "normal");
    require(!recipe.premultiplied || !is_data(role), "--premultiplied", "color");
    require(recipe.space != Space::data || is_data(role), "--space data", "data");
    if (recipe.from == MipSource::base && (recipe.filter == "downsample8" || is_taps_file(recipe.filter)))
        throw UsageError(fmt::format(
            "--from base: {} makes a level from the one above; choose a kernel, or leave it out", recipe.filter));
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
        throw UsageError(fmt::format(
            "--filter {}: its taps are made for a factor of {}, and every level halves; give taps of factor 2", name,
            file.factor));
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

}  // namespace bandlimit::app
