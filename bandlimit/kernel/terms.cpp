#include "bandlimit/kernel/terms.h"

#include "bandlimit/core/error.h"

namespace bandlimit {

WeightGrid expanded(const Terms& terms) {
    if (terms.empty()) fail("expanded: no terms; pass at least one");
    const std::size_t height = terms[0].column.size(), width = terms[0].row.size();
    for (const Term& term : terms)
        if (term.column.size() != height || term.row.size() != width || height == 0 || width == 0)
            fail("expanded: a term of ", term.column.size(), " x ", term.row.size(), " weights among those of ", height,
                 " x ", width, "; pass equal lengths of at least 1");
    WeightGrid grid(static_cast<int>(width), static_cast<int>(height));
    for (const Term& term : terms)
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x) grid.weights[y * width + x] += term.column[y] * term.row[x];
    return grid;
}

}  // namespace bandlimit
