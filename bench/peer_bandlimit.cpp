#include <hwy/targets.h>

#include <memory>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/resample/resize.h"
#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

/// The instruction sets that a name of --targets leaves, as Highway's mask; 0 means all.
std::int64_t mask_of(const std::string& targets) {
    constexpr std::int64_t avx512 = HWY_AVX3 | HWY_AVX3_DL;
    if (targets == "all") return 0;
    if (targets == "avx2") return hwy::SupportedTargets() & ~avx512;
    if (targets == "sse4") return hwy::SupportedTargets() & ~avx512 & ~std::int64_t{HWY_AVX2};
    fail("targets \"", targets, "\" are unknown; pass all, avx2 or sse4");
}

/// While it lives, Highway has no other instruction sets.
class Limited {
public:
    explicit Limited(std::int64_t mask) { hwy::SetSupportedTargetsForTest(mask); }
    ~Limited() { hwy::SetSupportedTargetsForTest(0); }
    Limited(const Limited&) = delete;
    Limited& operator=(const Limited&) = delete;
};

/// A view of interleaved samples that are somebody's bytes.
template <class T>
View<T> view_at(std::byte* bytes, int width, int height, int channels) {
    return {reinterpret_cast<T*>(bytes), width, height, channels, channels, std::ptrdiff_t{width} * channels, 1};
}
AnyView any_view(const Case& c, std::byte* bytes, int width, int height) {
    if (c.channels == 1) return view_at<float>(bytes, width, height, 1);
    return view_at<std::uint8_t>(bytes, width, height, c.channels);
}

/// One Resizer per level.
std::vector<Resizer> resizers_for(const Case& c) {
    std::vector<Resizer> resizers;
    int width = c.width, height = c.height;
    for (const Level& level : levels_of(c)) {
        resizers.emplace_back(Grid{{width}, {height}}, Grid{{level.width}, {level.height}}, c.channels,
                              ResizeOptions{.reconstruction = c.filter == Filter::box ? box() : lanczos(3)});
        width = level.width, height = level.height;
    }
    return resizers;
}

Task prepare(const Case& c, const Buffers& buffers, int threads, std::int64_t mask) {
    const Limited limited(mask);
    const auto resizers = std::make_shared<std::vector<Resizer>>(resizers_for(c));
    const Encoding encoding = c.linear ? Encoding{Transfer::srgb, 3, false} : Encoding{};
    return timed([=, &buffers](int k) {
        const Limited while_it_runs(mask);
        // A View<const T> is made of a View<T>; nothing is written to the source.
        AnyView from =
            any_view(c, const_cast<std::byte*>(buffers.sources[static_cast<std::size_t>(k)].data()), c.width, c.height);
        const std::vector<Level> levels = levels_of(c);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            std::byte* target = buffers.targets[static_cast<std::size_t>(k)].data() + levels[i].offset;
            const AnyView to = any_view(c, target, levels[i].width, levels[i].height);
            (*resizers)[i].run({const_view(from), 0, encoding}, {to, 0, encoding, {}}, {threads});
            from = to;
        }
    });
}

}  // namespace

Peer bandlimit_peer(const std::string& targets) {
    const std::int64_t mask = mask_of(targets);
    return {.name = targets == "all" ? "**bandlimit**" : "bandlimit, " + targets + " and less",
            .note = targets == "all" ? "Resizer, made beforehand; the caller's target" : "",
            .prepare = [=](const Case& c, const Buffers& buffers, int threads) {
                return std::optional(prepare(c, buffers, threads, mask));
            }};
}

}  // namespace bandlimit::bench
