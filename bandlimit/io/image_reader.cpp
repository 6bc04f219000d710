#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>
#include <utility>
#include <variant>
#include <vector>

#include "bandlimit/core/file_error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/io/codecs.h"
#include "bandlimit/io/orientation.h"
#include "bandlimit/io/packed.h"
#include "bandlimit/io/pnm.h"
#include "bandlimit/io/probe.h"

namespace bandlimit {
namespace {

Decoder open_decoder(const std::string& path, const Probe& found, int threads) {
    require_memory(found.memory_to_open, path);
    if (found.format == "pnm")
        if (const auto layout = find_pnm_of_16_bits(path)) return decode_pnm(path, *layout);
    return oiio_codecs().decode(path, found.format, threads);
}

}  // namespace

struct ImageReader::State {
    State(const std::string& path_to_read, int threads);

    /// The stored rows [y, y + to.height), as they are stored.
    template <class T>
    void read_stored(int y, const View<T>& to);
    /// The upright rows.
    template <class T>
    void read_upright(int y, const View<T>& to);

    std::string path;
    Probe found;
    Decoder decoder;
    StoredPicture& stored;
    ImageInfo& info;
    Metadata metadata;
    int width, height;  ///< of the stored picture

private:
    void check_sizes() const;
    template <class Work>
    auto with_memory(Work work);
    template <class T>
    View<T> held_rows(int count);
    template <class T>
    View<const T> tile_row(int y);
    template <class T>
    Image<T>& whole();

    std::vector<std::byte> rows_;  ///< the tile row read last, or rows on their way to a view that is not packed
    int first_tile_row_ = -1;      ///< the first row in rows_ if it holds a tile row
    AnyImage whole_;               ///< the stored picture, if it is upside down or sideways
    bool has_whole_ = false;
};

ImageReader::State::State(const std::string& path_to_read, int threads)
    : path(path_to_read),
      found(probe(path_to_read)),
      decoder(open_decoder(path, found, threads)),
      stored(decoder.picture),
      info(stored.info),
      metadata{stored.metadata, info.transfer},
      width(is_sideways(info.orientation) ? info.height : info.width),
      height(is_sideways(info.orientation) ? info.width : info.height) {
    check_sizes();
    const Parts parts = decoder.count_parts();
    info.levels = parts.levels, info.subimages = parts.subimages;
}

/// Allocates, and says in words where memory ends.
template <class Work>
auto ImageReader::State::with_memory(Work work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        fail_file(path, "needs more memory than there is; use a smaller picture or a larger machine");
    }
}

void ImageReader::State::check_sizes() const {
    const bool is_tiled = stored.tile_width > 0;
    const std::uint64_t pixel_bytes = static_cast<std::uint64_t>(info.channels()) * size_of(info.depth);
    const std::uint64_t row_bytes = saturating_product(static_cast<std::uint64_t>(width), pixel_bytes);
    const std::uint64_t tile_pixels = static_cast<std::uint64_t>(stored.tile_width) * stored.tile_height;
    const std::uint64_t tile_bytes = is_tiled ? saturating_product(tile_pixels, pixel_bytes) : 0;
    std::uint64_t claimed = saturating_product(static_cast<std::uint64_t>(height), row_bytes);
    if (found.format == "tiff") claimed = std::max(claimed, tile_bytes);  // which stores even a single tile whole
    const std::uint64_t expansion = largest_expansion(found.format, stored.compression, row_bytes);
    if (expansion > 0 && claimed / expansion > found.bytes)
        fail_file(path, "claims ", width, " x ", height, " pixels",
                  is_tiled ? message(" in tiles of ", stored.tile_width, " x ", stored.tile_height) : "",
                  ", for which its ", found.bytes, " bytes are too few; the file is damaged or cut short");
    // A codec holds what it reads at once up to three times: compressed, decoded, and in order.
    const std::uint64_t copies = is_tiled ? 3 * std::max(tile_bytes, std::min(bytes_at_once, row_bytes)) : 0;
    const int rows_at_once = found.is_interlaced ? height : stored.rows_at_once;
    const std::uint64_t rows = saturating_product(row_bytes, static_cast<std::uint64_t>(rows_at_once));
    require_memory(rows > std::numeric_limits<std::uint64_t>::max() - copies ? rows : rows + copies, path);
}

