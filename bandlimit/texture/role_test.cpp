#include <gtest/gtest.h>

#include "bandlimit/core/error.h"
#include "bandlimit/texture/role.h"

namespace bandlimit {
namespace {

TEST(Roles, HaveNames) {
    for (const RoleTraits& traits : role_table()) {
        EXPECT_EQ(parse_role(traits.name), traits.role);
        EXPECT_EQ(&traits_of(traits.role), &traits);
        EXPECT_TRUE(traits.is_light || !traits.may_be_srgb) << traits.name;
    }
    EXPECT_EQ(role_table().size(), 8u);
    EXPECT_EQ(parse_role("alpha-tested"), Role::alpha_tested);
    try {
        parse_role("albedo");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("color-linear"), std::string::npos);
    }
}

TEST(GuessRole, ReadsTheLastWord) {
    struct Row {
        const char* path;
        Role role;
        const char* because;
    };
    for (const Row& row : {Row{"wall_n.png", Role::normal, "n"},
                           {"textures/n/Wall_NRM.TGA", Role::normal, "NRM"},
                           {"wall-normal.png", Role::normal, "normal"},
                           {"WoodNormalGL.png", Role::normal, "Normal"},
                           {"wood_nor_dx_4k.exr", Role::normal, "nor"},
                           {"wall.ddn.tga", Role::normal, "ddn"},
                           {"ground_NormalMap_01.png", Role::normal, "Normal"},
                           {"rock_bump.png", Role::height, "bump"},
                           {"rock_h.png", Role::height, "h"},
                           {"rock_disp_2k.png", Role::height, "disp"},
                           {"steel_rough.png", Role::roughness, "rough"},
                           {"steel_r.png", Role::roughness, "r"},
                           {"metal_Roughness_v2.png", Role::roughness, "Roughness"},
                           {"wall_ao.png", Role::mask, "ao"},
                           {"WallAO.png", Role::mask, "AO"},
                           {"wall_AmbientOcclusion.png", Role::mask, "Occlusion"},
                           {"door_metal.png", Role::mask, "metal"},
                           {"leaf_opacity.png", Role::mask, "opacity"},
                           {"metal_plate_albedo.png", Role::color, "albedo"},
                           {"normal_street_diff.jpg", Role::color, "diff"},
                           {"wall_BaseColor.1001.png", Role::color, "Color"},
                           {"wall_basecolor.png", Role::color, "basecolor"},
                           {"wall_d.png", Role::color, "d"},
                           {"wall_spec.png", Role::color, "spec"},
                           {"wall_ORM.png", Role::data, "ORM"},
                           {"wall_arm_4k.png", Role::data, "arm"},
                           {"helmet_metallicRoughness.png", Role::data, "metallicRoughness"},
                           {"wall_gloss.png", Role::data, "gloss"},
                           {"C:\\art\\wall_n.png", Role::normal, "n"},
                           {"normal.png", Role::normal, "normal"}}) {
        EXPECT_EQ(guess_role(row.path).role, row.role) << row.path;
        EXPECT_EQ(guess_role(row.path).because, row.because) << row.path;
    }
}

TEST(GuessRole, SaysNothingOfOtherNames) {
    for (const char* path : {"holiday.jpg", "n.png", "rough_wood.png", "normal_street.jpg", "IMG_0001.png", "", "...",
                             "a/b/", "2k.png", "machine.png", "\xff_\xfe"}) {
        EXPECT_EQ(guess_role(path).because, "") << path;
        EXPECT_EQ(guess_role(path).role, Role::color) << path;
    }
}

}  // namespace
}  // namespace bandlimit
