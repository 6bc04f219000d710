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

Grid grid_of(Size samples, Size interval) {
    return {{samples.width, 0, static_cast<double>(interval.width)},
            {samples.height, 0, static_cast<double>(interval.height)}};
}

/// Normals that lie outside as zero vectors make means shorter and turn none: the same as to leave them out.
LevelFilter::Options edges_of(const MipOptions& options) {
    const auto edge = [&](Edge e) { return options.role == Role::normal && e == Edge::zero ? Edge::renormalize : e; };
    return {edge(options.edge_x), edge(options.edge_y), true};
}

ResizeOptions resize_options(const MipOptions& options) {
    const LevelFilter::Options edges = edges_of(options);
    ResizeOptions resize{.edge = edges.edge_x, .edge_y = edges.edge_y};
    if (const auto* kernel = std::get_if<Kernel>(&options.filter)) resize.reconstruction = *kernel;
    return resize;
}

constexpr std::size_t face_count = 6;

/// Levels of six faces, each filtered with the margins that its kernel reaches into.
class CubeMaker {
public:
    CubeMaker(std::span<const AnyConstView> faces, const Encoding& stored, const TexelFormat& target,
              const MipOptions& options, Parallel parallel)
        : options_(options), parallel_(parallel), length_(size_of_view(faces[0]).width) {
        for (const AnyConstView& face : faces) {
            roles_.emplace_back(face, stored, target, options, parallel);
            MipChain& chain = chains_.emplace_back();
            chain.images.push_back(roles_.back().level_zero(chain.lost_non_finite, parallel));
            above_.push_back(roles_.back().source_as_floats(parallel));
            roles_.back().release_source();
        }
    }

    void make_level(int level) {
        const int to = mip_length(length_, level), from = above_[0].width();
        const int margin = std::min(from, reach_of(options_.filter, static_cast<double>(from) / to));
        const Axis wide{from + 2 * margin, static_cast<double>(-margin), static_cast<double>(from + margin)};
        const Axis axis{to, 0, static_cast<double>(from)};
        // A margin is no longer than the face; what a wide kernel reads beyond it is dropped.
        const LevelFilter filter(options_.filter, {wide, wide}, {axis, axis}, roles_[0].channels(), {});
        std::vector<View<const float>> views;
        for (const Image<float>& image : above_) views.push_back(image.view());
        std::vector<Image<float>> made(face_count);
        for (std::size_t face = 0; face < face_count; ++face) {
            const Image<float> source = extended_face(views, static_cast<int>(face), margin, parallel_);
            MipChain& chain = chains_[face];
            chain.images.push_back(roles_[face].level(filter, {source.view(), 0, roles_[face].between()}, made[face],
                                                      options_.from == MipSource::previous, to, to,
                                                      chain.lost_non_finite, parallel_));
        }
        if (options_.from == MipSource::previous) above_ = std::move(made);
    }

    std::vector<MipChain> take() { return std::move(chains_); }

private:
    const MipOptions& options_;
    Parallel parallel_;
    int length_;
    std::vector<RoleLevels> roles_;
    std::vector<Image<float>> above_;  ///< what the next level is made of
    std::vector<MipChain> chains_;
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
    const bool stands_alone = options.role != Role::roughness && options.role != Role::alpha_tested &&
                              !(options.role == Role::normal && channels == 2);
    return is_kernel && stands_alone && options.from == MipSource::previous;
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
    const Size size = size_of_view(base);
    const int count = check_levels(size, options);
    RoleLevels role(base, stored, target, options, parallel);
    MipChain chain;
    chain.images.push_back(role.level_zero(chain.lost_non_finite, parallel));
    const bool from_previous = options.from == MipSource::previous;
    Image<float> above;  // the last level, before it was rounded
    for (int level = 1; level < count; ++level) {
        const bool from_base = level == 1 || !from_previous;
        const SourceRows source = from_base ? role.source() : SourceRows{above.view(), 0, role.between()};
        const Size from = at_level(size, from_base ? 0 : level - 1), to = at_level(size, level);
        const LevelFilter filter(options.filter, grid_of(from, from), grid_of(to, from), role.channels(),
                                 edges_of(options));
        Image<float> floats;
        chain.images.push_back(role.level(filter, source, floats, from_previous && level + 1 < count, to.width,
                                          to.height, chain.lost_non_finite, parallel));
        above = std::move(floats);
        if (from_previous) role.release_source();
    }
    return chain;
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
    const int count = check_levels(size, options);
    CubeMaker maker(faces, stored, target, options, parallel);
    for (int level = 1; level < count; ++level) maker.make_level(level);
    return maker.take();
}

}  // namespace bandlimit
