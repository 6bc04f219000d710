#include "bandlimit/job/check_conventions.h"

#include <gtest/gtest.h>

#include "bandlimit/job/channels.h"
#include "bandlimit/math/random.h"
#include "bandlimit/sampling/sequence.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit::job {
namespace {

using Units = MotionConvention::Units;
using JitterSign = MotionConvention::JitterSign;
using Verdict = ConventionReport::Verdict;

/// A vector as a file by `c` has it: what motion_of() takes back.
Point stored_motion(Point motion, const MotionConvention& c, int width, int height) {
    const auto unit = [&](int length) {
        return c.units == Units::pixels ? 1.0 : length / (c.units == Units::uv ? 1 : 2.0);
    };
    const double sign = c.is_previous_minus_current ? 1 : -1;
    const Point p{sign * motion.x / unit(width), (c.is_y_up ? -sign : sign) * motion.y / unit(height)};
    return c.are_axes_swapped ? Point{p.y, p.x} : p;
}

Point stored_jitter(Point jitter, const MotionConvention& c) {
    const double sign = c.jitter_sign == JitterSign::minus ? -1 : 1;
    return {sign * jitter.x, (c.is_jitter_y_up ? -sign : sign) * jitter.y};
}

struct Sequence {
    std::string scene = "plane";
    int width = 96, height = 64, count = 4;
    bool is_jittered = true;
    SceneOptions options = {};
};

/// Where frame i is sampled, and where it says that it is.
Point listed_jitter(int i) { return i < 0 ? Point{} : jitter_sequence(JitterKind::halton, 16)[std::size_t(i)]; }

/// The frames of a scene by our conventions; without jitter in the pictures where `is_sampled_at_centre`.
std::vector<SequenceFrame> rendered(const Sequence& s, bool is_sampled_at_centre = false) {
    const Scene scene = make_scene(s.scene, s.width, s.height, s.options);
    std::vector<SequenceFrame> frames;
    for (int i = 0; i < s.count; ++i) {
        const Point jitter = s.is_jittered && !is_sampled_at_centre ? listed_jitter(i) : Point{};
        const Image<float> all = render_scene(scene, s.width, s.height, i, {.jitter = jitter});
        frames.emplace_back();
        frames.back().color = channels_copied(all.view(), scene_channel::color, 4);
        frames.back().depth = channels_copied(all.view(), scene_channel::depth, 1);
        frames.back().motion = channels_copied(all.view(), scene_channel::motion, 2);
    }
    return frames;
}

/// The same frames as a renderer with the conventions `c` stores them, read by ours so far.
StoredFrames stored(const Sequence& s, const std::vector<SequenceFrame>& frames, const MotionConvention& c) {
    StoredFrames result;
    result.count = s.count, result.has_jitter = s.is_jittered;
    result.read = [=, &frames](int i) {
        const SequenceFrame& from = frames[std::size_t(i)];
        const Point now = listed_jitter(i), before = listed_jitter(i - 1);
        SequenceFrame frame{from.color.clone(), from.depth.clone(), from.motion.clone(), {}};
        if (s.is_jittered) frame.jitter = stored_jitter(now, c);
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x) {
                Point motion{double(frame.motion.view()(x, y, 0)), double(frame.motion.view()(x, y, 1))};
                if (c.includes_jitter) motion.x += now.x - before.x, motion.y += now.y - before.y;
                const Point vector = stored_motion(motion, c, s.width, s.height);
                frame.motion.view()(x, y, 0) = float(vector.x), frame.motion.view()(x, y, 1) = float(vector.y);
            }
        return frame;
    };
    return result;
}

ConventionReport report_of(const Sequence& s) {
    const std::vector<SequenceFrame> frames = rendered(s);
    return check_conventions(stored(s, frames, {}));
}

std::vector<MotionConvention> motion_conventions() {
    std::vector<MotionConvention> all;
    for (const Units units : {Units::pixels, Units::uv, Units::ndc})
        for (int bits = 0; bits < 8; ++bits) all.push_back({units, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0});
    return all;
}

TEST(MotionConvention, SaysWhereThingsWere) {
    // The manual of Unity: current minus previous, in shares of the picture, y up.
    const Point unity = convention_called("unity").motion.motion_of({0.01, -0.02}, 1920, 1080);
    EXPECT_NEAR(unity.x, -19.2, 1e-12);
    EXPECT_NEAR(unity.y, -21.6, 1e-12);
    const Point blender = convention_called("blender").motion.motion_of({3, 4}, 1920, 1080);
    EXPECT_EQ(blender.x, 3);
    EXPECT_EQ(blender.y, -4);
    const Point swapped = MotionConvention{.are_axes_swapped = true}.motion_of({3, 4}, 1920, 1080);
    EXPECT_EQ(swapped.x, 4);
    EXPECT_EQ(swapped.y, 3);
    const Point jitter =
        MotionConvention{.jitter_sign = JitterSign::minus, .is_jitter_y_up = true}.jitter_of({0.25, 0.5});
    EXPECT_EQ(jitter.x, -0.25);
    EXPECT_EQ(jitter.y, 0.5);
    for (const MotionConvention& c : motion_conventions()) {
        const Point back = c.motion_of(stored_motion({2, -3}, c, 64, 48), 64, 48);
        EXPECT_NEAR(back.x, 2, 1e-12);
        EXPECT_NEAR(back.y, -3, 1e-12);
    }
}

