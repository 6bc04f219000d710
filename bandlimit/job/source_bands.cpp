#include "bandlimit/job/source_bands.h"

#include <algorithm>

namespace bandlimit::job {
namespace {

void copy_rows(const AnyImage& from, int first, int count, AnyImage& to) {
    std::visit(
        [&](auto& image) {
            const auto v = image.view();
            const auto kept = std::get<std::decay_t<decltype(image)>>(from).view();
            std::copy_n(&kept(0, first), count * v.dy, &v(0, 0));
        },
        to);
}

}  // namespace

SourceBands::SourceBands(ImageReader& reader, int capacity)
    : reader_(reader), is_whole_(capacity == reader.info().height) {
    const ImageInfo& in = reader.info();
    bands_.resize(is_whole_ ? 1 : 2);
    for (Band& band : bands_) band.image = make_image(in.depth, in.width, capacity, in.channels());
}

std::uint64_t SourceBands::bytes(const ImageInfo& info, int capacity) {
    const std::uint64_t copies = capacity == info.height ? 1 : 2;
    return copies * static_cast<std::uint64_t>(capacity) * static_cast<std::uint64_t>(info.width) *
           info.channel_names.size() * size_of(info.depth);
}

void SourceBands::load(int i, IndexRange range) {
    Band& band = of(i);
    if (is_whole_) {
        if (i == 0) read(band, {0, reader_.info().height}, 0);
        return;
    }
    const Band& last = of(i + 1);
    const int kept =
        range.begin >= last.rows.begin ? std::clamp(last.rows.end - range.begin, 0, range.end - range.begin) : 0;
    if (kept > 0) copy_rows(last.image, range.begin - last.rows.begin, kept, band.image);
    read(band, range, kept);
}

SourceRows SourceBands::rows(int i, const Encoding& encoding) {
    Band& band = of(i);
    return {const_view(rows_of(view_of(band.image), 0, band.rows.end - band.rows.begin)), band.rows.begin, encoding};
}

/// Makes rows [range) the content of `band`, which holds the first `kept` of them.
void SourceBands::read(Band& band, IndexRange range, int kept) {
    const int missing = range.end - range.begin - kept;
    if (missing > 0) reader_.read_rows(range.begin + kept, rows_of(view_of(band.image), kept, missing));
    band.rows = range;
}

}  // namespace bandlimit::job
