// Image files: whole or by blocks of rows, through OpenImageIO.
// Stability: stable.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/color/depth.h"
#include "bandlimit/color/encoding.h"

namespace bandlimit {

/// What a file's codes mean, as a user may state it. `automatic`: 8- and 16-bit files are sRGB unless their metadata
/// say linear; float files are linear. `data` is never decoded, and its alpha is a channel like the others.
enum class Space { automatic, srgb, linear, data };
/// "auto", "srgb", "linear" or "data". Throws Error, listing them, for any other name.
Space parse_space(std::string_view name);
std::string_view name_of(Space space);

/// What a file says about itself. Sizes are those of the upright picture, after its orientation tag was applied.
struct ImageInfo {
    std::string format;  ///< as OpenImageIO names it: "png", "openexr", "pnm" (PFM too), ...
    int width = 0, height = 0;
    std::vector<std::string> channel_names;  ///< "R", "G", "B", "A", ...; EXR names are kept
    Depth depth = Depth::u8;                 ///< what samples are read as: the stored depth, or the next that holds it
    int alpha = -1;                          ///< channel that is coverage, or -1
    bool associated = false;                 ///< colour is stored multiplied by alpha
    Transfer transfer = Transfer::linear;    ///< what the metadata and the depth together say
    std::string color_hint;                  ///< the file's own word: "sRGB", "linear", "gamma 2.2", "" if it has none
    bool has_foreign_profile = false;        ///< an ICC profile that is not sRGB; its curve is treated as sRGB
    int levels = 1, subimages = 1;
    int orientation = 1;  ///< Exif orientation that was applied

    int channels() const { return static_cast<int>(channel_names.size()); }
    /// The encoding to decode with when the user says `space`; for `data`, no channel is alpha.
    Encoding encoding(Space space) const;
};

/// An open image. What kind of file it is, its first bytes say, whatever it is called.
///
/// range    PNG, JPEG, TIFF, EXR, HDR, PNM and PFM, WebP, BMP, TGA: the first picture, at its largest size. An EXR data
///          window is taken for the image. Palettes and 1 bit become u8; 32-bit integers, doubles and EXR channels of
///          mixed types become f32. The alpha of WebP comes multiplied from OpenImageIO and is divided again, to within
///          half a code of the product.
/// cost     no more than the rows asked for and one row of tiles, strips or compressed blocks, except for files that
///          are stored sideways, upside down, interlaced or progressively, and for WebP and PNM
/// threads  how many may decode: 0 for all cores, 1 for only the caller's. The pool belongs to the process: files that
///          are open at the same time share the pool of the first
/// throws   std::runtime_error "PATH: what is wrong; what to do" from every function, for files that are missing, not
///          images, truncated, or too large for this machine's memory; Error for rows or views that do not fit
class ImageReader {
public:
    explicit ImageReader(const std::string& path, int threads = 0);
    ~ImageReader();
    ImageReader(ImageReader&&) noexcept;
    ImageReader& operator=(ImageReader&&) noexcept;

    const ImageInfo& info() const;

    /// Reads rows [y, y + view.height) into `view`, whose width, channels and depth are those of info().
    ///
    /// Rows in ascending order are read once and from top to bottom; going back costs a new start. Files that are
    /// stored sideways or upside down are read whole at the first call.
    void read_rows(int y, const AnyView& view);

    /// All metadata, for a writer of the same picture to take over.
    struct Metadata;
    const Metadata& metadata() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// What kind of file to write.
struct ImageTarget {
    int width = 0, height = 0;
    std::vector<std::string> channel_names;
    Depth depth = Depth::u8;
    int alpha = -1;
    Transfer transfer = Transfer::srgb;               ///< noted in the file where the format can
    bool is_data = false;                             ///< values are not colours: no colour space is recorded
    const ImageReader::Metadata* metadata = nullptr;  ///< taken over, with ICC profile, if not null
    int tile = 0;                                     ///< side of square tiles, see check_tile(); 0 stores rows
};

/// What a format, known by the extension of a path, can hold. Throws Error for an unknown extension, naming known ones.
struct FormatAbilities {
    std::string name;                ///< "png", "openexr", ...
    std::vector<Depth> depths;       ///< best first
    bool alpha = false;              ///< holds an alpha channel
    bool associated = false;         ///< alpha is stored associated (EXR)
    bool is_linear = false;          ///< holds linear light by convention (EXR, HDR, PFM)
    bool tiles = false;              ///< can store square tiles
    bool notes_space = false;        ///< can say whether its codes are sRGB or linear (PNG)
    std::vector<int> channels = {};  ///< the numbers it holds: 4 are RGBA, 2 grey and alpha; empty = any, each its own
    int largest_channels = 4;
    int largest_side = 0;  ///< pixels; 0 = no limit of its own
};
FormatAbilities abilities_of(const std::string& path);

/// The depth of `wanted` or the nearest that the format holds.
Depth nearest_depth(const FormatAbilities& format, Depth wanted);

/// Throws Error unless files of this format can have square tiles of side `tile`: TIFF and EXR, in multiples of 16 from
/// 16 to 4096. 0, for none, always fits.
void check_tile(const FormatAbilities& format, int tile);

/// Writes a file beside `path` and renames it when all is well: the file appears whole or not at all.
///
/// A path that exists and is not a regular file is refused before its extension is checked; directories are not
/// created. A TIFF that could grow beyond 4 GB is written as BigTIFF.
/// cost     the rows that a codec compresses together; with tiles, a row of tiles
/// threads  as ImageReader
/// throws   std::runtime_error as ImageReader; Error for what no file of this format can be
class ImageWriter {
public:
    ImageWriter(const std::string& path, const ImageTarget& target, int threads = 0);
    ~ImageWriter();  ///< removes what was written unless finish() was called
    ImageWriter(ImageWriter&&) noexcept;
    ImageWriter& operator=(ImageWriter&&) noexcept;

    /// How colour and alpha must be stored in this file.
    const Encoding& encoding() const;
    /// Appends the rows of `view`, of the target's width, channels and depth.
    void write_rows(const AnyConstView& view);
    /// Closes, asks for errors that show only then (a full disk), and renames.
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Checks early what ImageWriter would refuse: parent directory missing or not writable, no regular file there, ....
void check_output_path(const std::string& path);

/// The memory, in bytes, that this machine would hand out without swapping.
std::uint64_t available_memory();
/// Throws std::runtime_error with `what` if `bytes` exceed the memory that this machine has available.
void require_memory(std::uint64_t bytes, const std::string& what);

/// Removes the unfinished files of this process, which is to end: a thread that wants to make another one waits for
/// that. Safe to call from a signal handler.
void remove_unfinished_files() noexcept;

}  // namespace bandlimit
