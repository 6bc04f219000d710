#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "bandlimit/core/file_error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/io/oiio.h"
#include "bandlimit/io/orientation.h"
#include "bandlimit/io/packed.h"
#include "bandlimit/io/pnm.h"
#include "bandlimit/io/probe.h"

namespace bandlimit {
namespace {

/// Divides the colour of 8-bit RGBA by its alpha: the inverse of what OpenImageIO does to WebP.
void divide_by_alpha(std::span<std::uint8_t> pixels) {
    for (std::size_t i = 0; i + 3 < pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned alpha = pixels[i + 3];
            if (alpha != 0)
                pixels[i + c] = static_cast<std::uint8_t>(std::min(255u, (pixels[i + c] * 255u + alpha / 2) / alpha));
        }
}

/// Rows that a codec decodes together.
int rows_at_once(const OIIO::ImageSpec& spec, const Probe& found) {
    constexpr int exr_block_rows = 256;  // of dwab, the largest
    int rows = 1;
    if (spec.tile_width > 0) rows = spec.tile_height;
    else if (found.is_interlaced || found.format == "webp") rows = spec.height;
    else if (found.format == "openexr") rows = exr_block_rows;
    else if (found.format == "tiff") rows = spec.get_int_attribute("tiff:RowsPerStrip", 1);
    return std::clamp(rows, 1, spec.height);
}

/// More pictures or levels than this in one file are not counted.
constexpr int most_counted = 4096;

}  // namespace

struct ImageReader::State {
    State(const std::string& path_to_read, int threads_to_use);

    /// The stored rows [y, y + to.height), as they are stored.
    template <class T>
    void read_stored(int y, const View<T>& to);
    /// The upright rows.
    template <class T>
    void read_upright(int y, const View<T>& to);

    std::string path;
    int threads;
    Probe found;
    OIIO::ImageInput::unique_ptr input;
    OIIO::ImageSpec spec;            ///< the stored picture
    std::optional<PnmLayout> pnm16;  ///< where we read the pixels ourselves
    ImageInfo info;
    Metadata metadata;

private:
    void open();
    void check_spec() const;
    void check_sizes() const;
    void count_parts();
    template <class Work>
    auto guarded(Work work);

    template <class T>
    void read_scanlines(int y, const View<T>& to);
    template <class T>
    bool read_tiles(const View<T>& to, int y);
    template <class T>
    View<const T> tile_row(int y);
    template <class T>
    Image<T>& whole();

    std::vector<std::byte> rows_;  ///< the tile row read last, or rows on their way to a view that is not packed
    int first_tile_row_ = -1;      ///< the first row in rows_ if it holds a tile row
    AnyImage whole_;               ///< the stored picture, if it is upside down or sideways
    bool has_whole_ = false;
};

ImageReader::State::State(const std::string& path_to_read, int threads_to_use)
    : path(path_to_read), threads(threads_to_use), found(probe(path_to_read)) {
    require_memory(found.memory_to_open, path);
    use_threads(threads);
    open();
    check_spec();
    info = info_of(spec, found.format);
    check_sizes();
    if (found.format == "pnm" && info.depth == Depth::u16) pnm16 = find_pnm_of_16_bits(path);
    count_parts();
    metadata = {spec.extra_attribs, info.transfer};
}

/// Turns what OpenImageIO and its codecs throw into our errors.
template <class Work>
auto ImageReader::State::guarded(Work work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        fail_file(path, "needs more memory than there is; use a smaller picture or a larger machine");
    } catch (const std::exception& e) {
        fail_file(path, "cannot be read: ", one_line(e.what()), "; the file is damaged");
    }
}

void ImageReader::State::open() {
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);
    input = OIIO::ImageInput::create(found.format);
    if (!input) fail_file(path, "no reader for ", found.format, " is installed; ", one_line(OIIO::geterror()));
    input->threads(threads);
    if (!guarded([&] { return input->open(path, spec, wish); }))
        fail_file(path, "cannot be read as ", found.format, ": ", one_line(input->geterror()),
                  "; the file is damaged or cut short");
}

void ImageReader::State::check_spec() const {
    if (spec.deep) fail_file(path, "is a deep image; flatten it first");
    if (spec.depth > 1 || spec.tile_depth > 1) fail_file(path, "is a volume; name a flat image");
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        fail_file(path, "claims ", spec.width, " x ", spec.height, " pixels of ", spec.nchannels,
                  " channels; the file is damaged");
    // No codec takes a tile of 2 GiB, and few take one that long gracefully.
    constexpr std::uint64_t largest_tile = std::numeric_limits<std::int32_t>::max();
    if (spec.tile_width < 0 || spec.tile_height < 0 || (spec.tile_width > 0) != (spec.tile_height > 0) ||
        spec.tile_bytes() > largest_tile)
        fail_file(path, "claims tiles of ", spec.tile_width, " x ", spec.tile_height, " pixels; the file is damaged");
}

