#include "apps/verbs/temporal_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/console/common.h"
#include "apps/page/false_color.h"
#include "apps/page/page.h"
#include "apps/page/plot.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/animated_png.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::app {
namespace {

using job::TemporalFrameReport, job::TemporalReport;
using Rows = std::vector<std::vector<std::string>>;

constexpr int frame_milliseconds = 100;

std::string text_of(const std::optional<double>& value, double scale, const char* unit) {
    return value ? fmt::format("{:.3g}{}", *value * scale, unit) : "unknown";
}

/// In CSS pixels: small pictures are enlarged by a whole factor, large ones fit the page.
int shown_width(int width, int at_least) { return width * std::max(1, at_least / width); }

void add_convergence(Page& page, const std::string& folder, const job::TemporalJob& job, const TemporalReport& r) {
    Series psnr{job.preset, {}, {}};
    for (const TemporalFrameReport& f : r.frames)
        if (f.psnr && std::isfinite(*f.psnr)) psnr.x.push_back(f.number), psnr.y.push_back(*f.psnr);
    if (psnr.x.empty()) return;
    page.section("Convergence", "PSNR to the truth in linear light, clamped to [0, 1], frame by frame.", {});
    draw({{"Distance to the truth", "frame", "PSNR in dB", {psnr}}}, folder + "/psnr.svg", 640, 400);
    page.figure("psnr.svg", "Higher is nearer to the truth.", "", 640);
}

void add_measures(Page& page, const TemporalReport& r) {
    const TemporalMeasures& m = r.measured;
    page.section("Measures",
                 fmt::format("Of the last {} frames, when history has filled. Codes are those of 8-bit sRGB.",
                             r.measured_frames),
                 {});
    page.table(
        {{"measure", "value", "what it means"},
         {"flicker", text_of(m.flicker, 255, " codes"),
          fmt::format("How much a pixel changes from frame to frame although nothing moves: its standard deviation, "
                      "mean over the {:.0f} % of pixels that stood still. Below 1 is hard to see.",
                      100 * m.still)},
         {"difference along the motion", text_of(m.warped_difference, 255, " codes"),
          "How much a point changes from one frame to where it is in the next: flicker of what moves, but also "
          "lights that change, and what interpolation loses."},
         {"error where disoccluded", text_of(m.error_disoccluded, 255, " / 255"),
          "Root mean square error in linear light of pixels that the frame before did not see. Far above the next "
          "line: ghosts, or noise where history begins anew."},
         {"error elsewhere", text_of(m.error_elsewhere, 255, " / 255"), "The same of all other pixels."},
         {"sharpness", text_of(sharpness(r), 1, ""),
          "Energy above half of Nyquist's frequency in the last frame, as a multiple of the truth's. Below 1 is blur, "
          "above 1 aliasing, noise or sharpening."},
         {"energy above half of Nyquist", text_of(r.high_frequencies, 100, " %"),
          fmt::format("As a share of all energy; of the truth: {}.", text_of(r.high_frequencies_of_truth, 100, " %"))},
         {"time a frame", fmt::format("{:.3g} ms", mean_milliseconds(r)),
          "Of the accumulation alone, without files, the truth and these measures."}},
        "Unknown is what needs a truth (--reference), two frames, something that moves, or something that does not.",
        "");
}

void write_codes_png(const std::string& path, const Image<std::uint8_t>& codes) {
    ImageTarget target;
    target.width = codes.width(), target.height = codes.height();
    target.channel_names = {"R", "G", "B"};
    ImageWriter writer(path, target);
    writer.write_rows(codes.view());
    writer.finish();
}

void add_pictures(Page& page, const std::string& folder, const job::TemporalJob& job, const TemporalReport& r) {
    const bool has_truth = r.high_frequencies_of_truth.has_value();
    const std::string which = has_truth ? "input, output and truth" : "input and output";
    page.section("Frames", fmt::format("The {} of each.", which), {});
    job::write_animated_png(folder + "/animation.png", r.animation, frame_milliseconds);
    const int width = r.animation.front().width();
    page.gallery({{"animation.png", fmt::format("From left to right: {}.", which)}},
                 fmt::format("The last {} frames, ten a second, at the size of the output; of large ones the middle.",
                             r.animation.size()),
                 "", shown_width(width, 960));
    write_codes_png(folder + "/sheet.png", r.sheet);
    std::string numbers;
    for (const int i : r.sheet_frames)
        numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", r.frames[static_cast<std::size_t>(i)].number);
    page.gallery({{"sheet.png", fmt::format("From top to bottom: {}. Frames {}.", which, numbers)}},
                 "Whole frames from the first to the last, scaled down where they are large.", "",
                 shown_width(r.sheet.width(), 960));
    const std::string last = (std::filesystem::path(job.out) / r.frames.back().file).string();
    job::write_picture(folder + "/last.png", job::read_picture(last).view());
    page.gallery({{"last.png", r.frames.back().file}}, "The last frame.", "", shown_width(r.width, 480));
}

/// Numbers of the last frame as colours, with what the colours mean.
void add_views(Page& page, const std::string& folder, const TemporalReport& r) {
    constexpr double most = 0.995;  // a few outliers do not make all others black
    const job::TemporalViews& v = r.views;
    std::vector<Page::Tile> tiles;
    const auto add = [&](const char* file, const Image<float>& codes, const std::string& caption) {
        job::write_data(folder + "/" + file, codes.view());
        tiles.push_back({file, caption});
    };
    const double weight = peak_of(v.frame_weight.view(), 1, 1e-6), memory = peak_of(v.memory.view(), most, 1e-6);
    const double rejection = peak_of(v.rejection.view(), most, 1e-3), motion = peak_of(v.motion.view(), most, 1e-3);
    add("weight.png", divergence_of(v.frame_weight.view(), weight),
        fmt::format("K, the weight of this frame's samples: white 0, dark red {:.3g}, blue below 0. A pixel near a "
                    "sample learns more from the frame.",
                    weight));
    add("memory.png", ramp_of(v.memory.view(), memory),
        fmt::format("W, the weight of all that a pixel remembers: black 0, pale yellow {:.3g}. Dark is new, noisy, "
                    "and fast to change.",
                    memory));
    add("rejection.png", ramp_of(v.rejection.view(), rejection),
        fmt::format("Rejection, how far history lay outside of the colours about the pixel, in their spreads: black "
                    "0, pale yellow {:.3g}.",
                    rejection));
    add("motion.png", directions_of(v.motion.view(), motion),
        fmt::format("Motion that history was followed by: the hue is the direction to where a point was (red right, "
                    "yellow-green down, cyan left, violet up), full brightness {:.3g} pixels of the output; black "
                    "stands still.",
                    motion));
    add("disocclusion.png", ramp_of(v.disocclusion.view(), 1),
        "Disocclusion: pale yellow where history is of something else, by its depth, or lies outside the picture.");
    page.section("What the last frame found out", "Each picture has the size of the output.", {});
    page.gallery(tiles, "The debug views of the step (TemporalDebug in antialias/temporal.h).", "",
                 std::min(shown_width(r.width, 320), 480));
}

}  // namespace

