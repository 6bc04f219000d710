// Scenes of shapes, as JSON.
//
//     { "width": 640, "height": 480,
//       "filter": "cone:1",                     optional, this is the default: as raster_filter() reads it
//       "background": [0, 0, 0],                optional, black: [r, g, b], or [r, g, b, a] for a picture with alpha
//       "shapes": [
//         { "type": "point", "at": [x, y], "radius": 3 },       without a radius: a point, of an area of 1
//         { "type": "disc", "center": [x, y], "radius": 20 },
//         { "type": "line", "from": [x, y], "to": [x, y], "width": 1, "cap": "butt" },       or "round"
//         { "type": "polyline", "points": [[x, y], ...], "width": 1, "cap": "butt", "closed": false },
//         { "type": "polygon", "points": [[x, y], ...] },       convex; with a "width" its outline, of any form
//         { "type": "group", "shapes": [...] } ] }              shapes that abut, blended at once (antialias/raster.h)
//
// Each shape but a group has "color": [r, g, b] or [r, g, b, a], white by default. Colours are linear light, not
// multiplied by alpha. Pixel (i, j) is centred at (i + 1/2, j + 1/2), y down. Shapes are drawn in the order of the list.
// Stability: evolving.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/antialias/raster.h"

namespace bandlimit::job {

struct RasterScene {
    int width = 0, height = 0;  ///< 1 to 65536 each
    std::string filter = "cone:1";
    std::array<float, 4> background{0, 0, 0, 1};
    bool has_alpha = false;  ///< whether the background gives alpha
    std::vector<RasterShape> shapes;
};

/// The scene that `text` describes; `name` is what errors call it.
/// throws   std::runtime_error "NAME, line N: what is wrong; what to do" for text that is not JSON, unknown and missing
///          keys, values of the wrong type or out of range, unknown filters, and polygons that are not convex
RasterScene parse_raster_scene(std::string_view text, const std::string& name);

/// The scene in a file of at most 16 MB. Throws also for what cannot be read.
RasterScene read_raster_scene(const std::string& path);

}  // namespace bandlimit::job
