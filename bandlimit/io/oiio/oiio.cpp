#include "bandlimit/io/oiio/oiio.h"

#include <algorithm>
#include <mutex>
#include <thread>

namespace bandlimit::oiio {
namespace {

struct Pools {
    std::mutex mutex;
    int open_files = 0;
    int threads = 0;  ///< 0 before the first file
};

Pools& pools() {
    static Pools pools;
    return pools;
}

void resize_pools(int threads) {
    OIIO::attribute("threads", threads);
    OIIO::attribute("exr_threads", threads == 1 ? -1 : threads);  // -1: no pool, the caller decodes
    // We check sizes ourselves, against the memory of this machine and the length of the file.
    OIIO::attribute("limits:imagesize_MB", 0);
}

}  // namespace

PoolShare::PoolShare(int threads) {
    const int wanted = threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const std::lock_guard lock(pools().mutex);
    if (pools().open_files == 0 && pools().threads != wanted) {
        resize_pools(wanted);
        pools().threads = wanted;
    }
    ++pools().open_files;
}

PoolShare::~PoolShare() {
    const std::lock_guard lock(pools().mutex);
    --pools().open_files;
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
    return line.empty() ? "the codec gives no reason" : line;
}

}  // namespace bandlimit::oiio

extern "C" const bandlimit::Codecs* bandlimit_oiio_codecs() {
    static constexpr bandlimit::Codecs codecs{bandlimit::oiio::decode, bandlimit::oiio::encode};
    return &codecs;
}
