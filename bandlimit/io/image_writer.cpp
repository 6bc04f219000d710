#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <optional>
#include <type_traits>

#include <OpenImageIO/filesystem.h>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/oiio.h"
#include "bandlimit/io/packed.h"
#include "bandlimit/io/pnm.h"

namespace bandlimit {
namespace {

/// What OpenImageIO writes through, so that every failure of the disk reaches us: its own files close silently, and
/// libjpeg, given a stdio file, ends the process when that is full. TIFF cannot be written so: OpenImageIO 2.4 does not
/// let libtiff read back what it wrote, and the Exif directory, which tells sRGB, needs that.
class Output final : public OIIO::Filesystem::IOProxy {
public:
    Output(const std::string& name, AtomicFile& file) : IOProxy(name, Write), file_(file) {}
    const char* proxytype() const override { return "bandlimit"; }
    std::int64_t tell() override { return file_.tell(); }
    bool seek(std::int64_t offset) override { return file_.seek(offset); }
    std::size_t read(void* data, std::size_t size) override { return file_.read(data, size); }
    std::size_t write(const void* data, std::size_t size) override { return file_.write(data, size); }
    std::size_t size() const override { return static_cast<std::size_t>(file_.size()); }

private:
    AtomicFile& file_;
};

/// Metadata that tell how the old file was stored, or that we decide ourselves.
bool belongs_to_old_file(const std::string& name) {
    constexpr std::array<std::string_view, 14> families{
        "oiio:", "tiff:", "openexr:", "png:", "jpeg:",      "bmp:",      "targa:",
        "hdr:",  "pnm:",  "webp:",    "exr",  "ICCProfile", "thumbnail", "textureformat"};
    constexpr std::array<std::string_view, 14> names{"Orientation",
                                                     "compression",
                                                     "CompressionQuality",
                                                     "planarconfig",
                                                     "wrapmodes",
                                                     "fovcot",
                                                     "Software",
                                                     "ImageWidth",
                                                     "ImageLength",
                                                     "Exif:PixelXDimension",
                                                     "Exif:PixelYDimension",
                                                     "Exif:ColorSpace",
                                                     "chunkCount",
                                                     "name"};
    const auto begins = [&](std::string_view family) { return OIIO::Strutil::istarts_with(name, family); };
    const auto is = [&](std::string_view known) { return OIIO::Strutil::iequals(name, known); };
    return std::any_of(families.begin(), families.end(), begins) || std::any_of(names.begin(), names.end(), is);
}

/// Whether a profile is made for so many colour channels: its header names its colour space at byte 16.
bool fits_profile(std::string_view profile, int colours) {
    return profile.size() >= 20 && profile.substr(16, 4) == (colours == 1 ? "GRAY" : "RGB ");
}

void take_over(const ImageReader::Metadata& metadata, const ImageTarget& target, OIIO::ImageSpec& spec) {
    for (const OIIO::ParamValue& attribute : metadata.attributes)
        if (!belongs_to_old_file(attribute.name().string())) spec.extra_attribs.push_back(attribute);
    // A profile belongs to codes: where those have become linear light, or were none at all, it would be wrong.
    const int colours = spec.nchannels - (spec.alpha_channel >= 0 ? 1 : 0);
    if (!target.is_data && target.transfer == metadata.transfer &&
        fits_profile(profile_in(metadata.attributes), colours))
        spec.extra_attribs.push_back(*metadata.attributes.find("ICCProfile"));
}

/// The channel that the file will show as alpha: the target's, or, where that is filtered as data, the one so named.
int alpha_in_file(const ImageTarget& target) {
    if (target.alpha >= 0) return target.alpha;
    for (std::size_t c = 0; c < target.channel_names.size(); ++c)
        if (OIIO::Strutil::iequals(target.channel_names[c], "A") ||
            OIIO::Strutil::iequals(target.channel_names[c], "alpha"))
            return static_cast<int>(c);
    return -1;
}

/// What the codes are, where the format can say so and no profile says it better: PNG holds one or the other.
void note_space(const ImageTarget& target, const FormatAbilities& format, OIIO::ImageSpec& spec) {
    const bool is_srgb = target.transfer == Transfer::srgb;
    const bool has_profile = spec.find_attribute("ICCProfile") != nullptr;
    const bool is_noted = !target.is_data && !has_profile;
    // TIFF says sRGB by Exif, and has no word for linear but Exif's "uncalibrated". It needs one of them: OpenImageIO
    // fails on an Exif directory that is empty.
    constexpr int uncalibrated = 0xffff;
    if (is_noted && (is_srgb || format.name != "tiff")) spec.attribute("oiio:ColorSpace", is_srgb ? "sRGB" : "Linear");
    else if (format.name == "tiff") spec.attribute("Exif:ColorSpace", uncalibrated);
}

OIIO::ImageSpec spec_of(const ImageTarget& target, const FormatAbilities& format) {
    OIIO::ImageSpec spec(target.width, target.height, static_cast<int>(target.channel_names.size()),
                         type_of(target.depth));
    spec.channelnames = target.channel_names;
    spec.alpha_channel = alpha_in_file(target);
    spec.z_channel = -1;
    spec.tile_width = spec.tile_height = target.tile;
    if (target.metadata != nullptr) take_over(*target.metadata, target, spec);
    spec.attribute("Orientation", 1);
    if (!format.associated) spec.attribute("oiio:UnassociatedAlpha", 1);
    note_space(target, format, spec);
    // Else TIFF and EXR get the time of day, and the same pixels would never make the same file twice.
    if (spec.find_attribute("DateTime") == nullptr) spec.attribute("DateTime", "");
    if (format.name == "jpeg") {
        spec.attribute("Compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    if (format.name == "tiff" || format.name == "openexr") spec.attribute("compression", "zip");
    return spec;
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

/// libtiff writes rows first and then what makes them a file, and of the latter no failure is reported.
bool is_whole_tiff(const std::string& path, const ImageTarget& target) {
    const auto in = OIIO::ImageInput::create("tiff");
    OIIO::ImageSpec spec;
    if (!in || !in->open(path, spec)) return false;
    if (spec.width != target.width || spec.height != target.height) return false;
    const int x = target.width - 1, y = target.height - 1;
    std::vector<std::byte> last(target.tile > 0 ? spec.tile_bytes() : spec.scanline_bytes());
    const bool is_read = target.tile > 0
                             ? in->read_tile(x - x % target.tile, y - y % target.tile, 0, spec.format, last.data())
                             : in->read_scanline(y, 0, spec.format, last.data());
    return is_read && !in->has_error();
}

}  // namespace

struct ImageWriter::State {
    State(const std::string& path_to_write, const ImageTarget& wanted, int threads);
    ~State();

    template <class T>
    void write(const View<const T>& rows);
    void finish();

    std::string path;
    ImageTarget target;
    Encoding encoding;
    int next_row = 0;

private:
    template <class Work>
    void guarded(Work work);
    template <class T>
    void write_scanlines(const View<const T>& rows);
    template <class T>
    void write_tiled(const View<const T>& rows);
    template <class T>
    void write_tiles(const View<const T>& rows, int y);

    std::optional<AtomicFile> file_;
    std::optional<Output> proxy_;
    OIIO::ImageOutput::unique_ptr output_;  ///< null for PNM
    PnmLayout pnm_;
    bool is_tiff_ = false;
    AnyImage tile_row_;  ///< rows that wait for the rest of their tiles
};

ImageWriter::State::State(const std::string& path_to_write, const ImageTarget& wanted, int threads)
    : path(path_to_write), target(wanted) {
    check_output_path(path);
    const FormatAbilities format = abilities_of(path);
    check_target(path, target, format);
    const bool is_linear = format.is_linear || target.is_data;
    encoding = {is_linear ? Transfer::linear : target.transfer, target.alpha, format.associated};
    target.transfer = encoding.transfer;

    file_.emplace(path);
    if (format.name == "pnm") {
        pnm_ = write_pnm_header(*file_, target.width, target.height, static_cast<int>(target.channel_names.size()),
                                target.depth);
        return;
    }
    if (target.tile > 0) {
        const auto channels = target.channel_names.size();
        require_memory(saturating_product(static_cast<std::uint64_t>(target.width) * channels,
                                          static_cast<std::uint64_t>(target.tile) * size_of(target.depth)),
                       path);
        tile_row_ = make_image(target.depth, target.width, target.tile, static_cast<int>(channels));
    }
    use_threads(threads);
    output_ = OIIO::ImageOutput::create(format.name);
    if (!output_) fail_file(path, "no writer for ", format.name, " is installed; ", one_line(OIIO::geterror()));
    output_->threads(threads);
    is_tiff_ = format.name == "tiff";
    if (!is_tiff_) {
        proxy_.emplace(path, *file_);
        output_->set_ioproxy(&*proxy_);
    }
    guarded([&] {
        const FileMaking making;
        return output_->open(is_tiff_ ? file_->unfinished() : path, spec_of(target, format));
    });
    target.metadata = nullptr;  // the caller may drop it now
}

ImageWriter::State::~State() {
    // An abandoned file: some codecs complain about missing rows, which is no news.
    try {
        if (output_) output_->close();
    } catch (const std::exception&) {
    }
}

/// Runs what returns whether all is well, and turns every way of failing into our error, the disk's own reason first.
template <class Work>
void ImageWriter::State::guarded(Work work) {
    bool is_well = false;
    std::string reason;
    try {
        is_well = work();
        is_well = is_well && (!output_ || !output_->has_error());
        if (!is_well && output_) reason = output_->geterror();
    } catch (const std::bad_alloc&) {
        fail_file(path, "writing needs more memory than there is; use a smaller picture or a larger machine");
    } catch (const std::exception& e) {
        reason = e.what();
    }
    file_->check();
    if (!is_well) fail_file(path, "cannot be written: ", one_line(reason), "; choose another format or place");
}

template <class T>
void ImageWriter::State::write_scanlines(const View<const T>& rows) {
    if (!is_packed(rows)) {
        std::vector<T> packed(static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.channels));
        const View<T> row = packed_view(packed.data(), rows.width, 1, rows.channels);
        for (int y = 0; y < rows.height; ++y) {
            copy_samples(cropped(rows, 0, y, rows.width, 1), row);
            guarded([&] { return output_->write_scanline(next_row + y, 0, type_of(target.depth), row.data); });
        }
        return;
    }
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    guarded([&] {
        return output_->write_scanlines(next_row, next_row + rows.height, 0, type_of(target.depth), rows.data,
                                        size * rows.dx, size * rows.dy);
    });
}

/// Collects rows until they make a row of tiles.
template <class T>
void ImageWriter::State::write_tiled(const View<const T>& rows) {
    const View<T> held = std::get<Image<T>>(tile_row_).view();
    for (int done = 0; done < rows.height;) {
        const int y = next_row + done, above = y % target.tile;
        const int count = std::min(rows.height - done, target.tile - above);
        copy_samples(cropped(rows, 0, done, rows.width, count), cropped(held, 0, above, rows.width, count));
        done += count;
        if (above + count == target.tile || y + count == target.height)
            write_tiles<T>(cropped(held, 0, 0, rows.width, above + count), y - above);
    }
}

/// Writes a row of tiles, whose first row is `y`, some tiles at a time.
template <class T>
void ImageWriter::State::write_tiles(const View<const T>& rows, int y) {
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    const int columns = tile_columns_at_once(output_->spec());
    for (int x = 0, end = 0; x < rows.width; x = end) {
        end = columns < rows.width - x ? x + columns : rows.width;
        guarded([&] {
            return output_->write_tiles(x, end, y, y + rows.height, 0, 1, type_of(target.depth), &rows(x, 0),
                                        size * rows.dx, size * rows.dy);
        });
    }
}

template <class T>
void ImageWriter::State::write(const View<const T>& rows) {
    if (!output_) {
        write_pnm_rows(*file_, pnm_, next_row, rows);
        file_->check();
    } else if (target.tile > 0) {
        write_tiled(rows);
    } else {
        write_scanlines(rows);
    }
    next_row += rows.height;
}

void ImageWriter::State::finish() {
    if (next_row != target.height)
        fail("ImageWriter: ", path, ": finish() after ", next_row, " of ", target.height, " rows; write them all");
    if (output_) guarded([&] { return output_->close(); });
    if (is_tiff_) guarded([&] { return is_whole_tiff(file_->unfinished(), target); });
    output_.reset();
    proxy_.reset();
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
