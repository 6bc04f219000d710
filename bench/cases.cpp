#include "bench/cases.h"

#include <algorithm>

namespace bandlimit::bench {
namespace {

std::size_t bytes_of(const Case& c, int width, int height) {
    return c.sample_bytes() * static_cast<std::size_t>(c.channels) * static_cast<std::size_t>(width) *
           static_cast<std::size_t>(height);
}

}  // namespace

std::span<const Case> all_cases() {
    static const Case cases[] = {
        {.name = "a", .title = "a: half, L3", .width = 4096, .height = 4096, .new_width = 2048, .new_height = 2048},
        {.name = "b", .title = "b: 1000x700, L3", .width = 4096, .height = 4096, .new_width = 1000, .new_height = 700},
        {.name = "c",
         .title = "c: HD doubled, L3",
         .width = 1920,
         .height = 1080,
         .new_width = 3840,
         .new_height = 2160},
        {.name = "d",
         .title = "d: float half, L3",
         .width = 4096,
         .height = 4096,
         .new_width = 2048,
         .new_height = 2048,
         .channels = 1},
        {.name = "e",
         .title = "e: half, box",
         .width = 4096,
         .height = 4096,
         .new_width = 2048,
         .new_height = 2048,
         .filter = Filter::box},
        {.name = "f-box",
         .title = "f: mips, box",
         .width = 4096,
         .height = 4096,
         .new_width = 2048,
         .new_height = 2048,
         .filter = Filter::box,
         .chain = true},
        {.name = "f",
         .title = "f: mips, L3",
         .width = 4096,
         .height = 4096,
         .new_width = 2048,
         .new_height = 2048,
         .chain = true},
        {.name = "g",
         .title = "g: half, L3, linear light",
         .width = 4096,
         .height = 4096,
         .new_width = 2048,
         .new_height = 2048,
         .linear = true},
    };
    return cases;
}

std::vector<Level> levels_of(const Case& c) {
    std::vector<Level> levels{{c.new_width, c.new_height, 0}};
    while (c.chain && (levels.back().width > 1 || levels.back().height > 1)) {
        const Level last = levels.back();
        levels.push_back({std::max(1, last.width / 2), std::max(1, last.height / 2),
                          last.offset + bytes_of(c, last.width, last.height)});
    }
    return levels;
}

std::size_t source_bytes(const Case& c) { return bytes_of(c, c.width, c.height); }

std::size_t target_bytes(const Case& c) {
    const Level last = levels_of(c).back();
    return last.offset + bytes_of(c, last.width, last.height);
}

}  // namespace bandlimit::bench
