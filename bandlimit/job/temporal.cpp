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
#include "bandlimit/antialias/temporal_options.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/batch_manifest.h"
#include "bandlimit/job/channels.h"
#include "bandlimit/job/command.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/job/stopwatch.h"
#include "bandlimit/job/temporal_checkpoint.h"
#include "bandlimit/job/temporal_pictures.h"
#include "bandlimit/sampling/pattern.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;

/// Frames from wherever they come.
struct Source {
    int count = 0, width = 0, height = 0, jitter_length = 0;
    std::string conventions;
    std::string reading;  ///< all that these say, and the options that override them
    std::function<SequenceFrame(int)> read;
    std::function<std::string(int)> name;
    std::function<std::vector<std::string>(int)> files;  ///< that a frame is read from
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
    source.files = [](int) { return std::vector<std::string>(); };
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
    for (const auto& [option, value] : settings_of(sequence->convention()))
        source.reading += fmt::format(" {} {}", option, value);
    source.files = [=](int i) { return sequence->paths(i); };
    source.number = [=](int i) { return sequence->number(i); };
    source.name = [=](int i) { return sequence->name(i); };
    return source;
}

/// What the output should be, in linear light; none where nobody knows.
struct Truth {
    std::function<Image<float>(int i)> make;
    std::function<std::string(int i)> file;  ///< that it is read from; empty: none

    explicit operator bool() const { return static_cast<bool>(make); }
};

Truth truth_of_folder(const TemporalJob& job, const Source& source, int width, int height, const Context& context) {
    std::vector<std::pair<int, std::string>> files;
    if (!fs::is_directory(job.reference))
        throw std::runtime_error(job.reference + ": is not a folder; name one with an EXR file per frame");
    for (const fs::directory_entry& entry : fs::directory_iterator(job.reference))
        if (entry.path().extension() == ".exr")
            files.emplace_back(number_in(entry.path().filename().string()), entry.path().string());
    const auto file = [=, number = source.number](int i) {
        const auto found = std::ranges::find(files, number(i), &std::pair<int, std::string>::first);
        return found == files.end() ? std::string() : found->second;
    };
    const auto make = [=, number = source.number, name = source.name, &context](int i) {
        const std::string path = file(i);
        if (path.empty())
            throw std::runtime_error(fmt::format("{}: holds no reference for {}, whose number is {}; add it",
                                                 job.reference, name(i), number(i)));
        Image<float> picture = read_picture(path, Space::automatic, context.parallel);
        if (picture.width() != width || picture.height() != height || picture.channels() < 3)
            throw std::runtime_error(
                fmt::format("{}: is {} x {} with {} channels, and the output is {} x {}; name references of that size",
                            path, picture.width(), picture.height(), picture.channels(), width, height));
        return picture;
    };
    return {make, file};
}

