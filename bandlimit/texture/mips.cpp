#include "bandlimit/texture/mips.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/texture/cascade.h"
#include "bandlimit/texture/cube.h"
#include "bandlimit/texture/level_filter.h"
#include "bandlimit/texture/role_levels.h"

namespace bandlimit {
namespace {

struct Size {
    int width, height;
};
Size size_of_view(const AnyConstView& view) {
    const ViewShape shape = shape_of(view);
    return {shape.width, shape.height};
}
/// A view without samples.
AnyConstView shape_only(Depth depth, int width, int height, int channels) {
    const AnyImage none = make_image(depth, 0, 0, channels);
    return std::visit(
        [&](const auto& image) -> AnyConstView {
            auto view = image.view();
            view.width = width, view.height = height;
            return view;
        },
        none);
}
Size at_level(Size base, int level) { return {mip_length(base.width, level), mip_length(base.height, level)}; }

/// The number of levels to make. Throws Error where it, or the filter, does not suit the size.
int check_levels(Size base, const MipOptions& options) {
    if (base.width < 1 || base.height < 1)
        fail("make_mips: a base of ", base.width, " x ", base.height, "; pass at least 1 x 1");
    const int most = mip_count(base.width, base.height);
    if (options.levels < 0 || options.levels > most)
        fail("make_mips: ", options.levels, " levels of ", base.width, " x ", base.height, "; pass 1 to ", most,
             ", or 0 for all");
    const int count = options.levels > 0 ? options.levels : most;
    const auto* taps = std::get_if<Taps>(&options.filter);
    if (!taps && !std::holds_alternative<Fetches>(options.filter)) return count;
    if (options.from == MipSource::base && count > 2)
        fail("make_mips: a filter that halves makes level 1 of level 0, and no other; pass MipSource::previous");
    if (!taps) return count;
    if (taps->factor != 2) fail("make_mips: taps of factor ", taps->factor, "; pass taps that halve");
    for (int level = 1; level < count; ++level) {
        const Size from = at_level(base, level - 1), to = at_level(base, level);
        const auto halves = [](int length, int half) { return length == 2 * half || length == 1; };
        if (!halves(from.width, to.width) || !halves(from.height, to.height))
            fail("make_mips: taps of factor 2 cannot make level ", level, ", ", to.width, " x ", to.height, ", of ",
                 from.width, " x ", from.height, "; pass a kernel, or sizes that halve evenly");
    }
    return count;
}

/// Normals that lie outside as zero vectors make means shorter and turn none: the same as to leave them out.
LevelOptions edges_of(const MipOptions& options) {
    const auto edge = [&](Edge e) {
        return traits_of(options.role).finish == LevelFinish::unit_length && e == Edge::zero ? Edge::renormalize : e;
    };
    return {edge(options.edge_x), edge(options.edge_y), true};
}

ResizeOptions resize_options(const MipOptions& options) {
    const LevelOptions edges = edges_of(options);
    ResizeOptions resize{.edge = edges.edge_x, .edge_y = edges.edge_y};
    if (const auto* kernel = std::get_if<Kernel>(&options.filter)) resize.reconstruction = *kernel;
    return resize;
}

constexpr std::size_t face_count = 6;

/// The levels of a picture, or of the six faces of a cube, from large to small.
class LevelMaker {
public:
    LevelMaker(std::span<const AnyConstView> faces, const Encoding& stored, const TexelFormat& target,
               const MipOptions& options, Parallel parallel)
        : options_(options),
          parallel_(parallel),
          size_(size_of_view(faces[0])),
          count_(check_levels(size_, options)),
          is_cube_(faces.size() == face_count) {
        for (const AnyConstView& base : faces) {
            Face face{RoleLevels(base, stored, target, options, parallel), {}, {}};
            face.chain.images.push_back(face.role.level_zero(face.chain.lost_non_finite, parallel));
            if (is_cube_) {  // margins are copied from floats
                face.above = face.role.source_as_floats(parallel);
                face.role.release_source();
            }
            faces_.push_back(std::move(face));
        }
    }

