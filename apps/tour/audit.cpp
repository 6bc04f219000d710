// Audits: what a resizer does can be measured from outside.
#include <fmt/core.h>

#include <cmath>

#include "apps/tour/tour.h"
#include "apps/verbs/audit_report.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {

using job::kernel_text, job::ratio_text;

namespace {

/// Every value changed by a function, and rounded to an 8-bit code.
template <class Change>
Image<float> stored_as_codes(const Image<float>& image, Change change) {
    Image<float> codes(image.width(), image.height());
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            codes.view()(x, y) = from_code(to_code<std::uint8_t>(change(static_cast<double>(image.view()(x, y)))));
    return codes;
}

/// bandlimit with its defaults: linear light, and the kernels of auto.
Image<float> careful(View<const float> stored, int width, int height) {
    Image<float> light(stored.width, stored.height);
    for (int y = 0; y < stored.height; ++y)
        for (int x = 0; x < stored.width; ++x)
            light.view()(x, y) = static_cast<float>(srgb_to_linear(static_cast<double>(stored(x, y))));
    return stored_as_codes(resample(light.view(), width, height), [](double v) { return linear_to_srgb(v); });
}

/// Three common mistakes: codes are averaged, the kernel keeps the width of source pixels where it
/// shrinks, and what is enlarged moves by half a pixel.
Image<float> careless(View<const float> stored, int width, int height) {
    const auto bank = [](int from, int to) {
        Candidate cubic{catmull_rom()};
        cubic.widening = to < from ? static_cast<double>(to) / from : 1;
        return bank_of(cubic, {.shift = to > from ? 0.5 : 0.0}, from, to);
    };
    Image<float> middle(width, stored.height), result(width, height);
    apply(bank(stored.width, width), stored, middle.view());
    apply(bank(stored.height, height), transposed(View<const float>(middle.view())), transposed(result.view()));
    return stored_as_codes(result, [](double v) { return v; });
}

std::string light_of(const AuditReport& report) {
    return fmt::format("{}, black and white become {:.0f}", name_of(report.filtered_in),
                       255 * report.light.front().checker);
}

}  // namespace

void tour_audit(Tour& tour) {
    tour.page.section(
        "What another program does, measured from outside",
        "Impulses at many phases show every weight of a resizer and how far it shifts; greys show in which light it "
        "averages. Here are two resizers: this one, and one with three common mistakes. bandlimit audit runs the same "
        "test on any program; docs/audit.md has the results for ImageMagick, libvips, ffmpeg, OpenCV, "
        "Pillow and OpenImageIO.",
        {"B. Wronski", "Bilinear down/upsampling, aligning pixel grids, and that infamous GPU half pixel offset",
         "bartwronski.com", "2021"});
    AuditOptions options;
    options.scales = {{2, 1}, {1, 2}};
    options.alpha = false;
    std::vector<std::vector<std::string>> rows{{"finding", "bandlimit", "three mistakes"}};
    const AuditReport right = audit(careful, options), wrong = audit(careless, options);
    const auto row = [&](const std::string& what, auto text) { rows.push_back({what, text(right), text(wrong)}); };
    row("averages", light_of);
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < options.scales.size(); ++i) {
        const auto scale = [i](const AuditReport& r) -> const ScaleReport& { return r.scales[i]; };
        const std::string ratio = ratio_text(right.scales[i].ratio);
        row("kernel at " + ratio, [&](const AuditReport& r) { return kernel_text(scale(r).x.kernel, scale(r).ratio); });
        row("shift at " + ratio, [&](const AuditReport& r) { return fmt::format("{:+.2f} px", scale(r).x.shift); });
        row("alias of the zone plate at " + ratio,
            [&](const AuditReport& r) { return fmt::format("{:.1f} dB", scale(r).alias); });
        panels.push_back(kernel_panel(scale(wrong).x, scale(wrong).ratio, "three mistakes, scale " + ratio));
    }
    tour.page.figure(tour.plot("audit.svg", panels, 1040, 380),
                     "The weights of the second resizer as they were measured, and the kernel that explains them.",
                     "bandlimit audit 'bandlimit resize {in} {out} --size {width}x{height}' --scales 2,1/2", 1040);
    tour.page.table(rows, "What the audit says of both.",
                    "bandlimit audit 'bandlimit resize {in} {out} --size {width}x{height}' --scales 2,1/2");
    tour.page.headline("shift of a resizer that is half a pixel off, as the audit finds it",
                       fmt::format("{:+.2f} px", wrong.scales[0].x.shift));
}

}  // namespace bandlimit::app
