#include <gtest/gtest.h>

#include <stdexcept>

#include "bandlimit/job/raster_scene.h"

namespace bandlimit::job {
namespace {

std::string refusal(const std::string& text) {
    try {
        parse_raster_scene(text, "s.json");
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return {};
}

std::string scene_of(const std::string& shape) {
    return "{\"width\": 8, \"height\": 8, \"shapes\": [\n" + shape + "\n]}";
}

TEST(RasterScene, ReadsEveryShape) {
    const RasterScene scene = parse_raster_scene(R"({"width": 64, "height": 32, "filter": "gaussian:0.5",
        "background": [0.1, 0.2, 0.3], "shapes": [
        {"type": "point", "at": [1, 2]},
        {"type": "point", "at": [1, 2], "radius": 3, "color": [1, 0, 2.5]},
        {"type": "disc", "center": [-4, 5.5], "radius": 6, "color": [1, 0, 0, 0.5]},
        {"type": "line", "from": [0, 1], "to": [2, 3], "width": 0.25, "cap": "round"},
        {"type": "polyline", "points": [[0, 0], [5, 5], [9, 1]], "closed": true},
        {"type": "polygon", "points": [[0, 0], [5, 0], [1, 1], [0, 5]], "width": 2},
        {"type": "group", "shapes": [{"type": "polygon", "points": [[0, 0], [5, 0], [0, 5]]},
                                     {"type": "polygon", "points": [[5, 0], [5, 5], [0, 5]]}]},
        {"type": "group", "shapes": []}]})",
                                                 "s.json");
    EXPECT_EQ(scene.width, 64);
    EXPECT_EQ(scene.height, 32);
    EXPECT_EQ(scene.filter, "gaussian:0.5");
    EXPECT_EQ(scene.background[2], 0.3f);
    EXPECT_FALSE(scene.has_alpha);
    ASSERT_EQ(scene.shapes.size(), 8u);
    EXPECT_EQ(std::get<PointShape>(scene.shapes[0].geometry).at.y, 2);
    EXPECT_EQ(std::get<DiscShape>(scene.shapes[1].geometry).radius, 3);
    EXPECT_EQ(scene.shapes[1].color[2], 2.5f);
    EXPECT_EQ(scene.shapes[1].color[3], 1);
    EXPECT_EQ(std::get<DiscShape>(scene.shapes[2].geometry).center.x, -4);
    EXPECT_EQ(scene.shapes[2].color[3], 0.5f);
    EXPECT_EQ(std::get<LineShape>(scene.shapes[3].geometry).cap, LineCap::round);
    EXPECT_EQ(std::get<PolylineShape>(scene.shapes[4].geometry).width, 1);
    EXPECT_TRUE(std::get<PolylineShape>(scene.shapes[4].geometry).closed);
    EXPECT_TRUE(std::get<PolylineShape>(scene.shapes[5].geometry).closed);  // an outline may be of any form
    EXPECT_EQ(std::get<PolygonShape>(scene.shapes[6].geometry).points.size(), 3u);
    EXPECT_EQ(scene.shapes[5].group, 0);
    EXPECT_NE(scene.shapes[6].group, 0);
    EXPECT_EQ(scene.shapes[6].group, scene.shapes[7].group);
    EXPECT_TRUE(parse_raster_scene(R"({"width":1,"height":1,"background":[0,0,0,0],"shapes":[]})", "").has_alpha);
}

TEST(RasterScene, SaysLineAndKeyOfWhatIsWrong) {
    struct Case {
        std::string text, words;
    };
    for (const Case& c : std::vector<Case>{
             {"[]", "line 1: a scene is a list"},
             {"{\"width\": 8,\n\"shapes\": []}", "line 1: a scene lacks \"height\""},
             {"{\"width\": 0, \"height\": 8, \"shapes\": []}", "\"width\" is not a whole number from 1 to 65536"},
             {"{\"width\": 8, \"height\": 1e99, \"shapes\": []}", "\"height\" is not"},
             {"{\"width\": 8, \"height\": 8,\n\n\"filter\": \"cone:0\", \"shapes\": []}", "line 3: \"filter\": cone:0"},
             {"{\"width\": 8, \"height\": 8, \"colour\": 1, \"shapes\": []}", "has no \"colour\"; choose among width"},
             {"{\"width\": 8, \"height\": 8, \"shapes\": {}}", "\"shapes\" is an object; write a list"},
             {"{\"width\": 8, \"height\": 8, \"shapes\": [], \"background\": [0, 0]}", "has 2 numbers; write 3 to 4"},
             {scene_of("7"), "line 2: \"shapes\" holds something that is not an object"},
             {scene_of("{\"at\": [1, 1]}"), "line 2: a shape lacks \"type\""},
             {scene_of("{\"type\": \"square\"}"), "line 2: \"type\" is unknown"},
             {scene_of("{\"type\": 7}"), "line 2: \"type\" is a number; write a text"},
             {scene_of("{\"type\": \"line\",\n\"from\": [1, 1], \"to\": [1]}"),
              "line 3: \"to\" has 1 numbers; write 2"},
             {scene_of("{\"type\": \"line\", \"from\": [1, 1], \"to\": [1, 2]}"), "line 2: a line lacks \"width\""},
             {scene_of("{\"type\": \"line\", \"from\": [1, 1], \"to\": [1, 2],\n\"width\": 0}"),
              "line 3: \"width\" is 0;"},
             {scene_of("{\"type\": \"disc\", \"center\": [1e10, 1], \"radius\": 1}"), "\"center\" is 1e+10"},
             {scene_of("{\"type\": \"disc\", \"center\": [1, 1], \"radius\": 1, \"width\": 1}"),
              "a disc has no \"width\""},
             {scene_of("{\"type\": \"disc\", \"center\": [1, 1], \"radius\": 1, \"color\": [1, 1, 1, 2]}"),
              "\"alpha\" is 2"},
             {scene_of("{\"type\": \"line\", \"from\": [1, 1], \"to\": [2, 2], \"width\": 1, \"cap\": \"square\"}"),
              "write \"butt\" or \"round\""},
             {scene_of("{\"type\": \"polygon\", \"points\": [[0, 0], [1, 1]]}"),
              "\"points\" has 2 points; write at least 3"},
             {scene_of("{\"type\": \"polygon\",\n\"points\": [[0, 0], [9, 0], [2, 2], [0, 9]]}"),
              "line 2: the polygon is not convex at its point 2"},
             {scene_of("{\"type\": \"group\", \"shapes\": [\n{\"type\": \"group\", \"shapes\": []}]}"),
              "line 3: a group holds a group"},
             {scene_of("{\"type\": \"group\", \"color\": [1, 1, 1], \"shapes\": []}"), "a group has no \"color\""},
         })
        EXPECT_NE(refusal(c.text).find(c.words), std::string::npos) << c.text << "\n" << refusal(c.text);
}

}  // namespace
}  // namespace bandlimit::job
