#include "bandlimit/texture/role_levels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/texture/alpha_coverage.h"
#include "bandlimit/texture/roughness.h"

namespace bandlimit {
namespace {

constexpr int grain = 16;  // rows per thread at least

template <class T>
constexpr T one() {
    if constexpr (std::is_integral_v<T>) return std::numeric_limits<T>::max();
    else if constexpr (std::is_same_v<T, Half>) return Half{0x3c00};
    else return T{1};
}

/// Runs body(y, row) over the rows of an image in parallel; `row` is scratch of `samples` for one row.
/// returns whether any call did
template <class Body>
bool any_row(int height, std::size_t samples, Parallel parallel, const Body& body) {
    std::atomic<bool> result = false;
    parallel_for(height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<float> row(samples);
        for (int y = static_cast<int>(begin); y < end; ++y)
            if (body(y, std::span<float>(row))) result = true;
    });
    return result;
}

std::size_t row_length(const ViewShape& shape) {
    return static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.channels);
}

void copy_samples(const AnyConstView& from, const AnyView& to, Parallel parallel) {
    std::visit(
        [&](const auto& source) {
            using T = std::remove_cvref_t<decltype(source(0, 0, 0))>;
            const View<T> target = std::get<View<T>>(to);
            parallel_for(source.height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                const auto is_interleaved = [](const auto& v) {
                    return v.dx == v.channels && (v.dc == 1 || v.channels == 1);
                };
                const bool by_rows = is_interleaved(source) && is_interleaved(target);
                for (int y = static_cast<int>(begin); y < end; ++y) {
                    if (by_rows) {
                        std::copy_n(&source(0, y), source.width * source.channels, &target(0, y));
                        continue;
                    }
                    for (int x = 0; x < source.width; ++x)
                        for (int c = 0; c < source.channels; ++c) target(x, y, c) = source(x, y, c);
                }
            });
        },
        from);
}

/// Clamps floats to [0, 1]; a NaN stays one.
void clamp_samples(const AnyView& view, Parallel parallel) {
    const ViewShape shape = shape_of(view);
    any_row(shape.height, row_length(shape), parallel, [&](int y, std::span<float> row) {
        decode_row(const_view(view), y, {}, false, row);
        for (float& v : row) v = v < 0 ? 0 : v > 1 ? 1 : v;
        return encode_row(row, false, view, y, {});
    });
}

/// Whether what is filtered is made of the samples first, as floats: squared widths, and z of normals that lack it.
bool is_decoded_first(const RoleTraits& role, int channels) {
    return role.finish == LevelFinish::lost_variance || (role.finish == LevelFinish::unit_length && channels == 2);
}

}  // namespace

RoleLevels::RoleLevels(const AnyConstView& base, const Encoding& stored, const TexelFormat& target,
                       const MipOptions& options, Parallel parallel)
    : base_(base),
      target_(target),
      role_(&traits_of(options.role)),
      base_channels_(shape_of(base).channels),
      alpha_threshold_(options.alpha_threshold) {
    check(stored, options);
    base_is_grey_alpha_ = base_channels_ == 2 && stored.alpha == 1 && role_->finish != LevelFinish::unit_length;
    if (role_->is_light) stored_ = stored;
    if (!role_->may_be_srgb) stored_.transfer = Transfer::linear;
    between_ = {Transfer::linear, stored_.alpha, stored_.alpha >= 0};
    channels_ = base_channels_;
    if (is_decoded_first(*role_, base_channels_)) {
        decoded_ = source_as_floats(parallel);
        channels_ = decoded_->channels();
    }
    if (options.normals) moments_.emplace(*options.normals, parallel);
}

void RoleLevels::check(const Encoding& stored, const MipOptions& options) const {
    const int c = base_channels_, to = target_.channels;
    const auto [role, name, is_light, may_be_srgb, least, finish] = *role_;
    if (to != 1 && to != 2 && to != 4) fail("make_mips: a target of ", to, " channels; pass 1, 2 or 4");
    if (target_.srgb && target_.depth != Depth::u8)
        fail("make_mips: sRGB codes of ", name_of(target_.depth), "; only u8 has them");
    if (target_.srgb && !may_be_srgb)
        fail("make_mips: ", name, " in sRGB codes; pass a target with srgb = false, or Role::color");
    if (target_.premultiplied && (to != 4 || !is_light))
        fail("make_mips: ", name, " with ", to, " channels, premultiplied; pass colour with 4 channels, or false");
    if (is_light && stored.alpha >= 0 && (stored.alpha != c - 1 || (c != 2 && c != 4)))
        fail("make_mips: alpha is channel ", stored.alpha, " of ", c, "; pass the last one of 2 or 4, or -1");
    if (is_light && stored.alpha >= 0 && to != 4)
        fail("make_mips: ", name, " with alpha in ", to, " channels; pass a target of 4, or Role::data");
    check_encoding("make_mips", stored, c);
    if (finish == LevelFinish::coverage && (stored.alpha < 0 || to != 4))
        fail("make_mips: nothing to test without alpha; pass a picture and a target with it, or Role::color");
    if (!(options.alpha_threshold > 0 && options.alpha_threshold <= 1))
        fail("make_mips: alpha_threshold = ", options.alpha_threshold, "; pass one above 0 and up to 1");
    // Vectors of three channels fit two, which z is left out of.
    const int most = finish == LevelFinish::unit_length ? 4 : to;
    if (c < least || c > most || to < least)
        fail("make_mips: ", name, " of ", c, " channels in ", to, "; pass ", least, " to ", most,
             ", or another target");
    if (!options.normals) return;
    if (finish != LevelFinish::lost_variance) fail("make_mips: normals for ", name, "; only roughness takes them");
    const ViewShape normals = shape_of(*options.normals);
    if (normals.width < 1 || normals.height < 1 || normals.channels < 2 || normals.channels > 4)
        fail("make_mips: normals of ", normals.width, " x ", normals.height, " with ", normals.channels,
             " channels; pass at least 1 x 1 with 2 to 4");
}

