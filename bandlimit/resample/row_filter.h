// Filters of images that run on blocks of rows: what they have in common, and what runs them.
// Stability: stable.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bandlimit/color/encoding.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit {

/// Source samples: rows [first_row, first_row + height) of an image, and what they mean.
struct SourceRows {
    AnyConstView samples;
    int first_row = 0;
    Encoding encoding;
};

/// Where output rows [first_row, first_row + height) go, and how they are stored.
struct TargetRows {
    AnyView samples;
    int first_row = 0;
    Encoding encoding;
    /// If not empty: the opaque colour in linear light under the picture; alpha is dropped. [channels - 1]
    std::vector<float> background;
};

/// What a run has to tell.
struct RunReport {
    bool lost_non_finite = false;  ///< a value that is not finite was stored as the code 0
};

/// Called now and then while a run goes on, from any thread but by one at a time, with the share that is done, 0 to 1.
using RowProgress = std::function<void(double done)>;

/// Hears how far a run is; ends it where its caller asks for that.
class RunMonitor {
public:
    /// Of nobody.
    RunMonitor() = default;
    /// `samples` is how many the run makes.
    RunMonitor(const Parallel& parallel, const RowProgress& progress, std::int64_t samples);

    /// So many more are made. To be called every few rows. Throws Stopped.
    void made(std::int64_t samples);

private:
    std::stop_token stop_;
    RowProgress progress_;
    std::int64_t samples_ = 0, made_ = 0;
    std::mutex mutex_;
};

/// One run of a RowFilter, after all was checked.
struct RowRun {
    std::span<const SourceRows> sources;
    const TargetRows& target;
    int channels;  ///< of the sources
    const Parallel& parallel;
    RunMonitor& monitor;

    /// The rows of the target: of the whole output.
    IndexRange rows() const;
};

/// A run in pieces, which may be done in any order and side by side. run() returns whether a value that is not finite
/// was lost.
struct RowWork {
    int pieces = 0;
    std::function<bool(int piece)> run;
};

/// `rows` in `count` parts of one length, but for the last.
class RowParts {
public:
    /// No part has fewer than `least` rows, but for the last; there are at most `most`.
    RowParts(IndexRange rows, int least, int most);

    int count() const { return (rows_.count() - 1) / length_ + 1; }
    IndexRange operator[](int i) const;

private:
    IndexRange rows_;
    int length_;
};

/// What a kind of filter must tell of itself. All functions are called by any thread, and several at a time.
struct RowProtocol {
    struct Source {
        int width = 0, height = 0;
        Edge edge_y = Edge::clamp;
    };

    std::string name;             ///< for messages of errors
    std::vector<Source> sources;  ///< one for most filters
    int width = 0, height = 0;    ///< of the output
    int channels = 0;             ///< of sources, and of the output without a background; 0: any number
    int target_channels = 0;      ///< of the output, where it has not those of the sources; it has no background then
    /// The rows of a source that output rows [first, last) are made of; they may lie outside it.
    std::function<IndexRange(std::size_t source, int first, int last)> rows_read;
    /// About how much memory a run takes, in bytes.
    std::function<double(int channels, const Parallel& parallel)> bytes;
    std::function<RowWork(const RowRun& run)> start;
};

/// A filter ready to run on blocks of rows, so that no image need be in memory: what a Resizer, a Convolution and a
/// filter of mip levels are inside. Copies share what was worked out.
class RowFilter {
public:
    explicit RowFilter(RowProtocol protocol);

    /// What it told of itself, for filters around it.
    const RowProtocol& protocol() const { return *protocol_; }

    /// The stored rows of a source that output rows [first, last) are made of; {0, 0} if there are none.
    /// throws   Error for rows that the output does not have
    IndexRange rows_needed(int first, int last, std::size_t source = 0) const;

    /// About how much memory run() takes for so many channels, in bytes.
    std::uint64_t bytes(int channels, const Parallel& parallel) const;

    /// Computes the rows of `target` from those of the sources, which must hold rows_needed() of them.
    ///
    /// shapes   as many sources as the filter has, of its size and of the target's channels (one more with a background)
    /// throws   Error if sizes, channels, rows or encodings do not fit, and where a source and the target overlap;
    ///          Stopped, with the target made in part, where parallel.stop asks for it
    RunReport run(std::span<const SourceRows> sources, const TargetRows& target, const Parallel& parallel = {},
                  const RowProgress& progress = {}) const;
    RunReport run(const SourceRows& source, const TargetRows& target, const Parallel& parallel = {},
                  const RowProgress& progress = {}) const {
        return run(std::span(&source, 1), target, parallel, progress);
    }

private:
    void check_source(const SourceRows& source, std::size_t i, const TargetRows& target) const;

    std::shared_ptr<const RowProtocol> protocol_;
};

}  // namespace bandlimit
