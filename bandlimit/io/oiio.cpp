#include "bandlimit/io/oiio.h"

#include <algorithm>
#include <atomic>

#include "bandlimit/core/parallel.h"

namespace bandlimit {

void use_threads(int threads) {
    static std::atomic<int> in_use{0};
    const int count = Parallel{threads}.count();
    if (in_use.exchange(count) == count) return;
    OIIO::attribute("threads", count);
    OIIO::attribute("exr_threads", count == 1 ? -1 : count);  // -1: no pool, the caller decodes
    // We check sizes ourselves, against the memory of this machine and the length of the file.
    OIIO::attribute("limits:imagesize_MB", 0);
}

int tile_columns_at_once(const OIIO::ImageSpec& spec) {
    const std::uint64_t tile_bytes = std::max<std::uint64_t>(1, spec.tile_bytes());
    const auto most = static_cast<std::uint64_t>(std::numeric_limits<int>::max() / spec.tile_width);
    return spec.tile_width * static_cast<int>(std::clamp<std::uint64_t>(bytes_at_once / tile_bytes, 1, most));
}

std::string_view profile_in(const OIIO::ParamValueList& attributes) {
    const auto profile = attributes.find("ICCProfile");
    if (profile == attributes.end() || profile->type().basetype != OIIO::TypeDesc::UINT8) return {};
    return {static_cast<const char*>(profile->data()), static_cast<std::size_t>(profile->datasize())};
}

std::string one_line(std::string_view text) {
    std::string line;
    for (const char c : text) {
        if (static_cast<unsigned char>(c) >= ' ') line += c;
        else if (c == '\n' && !line.empty() && line.back() != ' ') line += ", ";
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == ',' || line.back() == '.')) line.pop_back();
    return line.empty() ? "unknown reason" : line;
}

}  // namespace bandlimit
