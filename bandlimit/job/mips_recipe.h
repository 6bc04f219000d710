// How the levels of a texture are to be made.
// Stability: evolving.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit::job {

/// What is not given is decided for each texture.
struct MipsRecipe {
    std::optional<Role> role;  ///< none: guessed from the name of the picture
    std::string normal;        ///< path of the normal map that belongs to a roughness map
    std::optional<double> alpha_threshold;
    std::string filter = "auto";  ///< a kernel, "auto", "downsample8", or the path of a taps.json
    MipSource from = MipSource::previous;
    std::optional<Edge> edge_x, edge_y;
    int levels = 0;  ///< 0: all
    Space space = Space::automatic;
    std::optional<Depth> depth;
    int channels = 0;  ///< 1, 2 or 4; 0: what picture and role need
    bool two_channel = false, premultiplied = false;
};

/// A recipe's entry by name, for command lines, rules of a batch, and user interfaces.
struct RecipeOption {
    using SetText = void (*)(MipsRecipe&, const std::string&);
    using SetInt = void (*)(MipsRecipe&, int);
    using SetNumber = void (*)(MipsRecipe&, double);
    using Flag = bool MipsRecipe::*;

    std::string_view name;  ///< "alpha-threshold"
    std::string_view type;  ///< what a value looks like, "T", "base|previous"; empty for flags
    std::variant<SetText, SetInt, SetNumber, Flag> set;  ///< throw OptionError or Error, listing what is right
    std::string_view help;
};
constexpr int most_levels = 31;  ///< that any picture has

/// All entries of a recipe.
std::span<const RecipeOption> recipe_options();
/// The entry of that name; null if there is none.
const RecipeOption* find_option(std::string_view name);

/// Whether a filter is the path of a taps.json.
bool is_taps_file(const std::string& filter);

/// Throws OptionError for options that belong to another role, or that contradict each other.
void check_recipe(const MipsRecipe& recipe, Role role);

/// Why a texture has its role.
struct RoleChoice {
    Role role = Role::color;
    std::string from;     ///< "option", "name" or "default"
    std::string because;  ///< the part of the name that decided; empty where nothing did
};
/// The role of a texture made of the picture `path`; `is_linear` where that is a texture whose codes have no curve.
RoleChoice choose_role(const MipsRecipe& recipe, const std::string& path, bool is_linear);

/// Reads the taps or the kernel where a file holds them. Throws OptionError for taps that do not halve, else as
/// read_taps.
MipFilter filter_of(const MipsRecipe& recipe);
/// What the filter is called along an axis of so many texels.
std::string name_of(const MipFilter& filter, int length);

}  // namespace bandlimit::job
