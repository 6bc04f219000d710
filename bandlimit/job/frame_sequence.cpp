#include "bandlimit/job/frame_sequence.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "bandlimit/io/image_file.h"
#include "bandlimit/io/located_json.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;

constexpr double sky_from = 1e9;  // depths that far are sky

struct NamedConvention {
    std::string_view name;
    MotionConvention motion;
    std::string_view motion_channel;
};
constexpr std::array<NamedConvention, 4> conventions{{
    {"bandlimit", {MotionConvention::Units::pixels, true, false}, "Vector"},
    {"blender", {MotionConvention::Units::pixels, true, true}, "Vector"},
    {"unreal", {MotionConvention::Units::ndc, false, true}, "Velocity"},
    {"unity", {MotionConvention::Units::uv, false, true}, "MotionVectors"},
}};

const NamedConvention& convention_called(const std::string& name) {
    const auto found = std::ranges::find(conventions, name, &NamedConvention::name);
    if (found == conventions.end())
        throw OptionError("conventions", fmt::format("\"{}\" is unknown; choose one of: {}", name,
                                                     fmt::join(convention_names(), ", ")));
    return *found;
}

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

std::vector<std::string_view> convention_names() {
    std::vector<std::string_view> names{"auto"};
    for (const NamedConvention& c : conventions) names.push_back(c.name);
    return names;
}

int number_in(const std::string& name) {
    const std::string stem = fs::path(name).stem().string();
    const auto digits = std::find_if(stem.rbegin(), stem.rend(), [](unsigned char c) { return !std::isdigit(c); });
    int number = -1;
    const char* const begin = stem.data() + (stem.rend() - digits);
    const auto [end, status] = std::from_chars(begin, stem.data() + stem.size(), number);
    return begin < stem.data() + stem.size() && status == std::errc() ? number : -1;
}

FrameSequence open_sequence(const SequenceJob& job) {
    FrameSequence sequence;
    sequence.find_files(job.folder);
    sequence.find_channels(job);
    if (!job.meta.empty()) sequence.read_meta(job);
    return sequence;
}

void FrameSequence::find_files(const std::string& folder) {
    if (!fs::is_directory(folder))
        throw std::runtime_error(folder + ": is not a folder; name one with EXR files, or a scene");
    std::vector<fs::path> paths;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".exr" && entry.path().filename().string()[0] != '.')
            paths.push_back(entry.path());
    if (paths.empty()) throw std::runtime_error(folder + ": holds no EXR files; name a folder with one per frame");
    std::ranges::sort(paths, [](const fs::path& a, const fs::path& b) {
        const int i = number_in(a.filename()), j = number_in(b.filename());
        return i != j ? i < j : a < b;
    });
    for (const fs::path& path : paths) {
        const int number = number_in(path.filename().string());
        if (!numbers_.empty() && numbers_.back() >= 0 && number > numbers_.back() + 1)
            throw std::runtime_error(fmt::format("{}: frame {} is missing between {} and {}; render it, or cut there",
                                                 folder, numbers_.back() + 1, names_.back(), path.filename().string()));
        files_.push_back(path.string());
        names_.push_back(path.filename().string());
        numbers_.push_back(number);
    }
}

