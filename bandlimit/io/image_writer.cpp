#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/codecs.h"
#include "bandlimit/io/packed.h"
#include "bandlimit/io/pnm.h"

namespace bandlimit {
namespace {

/// The channel that the file will show as alpha: the target's, or, where that is filtered as data, the one so named.
int alpha_in_file(const ImageTarget& target) {
    if (target.alpha >= 0) return target.alpha;
    for (std::size_t c = 0; c < target.channel_names.size(); ++c)
        if (const std::string name = lower_case(target.channel_names[c]); name == "a" || name == "alpha")
            return static_cast<int>(c);
    return -1;
}

void check_target(const std::string& path, const ImageTarget& target, const FormatAbilities& format) {
    const int channels = static_cast<int>(target.channel_names.size());
    if (target.width < 1 || target.height < 1)
        fail("ImageWriter: ", path, ": ", target.width, " x ", target.height, " pixels; pass at least 1 x 1");
    if (channels < 1) fail("ImageWriter: ", path, ": no channels; name at least one");
    if (target.alpha < -1 || target.alpha >= channels)
        fail("ImageWriter: ", path, ": alpha = ", target.alpha, "; pass a channel below ", channels, " or -1");
    if (std::find(format.depths.begin(), format.depths.end(), target.depth) == format.depths.end())
        fail_file(path, format.name, " holds no ", name_of(target.depth), "; choose ",
                  name_of(nearest_depth(format, target.depth)), " or another format");
    if (format.largest_side > 0 && std::max(target.width, target.height) > format.largest_side)
        fail_file(path, format.name, " holds at most ", format.largest_side, " pixels a side, not ", target.width,
                  " x ", target.height, "; choose TIFF or EXR");
    check_tile(format, target.tile);
    if (target.alpha >= 0 && !format.alpha)
        fail_file(path, format.name, " is written without alpha; give a background colour, or write PNG, TIFF or EXR");
    const bool is_held = format.channels.empty() ? channels <= format.largest_channels
                                                 : std::find(format.channels.begin(), format.channels.end(),
                                                             channels) != format.channels.end();
    if (!is_held) fail_file(path, format.name, " does not hold ", channels, " channels; choose TIFF or EXR");
    const bool has_implied_alpha = !format.channels.empty() && channels % 2 == 0;
    if (has_implied_alpha && alpha_in_file(target) != channels - 1 && !target.is_data)
        fail_file(path, "the last of ", channels, " channels of ", format.name,
                  " is alpha, and here it is not; choose TIFF or EXR");
}

}  // namespace

struct ImageWriter::State {
    State(const std::string& path_to_write, const ImageTarget& wanted, int threads);

    template <class T>
    void write(const View<const T>& rows);
    void finish();

    std::string path;
    ImageTarget target;
    Encoding encoding;
    int next_row = 0;

private:
    template <class Work>
    void checked(Work work);
    template <class T>
    void write_scanlines(const View<const T>& rows);
    template <class T>
    void write_tiled(const View<const T>& rows);
    Destination destination();

