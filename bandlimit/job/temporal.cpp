#include "bandlimit/job/temporal.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>

#include "bandlimit/analysis/metrics.h"
#include "bandlimit/antialias/supersample.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/channels.h"
#include "bandlimit/job/command.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/job/stopwatch.h"
#include "bandlimit/sampling/pattern.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;

/// Frames from wherever they come.
struct Source {
    int count = 0, width = 0, height = 0, jitter_length = 0;
    std::string conventions;
    std::function<SequenceFrame(int)> read;
    std::function<std::string(int)> name;
    std::function<int(int)> number;
};

int scaled(int length, double scale) { return std::max(1, static_cast<int>(std::lround(length * scale))); }

Source source_of_scene(const TemporalJob& job, const Context& context) {
    const int length = jitter_length(job.scale);
    const std::vector<Point> jitter = jitter_sequence(job.jitter, length);
    const int width = scaled(job.width, job.scale), height = scaled(job.height, job.scale);
    // That of the output's size: the truth is then what `supersample` draws.
    const Scene scene = with_larger_pixels(make_scene(job.input, width, height), double(width) / job.width,
                                           double(height) / job.height);
    Source source;
    source.count = job.frames > 0 ? job.frames : std::max(16, length);
    source.width = job.width, source.height = job.height, source.jitter_length = length;
    source.conventions = "scene";
    source.read = [=, &context](int i) {
        SequenceFrame frame;
        frame.jitter = jitter[static_cast<std::size_t>(i % length)];
        const Image<float> all =
            render_scene(scene, job.width, job.height, i, {.jitter = frame.jitter}, context.parallel);
        frame.color = channels_copied(all.view(), scene_channel::color, 4);
        frame.depth = channels_copied(all.view(), scene_channel::depth, 1);
        frame.motion = channels_copied(all.view(), scene_channel::motion, 2);
        return frame;
    };
    source.number = [](int i) { return i; };
    source.name = [](int i) { return fmt::format("frame_{:03}.exr", i); };
    return source;
}

Source source_of_folder(const TemporalJob& job, const Context& context) {
    SequenceJob reading = job.sequence;
    reading.folder = job.input;
    const auto sequence = std::make_shared<const FrameSequence>(open_sequence(reading));
    if (!sequence->has_motion())
        context.say(job.input + " has no motion vectors: it is taken to stand still; name their channel by --motion");
    Source source;
    source.count = job.frames > 0 ? std::min(job.frames, sequence->count()) : sequence->count();
    source.width = sequence->width(), source.height = sequence->height();
    source.jitter_length = sequence->jitter_length();
    source.conventions = sequence->conventions();
    source.read = [=, &context](int i) { return sequence->read(i, context.parallel.threads); };
    source.number = [=](int i) { return sequence->number(i); };
    source.name = [=](int i) { return sequence->name(i); };
    return source;
}

/// What the output should be, in linear light; none where nobody knows.
using Truth = std::function<Image<float>(int i)>;

Truth truth_of_folder(const TemporalJob& job, const Source& source, int width, int height, const Context& context) {
    std::vector<std::pair<int, std::string>> files;
    if (!fs::is_directory(job.reference))
        throw std::runtime_error(job.reference + ": is not a folder; name one with an EXR file per frame");
    for (const fs::directory_entry& entry : fs::directory_iterator(job.reference))
        if (entry.path().extension() == ".exr")
            files.emplace_back(number_in(entry.path().filename().string()), entry.path().string());
    return [=, number = source.number, name = source.name, &context](int i) -> Image<float> {
        const auto found = std::ranges::find(files, number(i), &std::pair<int, std::string>::first);
        if (found == files.end())
            throw std::runtime_error(fmt::format("{}: holds no reference for {}, whose number is {}; add it",
                                                 job.reference, name(i), number(i)));
        Image<float> picture = read_picture(found->second, Space::automatic, context.parallel);
        if (picture.width() != width || picture.height() != height || picture.channels() < 3)
            throw std::runtime_error(
                fmt::format("{}: is {} x {} with {} channels, and the output is {} x {}; name references of that size",
                            found->second, picture.width(), picture.height(), picture.channels(), width, height));
        return picture;
    };
}

