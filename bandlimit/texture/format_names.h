// What graphics interfaces call their texel formats. Not for callers.
// Stability: inner.
#pragma once
#include <cstdint>
#include <string>

namespace bandlimit {

/// "VK_FORMAT_R8G8B8A8_SNORM", or "VkFormat 12345" for a number that has no name.
std::string vulkan_format_name(std::uint32_t number);

/// "DXGI_FORMAT_BC7_UNORM", or "DXGI_FORMAT 12345".
std::string dxgi_format_name(std::uint32_t number);

}  // namespace bandlimit
