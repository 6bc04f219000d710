// Where a run over frames was when it ended before its time.
// Stability: inner.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/antialias/temporal_state.h"
#include "bandlimit/job/temporal.h"

namespace bandlimit::job {

/// How a file looked.
struct FileStamp {
    std::string path;
    std::uint64_t size = 0;     ///< bytes
    std::int64_t modified = 0;  ///< nanoseconds, as the file system counts

    bool operator==(const FileStamp&) const = default;
};
/// Of a file that is not there: size and time 0.
FileStamp stamp_of(const std::string& path);

/// A frame that was made, of which files, and what file it became.
struct MadeFrame {
    TemporalFrameReport report;
    std::vector<FileStamp> inputs = {};
    FileStamp output = {};
};

/// The file .bandlimit-temporal of a folder of frames: those that are done, what they left in the history, and the
/// measures so far.
class TemporalCheckpoint {
public:
    /// `settings` are all that decides what frames look like, besides their files.
    TemporalCheckpoint(const std::string& folder, std::string settings);

    /// The frames that need not be made again; `history` and `meter`, which are new, are as after the last of them. None
    /// if there is no such file, if it is of other settings or damaged, or if any file that it names has changed.
    std::vector<MadeFrame> restore(TemporalHistory& history, std::optional<TemporalMeter>& meter) const;
    /// Writes the file, whole or not at all.
    void save(const std::vector<MadeFrame>& frames, const TemporalHistory& history,
              const std::optional<TemporalMeter>& meter) const;
    /// Removes it: the run is complete.
    void remove() const;

private:
    std::string path_, settings_;
};

}  // namespace bandlimit::job