double mean_milliseconds(const TemporalReport& report) {
    double sum = 0;
    for (const TemporalFrameReport& f : report.frames) sum += f.ms;
    return report.frames.empty() ? 0 : sum / static_cast<double>(report.frames.size());
}

std::optional<double> sharpness(const TemporalReport& report) {
    const std::optional<double>&found = report.high_frequencies, &wanted = report.high_frequencies_of_truth;
    if (!found || !wanted || !(*wanted > 0)) return std::nullopt;
    return *found / *wanted;
}

void write_temporal_page(const std::string& folder, const job::TemporalJob& job, const TemporalReport& r,
                         const std::string& command) {
    Page page("bandlimit temporal",
              fmt::format("{}, {} frames, {} x {} to {} x {}, preset {}.", job.input, r.frames.size(), r.in_width,
                          r.in_height, r.width, r.height, job.preset));
    if (r.frames.back().psnr) page.headline("PSNR of the last frame", fmt::format("{:.2f} dB", *r.frames.back().psnr));
    if (r.measured.flicker) page.headline("flicker, in codes of 255", fmt::format("{:.2f}", *r.measured.flicker * 255));
    if (const std::optional<double> s = sharpness(r))
        page.headline("sharpness, 1 as the truth", fmt::format("{:.2f}", *s));
    page.headline("a frame", fmt::format("{:.1f} ms", mean_milliseconds(r)));
    add_convergence(page, folder, job, r);
    add_measures(page, r);
    add_pictures(page, folder, job, r);
    add_views(page, folder, r);
    Rows rows{{"frame", "PSNR in dB", "SSIM", "ms"}};
    for (const TemporalFrameReport& f : r.frames)
        rows.push_back({f.file, f.psnr ? fmt::format("{:.2f}", *f.psnr) : "-",
                        f.ssim ? fmt::format("{:.4f}", *f.ssim) : "-", fmt::format("{:.1f}", f.ms)});
    page.section("All frames", "Milliseconds are those of the accumulation alone.", {});
    page.table(rows, "The same as JSON: report.json.", command);
    write_text(folder + "/index.html", page.html());
}

}  // namespace bandlimit::app