    std::vector<MipChain> make() {
        for (int level = 1; level < count_; ++level) make_level(level);
        std::vector<MipChain> chains;
        for (Face& face : faces_) chains.push_back(std::move(face.chain));
        return chains;
    }

private:
    struct Face {
        RoleLevels role;
        Image<float> above;  ///< what the next level is made of, but level 1 of a picture
        MipChain chain;
    };

    void make_level(int level) {
        const bool from_previous = options_.from == MipSource::previous, from_base = level == 1 || !from_previous;
        const Size from = at_level(size_, from_base ? 0 : level - 1), to = at_level(size_, level);
        // A margin is no longer than the face; what a wide kernel reads beyond it is dropped.
        const int margin =
            is_cube_ ? std::min(from.width, reach_of(options_.filter, double(from.width) / to.width)) : 0;
        const auto source_axis = [&](int length) {
            return Axis{length + 2 * margin, double(-margin), double(length + margin)};
        };
        const RowFilter filter =
            level_filter(options_.filter, {source_axis(from.width), source_axis(from.height)},
                         {{to.width, 0, double(from.width)}, {to.height, 0, double(from.height)}},
                         faces_[0].role.channels(), is_cube_ ? LevelOptions() : edges_of(options_));
        std::vector<Image<float>> made(faces_.size());
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            Face& face = faces_[i];
            const Image<float> wide = is_cube_ ? extended_face(above(), int(i), margin, parallel_) : Image<float>();
            const SourceRows source = is_cube_    ? SourceRows{wide.view(), 0, face.role.between()}
                                      : from_base ? face.role.source()
                                                  : SourceRows{face.above.view(), 0, face.role.between()};
            face.chain.images.push_back(face.role.level(filter, source, made[i], from_previous && level + 1 < count_,
                                                        face.chain.lost_non_finite, parallel_));
        }
        if (!from_previous) return;
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            faces_[i].above = std::move(made[i]);
            faces_[i].role.release_source();
        }
    }

    std::vector<View<const float>> above() const {
        std::vector<View<const float>> views;
        for (const Face& face : faces_) views.push_back(face.above.view());
        return views;
    }

    const MipOptions& options_;
    Parallel parallel_;
    Size size_;
    int count_;
    bool is_cube_;
    std::vector<Face> faces_;
};

constexpr int base_block = 256;  // rows at a time where there is nothing but level 0

}  // namespace

struct MipStream::State {
    RoleLevels role;
    MipCascade cascade;
    int levels, height;
    Parallel parallel;
    int step = 0;              ///< the next one
    int stored_base_rows = 0;  ///< of level 0, in the target's format

    int base_blocks() const { return (height - 1) / base_block + 1; }
};

bool MipStream::is_possible(const MipOptions& options, int channels) {
    const bool is_kernel =
        std::holds_alternative<Auto>(options.filter) || std::holds_alternative<Kernel>(options.filter);
    return is_kernel && RoleLevels::goes_by_rows(options.role, channels) && options.from == MipSource::previous;
}

MipStream::MipStream(int width, int height, int channels, Depth depth, const Encoding& stored,
                     const TexelFormat& target, const MipOptions& options, Parallel parallel) {
    if (!is_possible(options, channels))
        fail("MipStream: ", name_of(options.role), " of ", channels,
             " channels with this filter; pass what is_possible(), or use make_mips");
    const int levels = check_levels({width, height}, options);
    RoleLevels role(shape_only(depth, width, height, channels), stored, target, options, parallel);
    MipCascade cascade(width, height, channels, role.source().encoding, levels, resize_options(options), parallel);
    state_ = std::make_unique<State>(State{std::move(role), std::move(cascade), levels, height, parallel});
}

MipStream::~MipStream() = default;
MipStream::MipStream(MipStream&&) noexcept = default;
MipStream& MipStream::operator=(MipStream&&) noexcept = default;

int MipStream::levels() const { return state_->levels; }
int MipStream::steps() const { return state_->cascade.steps() > 0 ? state_->cascade.steps() : state_->base_blocks(); }