TEST(MotionConvention, FlagsNameWhatDiffers) {
    EXPECT_TRUE(flags_between({}, {}).empty());
    EXPECT_EQ(flags_between({}, convention_called("unreal").motion),
              (std::vector<std::string>{"--motion-units ndc", "--motion-direction current-previous", "--motion-y up"}));
    EXPECT_EQ(flags_between({.are_axes_swapped = true, .jitter_sign = JitterSign::none},
                            {.includes_jitter = true, .is_jitter_y_up = true}),
              (std::vector<std::string>{"--motion-axes xy", "--motion-jitter included", "--jitter-sign plus",
                                        "--jitter-y up"}));
}

// However vectors are stored, the check names the options that take them back.
TEST(CheckConventions, FindsEveryReadingOfVectors) {
    const Sequence s{"plane", 96, 64, 3, false};
    const std::vector<SequenceFrame> frames = rendered(s);
    for (const MotionConvention& c : motion_conventions()) {
        if (c.units == Units::ndc && c.is_y_up) continue;  // enough of them
        const ConventionReport report = check_conventions(stored(s, frames, c));
        EXPECT_EQ(report.flags, flags_between({}, c));
        EXPECT_EQ(report.best.convention, c);
        EXPECT_EQ(report.verdict, c == MotionConvention{} ? Verdict::right : Verdict::wrong);
        EXPECT_EQ(report.candidates.size(), 24u);
        EXPECT_EQ(judged(report, c).verdict, Verdict::right);
    }
}

TEST(CheckConventions, FindsEveryReadingOfJitter) {
    const Sequence s;
    const std::vector<SequenceFrame> frames = rendered(s), unjittered = rendered(s, true);
    for (const MotionConvention& c : {
             MotionConvention{.jitter_sign = JitterSign::minus},
             {.is_jitter_y_up = true},
             {.includes_jitter = true, .jitter_sign = JitterSign::minus},
             {.jitter_sign = JitterSign::none},
             {.units = Units::uv, .is_y_up = true, .includes_jitter = true},
         })
        EXPECT_EQ(check_conventions(stored(s, c.jitter_sign == JitterSign::none ? unjittered : frames, c)).flags,
                  flags_between({}, c));
}

// One comparison tells of each of the 216 readings what to change.
TEST(CheckConventions, TellsWhatToChangeInAnyReading) {
    for (const Sequence& s : {Sequence{"plane"}, {"mover", 120, 80, 4}}) {
        const ConventionReport report = report_of(s);
        ASSERT_EQ(report.candidates.size(), 216u);
        EXPECT_LT(report.best.error, report.still_error);
        EXPECT_EQ(report.pairs, s.count - 1);
        for (const ConventionCandidate& candidate : report.candidates) {
            const ConventionReport other = judged(report, candidate.convention);
            EXPECT_EQ(other.flags, flags_between(candidate.convention, {})) << s.scene;
            EXPECT_EQ(other.current.error, candidate.error);
        }
    }
}

TEST(CheckConventions, SaysWhatItCannotTell) {
    const Sequence s{"glyphs", 48, 32, 3};
    const ConventionReport still = report_of(s);
    EXPECT_EQ(still.verdict, Verdict::cannot_tell);
    EXPECT_EQ(still.reason, "nothing moves");
    EXPECT_TRUE(still.flags.empty());
    // Vectors that have nothing to do with the pictures.
    std::vector<SequenceFrame> noise = rendered(s);
    Random random(7);
    for (SequenceFrame& frame : noise)
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x)
                for (int c = 0; c < 2; ++c) frame.motion.view()(x, y, c) = float(random.integer(-4, 4));
    const ConventionReport unrelated = check_conventions(stored(s, noise, {}));
    EXPECT_EQ(unrelated.verdict, Verdict::cannot_tell);
    EXPECT_NE(unrelated.reason, still.reason);
}

// What moves along x alone says nothing about y.
TEST(CheckConventions, LeavesOpenWhatThePicturesDo) {
    const ConventionReport report = report_of({"glyphs", 64, 48, 3, true, {.speed = 1.3}});
    EXPECT_EQ(report.verdict, Verdict::right);
    EXPECT_EQ(report.open, std::vector<std::string>{"--motion-y"});
    EXPECT_EQ(judged(report, {.is_y_up = true}).verdict, Verdict::right);
    EXPECT_EQ(judged(report, {.is_previous_minus_current = false}).verdict, Verdict::wrong);
}

TEST(CheckConventions, RefusesWhatCannotBeCompared) {
    EXPECT_THROW(report_of({"plane", 8, 8, 1}), std::runtime_error);
    const Sequence s{"plane", 8, 8, 2, false};
    std::vector<SequenceFrame> frames = rendered(s);
    EXPECT_THROW(judged(check_conventions(stored(s, frames, {})), {.includes_jitter = true}), Error);
    StoredFrames bare = stored(s, frames, {});
    bare.read = [read = bare.read](int i) {
        SequenceFrame frame = read(i);
        frame.motion = Image<float>();
        return frame;
    };
    EXPECT_THROW(check_conventions(bare), std::runtime_error);
}

}  // namespace
}  // namespace bandlimit::job
