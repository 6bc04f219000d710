#include "bandlimit/resample/row_store.h"

#include <variant>

namespace bandlimit {
namespace {

template <class Any>
Any columns_of_any(const Any& view, int first, int width) {
    return std::visit([&](auto v) { return Any(cropped(v, first, 0, width, v.height)); }, view);
}

}  // namespace

AnyConstView columns_of(const AnyConstView& view, int first, int width) { return columns_of_any(view, first, width); }
AnyView columns_of(const AnyView& view, int first, int width) { return columns_of_any(view, first, width); }

RowStore::RowStore(const RowRun& run, int first_column, int width, bool premultiply)
    : target_(run.target),
      samples_(columns_of(run.target.samples, first_column, width)),
      channels_(run.channels),
      alpha_(run.sources[0].encoding.alpha),
      is_premultiplied_(premultiply || run.sources[0].encoding.associated),
      opaque_(run.target.background.size() * static_cast<std::size_t>(width)) {}

bool RowStore::store(std::span<const float> row, int y) {
    const int at = y - target_.first_row;
    if (target_.background.empty()) return encode_row(row, is_premultiplied_, samples_, at, target_.encoding);
    composite_row(row, is_premultiplied_, channels_, alpha_, target_.background, opaque_);
    return encode_row(opaque_, false, samples_, at, target_.encoding);
}

View<float> RowStore::direct(int first, int last) const {
    const auto* floats = std::get_if<View<float>>(&samples_);
    const Encoding& to = target_.encoding;
    if (!floats || to.transfer != Transfer::linear || !target_.background.empty() ||
        (to.alpha >= 0 && is_premultiplied_ != to.associated))
        return {};
    return cropped(*floats, 0, first - target_.first_row, floats->width, last - first);
}

}  // namespace bandlimit
