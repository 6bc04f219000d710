// Memory for samples: aligned for vectors, in huge pages where it is large.
// Stability: stable.
#pragma once
#include <cstddef>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace bandlimit {

/// An allocator for std::vector whose memory begins at a cache line, or from 4 MiB on at a huge page, which the system
/// is then advised to use: touching small pages for the first time costs as much as resizing their content.
template <class T>
struct SampleAllocator {
    using value_type = T;
    SampleAllocator() = default;
    template <class U>
    SampleAllocator(const SampleAllocator<U>&) {}

    T* allocate(std::size_t count) {
        if (count > static_cast<std::size_t>(-1) / (2 * sizeof(T))) throw std::bad_alloc();
        const std::size_t bytes = count * sizeof(T);
        void* const memory = ::operator new(bytes, alignment(bytes));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
        // Only advice: if it is refused, pages stay small.
        if (bytes >= huge) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) noexcept { ::operator delete(memory, alignment(count * sizeof(T))); }

    template <class U>
    bool operator==(const SampleAllocator<U>&) const {
        return true;
    }

private:
    static constexpr std::size_t cache_line = 64, huge_page = std::size_t{1} << 21, huge = 2 * huge_page;
    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t{bytes >= huge ? huge_page : cache_line};
    }
};

}  // namespace bandlimit