IndexRange MipStream::rows_needed(int step) const {
    const State& s = *state_;
    if (s.cascade.steps() == 0) return {step * base_block, std::min((step + 1) * base_block, s.height)};
    // A kernel may skip rows, which level 0 holds all the same.
    const IndexRange read = s.cascade.rows_needed(step);
    const int before = step > 0 ? s.cascade.rows_needed(step - 1).end : 0;
    return {std::min(read.begin, before), step + 1 == s.cascade.steps() ? s.height : read.end};
}

bool MipStream::advance(const AnyConstView& rows, int first, const Sink& sink) {
    State& s = *state_;
    if (s.step == steps()) fail("MipStream::advance: all levels are made; call it steps() times");
    const IndexRange needed = rows_needed(s.step);
    const int held = size_of_view(rows).height;
    if (first > needed.begin || first + held < needed.end)
        fail("MipStream::advance: rows ", first, " to ", first + held, "; rows ", needed.begin, " to ", needed.end,
             " are needed");
    ++s.step;
    bool lost = false;
    if (const int begin = s.stored_base_rows, count = needed.end - begin; count > 0) {
        const AnyView to = sink.place(0, begin, count);
        lost |= s.role.store_base_rows(rows_of(rows, begin - first, count), to, s.parallel);
        sink.finished(0, begin, to);
        s.stored_base_rows = needed.end;
    }
    if (s.cascade.steps() == 0) return lost;
    s.cascade.advance(rows, first, [&](int level, int row, View<const float> floats) {
        const AnyView to = sink.place(level, row, floats.height);
        lost |= s.role.store_rows(floats, to, s.parallel);
        sink.finished(level, row, to);
    });
    return lost;
}

namespace {

MipChain make_by_rows(const AnyConstView& base, const Encoding& stored, const TexelFormat& target,
                      const MipOptions& options, Parallel parallel) {
    const Size size = size_of_view(base);
    MipStream stream(size.width, size.height, shape_of(base).channels, depth_of(base), stored, target, options,
                     parallel);
    MipChain chain;
    for (int level = 0; level < stream.levels(); ++level) {
        const Size s = at_level(size, level);
        chain.images.push_back(make_image(target.depth, s.width, s.height, target.channels));
    }
    const auto place = [&](int level, int first, int count) {
        return rows_of(view_of(chain.images[static_cast<std::size_t>(level)]), first, count);
    };
    for (int step = 0; step < stream.steps(); ++step)
        chain.lost_non_finite |= stream.advance(base, 0, {place, [](int, int, const AnyView&) {}});
    return chain;
}

}  // namespace

MipChain make_mips(const AnyConstView& base, const Encoding& stored, const TexelFormat& target,
                   const MipOptions& options, Parallel parallel) {
    if (MipStream::is_possible(options, shape_of(base).channels))
        return make_by_rows(base, stored, target, options, parallel);
    return std::move(LevelMaker({&base, 1}, stored, target, options, parallel).make().front());
}

std::vector<MipChain> make_cube_mips(std::span<const AnyConstView> faces, const Encoding& stored,
                                     const TexelFormat& target, const MipOptions& options, Parallel parallel) {
    if (faces.size() != face_count) fail("make_cube_mips: ", faces.size(), " faces; pass 6: +x -x +y -y +z -z");
    if (options.normals) fail("make_cube_mips: one map of normals for six faces; pass none, or each face to make_mips");
    const Size size = size_of_view(faces[0]);
    for (const AnyConstView& face : faces) {
        const ViewShape other = shape_of(face);
        if (other.width != size.width || other.height != size.width || depth_of(face) != depth_of(faces[0]) ||
            other.channels != shape_of(faces[0]).channels)
            fail("make_cube_mips: faces of ", size.width, " x ", size.height, " and ", other.width, " x ", other.height,
                 "; pass six squares of the same size, depth and channels");
    }
    return LevelMaker(faces, stored, target, options, parallel).make();
}

}  // namespace bandlimit
