// Any bytes as taps.json: they parse, or one std::runtime_error says why not.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "bandlimit/io/taps_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        bandlimit::parse_taps({reinterpret_cast<const char*>(data), size}, "fuzz");
    } catch (const std::runtime_error&) {
    }
    return 0;
}
