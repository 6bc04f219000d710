#include <memory>

#include "bandlimit/core/targets.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/resample/resize.h"
#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

/// What a name of --targets means.
Target target_of(const std::string& name) { return name == "all" ? supported_targets().back() : parse_target(name); }

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

Task prepare(const Case& c, const Buffers& buffers, int threads, Target target) {
    const auto resizers = std::make_shared<std::vector<Resizer>>(resizers_for(c));
    const Encoding encoding = c.linear ? Encoding{Transfer::srgb, 3, false} : Encoding{};
    return timed([=, &buffers](int k) {
        const TargetScope while_it_runs(target);
        // A View<const T> is made of a View<T>; nothing is written to the source.
        AnyView from =
            any_view(c, const_cast<std::byte*>(buffers.sources[static_cast<std::size_t>(k)].data()), c.width, c.height);
        const std::vector<Level> levels = levels_of(c);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            std::byte* out = buffers.targets[static_cast<std::size_t>(k)].data() + levels[i].offset;
            const AnyView to = any_view(c, out, levels[i].width, levels[i].height);
            (*resizers)[i].run({const_view(from), 0, encoding}, {to, 0, encoding, {}}, {threads});
            from = to;
        }
    });
}

}  // namespace

Peer bandlimit_peer(const std::string& name) {
    const Target target = target_of(name);
    return {.name = name == "all" ? "**bandlimit**" : "bandlimit, " + name,
            .note = name == "all" ? "Resizer, made beforehand; the caller's target" : "",
            .prepare = [=](const Case& c, const Buffers& buffers, int threads) {
                return std::optional(prepare(c, buffers, threads, target));
            }};
}

}  // namespace bandlimit::bench
