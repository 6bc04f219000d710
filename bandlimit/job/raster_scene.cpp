#include "bandlimit/job/raster_scene.h"

#include <algorithm>
#include <initializer_list>
#include <optional>

#include "bandlimit/core/error.h"
#include "bandlimit/io/located_json.h"

namespace bandlimit::job {
namespace {

constexpr int largest_side = 65536;
constexpr double largest_length = 1e9, largest_light = 1e9, least_length = 1e-9;

/// Reads the shapes of one file.
class SceneReader {
public:
    explicit SceneReader(const LocatedJson& file) : file_(file) {}

    RasterScene scene() {
        const LocatedObject root(file_, file_.root(), {"width", "height", "filter", "background", "shapes"}, "a scene");
        RasterScene scene;
        scene.width = file_.integer(root.require("width"), "width", 1, largest_side);
        scene.height = file_.integer(root.require("height"), "height", 1, largest_side);
        if (const JsonValue* filter = root.find("filter")) scene.filter = filter_of(*filter);
        if (const JsonValue* color = root.find("background")) {
            scene.background = color_of(*color, "background");
            scene.has_alpha = color->items.size() == 4;
        }
        for (const JsonValue& shape : file_.list(root.require("shapes"), "shapes")) add_any(shape, scene.shapes);
        return scene;
    }

private:
    std::string filter_of(const JsonValue& value) const {
        const std::string& filter = file_.text(value, "filter");
        try {
            raster_filter(filter);
        } catch (const Error& e) {
            file_.fail_at(value, "\"filter\": ", e.what());
        }
        return filter;
    }

    std::array<float, 4> color_of(const JsonValue& value, std::string_view key) const {
        const std::vector<double> c = file_.numbers(value, key, 3, 4, -largest_light, largest_light);
        const auto part = [&](std::size_t i) { return static_cast<float>(c[i]); };
        const float alpha = c.size() == 4 ? static_cast<float>(file_.number(value.items[3], "alpha", 0, 1)) : 1.0f;
        return {part(0), part(1), part(2), alpha};
    }

    Point point(const JsonValue& value, std::string_view key) const {
        const std::vector<double> p = file_.numbers(value, key, 2, 2, -largest_length, largest_length);
        return {p[0], p[1]};
    }

    std::vector<Point> points(const JsonValue& value, std::size_t least) const {
        const std::vector<JsonValue>& items = file_.list(value, "points");
        if (items.size() < least)
            file_.fail_at(value, "\"points\" has ", items.size(), " points; write at least ", least);
        std::vector<Point> result;
        for (const JsonValue& item : items) result.push_back(point(item, "points"));
        return result;
    }

    double size(const JsonValue& value, std::string_view key) const {
        return file_.number(value, key, least_length, largest_length);
    }

    LineCap cap_of(const LocatedObject& object) const {
        const JsonValue* cap = object.find("cap");
        if (!cap) return LineCap::butt;
        const std::string& name = file_.text(*cap, "cap");
        if (name == "round") return LineCap::round;
        if (name != "butt") file_.fail_at(*cap, "\"cap\" is unknown; write \"butt\" or \"round\"");
        return LineCap::butt;
    }

    using Keys = std::initializer_list<std::string_view>;
    LocatedObject object(const JsonValue& value, Keys keys, const char* what) const {
        return LocatedObject(file_, value, keys, what);
    }

    ShapeGeometry point_shape(const JsonValue& value) const {
        const LocatedObject o = object(value, {"type", "at", "radius", "color"}, "a point");
        const Point at = point(o.require("at"), "at");
        if (const JsonValue* radius = o.find("radius")) return DiscShape{at, size(*radius, "radius")};
        return PointShape{at};
    }

    ShapeGeometry disc(const JsonValue& value) const {
        const LocatedObject o = object(value, {"type", "center", "radius", "color"}, "a disc");
        return DiscShape{point(o.require("center"), "center"), size(o.require("radius"), "radius")};
    }

    ShapeGeometry line(const JsonValue& value) const {
        const LocatedObject o = object(value, {"type", "from", "to", "width", "cap", "color"}, "a line");
        return LineShape{point(o.require("from"), "from"), point(o.require("to"), "to"),
                         size(o.require("width"), "width"), cap_of(o)};
    }

    ShapeGeometry polyline(const JsonValue& value) const {
        const LocatedObject o = object(value, {"type", "points", "width", "cap", "closed", "color"}, "a polyline");
        PolylineShape shape{points(o.require("points"), 2), 1, cap_of(o)};
        if (const JsonValue* width = o.find("width")) shape.width = size(*width, "width");
        if (const JsonValue* closed = o.find("closed")) {
            if (!closed->is(JsonValue::Kind::boolean))
                file_.fail_at(*closed, "\"closed\" is not true or false; correct it");
            shape.closed = closed->number != 0;
        }
        return shape;
    }

    ShapeGeometry polygon(const JsonValue& value) const {
        const LocatedObject o = object(value, {"type", "points", "width", "color"}, "a polygon");
        std::vector<Point> corners = points(o.require("points"), 3);
        if (const JsonValue* width = o.find("width"))
            return PolylineShape{std::move(corners), size(*width, "width"), LineCap::butt, true};
        return PolygonShape{std::move(corners)};
    }

    const JsonValue& type_of(const JsonValue& value) const {
        if (!value.is(JsonValue::Kind::object))
            file_.fail_at(value, "\"shapes\" holds something that is not an object; correct it");
        const auto found = std::find(value.keys.begin(), value.keys.end(), "type");
        if (found == value.keys.end()) file_.fail_at(value, "a shape lacks \"type\"; add it");
        return value.items[static_cast<std::size_t>(found - value.keys.begin())];
    }

    ShapeGeometry geometry_of(const JsonValue& value) const {
        const JsonValue& type = type_of(value);
        const std::string& name = file_.text(type, "type");
        if (name == "point") return point_shape(value);
        if (name == "disc") return disc(value);
        if (name == "line") return line(value);
        if (name == "polyline") return polyline(value);
        if (name == "polygon") return polygon(value);
        if (name == "group") file_.fail_at(type, "a group holds a group; write its shapes instead");
        file_.fail_at(type, "\"type\" is unknown; write point, disc, line, polyline, polygon or group");
    }

    void add_shape(const JsonValue& value, int group, std::vector<RasterShape>& shapes) const {
        RasterShape shape{geometry_of(value)};
        shape.group = group;
        for (std::size_t i = 0; i < value.keys.size(); ++i)
            if (value.keys[i] == "color") shape.color = color_of(value.items[i], "color");
        try {
            check(shape);
        } catch (const Error& e) {
            file_.fail_at(value, e.what());
        }
        shapes.push_back(std::move(shape));
    }

    void add_any(const JsonValue& value, std::vector<RasterShape>& shapes) {
        const JsonValue& type = type_of(value);
        if (!type.is(JsonValue::Kind::text) || type.text != "group") return add_shape(value, 0, shapes);
        const LocatedObject group = object(value, {"type", "shapes"}, "a group");
        ++groups_;
        for (const JsonValue& shape : file_.list(group.require("shapes"), "shapes")) add_shape(shape, groups_, shapes);
    }

    const LocatedJson& file_;
    int groups_ = 0;
};

}  // namespace

RasterScene parse_raster_scene(std::string_view text, const std::string& name) {
    const LocatedJson file(name, text, "a scene");
    return SceneReader(file).scene();
}

RasterScene read_raster_scene(const std::string& path) {
    const LocatedJson file = LocatedJson::read(path, "a scene");
    return SceneReader(file).scene();
}

}  // namespace bandlimit::job
