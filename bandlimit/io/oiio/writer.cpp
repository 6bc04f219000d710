// Writing through OpenImageIO.
#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <variant>
#include <vector>

#include <OpenImageIO/filesystem.h>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/oiio/oiio.h"

namespace bandlimit::oiio {
namespace {

/// What OpenImageIO writes through, so that every failure of the disk reaches us: its own files close silently, and
/// libjpeg, given a stdio file, ends the process when that is full. TIFF cannot be written so: OpenImageIO 2.4 does not
/// let libtiff read back what it wrote, and the Exif directory, which tells sRGB, needs that.
class Output final : public OIIO::Filesystem::IOProxy {
public:
    explicit Output(const Destination& file) : IOProxy(file.path, Write), file_(file) {}
    const char* proxytype() const override { return "bandlimit"; }
    std::int64_t tell() override { return file_.tell(); }
    bool seek(std::int64_t offset) override { return file_.seek(offset); }
    std::size_t read(void* data, std::size_t size) override { return file_.read(data, size); }
    std::size_t write(const void* data, std::size_t size) override { return file_.write(data, size); }
    std::size_t size() const override { return static_cast<std::size_t>(file_.size()); }

private:
    const Destination& file_;
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
    if (metadata.attributes == nullptr) return;
    const auto& attributes = *static_cast<const OIIO::ParamValueList*>(metadata.attributes.get());
    for (const OIIO::ParamValue& attribute : attributes)
        if (!belongs_to_old_file(attribute.name().string())) spec.extra_attribs.push_back(attribute);
    // A profile belongs to codes: where those have become linear light, or were none at all, it would be wrong.
    const int colours = spec.nchannels - (spec.alpha_channel >= 0 ? 1 : 0);
    if (!target.is_data && target.transfer == metadata.transfer && fits_profile(profile_in(attributes), colours))
        spec.extra_attribs.push_back(*attributes.find("ICCProfile"));
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
    spec.alpha_channel = target.alpha;
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
    // What OpenImageIO compresses in parallel has other bytes than what libtiff does.
    if (format.name == "tiff") spec.attribute("tiff:multithread", 0);
    return spec;
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

class Writer {
public:
    Writer(const Destination& destination, const ImageTarget& target, const FormatAbilities& format, int threads);
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void write(int y, const AnyConstView& rows);
    void close();

private:
    template <class Work>
    void guarded(Work work);
    template <class T>
    bool write_scanlines(int y, const View<const T>& rows);
    template <class T>
    bool write_tiles(int y, const View<const T>& whole);

    const Destination file_;
    ImageTarget target_;
    const PoolShare pools_;
    std::optional<Output> proxy_;
    OIIO::ImageOutput::unique_ptr output_;
    const bool is_tiff_;
};

Writer::Writer(const Destination& destination, const ImageTarget& target, const FormatAbilities& format, int threads)
    : file_(destination), target_(target), pools_(threads), is_tiff_(format.name == "tiff") {
    output_ = OIIO::ImageOutput::create(format.name);
    if (!output_) fail_file(file_.path, "no writer for ", format.name, " is installed; ", one_line(OIIO::geterror()));
    output_->threads(threads);
    if (!is_tiff_) {
        proxy_.emplace(file_);
        output_->set_ioproxy(&*proxy_);
    }
    guarded([&] { return output_->open(is_tiff_ ? file_.unfinished : file_.path, spec_of(target, format)); });
    target_.metadata = nullptr;  // the caller may drop it now
}

Writer::~Writer() {
    // An abandoned file: some codecs complain about missing rows, which is no news.
    try {
        output_->close();
    } catch (const std::exception&) {
    }
}

/// Runs what returns whether all is well, and turns every way of failing into our error.
template <class Work>
void Writer::guarded(Work work) {
    bool is_well = false;
    std::string reason;
    try {
        is_well = work() && !output_->has_error();
        if (!is_well) reason = output_->geterror();
    } catch (const std::bad_alloc&) {
        fail_file(file_.path, "writing needs more memory than there is; use a smaller picture or a larger machine");
    } catch (const std::exception& e) {
        reason = e.what();
    }
    if (!is_well) fail_file(file_.path, "cannot be written: ", one_line(reason), "; choose another format or place");
}

template <class T>
bool Writer::write_scanlines(int y, const View<const T>& rows) {
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    return output_->write_scanlines(y, y + rows.height, 0, type_of(target_.depth), rows.data, size * rows.dx,
                                    size * rows.dy);
}

/// Writes a row of tiles, some tiles at a time.
template <class T>
bool Writer::write_tiles(int y, const View<const T>& whole) {
    // OpenEXR stores no part of a tile that is beyond the picture, and OpenImageIO takes none.
    const View<const T> rows =
        is_tiff_ ? whole : cropped(whole, 0, 0, target_.width, std::min(whole.height, target_.height - y));
    const auto size = static_cast<OIIO::stride_t>(sizeof(T));
    const int columns = tile_columns_at_once(output_->spec());
    for (int x = 0, end = 0; x < rows.width; x = end) {
        end = columns < rows.width - x ? x + columns : rows.width;
        if (!output_->write_tiles(x, end, y, y + rows.height, 0, 1, type_of(target_.depth), &rows(x, 0), size * rows.dx,
                                  size * rows.dy))
            return false;
    }
    return true;
}

void Writer::write(int y, const AnyConstView& rows) {
    guarded([&] {
        return std::visit(
            [&](const auto& from) { return target_.tile > 0 ? write_tiles(y, from) : write_scanlines(y, from); }, rows);
    });
}

void Writer::close() {
    guarded([&] { return output_->close(); });
    if (is_tiff_) guarded([&] { return is_whole_tiff(file_.unfinished, target_); });
}

}  // namespace

Encoder encode(const Destination& destination, const ImageTarget& target, const FormatAbilities& format, int threads) {
    const auto writer = std::make_shared<Writer>(destination, target, format, threads);
    return {.write = [writer](int y, const AnyConstView& rows) { writer->write(y, rows); },
            .close = [writer] { writer->close(); }};
}

}  // namespace bandlimit::oiio