/// The first `count` rows of what rows_ has room for.
template <class T>
View<T> ImageReader::State::held_rows(int count) {
    const std::size_t row_samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(info.channels());
    with_memory([&] { return rows_.resize(row_samples * static_cast<std::size_t>(count) * sizeof(T)), true; });
    return packed_view(reinterpret_cast<T*>(rows_.data()), width, count, info.channels());
}

template <class T>
View<const T> ImageReader::State::tile_row(int y) {
    const int first = y - y % stored.tile_height;
    const View<T> rows = held_rows<T>(std::min(stored.tile_height, height - first));
    if (first != first_tile_row_) {
        first_tile_row_ = -1;
        decoder.read(first, rows);
        first_tile_row_ = first;
    }
    return rows;
}

template <class T>
void ImageReader::State::read_stored(int y, const View<T>& to) {
    const bool is_tiled = stored.tile_width > 0;
    if (!is_tiled && is_packed(to)) return decoder.read(y, to);

    for (int done = 0; done < to.height;) {
        View<const T> rows;
        int skipped = 0;
        if (is_tiled) {
            rows = tile_row<T>(y + done);
            skipped = (y + done) % stored.tile_height;
        } else {
            const View<T> row = held_rows<T>(1);
            decoder.read(y + done, row);
            rows = row;
        }
        const int count = std::min(rows.height - skipped, to.height - done);
        copy_samples(cropped(rows, 0, skipped, to.width, count), cropped(to, 0, done, to.width, count));
        done += count;
    }
}

template <class T>
Image<T>& ImageReader::State::whole() {
    if (!has_whole_) {
        require_memory(saturating_product(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height),
                                          static_cast<std::uint64_t>(info.channels()) * sizeof(T)),
                       path);
        whole_ = with_memory([&] { return Image<T>(width, height, info.channels(), Layout::interleaved); });
        read_stored(0, std::get<Image<T>>(whole_).view());
        has_whole_ = true;
    }
    return std::get<Image<T>>(whole_);
}

template <class T>
void ImageReader::State::read_upright(int y, const View<T>& to) {
    if (keeps_rows(info.orientation)) return read_stored(y, info.orientation == 2 ? flipped_x(to) : to);
    const View<const T> picture = std::as_const(whole<T>()).view();
    copy_samples(cropped(upright(picture, info.orientation), 0, y, to.width, to.height), to);
}

ImageReader::ImageReader(const std::string& path, int threads) : state_(std::make_unique<State>(path, threads)) {}
ImageReader::~ImageReader() = default;
ImageReader::ImageReader(ImageReader&&) noexcept = default;
ImageReader& ImageReader::operator=(ImageReader&&) noexcept = default;

const ImageInfo& ImageReader::info() const { return state_->info; }
const ImageReader::Metadata& ImageReader::metadata() const { return state_->metadata; }

void ImageReader::read_rows(int y, const AnyView& view) {
    const ImageInfo& picture = info();
    if (depth_of(const_view(view)) != picture.depth)
        fail("read_rows: the view holds ", name_of(depth_of(const_view(view))), "; pass ", name_of(picture.depth));
    std::visit(
        [&](const auto& to) {
            if (to.width != picture.width || to.channels != picture.channels() || y < 0 || to.height < 0 ||
                to.height > picture.height - y)
                fail("read_rows: rows ", y, " to ", y + to.height, " of ", to.width, " pixels of ", to.channels,
                     " channels; the picture has ", picture.height, " rows of ", picture.width, " of ",
                     picture.channels());
            if (to.height > 0) state_->read_upright(y, to);
        },
        view);
}

}  // namespace bandlimit
