#include "bandlimit/job/frame_sequence.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "bandlimit/io/image_file.h"
#include "bandlimit/io/located_json.h"
#include "bandlimit/job/channels.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;

/// The channel called `name`, or whose name ends in ".name" (layers of EXR); -1 if there is none.
int channel_called(const std::vector<std::string>& names, std::string_view name) {
    const std::string layered = "." + std::string(name);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<int>(i);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].ends_with(layered)) return static_cast<int>(i);
    return -1;
}

int first_of(const std::vector<std::string>& names, std::initializer_list<std::string_view> candidates) {
    for (const std::string_view name : candidates)
        if (const int channel = channel_called(names, name); channel >= 0) return channel;
    return -1;
}

/// By the names of the channels: Blender has a Z and a W of Vector, our own scenes an Albedo.
std::string guessed_conventions(const std::vector<std::string>& names) {
    if (channel_called(names, "Velocity.X") >= 0) return "unreal";
    if (channel_called(names, "MotionVectors.X") >= 0) return "unity";
    if (channel_called(names, "Vector.Z") >= 0 || channel_called(names, "Combined.R") >= 0) return "blender";
    return "bandlimit";
}

int channel_asked(const std::vector<std::string>& names, const std::string& asked, std::string_view component,
                  const std::string& file, std::string_view option) {
    const std::string part = asked + "." + std::string(component);
    const int channel = first_of(names, {part, asked});
    if (channel < 0)
        throw std::runtime_error(
            fmt::format("{}: has no channel {} for --{}; it has {}", file, part, option, fmt::join(names, ", ")));
    return channel;
}

void check_adjacent(const std::vector<std::string>& names, int first, std::initializer_list<std::string_view> ends,
                    const std::string& file) {
    int channel = first;
    for (const std::string_view end : ends) {
        const auto i = static_cast<std::size_t>(channel++);
        if (i >= names.size() || !(names[i] == end || names[i].ends_with("." + std::string(end))))
            throw std::runtime_error(fmt::format("{}: the channels beside {} are not {}; it has {}", file,
                                                 names[static_cast<std::size_t>(first)], fmt::join(ends, ", "),
                                                 fmt::join(names, ", ")));
    }
}

/// The channel in what an option says of a buffer: "Z" of "depth_####.exr:Z", or all of "Z".
std::string channel_in(const std::string& text) {
    return is_file_pattern(text) ? parse_file_pattern("", text).channel : text;
}

/// The item of an object called `key`; null if there is none.
const JsonValue* item_called(const JsonValue& object, std::string_view key) {
    const auto found = std::ranges::find(object.keys, key);
    return found == object.keys.end() ? nullptr : &object.items[static_cast<std::size_t>(found - object.keys.begin())];
}

std::vector<Point> jitter_in(const LocatedJson& file, const JsonValue& value) {
    std::vector<Point> jitter;
    for (const JsonValue& pair : file.list(value, "jitter")) {
        const std::vector<double> xy = file.numbers(pair, "jitter", 2, 2, -1, 1);
        jitter.push_back({xy[0], xy[1]});
    }
    if (jitter.empty()) file.fail_at(value, "\"jitter\" is empty; list the [x, y] of each frame, or leave it out");
    return jitter;
}

void read_matrix(const LocatedJson& file, const JsonValue& camera, std::string_view key, double* to) {
    const JsonValue* const rows = item_called(camera, key);
    if (rows == nullptr) file.fail_at(camera, "this camera has no \"", key, "\"; add its 4 x 4 matrix");
    if (file.list(*rows, key).size() != 4) file.fail_at(*rows, "\"", key, "\" is not 4 x 4; list four rows of four");
    for (const JsonValue& row : rows->items)
        for (const double v : file.numbers(row, key, 4, 4, -1e30, 1e30)) *to++ = v;
}

}  // namespace

void check(const SequenceJob& job) {
    if (job.conventions != "auto") convention_called(job.conventions);
    for (const auto& [option, text] : {std::pair("color", &job.color), {"depth", &job.depth}, {"motion", &job.motion}})
        if (is_file_pattern(*text)) parse_file_pattern(option, *text);
}

bool is_sky(float depth) { return depth >= 1e9f; }

FrameSequence open_sequence(const SequenceJob& job) {
    check(job);
    FrameSequence sequence;
    sequence.find_files(job);
    sequence.find_channels(job);
    if (!job.meta.empty()) sequence.read_meta(job);
    return sequence;
}

