// Mip chains that know what their texels mean.
// Stability: stable.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "bandlimit/core/parallel.h"
#include "bandlimit/kernel/fetches.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/texture/role.h"
#include "bandlimit/texture/texture.h"

namespace bandlimit {

/// Wronski's eight reads that halve (2022, "Fast, GPU friendly, antialiasing downsampling filter"). Between texels of
/// uneven sizes the offsets of fetches are stretched by the ratio of the pitches to 2.
Fetches downsample8();

/// What makes the weights of a level.
using MipFilter = std::variant<Auto, Kernel, Taps, Fetches>;

/// Where levels come from: docs/mips.md has the cost and the error of both.
enum class MipSource {
    base,     ///< every level from level 0
    previous  ///< every level from the one above, before that was rounded to codes
};

struct MipOptions {
    Role role = Role::color;
    MipFilter filter = Auto{};
    MipSource from = MipSource::previous;
    Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
    int levels = 0;                ///< how many to make, level 0 included; 0: all, down to 1 x 1
    double alpha_threshold = 0.5;  ///< of alpha_tested: what is not below passes, 0 < threshold <= 1
    /// Of roughness: the normal map of the same surface, as Role::normal reads it, of any size. None: roughness alone.
    std::optional<AnyConstView> normals = {};
};

/// The mip chain of one picture: images[0] is the picture itself, in the target's format.
///
/// Every level is made of exact weights for its size: 903 x 451 to 451 x 225 to 1 x 1. Levels share the corners of the
/// picture. Taps and fetches halve, so they need MipSource::previous beyond level 1; taps need sizes that halve evenly
/// too. Edge::zero is Edge::renormalize for normals: a zero vector turns none. alpha_tested scales the alpha of each
/// level so that the share of texels that pass, as stored, is that of level 0 to half a texel, or as near as equal
/// alphas permit; colour stays what it was. With `normals`, roughness of level 0 stays what it is.
///
/// shapes   base [w x h x c]; c fits the target, or grows to it: grey to red, green and blue, missing alpha opaque, a
///          missing blue 0. Normals of 2 to 4 channels fit targets of 2 and 4: z is left out or found
/// range    any; a NaN reaches only the texels whose weights cover it, and none where its alpha is 0
/// error    levels from base: as Resizer. From previous: one rounding to codes, of floats that no level rounded
/// memory   beside the levels: chains that can go by rows (see MipStream) as MipStream; others from previous the floats
///          of two levels, for 4096 x 4096 RGBA 64 and 16 MiB; roughness, and normals of two channels, their level 0 as
///          floats (three per normal, for `normals` too); alpha_tested the alpha of a level
/// cost     4096 x 4096 RGBA in sRGB: docs/mips.md
/// throws   Error for what the above rules out, levels below 0 or more than there are, a threshold outside 0 to 1,
///          sRGB other than of 8 bits or of roles that are no colour, and as make_bank
/// example  make_mips(image.view(), {Transfer::srgb, 3}, {4, Depth::u8, true}).images[1]
struct MipChain {
    std::vector<AnyImage> images;
    bool lost_non_finite = false;  ///< a value that is not finite was stored as the code 0
};
MipChain make_mips(const AnyConstView& base, const Encoding& stored, const TexelFormat& target,
                   const MipOptions& options = {}, Parallel parallel = {});

/// A mip chain made while the rows of its picture come by, so that neither need be in memory: for textures of any
/// size. Its levels have the bits of make_mips().
///
/// memory   as MipCascade: about 200 rows of each level, and all rows under Edge::wrap along y
class MipStream {
public:
    /// Whether chains of these options, of pictures of so many channels, can be made by rows: by a kernel or Auto, each
    /// level from the previous, of all roles but roughness, alpha_tested, and normals of two channels.
    static bool is_possible(const MipOptions& options, int channels);

    /// The picture has width x height samples of so many channels and depth, stored as `stored`.
    /// throws   Error as make_mips, and where it is not possible
    MipStream(int width, int height, int channels, Depth depth, const Encoding& stored, const TexelFormat& target,
              const MipOptions& options = {}, Parallel parallel = {});
    ~MipStream();
    MipStream(MipStream&&) noexcept;
    MipStream& operator=(MipStream&&) noexcept;

    int levels() const;
    /// How often advance() must be called to make all.
    int steps() const;
    /// The rows [begin, end) of the picture that it reads when it is called for the (step + 1)-th time. From step to
    /// step neither end falls, and all rows are among them.
    IndexRange rows_needed(int step) const;

    /// Where rows go: place() gives the memory for rows [first, first + count) of a level in the target's format,
    /// interleaved, and finished() tells that they are made. Rows of a level come from top to bottom, by one thread.
    struct Sink {
        std::function<AnyView(int level, int first, int count)> place;
        std::function<void(int level, int first, const AnyView& rows)> finished;
    };
    /// Takes the next step, on all levels. Row 0 of `rows` is row `first` of the picture; they must hold
    /// rows_needed(), and may hold more.
    ///
    /// returns  whether a value that is not finite was stored as the code 0
    /// throws   Error for rows that do not fit, or after the last step; what `sink` throws
    bool advance(const AnyConstView& rows, int first, const Sink& sink);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The mip chain of six square faces of a cube, filtered across their edges.
///
/// Each face is extended by texels of its neighbours, as if they were unfolded into its plane, and filtered like any
/// picture; edges of the options do not matter. Beyond a corner both neighbours count half. Where a kernel reaches
/// further than a face is long, what it reads beyond that is dropped. Normals are vectors in one space for all faces.
/// shapes   six of [n x n x c]
/// returns  chains in the order of `faces`: +x -x +y -y +z -z, oriented as Direct3D, OpenGL and Vulkan have them
/// memory   level 0 of all faces as floats, and two levels below it
/// throws   Error as make_mips, unless there are six squares of one size, depth and number of channels, and for
///          `normals`
std::vector<MipChain> make_cube_mips(std::span<const AnyConstView> faces, const Encoding& stored,
                                     const TexelFormat& target, const MipOptions& options = {}, Parallel parallel = {});

}  // namespace bandlimit
