// Antialiasing and upscaling over time: which rule converges to what.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/metrics.h"
#include "bandlimit/antialias/supersample.h"
#include "bandlimit/antialias/temporal.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/sampling/sequence.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit::app {
namespace {

const Citation filters{"M. Agopian (pixelflinger)", "Correct application of the Lanczos filter in 2D",
                       "README of the repository pixelflinger/lanczos-2d", "2025"};

/// A scene at the size of the output, its jittered frames at that of the input.
struct Setting {
    const char* scene;
    int width, height;
    int scale;
    int frames;
};

/// A preset, and what it shows after each frame.
struct Trial {
    std::string preset;
    TemporalHistory history;
    Image<float> shown;
    Series error;  ///< after each frame
};

/// What a trial that has taken some frames is compared with.
using Compare = std::function<double(const Trial& trial)>;

struct Trials {
    std::vector<Trial> trials;
    Image<float> last_frame;

    const Trial& of(const std::string& preset) const {
        return *std::ranges::find(trials, preset, [](const Trial& t) { return t.preset; });
    }
};

/// Runs presets over the frames of a scene. `compare`, if any, is asked after each of them.
Trials run(const Setting& s, const std::vector<std::string>& presets, const Compare& compare, Parallel parallel) {
    const Scene seen = with_larger_pixels(make_scene(s.scene, s.width, s.height), s.scale, s.scale);
    const std::vector<Point> jitter = jitter_sequence(JitterKind::halton, jitter_length(s.scale));
    Trials all;
    for (const std::string& preset : presets)
        all.trials.push_back({preset,
                              TemporalHistory(s.width, s.height),
                              Image<float>(s.width, s.height, 3, Layout::interleaved),
                              {preset, {}, {}}});
    for (int i = 0; i < s.frames; ++i) {
        const Point offset = jitter[static_cast<std::size_t>(i) % jitter.size()];
        all.last_frame = render_scene(seen, s.width / s.scale, s.height / s.scale, i, {.jitter = offset}, parallel);
        const View<const float> frame = std::as_const(all.last_frame).view();
        for (Trial& trial : all.trials) {
            accumulate(trial.history,
                       {.color = channels_of(frame, scene_channel::color, 3),
                        .depth = channels_of(frame, scene_channel::depth, 1),
                        .motion = channels_of(frame, scene_channel::motion, 2),
                        .jitter = offset},
                       temporal_preset(trial.preset), trial.shown.view(), parallel);
            if (!compare) continue;
            trial.error.x.push_back(i + 1);
            trial.error.y.push_back(compare(trial));
        }
    }
    return all;
}

/// The truth: RGB of many samples per pixel.
Image<float> truth_of(const Setting& s, const Kernel& kernel, Parallel parallel) {
    return supersample(make_scene(s.scene, s.width, s.height), s.width, s.height, s.frames - 1,
                       {.pattern = regular_pattern(64), .kernel = kernel}, parallel);
}

/// PSNR in dB where all is within [0, 1], as a display shows it.
double psnr_to(const Image<float>& truth, View<const float> picture) {
    const auto clamped = [](View<const float> from) {
        Image<float> to(from.width, from.height, 3);
        for (int c = 0; c < 3; ++c)
            for (int y = 0; y < from.height; ++y)
                for (int x = 0; x < from.width; ++x) to.view()(x, y, c) = std::clamp(from(x, y, c), 0.0f, 1.0f);
        return to;
    };
    return psnr(clamped(picture).view(), clamped(truth.view()).view());
}

std::string write_rgb(const Tour& tour, const std::string& file, View<const float> picture) {
    job::write_picture(tour.path(file), channels_of(picture, 0, 3));
    return file;
}

void native_part(Tour& tour) {
    tour.page.section(
        "Antialiasing over time: one sample per pixel and frame",
        "Each frame is rendered with the camera moved by another part of a pixel. History is read where things were, "
        "and the new samples are added by the weights of a kernel about each output pixel. What moves must forget: "
        "reading between samples blurs, and what was hidden has no history.",
        filters);
    const Setting setting{"mover", 160, 90, 1, 16};
    const std::vector<std::string> presets{"balanced", "reference", "per-frame", "input-sized"};
    const Trials trials = run(setting, presets, {}, tour.parallel);
    const Image<float> truth = truth_of(setting, box(), tour.parallel);
    std::vector<Page::Tile> tiles{{write_rgb(tour, "time-truth.png", truth.view()), "truth: 64 samples"},
                                  {write_rgb(tour, "time-frame.png", trials.last_frame.view()),
                                   fmt::format("one frame: {:.1f} dB", psnr_to(truth, trials.last_frame.view()))}};
    for (const Trial& trial : trials.trials)
        tiles.push_back({write_rgb(tour, fmt::format("time-{}.png", trial.preset), trial.shown.view()),
                         fmt::format("{}: {:.1f} dB", trial.preset, psnr_to(truth, trial.shown.view()))});
    tour.page.gallery(
        tiles,
        "A flying box, a rolling ball and thin poles, after 16 frames. balanced rejects history of another depth; "
        "reference and the plain rules believe all of it, and leave ghosts behind what moves. Without upscaling the "
        "plain "
        "rules are as good as reference: every pixel gets about one sample a frame.",
        "bandlimit temporal mover smooth --size 160x90 --frames 16 --report smooth/report", 320);
    tour.page.headline("a moving scene at 1x: one frame / balanced, against the truth",
                       fmt::format("{:.1f} / {:.1f} dB", psnr_to(truth, trials.last_frame.view()),
                                   psnr_to(truth, trials.of("balanced").shown.view())));
}

void plate_part(Tour& tour) {
    tour.page.section(
        "Upscaling twofold: which rule converges to what",
        "Twice as wide and high, a frame has a sample for one of four output pixels: the sum of weights of a pixel is "
        "large in some frames and about 0 in others. Rules that divide each frame by its own sum count both alike, "
        "and never arrive. A kernel as wide as the input's pixels always finds samples, and blurs for good. Keeping "
        "the sum of weights beside the mean, and dividing once, gives what supersampling gives.",
        filters);
    const Setting setting{"zoneplate", 128, 128, 2, 32};
    const Image<float> sharp = truth_of(setting, lanczos(2), tour.parallel);
    const Image<float> soft = truth_of(setting, temporal_preset("balanced").kernel, tour.parallel);
    const auto rms_to = [](const Image<float>& truth, View<const float> picture) {
        return std::sqrt(mse(channels_of(picture, 0, 1), channels_of(truth.view(), 0, 1), 6));
    };
    const Compare compare = [&](const Trial& trial) {
        return rms_to(trial.preset == "balanced" ? soft : sharp, trial.shown.view());
    };
    const std::vector<std::string> presets{"balanced", "reference", "per-frame", "input-sized"};
    const Trials trials = run(setting, presets, compare, tour.parallel);
    const auto error_of = [&](const std::string& preset) { return trials.of(preset).error.y.back(); };
    std::vector<Page::Tile> tiles{
        {write_rgb(tour, "twice-truth.png", sharp.view()), "truth: 64 samples, Lanczos-2"},
        {write_rgb(tour, "twice-frame.png", trials.last_frame.view()), "one frame: a quarter of the pixels"}};
    for (const Trial& trial : trials.trials)
        tiles.push_back({write_rgb(tour, fmt::format("twice-{}.png", trial.preset), trial.shown.view()),
                         fmt::format("{}: RMS {:.3f}", trial.preset, trial.error.y.back())});
    tour.page.gallery(tiles,
                      fmt::format("After 32 frames, one period of the jitter. per-frame is wrong by {:.2f} where the "
                                  "plate itself deviates from grey by {:.2f}: it shows rings that are not there. "
                                  "input-sized has lost the fine ones.",
                                  error_of("per-frame"), 1 / std::sqrt(8.0)),
                      "bandlimit temporal zoneplate plate --size 64x64 --scale 2 --preset per-frame --frames 32", 256);
    tour.page.headline(
        "RMS error on a zone plate at 2x: reference / per-frame / input-sized",
        fmt::format("{:.3f} / {:.2f} / {:.2f}", error_of("reference"), error_of("per-frame"), error_of("input-sized")));

    Panel panel{.title = "", .x_label = "frames", .y_label = "RMS error", .series = {}};
    for (const Trial& trial : trials.trials) panel.series.push_back(trial.error);
    tour.page.figure(
        tour.plot("twice.svg", {panel}, 720, 380),
        "How far each rule is from supersampling with its own kernel (input-sized: with the output's), by 64 samples. "
        "What is left of balanced and reference is that a period brings eight samples per pixel: from supersampling "
        "with the same eight, reference differs by less than 1e-6. The plain rules stay wrong, however long they run.",
        "bandlimit temporal zoneplate plate --size 64x64 --scale 2 --preset reference --report plate/report", 720);
}

void glyphs_part(Tour& tour) {
    tour.page.section("Upscaling twofold: text",
                      "The same with letters of 6 pixels and more. One frame holds a quarter of the pixels of the "
                      "output, and no letter of its smallest lines; after a period of the jitter they can be read.",
                      filters);
    const Setting setting{"glyphs", 160, 90, 2, 32};
    const Image<float> truth = truth_of(setting, box(), tour.parallel);
    const Compare compare = [&](const Trial& trial) { return psnr_to(truth, trial.shown.view()); };
    const Trials trials = run(setting, {"balanced", "sharp", "per-frame"}, compare, tour.parallel);
    std::vector<Page::Tile> tiles{{write_rgb(tour, "text-truth.png", truth.view()), "truth: 64 samples, box"},
                                  {write_rgb(tour, "text-frame.png", trials.last_frame.view()), "one frame, 80 x 45"}};
    for (const Trial& trial : trials.trials)
        tiles.push_back({write_rgb(tour, fmt::format("text-{}.png", trial.preset), trial.shown.view()),
                         fmt::format("{}: {:.1f} dB", trial.preset, trial.error.y.back())});
    tour.page.gallery(tiles, "After 32 frames.", "bandlimit temporal glyphs text --size 80x45 --scale 2 --frames 32",
                      320);
    Panel panel{.title = "", .x_label = "frames", .y_label = "PSNR (dB)", .series = {}};
    for (const Trial& trial : trials.trials) panel.series.push_back(trial.error);
    tour.page.figure(tour.plot("text.svg", {panel}, 720, 380),
                     "PSNR to the truth. After one period every pixel has had eight samples, and little is to be won.",
                     "bandlimit temporal glyphs text --size 80x45 --scale 2 --frames 32 --report text/report", 720);
}

}  // namespace

void tour_temporal(Tour& tour) {
    native_part(tour);
    plate_part(tour);
    glyphs_part(tour);
}

}  // namespace bandlimit::app