void ImageReader::State::check_sizes() const {
    const bool is_tiled = spec.tile_width > 0;
    const std::uint64_t pixel_bytes = static_cast<std::uint64_t>(spec.nchannels) * size_of(info.depth);
    const std::uint64_t row_bytes = saturating_product(static_cast<std::uint64_t>(spec.width), pixel_bytes);
    const std::uint64_t tile_pixels = static_cast<std::uint64_t>(spec.tile_width) * spec.tile_height;
    const std::uint64_t tile_bytes = is_tiled ? saturating_product(tile_pixels, pixel_bytes) : 0;
    std::uint64_t claimed = saturating_product(static_cast<std::uint64_t>(spec.height), row_bytes);
    if (found.format == "tiff") claimed = std::max(claimed, tile_bytes);  // which stores even a single tile whole
    const std::uint64_t expansion =
        largest_expansion(found.format, spec.get_string_attribute("compression"), row_bytes);
    if (expansion > 0 && claimed / expansion > found.bytes)
        fail_file(path, "claims ", spec.width, " x ", spec.height, " pixels",
                  is_tiled ? message(" in tiles of ", spec.tile_width, " x ", spec.tile_height) : "",
                  ", for which its ", found.bytes, " bytes are too few; the file is damaged or cut short");
    // OpenImageIO holds what it reads at once up to three times: compressed, decoded, and in order.
    const std::uint64_t copies = is_tiled ? 3 * std::max(tile_bytes, std::min(bytes_at_once, row_bytes)) : 0;
    const std::uint64_t rows = saturating_product(row_bytes, static_cast<std::uint64_t>(rows_at_once(spec, found)));
    require_memory(rows > std::numeric_limits<std::uint64_t>::max() - copies ? rows : rows + copies, path);
}

void ImageReader::State::count_parts() {
    if (found.format != "tiff" && found.format != "openexr") return;
    guarded([&] {
        while (info.levels < most_counted && input->seek_subimage(0, info.levels)) ++info.levels;
        while (info.subimages < most_counted && input->seek_subimage(info.subimages, 0)) ++info.subimages;
        return true;
    });
    input->close();
    open();
}

template <class T>
void ImageReader::State::read_scanlines(int y, const View<T>& to) {
    if constexpr (std::is_same_v<T, std::uint16_t>)
        if (pnm16) {
            if (!read_pnm_rows(path, *pnm16, y, to))
                fail_file(path, "rows ", y, " to ", y + to.height - 1, " are missing; the file is cut short");
            return;
        }
    const auto pixel_bytes = static_cast<OIIO::stride_t>(sizeof(T)) * to.channels;
    const auto row_bytes = to.height > 1 ? static_cast<OIIO::stride_t>(sizeof(T)) * to.dy : pixel_bytes * to.width;
    const bool is_read = guarded([&] {
        return input->read_scanlines(0, 0, spec.y + y, spec.y + y + to.height, spec.z, 0, spec.nchannels,
                                     type_of(info.depth), to.data, pixel_bytes, row_bytes);
    });
    // Codecs that go on after an error, with grey for what is missing, leave only the message.
    if (!is_read || input->has_error())
        fail_file(path, "rows ", y, " to ", y + to.height - 1, " cannot be read: ", one_line(input->geterror()),
                  "; the file is damaged or cut short");
}

/// Reads a row of tiles, whose first row is `y`, some tiles at a time.
template <class T>
bool ImageReader::State::read_tiles(const View<T>& to, int y) {
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    const int columns = tile_columns_at_once(spec);
    for (int x = 0, end = 0; x < to.width; x = end) {
        end = columns < to.width - x ? x + columns : to.width;
        if (!input->read_tiles(0, 0, spec.x + x, spec.x + end, spec.y + y, spec.y + y + to.height, spec.z, spec.z + 1,
                               0, spec.nchannels, type_of(info.depth), &to(x, 0), size * to.dx, size * to.dy))
            return false;
    }
    return true;
}

template <class T>
View<const T> ImageReader::State::tile_row(int y) {
    const int first = y - y % spec.tile_height;
    const int rows = std::min(spec.tile_height, spec.height - first);
    const auto bytes = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(rows) *
                       static_cast<std::size_t>(spec.nchannels) * sizeof(T);
    if (first != first_tile_row_) {
        first_tile_row_ = -1;
        const bool is_read = guarded([&] {
            rows_.resize(bytes);
            return read_tiles(packed_view(reinterpret_cast<T*>(rows_.data()), spec.width, rows, spec.nchannels), first);
        });
        if (!is_read || input->has_error())
            fail_file(path, "the tiles of rows ", first, " to ", first + rows - 1,
                      " cannot be read: ", one_line(input->geterror()), "; the file is damaged or cut short");
        first_tile_row_ = first;
    }
    return packed_view(reinterpret_cast<T*>(rows_.data()), spec.width, rows, spec.nchannels);
}

template <class T>
void ImageReader::State::read_stored(int y, const View<T>& to) {
    const bool is_tiled = spec.tile_width > 0, is_multiplied = found.format == "webp" && spec.nchannels == 4;
    if (!is_tiled && !is_multiplied && is_packed(to)) return read_scanlines(y, to);

    for (int done = 0; done < to.height;) {
        View<const T> rows;
        int skipped = 0;
        if (is_tiled) {
            rows = tile_row<T>(y + done);
            skipped = (y + done) % spec.tile_height;
        } else {
            const std::size_t row_samples = static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.channels);
            guarded([&] { return rows_.resize(row_samples * sizeof(T)), true; });
            const View<T> row = packed_view(reinterpret_cast<T*>(rows_.data()), to.width, 1, to.channels);
            read_scanlines(y + done, row);
            if constexpr (std::is_same_v<T, std::uint8_t>)
                if (is_multiplied) divide_by_alpha({row.data, row_samples});
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
        require_memory(
            saturating_product(static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height),
                               static_cast<std::uint64_t>(spec.nchannels) * sizeof(T)),
            path);
        whole_ = guarded([&] { return Image<T>(spec.width, spec.height, spec.nchannels, Layout::interleaved); });
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
