// How much memory this machine has left.
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <limits>
#include <string>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit {
namespace {

std::string gigabytes(std::uint64_t bytes) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(bytes < 10'000'000'000 ? 2 : 0) << static_cast<double>(bytes) / 1e9
         << " GB";
    return text.str();
}

}  // namespace

/// What the kernel would hand out without swapping, caches it can drop included; the free pages where it does not say.
std::uint64_t available_memory() {
    std::ifstream info("/proc/meminfo");
    for (std::string key; info >> key;) {
        std::uint64_t kibibytes = 0;
        if (key == "MemAvailable:" && info >> kibibytes) return kibibytes * 1024;
        info.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
#ifdef _SC_AVPHYS_PAGES
    const long pages = ::sysconf(_SC_AVPHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    if (pages > 0 && page > 0) return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
#endif
    return std::numeric_limits<std::uint64_t>::max();
}

void require_memory(std::uint64_t bytes, const std::string& what) {
    constexpr std::uint64_t always_there = 1 << 20;  // not worth a look at the system
    if (bytes <= always_there) return;
    const std::uint64_t available = available_memory();
    if (bytes > available)
        fail_file(what, "needs ", gigabytes(bytes), " of memory, and ", gigabytes(available),
                  " are available; use a smaller picture or a larger machine");
}

}  // namespace bandlimit