void FrameSequence::find_channels(const SequenceJob& job) {
    const std::string& first = files_.front();
    const ImageReader reader(first, 1);
    const std::vector<std::string>& names = channel_names_ = reader.info().channel_names;
    width_ = reader.info().width, height_ = reader.info().height;
    conventions_ = job.conventions == "auto" ? guessed_conventions(names) : job.conventions;
    const NamedConvention& convention = convention_called(conventions_);
    convention_ = convention.motion;
    if (job.motion_units) convention_.units = *job.motion_units;
    if (job.is_previous_minus_current) convention_.is_previous_minus_current = *job.is_previous_minus_current;
    if (job.is_y_up) convention_.is_y_up = *job.is_y_up;

    color_ =
        job.color.empty() ? first_of(names, {"R", "Combined.R"}) : channel_asked(names, job.color, "R", first, "color");
    if (color_ < 0)
        throw std::runtime_error(
            fmt::format("{}: has no channel R; name the colour by --color; it has {}", first, fmt::join(names, ", ")));
    check_adjacent(names, color_, {"R", "G", "B"}, first);
    const auto alpha = static_cast<std::size_t>(color_) + 3;
    if (alpha < names.size() && (names[alpha] == "A" || names[alpha].ends_with(".A"))) alpha_ = color_ + 3;
    depth_ = job.depth.empty() ? first_of(names, {"Depth.Z", "Depth.V", "Z", "depth"})
                               : channel_asked(names, job.depth, "Z", first, "depth");
    motion_ = job.motion.empty() ? channel_called(names, std::string(convention.motion_channel) + ".X")
                                 : channel_asked(names, job.motion, "X", first, "motion");
    if (motion_ >= 0) check_adjacent(names, motion_, {"X", "Y"}, first);
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

SequenceFrame FrameSequence::read(int i, int threads) const {
    const std::string& path = files_[static_cast<std::size_t>(i)];
    ImageReader reader(path, threads);
    const ImageInfo& info = reader.info();
    if (info.width != width_ || info.height != height_)
        throw std::runtime_error(fmt::format("{}: is {} x {}, and {} is {} x {}; render all frames in one size", path,
                                             info.width, info.height, names_.front(), width_, height_));
    if (info.channel_names != channel_names_)
        throw std::runtime_error(fmt::format("{}: has the channels {}, and {} has {}; render all frames alike", path,
                                             fmt::join(info.channel_names, ", "), names_.front(),
                                             fmt::join(channel_names_, ", ")));
    Image<float> all(width_, height_, info.channels(), Layout::interleaved);
    PictureRows rows(reader, {}, false, height_);
    rows.read(0, all.view(), {threads});
    const auto part = [&](int first, int count) {
        View<float> view = all.view();
        view.data += first, view.channels = count;
        Image<float> copy(width_, height_, count, Layout::interleaved);
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                for (int c = 0; c < count; ++c) copy.view()(x, y, c) = view(x, y, c);
        return copy;
    };
    SequenceFrame frame;
    frame.color = part(color_, alpha_ >= 0 ? 4 : 3);
    if (depth_ >= 0) frame.depth = part(depth_, 1);
    if (!jitter_.empty()) frame.jitter = jitter_[static_cast<std::size_t>(i) % jitter_.size()];
    if (depth_ >= 0)
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                if (std::isnan(frame.depth.view()(x, y)))
                    throw std::runtime_error(
                        fmt::format("{}: the depth at {}, {} is not a number; render it again", path, x, y));
    if (motion_ < 0) return frame;
    frame.motion = part(motion_, 2);
    const double sign = convention_.is_previous_minus_current ? 1 : -1;
    const auto unit = [&](int length) {
        return sign * (convention_.units == MotionConvention::Units::pixels ? 1
                       : convention_.units == MotionConvention::Units::uv   ? length
                                                                            : length / 2.0);
    };
    const auto scale_x = static_cast<float>(unit(width_));
    const auto scale_y = static_cast<float>(unit(height_) * (convention_.is_y_up ? -1 : 1));
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            frame.motion.view()(x, y, 0) *= scale_x;
            frame.motion.view()(x, y, 1) *= scale_y;
        }
    if (depth_ >= 0 && i > 0 && !cameras_.empty()) move_sky(frame, i);
    return frame;
}

/// What is infinitely far away moves as the camera turns, which renderers leave out.
void FrameSequence::move_sky(SequenceFrame& frame, int i) const {
    const Camera &now = cameras_[static_cast<std::size_t>(i)], &before = cameras_[static_cast<std::size_t>(i) - 1];
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            if (static_cast<double>(frame.depth.view()(x, y)) < sky_from) continue;
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
