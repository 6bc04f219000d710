#include "bandlimit/io/codecs.h"

#include <dlfcn.h>
#include <sys/mman.h>

#include <array>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "bandlimit/core/error.h"

// Whoever links bandlimit::io links the codecs with it. The program does not: to relocate OpenImageIO and the 260
// libraries behind it takes a third of a second, which what reads no picture shall not pay.
extern "C" [[gnu::weak]] const bandlimit::Codecs* bandlimit_oiio_codecs();

namespace bandlimit {
namespace {

namespace fs = std::filesystem;

/// Throws std::bad_alloc unless there is room for `bytes` more of memory with this protection.
void require_room(std::size_t bytes, int protection) {
    void* const place = ::mmap(nullptr, bytes, protection, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) throw std::bad_alloc();
    ::munmap(place, bytes);
}

/// The module, which stays loaded.
void* load_module() {
    // Some of its libraries crash where they lack memory while they are initialised: they take 340 MB of addresses
    // and 40 of data.
    require_room(std::size_t{512} << 20, PROT_NONE);
    require_room(std::size_t{96} << 20, PROT_READ | PROT_WRITE);
    constexpr const char* name = "bandlimit_oiio.so";
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
    const std::array folders{program, (program / BANDLIMIT_MODULES).lexically_normal()};  // built, installed
    for (const fs::path& folder : folders) {
        const fs::path path = folder / name;
        if (!fs::exists(path, error)) continue;
        if (void* const module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL)) return module;
        throw std::runtime_error(message("image files need ", path.string(), ", which cannot be loaded (", ::dlerror(),
                                         "); free memory, or install OpenImageIO and bandlimit again"));
    }
    throw std::runtime_error(message("image files need ", name, ", which is in neither ", folders[0].string(), " nor ",
                                     folders[1].string(), "; install bandlimit again"));
}

const Codecs* load_codecs() {
    using Table = const Codecs* (*)();
    const auto table = reinterpret_cast<Table>(::dlsym(load_module(), "bandlimit_oiio_codecs"));
    if (table == nullptr) throw std::runtime_error("bandlimit_oiio.so is of another version; install bandlimit again");
    return table();
}

}  // namespace

const Codecs& oiio_codecs() {
    static const Codecs& codecs = *(bandlimit_oiio_codecs != nullptr ? bandlimit_oiio_codecs() : load_codecs());
    return codecs;
}

}  // namespace bandlimit