    std::optional<AtomicFile> file_;
    std::optional<PnmLayout> pnm_;
    Encoder encoder_;    ///< empty for PNM
    AnyImage tile_row_;  ///< whole tiles: rows that wait for the rest of theirs
};

ImageWriter::State::State(const std::string& path_to_write, const ImageTarget& wanted, int threads)
    : path(path_to_write), target(wanted) {
    check_output_path(path);
    const FormatAbilities format = abilities_of(path);
    check_target(path, target, format);
    const bool is_linear = format.is_linear || target.is_data;
    encoding = {is_linear ? Transfer::linear : target.transfer, target.alpha, format.associated};
    target.transfer = encoding.transfer;
    const int channels = static_cast<int>(target.channel_names.size());

    file_.emplace(path);
    if (format.name == "pnm") {
        pnm_ = write_pnm_header(*file_, target.width, target.height, channels, target.depth);
        return;
    }
    if (target.tile > 0) {
        if (target.width > std::numeric_limits<int>::max() - target.tile)
            fail_file(path, target.width, " pixels are too wide for tiles of ", target.tile, "; store rows");
        const int width = (target.width + target.tile - 1) / target.tile * target.tile;
        require_memory(saturating_product(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(channels),
                                          static_cast<std::uint64_t>(target.tile) * size_of(target.depth)),
                       path);
        tile_row_ = make_image(target.depth, width, target.tile, channels);
    }
    ImageTarget in_file = target;
    in_file.alpha = alpha_in_file(target);
    const Codecs& codecs = oiio_codecs();
    checked([&] {
        const FileMaking making;  // a codec that opens the file by itself must not do so after it was removed
        encoder_ = codecs.encode(destination(), in_file, format, threads);
    });
    target.metadata = nullptr;  // the caller may drop it now
}

Destination ImageWriter::State::destination() {
    AtomicFile* const file = &*file_;
    return {.path = path,
            .unfinished = file->unfinished(),
            .tell = [file] { return file->tell(); },
            .size = [file] { return file->size(); },
            .seek = [file](std::int64_t offset) { return file->seek(offset); },
            .read = [file](void* data, std::size_t size) { return file->read(data, size); },
            .write = [file](const void* data, std::size_t size) { return file->write(data, size); }};
}

/// Where writing fails, the disk's own reason comes first.
template <class Work>
void ImageWriter::State::checked(Work work) {
    try {
        work();
    } catch (const std::exception&) {
        file_->check();
        throw;
    }
    file_->check();
}

template <class T>
void ImageWriter::State::write_scanlines(const View<const T>& rows) {
    if (is_packed(rows)) return checked([&] { encoder_.write(next_row, rows); });
    std::vector<T> packed(static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.channels));
    const View<T> row = packed_view(packed.data(), rows.width, 1, rows.channels);
    for (int y = 0; y < rows.height; ++y) {
        copy_samples(cropped(rows, 0, y, rows.width, 1), row);
        checked([&] { encoder_.write(next_row + y, View<const T>(row)); });
    }
}

/// Collects rows until they make a row of tiles. Beyond the picture the tiles are 0: what a codec would leave there is
/// what happened to be in memory.
template <class T>
void ImageWriter::State::write_tiled(const View<const T>& rows) {
    const View<T> held = std::get<Image<T>>(tile_row_).view();
    for (int done = 0; done < rows.height;) {
        const int y = next_row + done, above = y % target.tile;
        const int count = std::min(rows.height - done, target.tile - above);
        copy_samples(cropped(rows, 0, done, rows.width, count), cropped(held, 0, above, rows.width, count));
        done += count;
        if (y + count == target.height)
            for (int i = above + count; i < held.height; ++i)
                std::fill_n(&held(0, i), static_cast<std::ptrdiff_t>(held.width) * held.channels, T());
        if (above + count == target.tile || y + count == target.height)
            checked([&] { encoder_.write(y - above, View<const T>(held)); });
    }
}

template <class T>
void ImageWriter::State::write(const View<const T>& rows) {
    if (pnm_) checked([&] { write_pnm_rows(*file_, *pnm_, next_row, rows); });
    else if (target.tile > 0) write_tiled(rows);
    else write_scanlines(rows);
    next_row += rows.height;
}

void ImageWriter::State::finish() {
    if (next_row != target.height)
        fail("ImageWriter: ", path, ": finish() after ", next_row, " of ", target.height, " rows; write them all");
    if (encoder_.close) checked([&] { encoder_.close(); });
    encoder_ = {};
    file_->commit();
}

ImageWriter::ImageWriter(const std::string& path, const ImageTarget& target, int threads)
    : state_(std::make_unique<State>(path, target, threads)) {}
ImageWriter::~ImageWriter() = default;
ImageWriter::ImageWriter(ImageWriter&&) noexcept = default;
ImageWriter& ImageWriter::operator=(ImageWriter&&) noexcept = default;

const Encoding& ImageWriter::encoding() const { return state_->encoding; }

void ImageWriter::write_rows(const AnyConstView& view) {
    const ImageTarget& target = state_->target;
    const int channels = static_cast<int>(target.channel_names.size());
    if (depth_of(view) != target.depth)
        fail("write_rows: the view holds ", name_of(depth_of(view)), "; pass ", name_of(target.depth));
    std::visit(
        [&](const auto& rows) {
            if (rows.width != target.width || rows.channels != channels || rows.height < 0 ||
                rows.height > target.height - state_->next_row)
                fail("write_rows: ", rows.height, " rows of ", rows.width, " pixels of ", rows.channels, " channels; ",
                     target.height - state_->next_row, " rows of ", target.width, " of ", channels, " are left");
            if (rows.height > 0) state_->write(rows);
        },
        view);
}

void ImageWriter::finish() { state_->finish(); }

}  // namespace bandlimit
