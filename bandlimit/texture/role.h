// What the texels of a texture stand for.
// Stability: stable.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace bandlimit {

/// What the samples of a texture stand for. It decides what their mean is; docs/mips.md has the formulas.
///
/// Roles other than color, color_linear and alpha_tested take stored samples as they are: neither their transfer nor
/// their alpha matters.
enum class Role {
    color,         ///< light, in codes as `stored` says, weighted by alpha
    color_linear,  ///< light in linear codes, whatever `stored` says, weighted by alpha
    normal,        ///< unit vectors: filtered, then made unit again. Integers hold (n + 1) / 2, floats n itself; two
                   ///< channels hold x and y, and z >= 0 is what is missing to 1; a fourth is data
    roughness,     ///< perceptual roughness, the root of alpha; grows by the variance of normals that a level loses.
                   ///< Each channel by itself, but a fourth, which is data
    height,        ///< any quantity, each channel by itself
    mask,          ///< shares of 0 to 1, each channel by itself, clamped to that
    alpha_tested,  ///< color, whose alpha is compared with a threshold: the share that passes is kept
    data           ///< any quantity, each channel by itself, alpha too
};

/// What a level goes through once its means are made.
enum class LevelFinish {
    none,
    clamp,          ///< to [0, 1]
    unit_length,    ///< means of normals become normals
    lost_variance,  ///< means of squared widths take what normals lost, and become roughness
    coverage        ///< alpha is scaled until as many texels pass as in level 0
};

/// A row of the table of roles: all that tells them apart.
struct RoleTraits {
    Role role;
    std::string_view name;  ///< "color-linear"
    bool is_light;          ///< decoded, and weighted by alpha; else each channel by itself, as it is stored
    bool may_be_srgb;       ///< whether 8-bit codes may have the curve of sRGB
    int least_channels;     ///< of picture and texture
    LevelFinish finish;

    /// Whether rows of a level are finished without the others.
    bool finishes_by_rows() const { return finish != LevelFinish::lost_variance && finish != LevelFinish::coverage; }
};
/// All of them, in the order of Role.
std::span<const RoleTraits> role_table();
const RoleTraits& traits_of(Role role);
inline std::string_view name_of(Role role) { return traits_of(role).name; }
/// "color", "color-linear", "alpha-tested", ... Throws Error, listing them, for any other name.
Role parse_role(std::string_view name);

/// What the name of a file says about its role: "wall_n.png" is a normal map. `because` is the part of the name that
/// decided, empty where nothing did and the role is color.
///
/// The last word decides, after numbers, sizes ("4k"), versions ("v2"), "map", "tex", "texture", "raw" and the
/// conventions of normals ("gl", "dx", "opengl", "directx"). Words are divided by what is no letter or digit, and by
/// capitals; case does not matter.
///
/// | role | words |
/// | --- | --- |
/// | normal | n nrm nor nml norm normal normals ddn |
/// | roughness | r rgh rough roughness |
/// | height | h bump height disp displace displacement parallax |
/// | mask | ao occ occlusion mask metal metallic metalness opacity alpha transparency cavity |
/// | data | orm arm rma mra mrao rmo (packed side by side) data lut flow id gloss glossiness smoothness; and what |
/// |      | follows the word metallic or occlusion, as in metallicRoughness |
/// | color | d diff diffuse albedo alb base basecolor color colour col spec specular emissive emission |
struct RoleGuess {
    Role role = Role::color;
    std::string because;
};
RoleGuess guess_role(std::string_view path);

}  // namespace bandlimit
