// Text-like glyphs, drawn with strokes and arcs.
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include "bandlimit/scene/flat.h"
#include "bandlimit/scene/hash.h"
#include "bandlimit/scene/scenes.h"

namespace bandlimit {
namespace {

/// A line, or an arc, of a glyph. Units: the height of small letters is 1, y up from the line on which they stand.
struct Stroke {
    bool is_arc = false;
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< ends; of an arc the middle, radius in x1
    double from = 0, turn = 0;              ///< of an arc, in degrees, counter-clockwise from the right
    double cos_middle = 1, sin_middle = 0, cos_half = -1;

    double distance2(double x, double y) const {
        if (!is_arc) {
            const double dx = x1 - x0, dy = y1 - y0;
            const double t = std::clamp(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
            const double ex = x - x0 - t * dx, ey = y - y0 - t * dy;
            return ex * ex + ey * ey;
        }
        const double dx = x - x0, dy = y - y0, r = std::sqrt(dx * dx + dy * dy);
        // Without caps: arcs end where lines go on, or in the open.
        if (dx * cos_middle + dy * sin_middle < cos_half * r) return 1e9;
        return (r - x1) * (r - x1);
    }
};

Stroke line(double x0, double y0, double x1, double y1) { return {false, x0, y0, x1, y1}; }
Stroke arc(double x, double y, double radius, double from, double turn) {
    constexpr double degree = std::numbers::pi / 180;
    const double middle = (from + turn / 2) * degree;
    return {true, x, y, radius, 0, from, turn, std::cos(middle), std::sin(middle), std::cos(turn / 2 * degree)};
}

struct Glyph {
    std::vector<Stroke> strokes;
};

const std::vector<Glyph>& alphabet() {
    static const std::vector<Glyph> glyphs{
        {{arc(.45, .45, .36, 0, 360)}},                                                  // o
        {{line(.1, .9, .1, 0), arc(.45, .5, .35, 0, 180), line(.8, .5, .8, 0)}},         // n
        {{line(.8, 0, .8, .9), arc(.45, .4, .35, 180, 180), line(.1, .4, .1, .9)}},      // u
        {{arc(.45, .45, .36, 0, 310), line(.1, .45, .81, .45)}},                         // e
        {{arc(.45, .45, .36, 45, 270)}},                                                 // c
        {{arc(.45, .45, .36, 0, 360), line(.81, 0, .81, 1.5)}},                          // d
        {{arc(.45, .45, .36, 0, 360), line(.09, 0, .09, 1.5)}},                          // b
        {{line(.1, 1.5, .1, 0), arc(.45, .5, .35, 0, 180), line(.8, .5, .8, 0)}},        // h
        {{line(.45, 0, .45, 1.5)}},                                                      // l
        {{line(.45, 0, .45, .9), line(.45, 1.15, .45, 1.3)}},                            // i
        {{line(.4, 1.3, .4, .3), arc(.65, .3, .25, 180, 120), line(.15, .9, .75, .9)}},  // t
        {{line(.05, .9, .45, 0), line(.45, 0, .85, .9)}},                                // v
        {{line(.05, .9, .85, 0), line(.05, 0, .85, .9)}},                                // x
        {{line(.1, .9, .1, 0), arc(.5, .45, .4, 40, 140)}},                              // r
        {{line(.1, 1.5, .1, 0), line(.75, .9, .1, .35), line(.3, .5, .8, 0)}},           // k
        {{line(.0, 0, .45, 1.5), line(.45, 1.5, .9, 0), line(.2, .5, .7, .5)}},          // A
        {{line(.1, 1.4, .85, 1.4), line(.1, 0, .1, 1.4), line(.1, .75, .7, .75)}},       // F
        {{arc(.45, 1.05, .33, 60, 210), arc(.45, .39, .33, 240, 210)}},                  // S
        {{arc(.45, .45, .36, 0, 360), line(.81, .9, .81, -.45)}},                        // q
        {{line(.1, .9, .8, .9), line(.8, .9, .1, 0), line(.1, 0, .8, 0)}},               // z
    };
    return glyphs;
}

/// A line of text: heights in pixels.
struct TextLine {
    double top = 0, height = 0;  ///< of the line
    double size = 0;             ///< of small letters
    double stroke = 0;           ///< half its width, in sizes
};

constexpr double line_heights[] = {6, 7, 8, 9, 11, 13, 16, 20, 26, 40};
constexpr int line_count = 10;

std::array<TextLine, line_count> text_lines() {
    std::array<TextLine, line_count> lines;
    double top = 4.3;
    for (int i = 0; i < line_count; ++i) {
        const double height = line_heights[i];
        lines[static_cast<std::size_t>(i)] = {top, height * 1.25, height / 2.2, 0.06 + 0.02 * (i % 3)};
        top += height * 1.25;
    }
    return lines;
}

/// How much of everything all lines take.
double block_height(const std::array<TextLine, line_count>& lines) { return lines.back().top + lines.back().height; }

/// Whether there is ink at a point of a line: `along` from its beginning, `up` from where its letters stand, in sizes.
bool is_ink(double along, double up, std::int64_t line_number, double half_stroke) {
    constexpr double advance = 1.12;
    const double place = std::floor(along / advance);
    const auto number = static_cast<std::int64_t>(place);
    const std::uint64_t bits = hash_bits(number, line_number, 7);
    if (bits % 6 == 0) return false;  // between words
    const std::vector<Glyph>& glyphs = alphabet();
    const Glyph& glyph = glyphs[(bits >> 8) % glyphs.size()];
    const double x = along - place * advance - 0.11;
    for (const Stroke& stroke : glyph.strokes)
        if (stroke.distance2(x, up) < half_stroke * half_stroke) return true;
    return false;
}

struct Page {
    std::array<TextLine, line_count> lines = text_lines();
    double height = block_height(lines);

    Vector3 operator()(double x, double y) const {
        const double block = std::floor(y / height), inside = y - block * height;
        const auto number = static_cast<std::int64_t>(block);
        const bool is_dark = (number & 1) != 0;  // every other block is light on dark
        const Vector3 paper = is_dark ? Vector3{0.02, 0.03, 0.05} : Vector3{0.9, 0.88, 0.82};
        for (int i = 0; i < line_count; ++i) {
            const TextLine& line = lines[static_cast<std::size_t>(i)];
            if (inside < line.top || inside >= line.top + line.height) continue;
            const double up = (line.top + line.height * 0.76 - inside) / line.size;
            if (!is_ink(x / line.size - 0.6, up, number * line_count + i, line.stroke)) return paper;
            return is_dark      ? Vector3{0.95, 0.9, 0.7}
                   : i % 4 == 3 ? Vector3{0.45, 0.03, 0.02}
                                : Vector3{0.02, 0.02, 0.03};
        }
        return paper;
    }
};

}  // namespace

Scene glyphs_scene(const SceneSetting& s) { return moved_scene(s.speed, Page()); }

}  // namespace bandlimit
