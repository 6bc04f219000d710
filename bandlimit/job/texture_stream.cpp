#include "bandlimit/job/texture_stream.h"

#include <algorithm>

#include "bandlimit/core/pipeline.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/job/source_bands.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::job {
namespace {

/// Takes rows of levels, and puts them where the plan of a file has them.
class LevelRows {
public:
    LevelRows(const TextureShape& shape, const ContainerPlan& plan, AtomicFile& file)
        : shape_(shape), plan_(plan), file_(file), blocks_(static_cast<std::size_t>(shape.levels)) {
        file_.write(plan.header.data(), plan.header.size());
    }

    /// Memory for rows of a level, to be used until the next are asked for.
    AnyView place(int level, int count) {
        AnyImage& block = blocks_[static_cast<std::size_t>(level)];
        const int held = std::visit([](const auto& image) { return image.height(); }, block);
        if (held < count)
            block = make_image(shape_.format.depth, mip_length(shape_.width, level), count, shape_.format.channels);
        return rows_of(view_of(block), 0, count);
    }

    void write(int level, int first, const AnyView& rows) {
        const std::uint64_t row_bytes =
            shape_.image_bytes(level) / static_cast<std::uint64_t>(mip_length(shape_.height, level));
        const int count = shape_of(rows).height;
        const std::uint64_t start = plan_.levels[static_cast<std::size_t>(level)].start;
        file_.seek(static_cast<std::int64_t>(start + static_cast<std::uint64_t>(first) * row_bytes));
        file_.write(bytes_of(blocks_[static_cast<std::size_t>(level)]).data(),
                    static_cast<std::size_t>(count) * row_bytes);
    }

private:
    const TextureShape& shape_;
    const ContainerPlan& plan_;
    AtomicFile& file_;
    std::vector<AnyImage> blocks_;
};

int largest_need(const MipStream& stream) {
    int largest = 0;
    for (int step = 0; step < stream.steps(); ++step) {
        const IndexRange range = stream.rows_needed(step);
        largest = std::max(largest, range.end - range.begin);
    }
    return largest;
}

}  // namespace

MipsStreamReport stream_texture(ImageReader& reader, const Encoding& stored, const TexelFormat& texels,
                                const MipOptions& options, bool is_array, const std::string& path, Container container,
                                const Parallel& parallel, const std::function<void(const Progress&)>& progress) {
    const ImageInfo& in = reader.info();
    MipStream stream(in.width, in.height, in.channels(), in.depth, stored, texels, options, parallel);
    const int source_rows = largest_need(stream);
    require_memory(SourceBands::bytes(in, source_rows),
                   "making the levels of " + std::to_string(in.width) + " x " + std::to_string(in.height) + " texels");
    SourceBands source(reader, source_rows);
    const TextureShape shape{
        .format = texels, .width = in.width, .height = in.height, .levels = stream.levels(), .is_array = is_array};
    const ContainerPlan plan = plan_container(shape, container);
    AtomicFile file(path);
    LevelRows levels(shape, plan, file);
    MipsStreamReport report;
    Stopwatch watch;
    const MipStream::Sink sink{[&](int level, int, int count) { return levels.place(level, count); },
                               [&](int level, int first, const AnyView& rows) {
                                   watch.time(report.write, [&] { levels.write(level, first, rows); });
                               }};
    const auto read = [&](int step, Parallel) {
        watch.time(report.read, [&] { source.load(step, stream.rows_needed(step)); });
    };
    const auto filter = [&](int step, Parallel) {
        const SourceRows rows = source.rows(step, stored);
        watch.time(report.filter, [&] {
            if (stream.advance(rows.samples, rows.first_row, sink)) report.lost_non_finite = true;
        });
        file.check();
        if (progress) progress({"mips", double(step + 1), double(stream.steps())});
    };
    run_pipeline(stream.steps(), {{read}, {filter, true}}, parallel);
    report.filter -= report.write;  // which is done in between
    watch.time(report.write, [&] { file.commit(); });
    return report;
}

}  // namespace bandlimit::job