void FrameSequence::find_files(const SequenceJob& job) {
    if (is_file_pattern(job.color)) {
        const FilePattern pattern = parse_file_pattern("color", job.color);
        files_ = files_of(pattern, job.folder);
        if (files_.empty())
            throw std::runtime_error(
                fmt::format("{}: holds no {}; name the files of the colour by --color", job.folder, pattern.name()));
    } else {
        files_ = exr_files_in(job.folder);
        for (const std::string* text : {&job.depth, &job.motion}) {
            if (!is_file_pattern(*text)) continue;
            const FilePattern pattern = parse_file_pattern("", *text);
            if (pattern.folder.empty())  // other folders hold none of these
                std::erase_if(files_, [&](const FrameFile& f) { return pattern.number_of(f.name) >= 0; });
        }
        if (files_.empty())
            throw std::runtime_error(job.folder + ": holds no EXR files; name a folder with one per frame");
    }
    std::ranges::sort(files_, [](const FrameFile& a, const FrameFile& b) {
        return a.number != b.number ? a.number < b.number : a.name < b.name;
    });
    for (std::size_t i = 1; i < files_.size(); ++i) {
        const FrameFile &before = files_[i - 1], &file = files_[i];
        if (before.number < 0) continue;
        if (file.number == before.number)
            throw std::runtime_error(fmt::format(
                "{}: {} and {} are both frame {}; name the files of the colour, as by --color color_####.exr",
                job.folder, before.name, file.name, file.number));
        if (file.number > before.number + 1)
            throw std::runtime_error(fmt::format("{}: frame {} is missing between {} and {}; render it, or cut there",
                                                 job.folder, before.number + 1, before.name, file.name));
    }
}

/// Finds the file of each frame; none where `text` names channels, not files.
FrameSequence::Buffer FrameSequence::files_of_buffer(const std::string& option, const std::string& text,
                                                     const std::string& folder) const {
    if (!is_file_pattern(text)) return {{}, color_.channel_names};
    const FilePattern pattern = parse_file_pattern(option, text);
    const std::vector<FrameFile> all = files_of(pattern, folder);
    Buffer buffer;
    for (const FrameFile& file : files_) {
        const auto found = std::ranges::find(all, file.number, &FrameFile::number);
        if (found == all.end())
            throw std::runtime_error(
                fmt::format("{}: there is no {} for {}, as --{} {} asks; render it, or cut there", folder,
                            file.number < 0 ? pattern.name() : pattern.name_of(file.number), file.name, option, text));
        buffer.paths.push_back(found->path);
    }
    buffer.channel_names = ImageReader(buffer.paths.front(), 1).info().channel_names;
    return buffer;
}

void FrameSequence::find_channels(const SequenceJob& job) {
    const std::string& first = files_.front().path;
    const ImageReader reader(first, 1);
    const std::vector<std::string>& names = color_.channel_names = reader.info().channel_names;
    width_ = reader.info().width, height_ = reader.info().height;
    depth_ = files_of_buffer("depth", job.depth, job.folder);
    motion_ = files_of_buffer("motion", job.motion, job.folder);
    std::vector<std::string> all = names;
    all.insert(all.end(), motion_.channel_names.begin(), motion_.channel_names.end());
    conventions_ = job.conventions == "auto" ? guessed_conventions(all) : job.conventions;
    const NamedConvention& convention = convention_called(conventions_);
    convention_ = convention.motion;
    if (job.motion_units) convention_.units = *job.motion_units;
    if (job.is_previous_minus_current) convention_.is_previous_minus_current = *job.is_previous_minus_current;
    if (job.is_y_up) convention_.is_y_up = *job.is_y_up;
    convention_.are_axes_swapped = job.are_axes_swapped, convention_.includes_jitter = job.includes_jitter;
    convention_.jitter_sign = job.jitter_sign, convention_.is_jitter_y_up = job.is_jitter_y_up;

    const std::string color = channel_in(job.color), depth = channel_in(job.depth);
    color_.first =
        color.empty() ? first_of(names, {"R", "Combined.R"}) : channel_asked(names, color, "R", first, "color");
    if (color_.first < 0)
        throw std::runtime_error(
            fmt::format("{}: has no channel R; name the colour by --color; it has {}", first, fmt::join(names, ", ")));
    check_adjacent(names, color_.first, {"R", "G", "B"}, first);
    const auto alpha = static_cast<std::size_t>(color_.first) + 3;
    if (alpha < names.size() && (names[alpha] == "A" || names[alpha].ends_with(".A"))) alpha_ = color_.first + 3;

    const std::string& depth_file = depth_.paths.empty() ? first : depth_.paths.front();
    depth_.first = depth.empty() ? first_of(depth_.channel_names, {"Depth.Z", "Depth.V", "Z", "depth"})
                                 : channel_asked(depth_.channel_names, depth, "Z", depth_file, "depth");
    if (depth_.first < 0 && !depth_.paths.empty()) {
        if (depth_.channel_names.size() > 1)
            throw std::runtime_error(
                fmt::format("{}: has no channel Z; name the depth's, as --depth {}:NAME; it has {}", depth_file,
                            job.depth, fmt::join(depth_.channel_names, ", ")));
        depth_.first = 0;
    }
    find_motion(job, convention.motion_channel);
}

