// A compute shader, run on whatever Vulkan device there is, without a window.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bandlimit/shader/picture_test.h"

namespace bandlimit::test {

/// What a compute shader is given: textures at bindings 0, 3, 4, ... of set 0, their sampler at 1, the result at 2.
struct Dispatch {
    std::string entry = "main";
    bool combined = false;  ///< textures and sampler are one, as in GLSL, and there is no binding 1
    Edge edge = Edge::clamp;
    std::vector<const Picture*> textures = {};
    int width = 0, height = 0;       ///< of the result
    int groups_x = 0, groups_y = 0;  ///< workgroups
    bool half_result = false;        ///< the result is rgba16f, else rgba32f
    bool loads_floats = false;       ///< textures are rgba32f, and read without the sampler
};

/// A device and what belongs to it. All failures of Vulkan throw std::runtime_error.
class Vulkan {
public:
    /// Why there is none: no header when this was built, no loader, no driver. Empty if there is one.
    static std::string missing();

    Vulkan();
    ~Vulkan();

    std::string device() const;
    /// Fractional bits of texture coordinates that the driver promises: 4 at least, 8 usually.
    int fraction_bits() const;
    /// The result's pixels, RGBA, row after row.
    std::vector<float> run(const std::vector<std::uint32_t>& spirv, const Dispatch& dispatch) const;

    struct State;

private:
    std::unique_ptr<State> state_;
};

}  // namespace bandlimit::test
