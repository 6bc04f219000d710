// Which reading of motion vectors and jitter is right: the one by which frames are found again in the frames before.
//
//     job::ConventionReport report = job::check_conventions(job::open_sequence({.folder = "render"}));
//     for (const std::string& flag : report.flags) std::cout << flag << "\n";  // --motion-y up
// Stability: evolving.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bandlimit/job/context.h"
#include "bandlimit/job/frame_sequence.h"

namespace bandlimit::job {

/// A reading, and how well it explains the pictures.
struct ConventionCandidate {
    MotionConvention convention;
    /// The mean difference in lightness, of colours v / (1 + v) and smoothed, between what pixels show and what the frame
    /// before shows where the reading says they were; 0.2 where that is of another depth.
    double error = 0;
    /// How much the motion of the middle pixel changes from frame to frame, in pixels; 0 for less than three frames. It
    /// tells readings apart that lead to the same places: vectors that include the jitter from pictures without jitter.
    double unsteadiness = 0;
    /// By how many standard errors it is farther from the pictures than the nearest, over the parts of the pictures.
    double excess = 0;
    bool is_likely = false;  ///< nothing but chance may be why another one is nearer: an excess of at most 3
};

struct ConventionReport {
    enum class Verdict { right, wrong, cannot_tell };
    Verdict verdict = Verdict::cannot_tell;
    std::string reason;                 ///< of cannot_tell: "nothing moves"
    ConventionCandidate current, best;  ///< the same where the verdict is right, or there is none
    double still_error = 0;             ///< if all vectors were 0
    std::vector<std::string> flags;     ///< options that turn the current reading into the best: "--motion-y up"
    /// Options whose other value would explain the pictures as well, as "--motion-y" where nothing moves up or down.
    std::vector<std::string> open;
    std::vector<ConventionCandidate> candidates;  ///< the nearest to the pictures first
    int pairs = 0;                                ///< of frames that were compared
};

/// Frames with motion and jitter as they are stored.
struct StoredFrames {
    int count = 0;
    std::function<SequenceFrame(int i)> read;
    MotionConvention convention;  ///< how they are read so far
    bool has_jitter = false;
};

/// Compares all readings of up to six frames in the middle of a sequence: 2 directions, 2 directions of y, 2 orders of
/// axes, 3 units, and 9 readings of the jitter where there is any.
///
/// A reading is taken for wrong if another one is nearer to the pictures in so many parts of them that chance is not
/// the reason (three standard errors); of several that are about as near, the one that needs the fewest flags is best.
/// What is infinitely far away is left out.
/// cost     up to 32768 pixels of each frame for each of 120 readings: about a second
/// memory   two frames
/// throws   std::runtime_error for sequences without motion or of one frame; what `read` throws; Stopped
ConventionReport check_conventions(const StoredFrames& frames, const Context& context = {});
ConventionReport check_conventions(const FrameSequence& sequence, const Context& context = {});

/// What the same comparison says to another reading. Throws Error unless it is among the candidates.
ConventionReport judged(ConventionReport report, const MotionConvention& current);

}  // namespace bandlimit::job
