#include "apps/design/report.h"

#include <fmt/core.h>

#include <cmath>

namespace bandlimit::app {

std::string weights_line(const Taps& taps) {
    constexpr std::size_t most = 25;
    std::string line = fmt::format("{:<14}from {}:", "weights", taps.first);
    if (taps.weights.size() > most)
        return line + fmt::format(" {} of them, with -o FILE.json or --json", taps.weights.size());
    for (const double w : taps.weights) line += fmt::format(" {:.7g}", std::abs(w) < 1e-12 ? 0 : w);
    return line;
}

std::vector<std::string> response_lines(const std::string& label, const std::function<double(double)>& value) {
    std::string head = fmt::format("{:<14}", "f"), line = fmt::format("{:<14}", label);
    for (int i = 0; i <= 8; ++i) {
        head += fmt::format("{:>9.4f}", i / 16.0);
        line += fmt::format("{:>9.4f}", value(i / 16.0));
    }
    return {head, line};
}

Panel weights_panel(const Taps& taps, double output) {
    const double first = taps.first - output, count = static_cast<double>(taps.weights.size());
    return {"Weights",
            "distance from the output (samples)",
            "weight",
            {stems("", first, taps.weights)},
            Range{first - 0.5, first + count - 0.5}};
}

Panel response_panel(const std::string& title, const std::string& y_label, std::vector<Series> series) {
    return {title, "frequency (cycles per sample)", y_label, std::move(series), Range{0, 0.5}};
}

}  // namespace bandlimit::app