Truth truth_of_scene(const TemporalJob& job, int width, int height, const Context& context) {
    const Scene scene = make_scene(job.input, width, height);
    const auto make = [=, &context](int i) {
        return bandlimit::supersample(scene, width, height, i, {.pattern = regular_pattern(64), .kernel = box()},
                                      context.parallel);
    };
    return {make, [](int) { return std::string(); }};
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

/// A frame that was written, with colour multiplied by alpha, as it is in memory before.
Image<float> read_frame(const std::string& path, const Parallel& parallel) {
    Image<float> picture = read_picture(path, Space::linear, parallel);
    const View<float> view = picture.view();
    for (int y = 0; y < view.height && view.channels == 4; ++y)
        for (int x = 0; x < view.width; ++x)
            for (int c = 0; c < 3; ++c) view(x, y, c) *= view(x, y, 3);
    return picture;
}

/// All that decides what frames look like, besides the files of each.
std::string settings_of(const TemporalJob& job, const TemporalReport& report, const Source& source) {
    const SequenceJob& s = job.sequence;
    std::string text = fmt::format(
        "{} {} {} {} {} {} {} {} {} {} {}\n{} {} {} {} {} {}", BANDLIMIT_VERSION, job.input, job.scale, source.count,
        report.in_width, report.in_height, int(job.jitter), report.jitter_length, report.conventions, job.measures,
        job.reference, s.color, s.depth, s.motion, source.reading, s.meta, s.meta.empty() ? "" : hash_of_file(s.meta));
    for (const TemporalOptionInfo& info : temporal_option_infos())
        text += fmt::format("\n{} {}", info.name, option_value(job.options, info.name));
    return text;
}

/// How many of the last frames are measured: a period of the jitter, but no more than half of all.
int settled_frames(int frames, int period) { return std::min(frames / 2, period > 0 ? period : frames); }

/// Frames being made.
class Run {
public:
    Run(const TemporalJob& job, const Context& context);
    TemporalReport finish();

private:
    std::string path_of(int i) const { return folder_ + "/" + source_.name(i); }
    void go_on();
    void make(int i);
    TemporalDebug debug(int i);
    void compare_to_truth(View<const float> wanted, TemporalFrameReport& frame);
    void show(int i, View<const float> input, View<const float> output, View<const float> wanted);

    const TemporalJob& job_;
    const Context& context_;
    Stopwatch watch_;
    Source source_;
    Truth truth_;
    TemporalReport report_;
    std::string folder_;
    int settled_from_ = 0;
    std::optional<TemporalHistory> history_;
    std::optional<TemporalMeter> meter_;
    std::optional<TemporalPictures> pictures_;
    std::optional<TemporalCheckpoint> checkpoint_;
    std::vector<MadeFrame> made_;
    Image<float> out_;
};

Run::Run(const TemporalJob& job, const Context& context) : job_(job), context_(context) {
    const bool is_of_scene = is_scene(job.input);
    source_ = is_of_scene ? source_of_scene(job, context) : source_of_folder(job, context);
    const int width = scaled(source_.width, job.scale), height = scaled(source_.height, job.scale);
    report_.in_width = source_.width, report_.in_height = source_.height;
    report_.width = width, report_.height = height;
    report_.conventions = source_.conventions, report_.jitter_length = source_.jitter_length;
    report_.mip_bias = std::log2(1 / job.scale);
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    require_memory(pixels * (job.measures ? 8 + 4 + 4 + 6 + 17 : 8 + 4 + 4 + 6) * sizeof(float),
                   fmt::format("a history of {} x {} pixels", width, height));
    if (!job.reference.empty()) truth_ = truth_of_folder(job, source_, width, height, context);
    else if (is_of_scene && job.measures) truth_ = truth_of_scene(job, width, height, context);
    folder_ = made_folder(job.out);
    history_.emplace(width, height);
    out_ = Image<float>(width, height, 4, Layout::interleaved);
    checkpoint_.emplace(folder_, settings_of(job, report_, source_));
    if (!job.measures) return;
    report_.measured_frames = settled_frames(source_.count, source_.jitter_length);
    settled_from_ = source_.count - report_.measured_frames;
    meter_.emplace(width, height);
    pictures_.emplace(width, height, source_.count);
    TemporalViews& v = report_.views;
    for (Image<float>* view : {&v.frame_weight, &v.memory, &v.rejection, &v.disocclusion})
        *view = Image<float>(width, height);
    v.motion = Image<float>(width, height, 2, Layout::interleaved);
}

/// Takes up a run that ended before its time. The last frame is made in any case: it leaves the views.
void Run::go_on() {
    std::vector<MadeFrame> old = checkpoint_->restore(*history_, meter_);
    bool fits = !old.empty() && static_cast<int>(old.size()) < source_.count;
    for (std::size_t i = 0; i < old.size() && fits; ++i)
        fits = old[i].report.file == source_.name(static_cast<int>(i)) &&
               old[i].output.path == path_of(static_cast<int>(i));
    if (!fits) {
        history_->reset();
        if (meter_) meter_.emplace(report_.width, report_.height);
        return;
    }
    made_ = std::move(old);
    report_.continued_at = static_cast<int>(made_.size());
    for (int i = 0; i < report_.continued_at && pictures_; ++i) {
        if (!pictures_->wants(i)) continue;
        context_.parallel.check_stop();
        const Image<float> wanted = truth_ ? truth_.make(i) : Image<float>();
        show(i, source_.read(i).color.view(), read_frame(path_of(i), context_.parallel).view(), wanted.view());
    }
}

/// Where the step notes what it finds out: measures need some of it, the last frame shows it all.
TemporalDebug Run::debug(int i) {
    TemporalViews& v = report_.views;
    if (!job_.measures || (i < settled_from_ && i < source_.count - 1)) return {};
    if (i < source_.count - 1) return {.motion = v.motion.view(), .disocclusion = v.disocclusion.view()};
    return {v.frame_weight.view(), v.memory.view(), v.rejection.view(), v.motion.view(), v.disocclusion.view()};
}

void Run::make(int i) {
    MadeFrame made{{source_.number(i), source_.name(i), {}, {}, 0}};
    for (const std::string& file : source_.files(i)) made.inputs.push_back(stamp_of(file));
    if (truth_ && !truth_.file(i).empty()) made.inputs.push_back(stamp_of(truth_.file(i)));
    const SequenceFrame input = source_.read(i);
    const Image<float> wanted = truth_ ? truth_.make(i) : Image<float>();
    double seconds = 0;
    watch_.time(seconds, [&] {
        accumulate(*history_,
                   {.color = input.color.view(),
                    .depth = input.depth.view(),
                    .motion = input.motion.view(),
                    .jitter = input.jitter},
                   job_.options, out_.view(), context_.parallel, debug(i));
    });
    made.report.ms = seconds * 1000;
    write_frame(path_of(i), out_.view(), context_.parallel.threads);
    made.output = stamp_of(path_of(i));
    if (truth_) compare_to_truth(wanted.view(), made.report);
    if (meter_ && i >= settled_from_)
        meter_->add({.shown = out_.view(),
                     .truth = wanted.view(),
                     .motion = report_.views.motion.view(),
                     .disocclusion = report_.views.disocclusion.view()},
                    context_.parallel);
    if (pictures_) show(i, input.color.view(), out_.view(), wanted.view());
    made_.push_back(std::move(made));
    if (i < source_.count - 1) return checkpoint_->save(made_, *history_, meter_);
    if (!job_.measures) return;
    report_.high_frequencies = energy_above_half_nyquist(out_.view());
    if (truth_) report_.high_frequencies_of_truth = energy_above_half_nyquist(wanted.view());
}

void Run::compare_to_truth(View<const float> wanted, TemporalFrameReport& frame) {
    const Metrics metrics = compare(clamped(out_.view()).view(), clamped(wanted).view(), 0, context_.parallel);
    frame.psnr = metrics.psnr(), frame.ssim = metrics.ssim;
}

void Run::show(int i, View<const float> input, View<const float> output, View<const float> wanted) {
    pictures_->add(i, {input, output, wanted}, context_.parallel);
}

TemporalReport Run::finish() {
    go_on();
    for (int i = report_.continued_at; i < source_.count; ++i) {
        context_.parallel.check_stop();
        make(i);
        context_.report({"temporal", double(i + 1), double(source_.count), "frames"});
    }
    for (const MadeFrame& made : made_) report_.frames.push_back(made.report);
    if (pictures_) {
        report_.measured = meter_->measures();
        report_.sheet = pictures_->sheet();
        report_.sheet_frames = pictures_->columns();
        report_.animation = std::move(*pictures_).animation();
    }
    checkpoint_->remove();
    report_.seconds = watch_.total();
    return std::move(report_);
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
    return Run(job, context).finish();
}

}  // namespace bandlimit::job
