// Numbers of texel formats against the enumerations of Vulkan and Direct3D.
#include "bandlimit/texture/format_names.h"

#include <gtest/gtest.h>

namespace bandlimit {
namespace {

TEST(FormatNames, StandAtTheirNumbers) {
    // The first and the last of each run, and some between, so that none is missing or twice.
    for (const auto& [number, name] :
         std::initializer_list<std::pair<std::uint32_t, const char*>>{{0, "UNDEFINED"},
                                                                      {1, "R4G4_UNORM_PACK8"},
                                                                      {37, "R8G8B8A8_UNORM"},
                                                                      {97, "R16G16B16A16_SFLOAT"},
                                                                      {109, "R32G32B32A32_SFLOAT"},
                                                                      {130, "D32_SFLOAT_S8_UINT"},
                                                                      {131, "BC1_RGB_UNORM_BLOCK"},
                                                                      {146, "BC7_SRGB_BLOCK"},
                                                                      {156, "EAC_R11G11_SNORM_BLOCK"},
                                                                      {157, "ASTC_4x4_UNORM_BLOCK"},
                                                                      {184, "ASTC_12x12_SRGB_BLOCK"},
                                                                      {1000054007, "PVRTC2_4BPP_SRGB_BLOCK_IMG"},
                                                                      {1000066000, "ASTC_4x4_SFLOAT_BLOCK"},
                                                                      {1000066013, "ASTC_12x12_SFLOAT_BLOCK"},
                                                                      {1000156000, "G8B8G8R8_422_UNORM"},
                                                                      {1000156033, "G16_B16_R16_3PLANE_444_UNORM"},
                                                                      {1000340001, "A4B4G4R4_UNORM_PACK16"}})
        EXPECT_EQ(vulkan_format_name(number), "VK_FORMAT_" + std::string(name));
    for (const auto& [number, name] :
         std::initializer_list<std::pair<std::uint32_t, const char*>>{{0, "UNKNOWN"},
                                                                      {2, "R32G32B32A32_FLOAT"},
                                                                      {28, "R8G8B8A8_UNORM"},
                                                                      {55, "D16_UNORM"},
                                                                      {61, "R8_UNORM"},
                                                                      {70, "BC1_TYPELESS"},
                                                                      {87, "B8G8R8A8_UNORM"},
                                                                      {99, "BC7_UNORM_SRGB"},
                                                                      {103, "NV12"},
                                                                      {115, "B4G4R4A4_UNORM"},
                                                                      {132, "V408"},
                                                                      {191, "A4B4G4R4_UNORM"}})
        EXPECT_EQ(dxgi_format_name(number), "DXGI_FORMAT_" + std::string(name));
}

TEST(FormatNames, NumbersWithoutANameStayNumbers) {
    for (const std::uint32_t number : {185u, 1000053999u, 1000054008u, 1000340002u, 0xffffffffu})
        EXPECT_EQ(vulkan_format_name(number), "VkFormat " + std::to_string(number));
    for (const std::uint32_t number : {116u, 129u, 133u, 192u, 0xffffffffu})
        EXPECT_EQ(dxgi_format_name(number), "DXGI_FORMAT " + std::to_string(number));
}

}  // namespace
}  // namespace bandlimit
