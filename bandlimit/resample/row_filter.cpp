#include "bandlimit/resample/row_filter.h"

#include <algorithm>
#include <atomic>

#include "bandlimit/core/error.h"
#include "bandlimit/core/overlap.h"

namespace bandlimit {

RunMonitor::RunMonitor(const Parallel& parallel, const RowProgress& progress, std::int64_t samples)
    : stop_(parallel.stop), progress_(progress), samples_(samples) {}

void RunMonitor::made(std::int64_t samples) {
    if (stop_.stop_requested()) throw Stopped();
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    made_ += samples;
    progress_(static_cast<double>(made_) / static_cast<double>(samples_));
}

IndexRange RowRun::rows() const { return {target.first_row, target.first_row + shape_of(target.samples).height}; }

RowParts::RowParts(IndexRange rows, int least, int most)
    : rows_(rows), length_(std::max((rows.count() - 1) / std::max(most, 1) + 1, least)) {}

IndexRange RowParts::operator[](int i) const {
    const int first = rows_.begin + i * length_;
    return {first, first + std::min(length_, rows_.end - first)};
}

RowFilter::RowFilter(RowProtocol protocol) : protocol_(std::make_shared<const RowProtocol>(std::move(protocol))) {}

IndexRange RowFilter::rows_needed(int first, int last, std::size_t source) const {
    const RowProtocol& p = *protocol_;
    if (first < 0 || first >= last || last > p.height || source >= p.sources.size())
        fail(p.name, "::rows_needed: rows ", first, " to ", last, " of ", p.height, " from source ", source, " of ",
             p.sources.size(), "; pass a part of the rows, and a source that there is");
    return stored_indices(p.rows_read(source, first, last), p.sources[source].height, p.sources[source].edge_y);
}

std::uint64_t RowFilter::bytes(int channels, const Parallel& parallel) const {
    return static_cast<std::uint64_t>(protocol_->bytes(channels, parallel));
}

void RowFilter::check_source(const SourceRows& source, std::size_t i, const TargetRows& target) const {
    const RowProtocol& p = *protocol_;
    const ViewShape from = shape_of(source.samples), to = shape_of(target.samples);
    const bool has_background = !target.background.empty();
    const bool has_own_channels = p.target_channels > 0;
    const int channels = p.channels > 0 ? p.channels : has_own_channels ? from.channels : to.channels + has_background;
    const int target_channels = has_own_channels ? p.target_channels : channels - has_background;
    if (from.width != p.sources[i].width || to.width != p.width || from.channels != channels ||
        to.channels != target_channels || to.channels < 1 || (has_own_channels && has_background))
        fail(p.name, "::run: source ", from.width, " wide with ", from.channels, " channels, target ", to.width,
             " with ", to.channels, "; need ", p.sources[i].width, " with ", channels, " and ", p.width, " with ",
             target_channels);
    const std::string run = p.name + "::run";
    check_encoding(run.c_str(), source.encoding, from.channels);
    check_apart(run.c_str(), source.samples, target.samples);
    if (has_background &&
        (source.encoding.alpha < 0 || target.background.size() != static_cast<std::size_t>(to.channels)))
        fail(p.name, "::run: a background of ", target.background.size(), " channels; it needs an alpha channel and ",
             to.channels, " values");
    if (to.height == 0) return;
    const IndexRange needed = rows_needed(target.first_row, target.first_row + to.height, i);
    if (needed.count() > 0 && (needed.begin < source.first_row || needed.end > source.first_row + from.height))
        fail(p.name, "::run: source rows ", source.first_row, " to ", source.first_row + from.height, "; rows ",
             needed.begin, " to ", needed.end, " are needed");
}

RunReport RowFilter::run(std::span<const SourceRows> sources, const TargetRows& target, const Parallel& parallel,
                         const RowProgress& progress) const {
    const RowProtocol& p = *protocol_;
    if (sources.size() != p.sources.size())
        fail(p.name, "::run: ", sources.size(), " sources; pass ", p.sources.size());
    const ViewShape to = shape_of(target.samples);
    check_encoding((p.name + "::run").c_str(), target.encoding, to.channels);
    for (std::size_t i = 0; i < sources.size(); ++i) check_source(sources[i], i, target);
    if (to.height == 0) return {};
    const int channels = shape_of(sources[0].samples).channels;
    RunMonitor monitor(parallel, progress, std::int64_t{to.width} * to.height * channels);
    const RowRun run{sources, target, channels, parallel, monitor};
    const RowWork work = p.start(run);
    std::atomic<bool> lost = false;
    parallel_for(work.pieces, 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t piece = begin; piece < end; ++piece)
            if (work.run(static_cast<int>(piece))) lost = true;
    });
    return {lost};
}

}  // namespace bandlimit
