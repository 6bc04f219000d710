// Rendered sequences: a folder of EXR files, one a frame, with what temporal antialiasing needs.
//
//     job::FrameSequence sequence = job::open_sequence({.folder = "render", .meta = "render/meta.json"});
//     for (int i = 0; i < sequence.count(); ++i) job::SequenceFrame frame = sequence.read(i);
// Stability: evolving.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/core/image.h"
#include "bandlimit/job/buffer_files.h"
#include "bandlimit/job/motion_convention.h"

namespace bandlimit::job {

/// "blender", "unreal", "unity" or "bandlimit"; none: by the names of the channels.
struct SequenceJob {
    std::string folder;
    std::string conventions = "auto";
    std::optional<MotionConvention::Units> motion_units{};  ///< these override the conventions
    std::optional<bool> is_previous_minus_current{}, is_y_up{};
    bool are_axes_swapped = false, includes_jitter = false, is_jitter_y_up = false;
    MotionConvention::JitterSign jitter_sign = MotionConvention::JitterSign::plus;
    /// Channels to use, as "Beauty", "Depth.Z", "Vector"; empty: found by name. Or files that hold this buffer alone, as
    /// "depth_####.exr:Z" (job/buffer_files.h), relative to the folder, with the numbers of the colour's.
    std::string color{}, depth{}, motion{};
    /// A JSON file: `sequences` has an entry named like the folder with `jitter`, a list of [x, y] in pixels, y down;
    /// `camera`, a list of {world_to_cam, proj}, tells how the sky moves. Empty: no jitter, and the sky stands still.
    std::string meta{};
};

/// Throws OptionError for conventions and patterns of files that are wrong by themselves.
void check(const SequenceJob& job);

/// One frame, by the conventions of antialias/temporal.h.
struct SequenceFrame {
    Image<float> color;          ///< RGB or RGBA
    Image<float> depth, motion;  ///< none where the files have none
    Point jitter{};
};

/// Whether a depth is that of what is infinitely far away: 1e9 or more.
bool is_sky(float depth);

class FrameSequence {
public:
    int count() const { return static_cast<int>(files_.size()); }
    int width() const { return width_; }
    int height() const { return height_; }
    bool has_motion() const { return motion_.first >= 0; }
    bool has_depth() const { return depth_.first >= 0; }
    /// After how many frames the jitter repeats; 0 if there is none.
    int jitter_length() const { return static_cast<int>(jitter_.size()); }
    /// "blender", what was chosen or found.
    const std::string& conventions() const { return conventions_; }
    /// What that and the options that override it say together.
    const MotionConvention& convention() const { return convention_; }
    /// "frame_003.exr", and the number in it: 3, or -1.
    const std::string& name(int i) const { return files_[static_cast<std::size_t>(i)].name; }
    int number(int i) const { return files_[static_cast<std::size_t>(i)].number; }
    /// All files that it is read from.
    std::vector<std::string> paths(int i) const;

    /// throws   std::runtime_error for files that cannot be read, or are unlike the first
    SequenceFrame read(int i, int threads = 0) const;
    /// The same with motion and jitter as the files have them. throws likewise
    SequenceFrame read_stored(int i, int threads = 0) const;

private:
    friend FrameSequence open_sequence(const SequenceJob& job);

    struct Camera {
        double world_to_camera[16], projection[16];
    };
    /// A buffer of all frames: in files of its own, or in those of the colour.
    struct Buffer {
        std::vector<std::string> paths;  ///< one a frame; empty: the colour's
        std::vector<std::string> channel_names;
        int first = -1;  ///< channel; -1: there is no such buffer
    };
    void find_files(const SequenceJob& job);
    Buffer files_of_buffer(const std::string& option, const std::string& pattern, const std::string& folder) const;
    void find_channels(const SequenceJob& job);
    void find_motion(const SequenceJob& job, std::string_view layer);
    void read_meta(const SequenceJob& job);
    Point stored_jitter(int i) const;
    Image<float> read_all(const Buffer& buffer, int i, int threads) const;
    void convert_motion(SequenceFrame& frame, int i) const;
    void move_sky(SequenceFrame& frame, int i) const;

    std::vector<FrameFile> files_;
    Buffer color_, depth_, motion_;
    std::vector<Point> jitter_;
    std::vector<Camera> cameras_;
    std::string conventions_;
    MotionConvention convention_;
    int width_ = 0, height_ = 0, alpha_ = -1;
};

/// The EXR files of a folder, by the numbers in their names.
/// throws   OptionError as check(); std::runtime_error for folders without any, files and channels that are missing, and a meta file that is broken or
///          knows no such sequence
FrameSequence open_sequence(const SequenceJob& job);

}  // namespace bandlimit::job
