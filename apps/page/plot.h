// Figures of curves, drawn by gnuplot.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bandlimit::app {

/// Values over positions. Those that are not finite leave a gap.
struct Series {
    enum class Style {
        line,
        points,  ///< a mark each
        stems    ///< a mark each, and a line down to 0: discrete weights
    };

    std::string label;  ///< in the legend; none if empty
    std::vector<double> x, y;
    Style style = Style::line;
};

/// `steps` + 1 points of f, evenly from `from` to `to`.
Series curve(const std::string& label, double from, double to, int steps, const std::function<double(double)>& f);

/// Weights at distances of 1, the first of them at `first`.
Series stems(const std::string& label, double first, const std::vector<double>& weights);

struct Range {
    double from = 0, to = 1;
};

/// Values on a grid as colours: white is 0, orange and red are above it, blue is below. Pixels are square, the first
/// row is at the top.
struct HeatMap {
    int width = 0, height = 0;
    std::vector<double> values = {};  ///< row after row
    double peak = 1;                  ///< the magnitude of the deepest colours
    double first = 0, step = 1;       ///< where the first column and row are on the axes, and how far the next is
};

/// One pair of axes. Labels say the unit.
struct Panel {
    std::string title, x_label, y_label;
    std::vector<Series> series;
    std::optional<Range> x_range = {}, y_range = {};  ///< default: what the series need
    std::optional<HeatMap> map = {};                  ///< in place of series and ranges
};

/// Draws panels side by side, on a white ground, as SVG or PNG by the extension of `path`.
///
/// units    width and height in pixels
/// throws   Error for no panel, a series of x and y of different lengths, a map whose values do not fill it, or another
///          extension; std::runtime_error if
///          gnuplot is missing or fails, or the file cannot be written. It appears whole or not at all
void draw(const std::vector<Panel>& panels, const std::string& path, int width, int height);

/// Throws Error unless draw() knows the extension of `path`; before that, std::runtime_error for something that exists
/// there and is no regular file.
void check_plot_format(const std::string& path);

}  // namespace bandlimit::app
