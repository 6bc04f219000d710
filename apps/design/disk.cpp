// bandlimit design disk: discs out of separable filters, for depth of field.
#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "apps/design/design.h"
#include "bandlimit/job/designs.h"

namespace bandlimit::app {
namespace {

constexpr double largest_radius = 10'000;
constexpr int longest_reach = 32'767;  // a taps.json holds no more

struct Options {
    job::DiskJob job;
    std::string preset = "fit";
};

void check(Options& o) {
    if (o.preset != "published" && o.preset != "fit")
        throw UsageError(fmt::format("--preset: \"{}\" is not a preset; choose fit or published", o.preset));
    o.job.is_published = o.preset == "published";
    job::check(o.job);
}

std::string origin_of(const job::DiskReport& disk) {
    if (disk.published_radius == 0) return "the nearest to a disc";
    return fmt::format("as published, scaled from radius {:.4g} and to height {:.3g}", disk.published_radius,
                       disk.published_scale);
}

std::string band_text(const DiskBand& band) {
    return fmt::format("half at {:.4f}, 0 at {:.4f} cycles per radius, then up to {:.3f}", band.half, band.zero,
                       band.leakage);
}

std::vector<std::string> lines_of(const job::DiskReport& disk) {
    const DiskProfile profile = disk_profile(disk.components);
    const DiskBand band = disk_band([&](double f) { return disk_response(disk.components, f); });
    std::vector<std::string> lines{fmt::format("disk          {} component{}, {}", disk.components.size(),
                                               disk.components.size() == 1 ? "" : "s", origin_of(disk))};
    for (const Component& c : disk.components)
        lines.push_back(fmt::format("component     a {:9.6f}   b {:9.6f}   A {:9.6f}   B {:9.6f}", c.a, c.b, c.A, c.B));
    lines.push_back(fmt::format("error         {:.5f}: the integral of (weight - disc)^2, relative to that of disc^2",
                                *disk.file.error));
    lines.push_back(fmt::format("edge          leaves 1 at {:.4f} and is 0 at {:.4f} radii; {:.3f} at the centre",
                                profile.flat_until, profile.zero_from, profile.centre));
    lines.push_back(fmt::format("ringing       {:.3f} inside, {:.3f} outside, of a disc of height 1",
                                profile.inner_ringing, profile.outer_ringing));
    lines.push_back("passband      " + band_text(band));
    lines.push_back("of a disc     " + band_text(disk_band(disc_response)));
    return lines;
}

std::vector<Panel> panels_of(const job::DiskReport& disk) {
    const std::string label = fmt::format("{} component{}, error {:.4f}", disk.components.size(),
                                          disk.components.size() == 1 ? "" : "s", *disk.file.error);
    const Series disc{"disc", {0, 1, 1, 2}, {1, 1, 0, 0}};
    return {{"Profile",
             "radii from the centre",
             "weight",
             {disc, curve(label, 0, 2, 800, [&](double r) { return value_at(disk.components, r); })}},
            {"Response",
             "cycles per radius",
             "gain",
             {curve("disc", 0, 3, 600, disc_response),
              curve(label, 0, 3, 600, [&](double f) { return disk_response(disk.components, f); })}}};
}

Design make(const Options& o) {
    const job::DiskReport disk = job::design_disk(o.job);
    Design design;
    design.file = disk.file;
    design.intermediates = 2 * static_cast<int>(disk.components.size());
    design.lines = lines_of(disk);
    design.lines.push_back(fmt::format("weights       2 x {} products of {} weights for a radius of {:.6g} pixels{}",
                                       disk.components.size(), 2 * disk.reach + 1, disk.radius,
                                       o.job.radius > 0 ? "" : "; --radius PX for another"));
    if (o.job.radius > 0)
        design.lines.push_back(fmt::format("sum           {:.6g}, of {:.6g} that a disc of height 1 has",
                                           sum(disk.file.terms), std::numbers::pi * disk.radius * disk.radius));
    design.panels = panels_of(disk);
    return design;
}

}  // namespace

void add_design_disk(const DesignVerb& verb) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        verb, "disk", "A disc from separable filters: complex phasors times Gaussians, for depth of field",
        "bandlimit design disk --components 2 --radius 25 --plot disk.svg -o disk.json", [o] { check(*o); },
        [o](Console&) { return make(*o); });
    app.add_option("--components", o->job.components,
                   "Phasors, 1 to 5; each needs two pictures between the passes. Default 2")
        .type_name("N");
    app.add_option("--preset", o->preset,
                   "fit: the nearest to a disc, the default; published: the parameters of Niemitalo 2011 for 1 or 2")
        .type_name("NAME");
    app.add_option("--radius", o->job.radius,
                   "Radius of the disc in pixels: adds its weights, as terms. Without it, costs are printed for 25")
        .in_range(0.01, largest_radius)
        .type_name("PX");
    app.add_option("--reach", o->job.reach,
                   "Weights left and right of the middle one; default: far enough that at most 1 % of the sum is lost; "
                   "for published, as in Garcia 2017")
        .in_range(0, longest_reach)
        .type_name("PX");
}

}  // namespace bandlimit::app