bool RoleLevels::has_own_alpha() const { return base_channels_ == 4 || base_is_grey_alpha_; }

SourceRows RoleLevels::source() const {
    if (decoded_) return {decoded_->view(), 0, between_};
    return {base_, 0, stored_};
}

Image<float> RoleLevels::floats_of(const AnyConstView& rows, Parallel parallel) const {
    if (role_->finish == LevelFinish::unit_length && base_channels_ == 2) return decode_normals(rows, false, parallel);
    const ViewShape shape = shape_of(rows);
    Image<float> floats(shape.width, shape.height, shape.channels, Layout::interleaved);
    const int filtered = shape.channels, rough = has_own_alpha() ? filtered - 1 : filtered;
    any_row(shape.height, 0, parallel, [&](int y, std::span<float>) {
        const std::span<float> row{&floats.view()(0, y), row_length(shape)};
        decode_row(rows, y, stored_, true, row);
        if (role_->finish == LevelFinish::lost_variance)
            for (std::size_t i = 0; i < row.size(); ++i)
                if (static_cast<int>(i) % filtered < rough) row[i] = roughness_variance(row[i]);
        return false;
    });
    return floats;
}

void RoleLevels::release_source() { decoded_.reset(); }

AnyView RoleLevels::filtered_part(const AnyView& image) const {
    const int count = base_channels_;
    const bool grey_alpha = base_is_grey_alpha_ && target_.channels == 4;
    return std::visit(
        [&](auto v) {
            v.channels = std::min(v.channels, count);
            if (grey_alpha) v.dc *= 3;  // red and alpha
            return AnyView(v);
        },
        image);
}

Encoding RoleLevels::target_encoding() const {
    Encoding encoding;
    encoding.transfer = target_.srgb ? Transfer::srgb : Transfer::linear;
    encoding.alpha = stored_.alpha;
    encoding.associated = target_.premultiplied;
    return encoding;
}

/// Fills the channels that are not filtered.
void RoleLevels::complete(const AnyView& image, Parallel parallel) const {
    if (role_->finish == LevelFinish::unit_length) return;
    if (role_->finish == LevelFinish::clamp && !is_integer(target_.depth))
        clamp_samples(filtered_part(image), parallel);
    const bool is_grey = base_channels_ == 1 || base_is_grey_alpha_;
    if (target_.channels == base_channels_) return;
    std::visit(
        [&](const auto& v) {
            using T = std::remove_cvref_t<decltype(v(0, 0, 0))>;
            parallel_for(v.height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                for (int y = static_cast<int>(begin); y < end; ++y)
                    for (int x = 0; x < v.width; ++x) {
                        T* const texel = &v(x, y);
                        for (int c = is_grey ? 1 : base_channels_; c < std::min(v.channels, 3); ++c)
                            texel[c] = is_grey ? texel[0] : T{};
                        if (v.channels == 4 && !has_own_alpha()) texel[3] = one<T>();
                    }
            });
        },
        image);
}

bool RoleLevels::are_codes_of_normals() const { return is_integer(depth_of(base_)) && base_channels_ > 2; }

bool RoleLevels::store_base_rows(const AnyConstView& rows, const AnyView& target, Parallel parallel) const {
    const ViewShape shape = shape_of(rows);
    const Encoding to = target_encoding();
    const bool is_same = depth_of(rows) == target_.depth && base_channels_ == target_.channels &&
                         stored_.transfer == to.transfer && (to.alpha < 0 || stored_.associated == to.associated);
    bool lost = false;
    if (is_same) copy_samples(rows, target, parallel);
    else if (role_->finish == LevelFinish::unit_length) {
        // Two channels are decoded to vectors already; others are read as they are.
        const Image<float> samples = floats_of(rows, parallel);
        return encode_normals({samples.view(), are_codes_of_normals()}, target, parallel);
    } else {
        const AnyView part = filtered_part(target);
        lost = any_row(shape.height, row_length(shape), parallel, [&](int y, std::span<float> row) {
            decode_row(rows, y, stored_, false, row);
            return encode_row(row, stored_.associated, part, y, to);
        });
    }
    complete(target, parallel);
    return lost;
}

