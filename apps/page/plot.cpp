#include "apps/page/plot.h"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "bandlimit/core/error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/image_file.h"

extern char** environ;

namespace bandlimit::app {
namespace {

/// Okabe & Ito 2008: told apart with every kind of colour vision.
constexpr std::array colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"};

/// A string that gnuplot prints as it is.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\' || c == '$' || c == '`') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out + "\"";
}

constexpr double legend_line = 18;  // pixels

bool is_svg(const std::string& path) { return path.ends_with(".svg"); }

std::string range(const char* axis, const std::optional<Range>& r) {
    return r ? fmt::format("set {}range [{:.17g}:{:.17g}]\n", axis, r->from, r->to)
             : fmt::format("set {}range [*:*]\n", axis);
}

/// Data of a series as a named block.
std::string data_block(const Series& series, std::size_t index) {
    std::string text = fmt::format("$d{} << EOD\n", index);
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (std::isfinite(series.x[i]) && std::isfinite(series.y[i]))
            text += fmt::format("{:.9g} {:.9g}\n", series.x[i], series.y[i]);
        else text += "\n";
    }
    return text + "EOD\n";
}

/// The clauses of a plot command that draw one series.
std::string clauses(const Series& series, std::size_t index) {
    const std::string color = colors[index % colors.size()];
    const std::string label = series.label.empty() ? "notitle" : "title " + quoted(series.label);
    const std::string marks = fmt::format("$d{} using 1:2 with points pt 7 ps 0.6 lc rgb \"{}\" ", index, color);
    switch (series.style) {
        case Series::Style::line:
            return fmt::format("$d{} using 1:2 with lines lw 1.8 lc rgb \"{}\" {}", index, color, label);
        case Series::Style::points: return marks + label;
        case Series::Style::stems:
            return marks + label +
                   fmt::format(", $d{} using 1:2 with impulses lw 1.2 lc rgb \"{}\" notitle", index, color);
    }
    return {};
}

/// How the legend of a panel is laid out.
struct Legend {
    std::size_t labels = 0, lines = 0;
};

/// As many entries on a line as fit below a panel of this many pixels.
Legend legend_of(const Panel& panel, double panel_width) {
    constexpr double letter = 7, sample = 45;  // pixels, of the fonts below
    Legend legend;
    std::size_t longest = 0;
    for (const Series& series : panel.series) {
        legend.labels += !series.label.empty();
        longest = std::max(longest, series.label.size());
    }
    const auto fitting = static_cast<std::size_t>(panel_width / (letter * static_cast<double>(longest) + sample));
    const std::size_t columns = std::max<std::size_t>(1, fitting);
    legend.lines = (legend.labels + columns - 1) / columns;
    return legend;
}

/// Pixels around the axes, the same for all panels, so that they line up.
struct Frame {
    double left = 75, right = 20, between = 95, top = 16, bottom = 80;
    double panel_width = 0, legend = 0;
};

Frame frame_of(const std::vector<Panel>& panels, int width) {
    Frame frame;
    // What the colours mean stands to the right of a map.
    if (panels.back().map) frame.right = 65;
    if (std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.map.has_value(); }))
        frame.between = 115;
    const auto count = static_cast<double>(panels.size());
    frame.panel_width = (width - frame.left - frame.right - (count - 1) * frame.between) / count;
    std::size_t lines = 0;
    for (const Panel& panel : panels) {
        if (!panel.title.empty()) frame.top = 44;
        lines = std::max(lines, legend_of(panel, frame.panel_width).lines);
    }
    frame.legend = legend_line * static_cast<double>(lines);
    frame.bottom += frame.legend;
    return frame;
}

std::string map_commands(const HeatMap& map) {
    std::string text = "$map << EOD\n";
    for (std::size_t i = 0; i < map.values.size(); ++i)
        text += fmt::format("{:.5g}{}", map.values[i], (i + 1) % static_cast<std::size_t>(map.width) ? ' ' : '\n');
    const auto edge = [&](double i) { return map.first + (i - 0.5) * map.step; };
    text += fmt::format("EOD\nunset key\nset size ratio -1\nset xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n",
                        edge(0), edge(map.width), edge(map.height), edge(0));
    return text + fmt::format(
                      "set cbrange [{0:.9g}:{1:.9g}]\n"
                      "set palette defined (-1 \"#08306b\", -0.5 \"#56b4e9\", 0 \"#ffffff\", 0.5 \"#e69f00\", "
                      "1 \"#7f1d00\")\n"
                      "set colorbox user origin graph 1.03, graph 0 size graph 0.04, graph 1\n"
                      "plot $map matrix using ({2:.9g} + {3:.9g} * $1):({2:.9g} + {3:.9g} * $2):3 with image notitle\n"
                      "set size noratio\n",
                      -map.peak, map.peak, map.first, map.step);
}

std::string panel_commands(const Panel& panel, const Frame& frame, int height) {
    std::string text = "set title " + quoted(panel.title) + "\nset xlabel " + quoted(panel.x_label) + "\nset ylabel " +
                       quoted(panel.y_label) + "\n";
    if (panel.map) return text + map_commands(*panel.map);
    text += range("x", panel.x_range) + range("y", panel.y_range);
    std::string plot;
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        text += data_block(panel.series[i], i);
        plot += (i ? ", " : "plot ") + clauses(panel.series[i], i);
    }
    const Legend legend = legend_of(panel, frame.panel_width);
    text += legend.lines == 0
                ? "unset key\n"
                : fmt::format("set key center top at graph 0.5, screen {:.4f} vertical maxrows {} samplen 1.5\n",
                              (frame.legend + 6) / height, legend.lines);
    return text + plot + "\n";
}

