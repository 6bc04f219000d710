// The page of an audit: findings, measured kernels over nominal ones, and the zone plate.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "apps/page/page.h"
#include "apps/page/plot.h"
#include "apps/verbs/audit_report.h"
#include "bandlimit/analysis/audit_scene.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {

using job::kernel_text, job::ratio_text;

namespace {

/// The kernel that was recognised, scaled like measured weights: by the sum of its values a pitch of the source apart.
Series nominal(const KernelFinding& kernel, const Ratio& ratio) {
    const Candidate& c = kernel.candidate;
    const double stretch = ratio.stretch(), radius = c.kernel.radius * c.widening;
    double sum = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i)
        sum += c.kernel.value((2 * (i + 0.5) / steps - 1) * c.kernel.radius) * 2 * radius / steps;
    Series series;
    series.label = (kernel.is_known ? "" : "nearest known: ") + kernel_text(kernel, ratio);
    if (!kernel.is_known) series.label = "nearest known: " + kernel.name;
    const double far = std::min(5.0, radius + 0.5);
    // A sampled box or nearest has no curve of its own between samples: its integral stands for it.
    const bool picks =
        c.kernel.form == Kernel::Form::nearest || (c.kernel.form == Kernel::Form::area && !ratio.shrinks());
    for (int i = -400; i <= 400; ++i) {
        const double x = far * i / 400;
        series.x.push_back(x);
        if (picks) series.y.push_back(std::abs(x) * stretch < 0.5 ? stretch : 0);
        else series.y.push_back(c.kernel.value(x / c.widening) / sum);
    }
    return series;
}

/// What bandlimit makes of the same zone plate in linear light of the same meaning.
Image<float> own_plate(const ScaleReport& s, Light light, double code) {
    const PictureScene scene = picture_scene(s.ratio, light, code);
    const Image<float> drawn = draw(scene);
    Image<float> plate(scene.width, scene.width);
    for (int y = 0; y < scene.width; ++y)
        for (int x = 0; x < scene.width; ++x)
            plate.view()(x, y) = static_cast<float>(decode(light, double(drawn.view()(x, y))));
    Image<float> out = resample(plate.view(), s.plate.width(), s.plate.height());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.view()(x, y) = static_cast<float>(encode(light, double(out.view()(x, y))));
    return out;
}

void add_scale(Page& page, const AuditReport& report, const ScaleReport& s, const std::string& folder) {
    const std::string name = fmt::format("{}-to-{}", s.ratio.from, s.ratio.to);
    const AxisReport& a = s.x;
    page.section(fmt::format("Scale {}", ratio_text(s.ratio)),
                 fmt::format("Along x: {}; placed by {}, shift {:.3f} output pixels. Along y: {}; {}, {:.3f}.",
                             kernel_text(a.kernel, s.ratio), a.alignment, a.shift, kernel_text(s.y.kernel, s.ratio),
                             s.y.alignment, s.y.shift),
                 {});
    draw({kernel_panel(s.x, s.ratio, "along x"), kernel_panel(s.y, s.ratio, "along y")},
         folder + "/kernel-" + name + ".png", 1000, 420);
    page.figure(
        "kernel-" + name + ".png",
        fmt::format("Every weight that was measured, over its distance from the output's place, and the kernel "
                    "that explains them best: {:.2f} % are left, of which rounding accounts for {:.2f} %. The next "
                    "best, {}, leaves {:.1f} %.",
                    a.kernel.residual * 100, a.kernel.noise * 100, a.kernel.runner_up,
                    a.kernel.runner_up_residual * 100),
        "", 1000);
    job::write_data(folder + "/plate-" + name + ".png", s.plate.view());
    const Light light = report.filtered_in == Light::unknown ? Light::codes : report.filtered_in;
    job::write_data(folder + "/own-" + name + ".png", own_plate(s, light, report.code).view());
    page.gallery(
        {{"plate-" + name + ".png", "this program"}, {"own-" + name + ".png", "bandlimit"}},
        fmt::format("The zone plate. Where it must survive its error is {:.1f} dB, and {:.1f} dB are left where it "
                    "must not. Rings beside the middle are aliases.",
                    s.pass_error, s.alias),
        "", std::min(480, s.plate.width() * (s.plate.width() < 240 ? 2 : 1)));
}

}  // namespace

Panel kernel_panel(const AxisReport& a, const Ratio& ratio, const std::string& title) {
    Series measured;
    measured.label = "measured";
    measured.style = Series::Style::points;
    const double far =
        std::min(5.0, std::max(a.kernel.candidate.kernel.radius * a.kernel.candidate.widening + 0.5, 1.0));
    for (std::size_t i = 0; i < a.samples.x.size(); ++i)
        if (std::abs(a.samples.x[i]) <= far) measured.x.push_back(a.samples.x[i]), measured.y.push_back(a.samples.y[i]);
    Panel panel{title, "pixels of the coarser grid", "weight", {measured, nominal(a.kernel, ratio)}};
    panel.x_range = Range{-far, far};
    return panel;
}

void write_audit_page(const job::CommandAudit& audit, const std::string& folder) {
    const auto& [report, subject, findings] = audit;
    Page page("An audit of a resizer",
              fmt::format("{} — tested on {} {} by {} runs; the slowest took {:.2f} s.", subject.command,
                          subject.format, subject.depth, report.runs, subject.seconds));
    for (const job::Finding& f : findings)
        if (f.is_wrong) page.headline(f.text, f.key);
    if (std::none_of(findings.begin(), findings.end(), [](const job::Finding& f) { return f.is_wrong; }))
        page.headline("was found", "nothing wrong");
    std::vector<std::vector<std::string>> rows{{"finding", ""}};
    for (const job::Finding& f : findings) rows.push_back({f.text, f.is_wrong ? "wrong" : "fine"});
    page.section("Findings", "", {});
    page.table(rows, "", "");
    for (const ScaleReport& s : report.scales) add_scale(page, report, s, folder);
    AtomicFile file(folder + "/index.html");
    const std::string html = page.html();
    file.write(html.data(), html.size());
    file.commit();
}

}  // namespace bandlimit::app
