// Kernel names come from command lines and files: parsing any of them throws Error or gives a kernel that is sound.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/kernel.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const bandlimit::Kernel kernel = bandlimit::parse_kernel({reinterpret_cast<const char*>(data), size});
        const auto require = [](bool fact) {
            if (!fact) std::abort();
        };
        require(kernel.radius > 0 && std::isfinite(kernel.radius));
        require(std::isfinite(kernel.value(0)) && kernel.value(kernel.radius * 1.001) == 0);
        require(kernel.value(0.3) == kernel.value(-0.3));
    } catch (const bandlimit::Error&) {
    }
    return 0;
}
