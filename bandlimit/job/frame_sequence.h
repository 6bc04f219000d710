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

namespace bandlimit::job {

/// What the numbers of a motion buffer mean.
struct MotionConvention {
    enum class Units {
        pixels,
        uv,  ///< 1 is the width or height of the picture
        ndc  ///< 2 is
    };
    Units units = Units::pixels;
    bool is_previous_minus_current = true;  ///< else current minus previous
    bool is_y_up = false;
};

/// "blender", "unreal", "unity" or "bandlimit"; none: by the names of the channels.
struct SequenceJob {
    std::string folder;
    std::string conventions = "auto";
    std::optional<MotionConvention::Units> motion_units{};
    std::optional<bool> is_previous_minus_current{}, is_y_up{};
    std::string color{}, depth{},
        motion{};  ///< channels to use, as "Beauty", "Depth.Z", "Vector"; empty: found by name
    /// A JSON file: `sequences` has an entry named like the folder with `jitter`, a list of [x, y] in pixels, y down;
    /// `camera`, a list of {world_to_cam, proj}, tells how the sky moves. Empty: no jitter, and the sky stands still.
    std::string meta{};
};

/// The names of conventions, "auto" first.
std::vector<std::string_view> convention_names();

/// One frame, by the conventions of antialias/temporal.h.
struct SequenceFrame {
    Image<float> color;          ///< RGB or RGBA
    Image<float> depth, motion;  ///< none where the files have none
    Point jitter{};
};

class FrameSequence {
public:
    int count() const { return static_cast<int>(files_.size()); }
    int width() const { return width_; }
    int height() const { return height_; }
    bool has_motion() const { return motion_ >= 0; }
    bool has_depth() const { return depth_ >= 0; }
    /// After how many frames the jitter repeats; 0 if there is none.
    int jitter_length() const { return static_cast<int>(jitter_.size()); }
    /// "blender", what was chosen or found.
    const std::string& conventions() const { return conventions_; }
    /// "frame_003.exr", and the number in it: 3, or -1.
    const std::string& name(int i) const { return names_[static_cast<std::size_t>(i)]; }
    int number(int i) const { return numbers_[static_cast<std::size_t>(i)]; }

    /// throws   std::runtime_error for files that cannot be read, or are unlike the first
    SequenceFrame read(int i, int threads = 0) const;

private:
    friend FrameSequence open_sequence(const SequenceJob& job);

    struct Camera {
        double world_to_camera[16], projection[16];
    };
    void find_files(const std::string& folder);
    void find_channels(const SequenceJob& job);
    void read_meta(const SequenceJob& job);
    void move_sky(SequenceFrame& frame, int i) const;

    std::vector<std::string> files_, names_, channel_names_;
    std::vector<int> numbers_;
    std::vector<Point> jitter_;
    std::vector<Camera> cameras_;
    std::string conventions_;
    MotionConvention convention_;
    int width_ = 0, height_ = 0, color_ = 0, alpha_ = -1, depth_ = -1, motion_ = -1;  ///< first channels
};

/// The EXR files of a folder, by the numbers in their names.
/// throws   std::runtime_error for folders without any, channels that are missing, and a meta file that is broken or
///          knows no such sequence
FrameSequence open_sequence(const SequenceJob& job);

/// The number that a file's name ends in, before its extension; -1 if there is none.
int number_in(const std::string& name);

}  // namespace bandlimit::job
