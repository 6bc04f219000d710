#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

cv::Mat picture(const Case& c, std::byte* bytes, int width, int height) {
    return cv::Mat(height, width, c.channels == 1 ? CV_32FC1 : CV_8UC4, bytes);
}

Task resize(const Case& c, const Buffers& buffers, int threads, cv::InterpolationFlags method) {
    return timed([=, &buffers](int k) {
        const auto i = static_cast<std::size_t>(k);
        cv::setNumThreads(threads);
        cv::Mat from = picture(c, const_cast<std::byte*>(buffers.sources[i].data()), c.width, c.height);
        for (const Level& level : levels_of(c)) {
            cv::Mat to = picture(c, buffers.targets[i].data() + level.offset, level.width, level.height);
            cv::resize(from, to, to.size(), 0, 0, method);
            from = to;
        }
    });
}

Peer peer(const std::string& name, const std::string& note, cv::InterpolationFlags method) {
    const auto prepare = [=](const Case& c, const Buffers& buffers, int threads) -> std::optional<Task> {
        const bool area = method == cv::INTER_AREA, box = c.filter == Filter::box, grows = c.new_width > c.width;
        if (c.linear || (box && !area) || (!box && c.chain) || (area && grows)) return {};
        Task task = resize(c, buffers, threads, method);
        task.other = !box;
        return task;
    };
    return {.name = "OpenCV " CV_VERSION " " + name, .note = note, .prepare = prepare};
}

}  // namespace

std::vector<Peer> opencv_peers() {
    return {
        peer("INTER_AREA", "a box in every column: OpenCV has no antialiased Lanczos", cv::INTER_AREA),
        peer("INTER_CUBIC", "4 x 4 samples at every scale: reducing, it is not antialiased", cv::INTER_CUBIC),
        peer("INTER_LANCZOS4",
             "8 x 8 samples at every scale: reducing, it is not antialiased; enlarging, it is Lanczos-4",
             cv::INTER_LANCZOS4),
    };
}

}  // namespace bandlimit::bench
