// How the levels of a texture are to be made, as the command line or the rules of a batch say it.
#pragma once
#include <optional>
#include <string>

#include "bandlimit/io/image_file.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit::app {

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

// Each sets what its text says. They throw UsageError or Error, listing what is right.
void set_role(MipsRecipe& recipe, const std::string& text);    ///< "auto" or a role
void set_filter(MipsRecipe& recipe, const std::string& text);  ///< a file of taps is not looked at yet
void set_from(MipsRecipe& recipe, const std::string& text);    ///< "base" or "previous"
void set_edge(MipsRecipe& recipe, const std::string& text);    ///< "wrap", or "wrap,clamp" for x and y
void set_threshold(MipsRecipe& recipe, double threshold);
void set_channels(MipsRecipe& recipe, int channels);

/// Whether a filter is the path of a taps.json.
bool is_taps_file(const std::string& filter);

/// Whether samples of this role are no colours: never decoded unless asked, and alpha is a channel like the others.
bool is_data(Role role);

/// Throws UsageError for options that belong to another role, or that contradict each other.
void check_recipe(const MipsRecipe& recipe, Role role);

/// Why a texture has its role.
struct RoleChoice {
    Role role = Role::color;
    std::string from;     ///< "option", "name" or "default"
    std::string because;  ///< the part of the name that decided; empty where nothing did
};
/// The role of a texture made of the picture `path`; `is_linear` where that is a texture whose codes have no curve.
RoleChoice choose_role(const MipsRecipe& recipe, const std::string& path, bool is_linear);

/// Reads the taps or the kernel where a file holds them. Throws UsageError for taps that do not halve, else as
/// read_taps.
MipFilter filter_of(const MipsRecipe& recipe);
/// What the filter is called along an axis of so many texels.
std::string name_of(const MipFilter& filter, int length);

}  // namespace bandlimit::app