/// In files of their own, vectors may have any of the names in use, or be a picture's red and green.
void FrameSequence::find_motion(const SequenceJob& job, std::string_view layer) {
    const std::vector<std::string>& names = motion_.channel_names;
    const bool is_own = !motion_.paths.empty();
    const std::string& file = is_own ? motion_.paths.front() : files_.front().path;
    const std::string asked = channel_in(job.motion), usual = std::string(layer) + ".X";
    motion_.first = asked.empty() ? channel_called(names, usual) : channel_asked(names, asked, "X", file, "motion");
    if (motion_.first < 0 && is_own) motion_.first = first_of(names, {"X", "R"});
    if (motion_.first < 0 && is_own)
        throw std::runtime_error(
            fmt::format("{}: has no channel {}, X or R; name the motion's, as --motion {}:NAME; it "
                        "has {}",
                        file, usual, job.motion, fmt::join(names, ", ")));
    if (motion_.first < 0) return;
    const std::string& x = names[static_cast<std::size_t>(motion_.first)];
    if (is_own && (x == "R" || x.ends_with(".R"))) check_adjacent(names, motion_.first, {"R", "G"}, file);
    else check_adjacent(names, motion_.first, {"X", "Y"}, file);
}

void FrameSequence::read_meta(const SequenceJob& job) {
    const LocatedJson file = LocatedJson::read(job.meta, "the JSON file that describes the sequence");
    const JsonValue& root = file.root();
    if (!root.is(JsonValue::Kind::object)) file.fail_at(root, "is not an object; write {\"sequences\": {...}}");
    const std::string folder = fs::path(fs::weakly_canonical(fs::absolute(job.folder))).filename().string();
    const JsonValue* const sequences = item_called(root, "sequences");
    const JsonValue* const entry = sequences != nullptr ? item_called(*sequences, folder) : nullptr;
    if (entry == nullptr)
        file.fail_at(sequences != nullptr ? *sequences : root, "\"sequences\" has no entry \"", folder,
                     "\"; add it, or leave the file out");
    if (const JsonValue* const jitter = item_called(*entry, "jitter")) jitter_ = jitter_in(file, *jitter);
    const JsonValue* const cameras = item_called(root, "camera");
    if (cameras == nullptr) return;
    if (file.list(*cameras, "camera").size() < files_.size())
        file.fail_at(*cameras, "\"camera\" describes ", cameras->items.size(), " frames of ", files_.size(),
                     "; describe them all, or leave it out");
    for (const JsonValue& value : cameras->items) {
        Camera camera;
        read_matrix(file, value, "world_to_cam", camera.world_to_camera);
        read_matrix(file, value, "proj", camera.projection);
        cameras_.push_back(camera);
    }
}

Point FrameSequence::stored_jitter(int i) const {
    return jitter_.empty() ? Point{} : jitter_[static_cast<std::size_t>(i) % jitter_.size()];
}

/// All channels of the file that a buffer of frame `i` is in.
Image<float> FrameSequence::read_all(const Buffer& buffer, int i, int threads) const {
    const std::string& path =
        buffer.paths.empty() ? files_[static_cast<std::size_t>(i)].path : buffer.paths[static_cast<std::size_t>(i)];
    ImageReader reader(path, threads);
    const ImageInfo& info = reader.info();
    if (info.width != width_ || info.height != height_)
        throw std::runtime_error(fmt::format("{}: is {} x {}, and {} is {} x {}; render all frames in one size", path,
                                             info.width, info.height, files_.front().name, width_, height_));
    if (info.channel_names != buffer.channel_names)
        throw std::runtime_error(
            fmt::format("{}: has the channels {}, and {} has {}; render all frames alike", path,
                        fmt::join(info.channel_names, ", "),
                        fs::path(buffer.paths.empty() ? files_.front().path : buffer.paths.front()).filename().string(),
                        fmt::join(buffer.channel_names, ", ")));
    Image<float> all(width_, height_, info.channels(), Layout::interleaved);
    PictureRows rows(reader, {}, false, height_);
    rows.read(0, all.view(), {threads});
    return all;
}