std::string script(const std::vector<Panel>& panels, const std::string& path, int width, int height) {
    std::string text = fmt::format("set terminal {} size {},{} noenhanced font \"sans,{}\" background rgb \"white\"\n",
                                   is_svg(path) ? "svg" : "pngcairo", width, height, is_svg(path) ? 13 : 10);
    text +=
        "set border 3 lc rgb \"#555555\"\n"
        "set tics nomirror out scale 0.5 textcolor rgb \"#333333\"\n"
        "set grid lc rgb \"#dddddd\" lt 1 lw 0.6\n"
        "set xzeroaxis lt 1 lw 0.8 lc rgb \"#999999\"\n";
    const Frame frame = frame_of(panels, width);
    text += fmt::format("set multiplot layout 1,{} margins {:.4f},{:.4f},{:.4f},{:.4f} spacing {:.4f}\n", panels.size(),
                        frame.left / width, 1 - frame.right / width, frame.bottom / height, 1 - frame.top / height,
                        frame.between / width);
    for (const Panel& panel : panels) text += panel_commands(panel, frame, height);
    return text + "unset multiplot\n";
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporary_file() {
    File file(std::tmpfile(), std::fclose);
    if (!file)
        throw std::runtime_error(message("a temporary file cannot be made for gnuplot (", std::strerror(errno), ")"));
    return file;
}

/// A child that is waited for, whatever happens.
class Child {
public:
    Child(const char* program, int in, int out, int error) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, error, STDERR_FILENO);
        std::string name = program;
        std::array<char*, 2> arguments{name.data(), nullptr};
        failure_ = posix_spawnp(&id_, program, &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    ~Child() { wait(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    int failure() const { return failure_; }
    /// Whether it ended well.
    bool wait() {
        if (failure_ == 0 && !waited_) waited_ = waitpid(id_, &status_, 0) == id_;
        return waited_ && WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
    }

private:
    pid_t id_ = -1;
    int failure_ = 0, status_ = 0;
    bool waited_ = false;
};

/// The first line that holds something.
std::string first_line(std::FILE* file) {
    std::rewind(file);
    std::array<char, 300> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), file)) {
        std::string text = line.data();
        while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
        if (text.find_first_not_of(" ^\t") != std::string::npos) return text;
    }
    return "it says nothing";
}

/// Runs gnuplot, whose picture goes to `out`.
void run_gnuplot(const std::string& commands, const std::string& path, AtomicFile& out) {
    const File in = temporary_file(), errors = temporary_file(), picture = temporary_file();
    if (std::fwrite(commands.data(), 1, commands.size(), in.get()) != commands.size() || std::fflush(in.get()) != 0)
        throw std::runtime_error("the temporary file for gnuplot cannot be written; is the disk full?");
    std::rewind(in.get());
    Child gnuplot("gnuplot", fileno(in.get()), fileno(picture.get()), fileno(errors.get()));
    if (gnuplot.failure())
        throw std::runtime_error(path + ": gnuplot, which draws figures, cannot be started (" +
                                 std::strerror(gnuplot.failure()) + "); install it, as the package gnuplot-nox");
    if (!gnuplot.wait()) throw std::runtime_error(path + ": gnuplot failed: " + first_line(errors.get()));
    std::rewind(picture.get());
    std::array<char, 1 << 16> block{};
    std::size_t total = 0;
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), picture.get())) {
        out.write(block.data(), count);
        total += count;
    }
    if (total == 0) throw std::runtime_error(path + ": gnuplot drew nothing: " + first_line(errors.get()));
}

void check_panel(const Panel& panel) {
    if (panel.map) {
        const HeatMap& map = *panel.map;
        const auto cells = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
        if (map.values.empty() || map.values.size() != cells || !(map.peak > 0))
            fail("draw: map \"", panel.title, "\" of ", map.width, " x ", map.height, " has ", map.values.size(),
                 " values and the peak ", map.peak, "; pass as many as it has cells, and a peak above 0");
        return;
    }
    if (panel.series.empty()) fail("draw: panel \"", panel.title, "\" has no series; pass at least one");
    for (const Series& series : panel.series)
        if (series.x.size() != series.y.size() || series.x.empty())
            fail("draw: series \"", series.label, "\" has ", series.x.size(), " x and ", series.y.size(),
                 " y; pass as many of both, and some");
}

}  // namespace

Series curve(const std::string& label, double from, double to, int steps, const std::function<double(double)>& f) {
    Series series{label, {}, {}, Series::Style::line};
    for (int i = 0; i <= steps; ++i) {
        const double x = from + (to - from) * i / steps;
        series.x.push_back(x);
        series.y.push_back(f(x));
    }
    return series;
}

Series stems(const std::string& label, double first, const std::vector<double>& weights) {
    Series series{label, {}, weights, Series::Style::stems};
    for (std::size_t j = 0; j < weights.size(); ++j) series.x.push_back(first + static_cast<double>(j));
    return series;
}

void check_plot_format(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) check_output_path(path);
    if (!is_svg(path) && !path.ends_with(".png"))
        fail("plot \"", path, "\" is not a kind of file that can be drawn; end the name in .svg or .png");
}

void draw(const std::vector<Panel>& panels, const std::string& path, int width, int height) {
    if (panels.empty()) fail("draw: no panel; pass at least one");
    for (const Panel& panel : panels) check_panel(panel);
    check_plot_format(path);
    AtomicFile out(path);
    run_gnuplot(script(panels, path, width, height), path, out);
    out.commit();
}

}  // namespace bandlimit::app