Truth truth_of_scene(const TemporalJob& job, int width, int height, const Context& context) {
    const Scene scene = make_scene(job.input, width, height);
    return [=, &context](int i) {
        return bandlimit::supersample(scene, width, height, i, {.pattern = regular_pattern(64), .kernel = box()},
                                      context.parallel);
    };
}

/// RGB, clamped to [0, 1].
Image<float> clamped(View<const float> picture) {
    Image<float> result(picture.width, picture.height, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) result.view()(x, y, c) = std::clamp(picture(x, y, c), 0.0f, 1.0f);
    return result;
}

/// Colour is multiplied by alpha, as frames have it.
void write_frame(const std::string& path, View<const float> picture, int threads) {
    ImageTarget target;
    target.width = picture.width, target.height = picture.height;
    target.channel_names = {"R", "G", "B", "A"};
    target.alpha = 3;
    target.depth = Depth::f32;
    target.transfer = Transfer::linear;
    PictureWriter writer(path, target, true, threads);
    writer.write(picture, true);
    writer.finish();
}

}  // namespace

void check(const TemporalJob& job) {
    if (!(job.scale >= 1 && job.scale <= 4))
        throw OptionError("scale", fmt::format("{:g} is out of range; pass 1 to 4", job.scale));
    if (job.frames < 0) throw OptionError("frames", fmt::format("{} is below 0; pass how many to make", job.frames));
    check(job.sequence);
    if (!is_scene(job.input)) return;
    if (job.width < 1 || job.height < 1)
        throw OptionError(
            "size",
            fmt::format("the scene {} has no size of its own; pass that of the input, e.g. 480x270", job.input));
    make_scene(job.input, job.width, job.height);
}

TemporalReport temporal(const TemporalJob& job, const Context& context) {
    check(job);
    Stopwatch watch;
    const bool is_of_scene = is_scene(job.input);
    const Source source = is_of_scene ? source_of_scene(job, context) : source_of_folder(job, context);
    TemporalReport report;
    report.in_width = source.width, report.in_height = source.height;
    report.width = scaled(source.width, job.scale), report.height = scaled(source.height, job.scale);
    report.conventions = source.conventions, report.jitter_length = source.jitter_length;
    report.mip_bias = std::log2(1 / job.scale);
    const auto pixels = static_cast<std::uint64_t>(report.width) * static_cast<std::uint64_t>(report.height);
    require_memory(pixels * (8 + 4 + 4 + 6) * sizeof(float),
                   fmt::format("a history of {} x {} pixels", report.width, report.height));
    Truth truth;
    if (!job.reference.empty()) truth = truth_of_folder(job, source, report.width, report.height, context);
    else if (is_of_scene && job.measures) truth = truth_of_scene(job, report.width, report.height, context);
    const std::string folder = made_folder(job.out);
    TemporalHistory history(report.width, report.height);
    Image<float> out(report.width, report.height, 4, Layout::interleaved);
    for (int i = 0; i < source.count; ++i) {
        context.parallel.check_stop();
        const SequenceFrame input = source.read(i);
        const Image<float> wanted = truth ? truth(i) : Image<float>();
        TemporalFrameReport frame{source.number(i), source.name(i), {}, {}, 0};
        double seconds = 0;
        watch.time(seconds, [&] {
            accumulate(history,
                       {.color = input.color.view(),
                        .depth = input.depth.view(),
                        .motion = input.motion.view(),
                        .jitter = input.jitter},
                       job.options, out.view(), context.parallel);
        });
        frame.ms = seconds * 1000;
        write_frame(folder + "/" + frame.file, out.view(), context.parallel.threads);
        if (truth) {
            const Metrics metrics =
                compare(clamped(out.view()).view(), clamped(wanted.view()).view(), 0, context.parallel);
            frame.psnr = metrics.psnr(), frame.ssim = metrics.ssim;
        }
        report.frames.push_back(frame);
        context.report({"temporal", double(i + 1), double(source.count), "frames"});
    }
    report.seconds = watch.total();
    return report;
}

}  // namespace bandlimit::job