SequenceFrame FrameSequence::read_stored(int i, int threads) const {
    const Image<float> all = read_all(color_, i, threads);
    const auto part = [&](const Buffer& buffer, int count) {
        return buffer.paths.empty() ? channels_copied(all.view(), buffer.first, count)
                                    : channels_copied(read_all(buffer, i, threads).view(), buffer.first, count);
    };
    SequenceFrame frame;
    frame.color = part(color_, alpha_ >= 0 ? 4 : 3);
    frame.jitter = stored_jitter(i);
    if (has_motion()) frame.motion = part(motion_, 2);
    if (!has_depth()) return frame;
    frame.depth = part(depth_, 1);
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            if (std::isnan(frame.depth.view()(x, y)))
                throw std::runtime_error(fmt::format("{}: the depth at {}, {} is not a number; render it again",
                                                     depth_.paths.empty() ? files_[static_cast<std::size_t>(i)].path
                                                                          : depth_.paths[static_cast<std::size_t>(i)],
                                                     x, y));
    return frame;
}

std::vector<std::string> FrameSequence::paths(int i) const {
    const auto frame = static_cast<std::size_t>(i);
    std::vector<std::string> all{files_[frame].path};
    for (const Buffer* buffer : {&color_, &depth_, &motion_})
        if (!buffer->paths.empty() && buffer->paths[frame] != all.front()) all.push_back(buffer->paths[frame]);
    return all;
}

SequenceFrame FrameSequence::read(int i, int threads) const {
    SequenceFrame frame = read_stored(i, threads);
    frame.jitter = convention_.jitter_of(frame.jitter);
    if (!has_motion()) return frame;
    convert_motion(frame, i);
    if (has_depth() && i > 0 && !cameras_.empty()) move_sky(frame, i);
    return frame;
}

/// From what the files mean to previous minus current, in pixels, y down, without the jitter.
void FrameSequence::convert_motion(SequenceFrame& frame, int i) const {
    Point jitter_step;
    if (convention_.includes_jitter && i > 0) {
        const Point before = convention_.jitter_of(stored_jitter(i - 1));
        jitter_step = {frame.jitter.x - before.x, frame.jitter.y - before.y};
    }
    const View<float> motion = frame.motion.view();
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const Point stored{double(motion(x, y, 0)), double(motion(x, y, 1))};
            const Point converted = convention_.motion_of(stored, width_, height_);
            motion(x, y, 0) = static_cast<float>(converted.x - jitter_step.x);
            motion(x, y, 1) = static_cast<float>(converted.y - jitter_step.y);
        }
}

/// What is infinitely far away moves as the camera turns, which renderers leave out.
void FrameSequence::move_sky(SequenceFrame& frame, int i) const {
    const Camera &now = cameras_[static_cast<std::size_t>(i)], &before = cameras_[static_cast<std::size_t>(i) - 1];
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            if (!is_sky(frame.depth.view()(x, y))) continue;
            const double px = x + 0.5 + frame.jitter.x, py = y + 0.5 + frame.jitter.y;
            const double ndc_x = 2 * px / width_ - 1, ndc_y = 1 - 2 * py / height_;
            const double* const p = now.projection;
            const double direction[3] = {(ndc_x + p[2]) / p[0], (ndc_y + p[6]) / p[5], -1};
            double world[3] = {}, old[3] = {};
            for (int r = 0; r < 3; ++r)  // the inverse of a rotation is its transpose
                for (int c = 0; c < 3; ++c) world[c] += now.world_to_camera[r * 4 + c] * direction[r];
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) old[r] += before.world_to_camera[r * 4 + c] * world[c];
            const double* const q = before.projection;
            const double old_x = (q[0] * old[0] + q[2] * old[2]) / -old[2];
            const double old_y = (q[5] * old[1] + q[6] * old[2]) / -old[2];
            frame.motion.view()(x, y, 0) = static_cast<float>((old_x + 1) / 2 * width_ - px);
            frame.motion.view()(x, y, 1) = static_cast<float>((1 - old_y) / 2 * height_ - py);
        }
}

}  // namespace bandlimit::job
