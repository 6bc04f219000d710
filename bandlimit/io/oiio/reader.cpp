// Reading through OpenImageIO.
#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <variant>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/oiio/oiio.h"

namespace bandlimit::oiio {
namespace {

/// More pictures or levels than this in one file are not counted.
constexpr int most_counted = 4096;

/// Divides the colour of 8-bit RGBA by its alpha: the inverse of what OpenImageIO does to WebP.
void divide_by_alpha(std::span<std::uint8_t> pixels) {
    for (std::size_t i = 0; i + 3 < pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned alpha = pixels[i + 3];
            if (alpha != 0)
                pixels[i + c] = static_cast<std::uint8_t>(std::min(255u, (pixels[i + c] * 255u + alpha / 2) / alpha));
        }
}

int rows_at_once(const OIIO::ImageSpec& spec, const std::string& format) {
    constexpr int exr_block_rows = 256;  // of dwab, the largest
    int rows = 1;
    if (spec.tile_width > 0) rows = spec.tile_height;
    else if (format == "webp") rows = spec.height;
    else if (format == "openexr") rows = exr_block_rows;
    else if (format == "tiff") rows = spec.get_int_attribute("tiff:RowsPerStrip", 1);
    return std::clamp(rows, 1, spec.height);
}

class Reader {
public:
    Reader(const std::string& path, const std::string& format, int threads);

    StoredPicture picture() const;
    void read(int y, const AnyView& rows);
    Parts count_parts();

private:
    void open();
    void check_spec() const;
    template <class T>
    bool read_scanlines(int y, const View<T>& to);
    template <class T>
    bool read_tiles(int y, const View<T>& to);

    /// Turns what OpenImageIO and its codecs throw into our errors.
    template <class Work>
    auto guarded(Work work) const;

    const std::string path_, format_;
    const int threads_;
    const PoolShare pools_;
    OIIO::ImageInput::unique_ptr input_;
    OIIO::ImageSpec spec_;
    ImageInfo info_;
};

Reader::Reader(const std::string& path, const std::string& format, int threads)
    : path_(path), format_(format), threads_(threads), pools_(threads) {
    open();
    check_spec();
    info_ = info_of(spec_, format_);
}

template <class Work>
auto Reader::guarded(Work work) const {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        fail_file(path_, "needs more memory than there is; use a smaller picture or a larger machine");
    } catch (const std::exception& e) {
        fail_file(path_, "cannot be read: ", one_line(e.what()), "; the file is damaged");
    }
}

void Reader::open() {
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);
    input_ = OIIO::ImageInput::create(format_);
    if (!input_) fail_file(path_, "no reader for ", format_, " is installed; ", one_line(OIIO::geterror()));
    input_->threads(threads_);
    if (!guarded([&] { return input_->open(path_, spec_, wish); }))
        fail_file(path_, "cannot be read as ", format_, ": ", one_line(input_->geterror()),
                  "; the file is damaged or cut short");
}

void Reader::check_spec() const {
    if (spec_.deep) fail_file(path_, "is a deep image; flatten it first");
    if (spec_.depth > 1 || spec_.tile_depth > 1) fail_file(path_, "is a volume; name a flat image");
    if (spec_.width < 1 || spec_.height < 1 || spec_.nchannels < 1)
        fail_file(path_, "claims ", spec_.width, " x ", spec_.height, " pixels of ", spec_.nchannels,
                  " channels; the file is damaged");
    // No codec takes a tile of 2 GiB, and few take one that long gracefully.
    constexpr std::uint64_t largest_tile = std::numeric_limits<std::int32_t>::max();
    if (spec_.tile_width < 0 || spec_.tile_height < 0 || (spec_.tile_width > 0) != (spec_.tile_height > 0) ||
        spec_.tile_bytes() > largest_tile)
        fail_file(path_, "claims tiles of ", spec_.tile_width, " x ", spec_.tile_height,
                  " pixels; the file is damaged");
}

StoredPicture Reader::picture() const {
    return {.info = info_,
            .tile_width = spec_.tile_width,
            .tile_height = spec_.tile_height,
            .rows_at_once = rows_at_once(spec_, format_),
            .compression = spec_.get_string_attribute("compression"),
            .metadata = std::make_shared<const OIIO::ParamValueList>(spec_.extra_attribs)};
}

Parts Reader::count_parts() {
    Parts parts;
    if (format_ != "tiff" && format_ != "openexr") return parts;
    guarded([&] {
        while (parts.levels < most_counted && input_->seek_subimage(0, parts.levels)) ++parts.levels;
        while (parts.subimages < most_counted && input_->seek_subimage(parts.subimages, 0)) ++parts.subimages;
        return true;
    });
    input_->close();
    open();
    return parts;
}

template <class T>
bool Reader::read_scanlines(int y, const View<T>& to) {
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    const int first = spec_.y + y, end = first + to.height;
    const OIIO::TypeDesc type = type_of(info_.depth);
    const bool has_gaps = to.height > 1 && to.dy != to.dx * to.width;
    // What needs no conversion goes straight to its place. OpenImageIO would read it into 64 MB that it takes at every
    // call, and copy it.
    const bool is_native = spec_.format == type && spec_.channelformats.empty() && !has_gaps;
    const bool is_read =
        is_native ? input_->read_native_scanlines(0, 0, first, end, spec_.z, to.data)
                  : input_->read_scanlines(0, 0, first, end, spec_.z, 0, spec_.nchannels, type, to.data, size * to.dx,
                                           to.height > 1 ? size * to.dy : size * to.dx * to.width);
    if (!is_read) return false;
    if constexpr (std::is_same_v<T, std::uint8_t>)
        if (format_ == "webp" && spec_.nchannels == 4)
            for (int row = 0; row < to.height; ++row)
                divide_by_alpha({&to(0, row), static_cast<std::size_t>(to.width) * 4});
    return true;
}

/// Reads a row of tiles, whose first row is `y`, some tiles at a time.
template <class T>
bool Reader::read_tiles(int y, const View<T>& to) {
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    const int columns = tile_columns_at_once(spec_);
    for (int x = 0, end = 0; x < to.width; x = end) {
        end = columns < to.width - x ? x + columns : to.width;
        if (!input_->read_tiles(0, 0, spec_.x + x, spec_.x + end, spec_.y + y, spec_.y + y + to.height, spec_.z,
                                spec_.z + 1, 0, spec_.nchannels, type_of(info_.depth), &to(x, 0), size * to.dx,
                                size * to.dy))
            return false;
    }
    return true;
}

void Reader::read(int y, const AnyView& rows) {
    const bool is_tiled = spec_.tile_width > 0;
    std::visit(
        [&](const auto& to) {
            const bool is_read = guarded([&] { return is_tiled ? read_tiles(y, to) : read_scanlines(y, to); });
            // Codecs that go on after an error, with grey for what is missing, leave only the message.
            if (!is_read || input_->has_error())
                fail_file(path_, is_tiled ? "the tiles of rows " : "rows ", y, " to ", y + to.height - 1,
                          " cannot be read: ", one_line(input_->geterror()), "; the file is damaged or cut short");
        },
        rows);
}

}  // namespace

Decoder decode(const std::string& path, const std::string& format, int threads) {
    const auto reader = std::make_shared<Reader>(path, format, threads);
    return {.picture = reader->picture(),
            .read = [reader](int y, const AnyView& rows) { reader->read(y, rows); },
            .count_parts = [reader] { return reader->count_parts(); }};
}

}  // namespace bandlimit::oiio