AnyImage RoleLevels::level_zero(bool& lost, Parallel parallel) {
    const ViewShape shape = shape_of(base_);
    AnyImage image = make_image(target_.depth, shape.width, shape.height, target_.channels);
    lost |= store_base_rows(base_, view_of(image), parallel);
    if (role_->finish == LevelFinish::coverage) {
        const double passing = static_cast<double>(count_passing(const_view(view_of(image)), 3, alpha_threshold_));
        share_ = passing / (static_cast<double>(shape.width) * shape.height);
    }
    return image;
}

AnyImage RoleLevels::level(const RowFilter& filter, const SourceRows& from, Image<float>& floats, bool keep_floats,
                           bool& lost, Parallel parallel) {
    const int width = filter.protocol().width, height = filter.protocol().height;
    AnyImage image = make_image(target_.depth, width, height, target_.channels);
    const bool is_mean = role_->finish == LevelFinish::none || role_->finish == LevelFinish::clamp;
    if (is_mean && !keep_floats) {
        lost |= filter.run(from, {filtered_part(view_of(image)), 0, target_encoding(), {}}, parallel).lost_non_finite;
        complete(view_of(image), parallel);
        return image;
    }
    floats = Image<float>(width, height, channels_, Layout::interleaved);
    filter.run(from, {floats.view(), 0, between_, {}}, parallel);
    lost |= store_rows(floats.view(), view_of(image), parallel);
    return image;
}

bool RoleLevels::goes_by_rows(Role role, int channels) {
    return traits_of(role).finishes_by_rows() && !is_decoded_first(traits_of(role), channels);
}

bool RoleLevels::store_rows(View<const float> floats, const AnyView& target, Parallel parallel) {
    if (role_->finish == LevelFinish::unit_length)
        return encode_normals({floats, are_codes_of_normals()}, target, parallel);
    const AnyView part = filtered_part(target);
    const bool lost = role_->finish == LevelFinish::lost_variance ? store_roughness(floats, part, parallel)
                      : role_->finish == LevelFinish::coverage    ? store_with_coverage(floats, part, parallel)
                                                                  : store_means(floats, part, parallel);
    complete(target, parallel);
    return lost;
}

bool RoleLevels::store_means(View<const float> floats, const AnyView& target, Parallel parallel) const {
    const auto samples = static_cast<std::size_t>(floats.width) * static_cast<std::size_t>(floats.channels);
    return any_row(floats.height, 0, parallel, [&](int y, std::span<float>) {
        return encode_row({&floats(0, y), samples}, between_.associated, target, y, target_encoding());
    });
}

bool RoleLevels::store_roughness(View<const float> floats, const AnyView& target, Parallel parallel) {
    std::optional<View<const float>> means;
    if (moments_) means = moments_->means(floats.width, floats.height, parallel);
    const auto step = static_cast<std::size_t>(channels_), rough = has_own_alpha() ? step - 1 : step;
    const auto width = static_cast<std::size_t>(floats.width);
    return any_row(floats.height, width * (step + 1), parallel, [&](int y, std::span<float> scratch) {
        const std::span<float> row = scratch.first(width * step), added = scratch.subspan(width * step);
        if (means) lost_variances(*means, y, added);
        std::copy_n(&floats(0, y), row.size(), row.begin());
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < rough; ++c) {
                float& sample = row[x * step + c];
                // A kernel with negative weights may leave the range: no variance is below 0.
                sample = roughness_of_variance((sample < 0 ? 0 : sample) + added[x]);
            }
        return encode_row(row, false, target, y, {});
    });
}

bool RoleLevels::store_with_coverage(View<const float> floats, const AnyView& target, Parallel parallel) const {
    const auto step = static_cast<std::size_t>(channels_), width = static_cast<std::size_t>(floats.width);
    const int alpha = between_.alpha;
    std::vector<float> alphas;
    alphas.reserve(width * static_cast<std::size_t>(floats.height));
    for (int y = 0; y < floats.height; ++y)
        for (int x = 0; x < floats.width; ++x) alphas.push_back(floats(x, y, alpha));
    const double factor = coverage_factor(std::move(alphas), share_, target_.depth, alpha_threshold_);
    return any_row(floats.height, width * step, parallel, [&](int y, std::span<float> row) {
        std::copy_n(&floats(0, y), row.size(), row.begin());
        if (factor != 1)
            for (std::size_t x = 0; x < width; ++x) {
                float* const texel = &row[x * step];
                // Colour is multiplied by alpha, so it takes the same factor; more than opaque is none.
                const double own = static_cast<double>(texel[alpha]), scaled = own * factor;
                const double by = scaled > 1 ? 1 / own : factor;
                for (int c = 0; c < channels_; ++c) texel[c] = static_cast<float>(static_cast<double>(texel[c]) * by);
            }
        return encode_row(row, true, target, y, target_encoding());
    });
}

}  // namespace bandlimit
