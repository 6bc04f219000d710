// Numbers from the front of a fuzzer's input.
#pragma once
#include <cstddef>
#include <cstdint>

namespace bandlimit {

/// Zeros follow after the end.
struct Bytes {
    const std::uint8_t* data;
    std::size_t size;
    int below(int limit) {
        if (size == 0) return 0;
        --size;
        return *data++ % limit;
    }
};

}  // namespace bandlimit
