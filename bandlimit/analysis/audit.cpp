#include "bandlimit/analysis/audit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bandlimit/analysis/audit_scene.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr double known_residual = 0.04;  // of kernels that differ by less than this nobody could tell the difference
constexpr int coarse_rows = 24;          // compared for every candidate; all rows for the best of them
constexpr std::size_t contenders = 8;

// ---- Runs

/// Runs the resizer and checks what comes back.
class Runs {
public:
    Runs(const ResizeFunction& resize, const AuditOptions& options, int all)
        : resize_(resize), options_(options), all_(all) {}

    Image<float> operator()(const Image<float>& image, const Ratio& ratio) {
        if (options_.progress) options_.progress(done_, all_);
        ++done_;
        const int width = image.width() / ratio.from * ratio.to, height = image.height() / ratio.from * ratio.to;
        Image<float> result = resize_(image.view(), width, height);
        if (result.width() != width || result.height() != height)
            fail("audit: asked for ", width, " x ", height, " samples, the resizer gave ", result.width(), " x ",
                 result.height());
        if (image.channels() == 1 && result.channels() > 1)
            fail("audit: a grey image became ", result.channels(), " channels");
        return result;
    }
    int done() const { return done_; }

private:
    const ResizeFunction& resize_;
    const AuditOptions& options_;
    int done_ = 0, all_;
};

Image<float> decoded(const Image<float>& stored, Light light) {
    Image<float> out(stored.width(), stored.height());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.view()(x, y) = static_cast<float>(decode(light, double(stored.view()(x, y))));
    return out;
}

Image<float> transposed_copy(const Image<float>& image) {
    Image<float> out(image.height(), image.width());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out.view()(x, y) = image.view()(y, x);
    return out;
}

/// The first of the scales that shrinks, and the first that does not.
std::vector<Ratio> two_of(const std::vector<Ratio>& scales) {
    std::vector<Ratio> two;
    for (const bool shrinks : {true, false})
        for (const Ratio& r : scales)
            if (r.shrinks() == shrinks) {
                two.push_back(r);
                break;
            }
    return two;
}

// ---- Weights

/// The weights along both axes at one scale, and how well each candidate explains them.
struct Measured {
    std::array<MeasuredBank, 2> banks;
    std::vector<Candidate> candidates;
    std::array<std::vector<CandidateFit>, 2> fits;  ///< of each candidate
};

/// The two values of the line probe: 1/4 and 3/4 of the light, as near as codes come. Sums of |weights| up to 2 fit.
struct Levels {
    double low, high;
};
Levels levels_of(Light light, double code) {
    const auto stored = [&](double value) {
        const double v = encode(light, value);
        return code > 0 ? std::round(v / code) * code : v;
    };
    return {stored(0.25), stored(0.75)};
}

MeasuredBank measure_axis(Runs& run, const Ratio& ratio, bool along_y, Light light, double code) {
    const LineProbe probe = line_probe(ratio);
    const Levels stored = levels_of(light, code);
    const Image<float> image = draw(probe, static_cast<float>(stored.low), static_cast<float>(stored.high));
    Image<float> result = along_y ? transposed_copy(run(transposed_copy(image), ratio)) : run(image, ratio);
    const double low = decode(light, stored.low), high = decode(light, stored.high);
    const double slope = (high - low) / (stored.high - stored.low);
    MeasuredBank bank = measure(probe, decoded(result, light).view(), low, high, slope * code / std::sqrt(12.0));
    bank.bias /= slope;
    return bank;
}

Measured fit_all(std::array<MeasuredBank, 2> banks) {
    Measured m{std::move(banks), {}, {}};
    m.candidates = all_candidates(m.banks[0].ratio);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        std::vector<CandidateFit>& fits = m.fits[axis];
        for (const Candidate& c : m.candidates) fits.push_back(best_fit(m.banks[axis], c, coarse_rows));
        std::vector<std::size_t> order(fits.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return fits[a].residual < fits[b].residual; });
        for (std::size_t k = 0; k < std::min(contenders, order.size()); ++k)
            fits[order[k]] = best_fit(m.banks[axis], m.candidates[order[k]]);
    }
    return m;
}

/// Sums of squares of the residuals of each candidate over both axes of all scales on the same side of 1: what looks
/// the same at one scale is decided by the others.
std::vector<double> joint_squares(const std::vector<Measured>& all, bool shrinks) {
    std::vector<double> sums;
    for (const Measured& m : all) {
        if (m.banks[0].ratio.shrinks() != shrinks) continue;
        sums.resize(m.candidates.size(), 0);
        for (const auto& fits : m.fits)
            for (std::size_t c = 0; c < fits.size(); ++c) sums[c] += fits[c].residual * fits[c].residual;
    }
    return sums;
}

std::string described(const Candidate& c) {
    std::string text = c.kernel.name;
    if (c.is_sampled) text += " by equal weights";
    if (c.ties_down) text += " (of two the lower)";
    if (c.widening < 1) text += ", not widened";
    return text;
}

bool is_same_kernel(const Candidate& a, const Candidate& b) {
    return a.kernel.name == b.kernel.name && a.widening == b.widening && a.is_sampled == b.is_sampled;
}

struct Choice {
    KernelFinding finding;
    CandidateFit fit;
};
Choice choose(const Measured& m, std::size_t axis, const std::vector<double>& joint, std::optional<bool> separable) {
    const MeasuredBank& bank = m.banks[axis];
    const std::vector<CandidateFit>& fits = m.fits[axis];
    const double floor = noise_floor(bank);
    double best = 1e9;
    for (std::size_t c = 0; c < fits.size(); ++c) best = std::min(best, fits[c].residual);
    const auto is_as_good = [&](std::size_t c) {
        return fits[c].residual <= std::max(1.15 * best + 1e-6, best + floor / 2);
    };
    const auto fits_form = [&](std::size_t c) { return !separable || *separable != m.candidates[c].is_radial; };
    std::vector<std::size_t> good, fitting;
    for (std::size_t c = 0; c < fits.size(); ++c) {
        if (!is_as_good(c)) continue;
        good.push_back(c);
        if (fits_form(c)) fitting.push_back(c);
    }
    const std::vector<std::size_t>& eligible = fitting.empty() ? good : fitting;
    // Of candidates that explain all scales alike, one that shares corners.
    const auto cost = [&](std::size_t c) {
        const Placement& p = fits[c].placement;
        return joint[c] + (p.centers || p.shift != 0 ? 1e-6 : 0);
    };
    const std::size_t chosen = *std::min_element(eligible.begin(), eligible.end(),
                                                 [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
    Choice choice{{}, fits[chosen]};
    KernelFinding& f = choice.finding;
    f.candidate = m.candidates[chosen];
    f.noise = floor;
    for (std::size_t c = 0; c < fits.size(); ++c) {
        if (is_same_kernel(m.candidates[c], f.candidate)) continue;
        if (is_as_good(c)) f.same.push_back(described(m.candidates[c]));
        if (fits[c].residual < f.runner_up_residual)
            f.runner_up_residual = fits[c].residual, f.runner_up = described(m.candidates[c]);
    }
    return choice;
}

/// Where no known kernel fits well, one with free parameters may.
void try_parameters(const MeasuredBank& bank, Choice& choice) {
    if (choice.fit.residual <= std::max(0.012, 2 * noise_floor(bank))) return;
    const FittedCandidate fitted = fit_parameters(bank, choice.finding.candidate, choice.fit);
    if (fitted.fit.residual > choice.fit.residual / 2) return;
    choice.finding.runner_up = described(choice.finding.candidate);
    choice.finding.runner_up_residual = choice.fit.residual;
    choice.finding.same.clear();
    choice.finding.candidate = fitted.candidate;
    choice.fit = fitted.fit;
}

AxisReport report_axis(const Measured& m, std::size_t axis, const std::vector<double>& joint,
                       std::optional<bool> separable, double code) {
    const MeasuredBank& bank = m.banks[axis];
    Choice choice = choose(m, axis, joint, separable);
    try_parameters(bank, choice);
    AxisReport r;
    r.kernel = std::move(choice.finding);
    const CandidateFit fit = refined(bank, r.kernel.candidate, choice.fit);
    r.kernel.residual = fit.residual;
    r.kernel.name = r.kernel.candidate.kernel.name;
    r.kernel.is_known = fit.residual <= std::max(known_residual, 3 * r.kernel.noise);
    r.placement = r.kernel.is_known ? fit.placement : Placement{false, mean_shift(bank)};
    r.alignment = alignment_name(r.placement, bank.ratio);
    r.shift = r.placement.shift;
    r.support_source = support(bank, r.placement);
    r.support_coarser = r.support_source / bank.ratio.stretch();
    if (r.kernel.is_known && !bank.ratio.is_whole())
        r.phases = find_phases(bank, r.kernel.candidate, choice.fit.placement);
    r.bias = code > 0 ? bank.bias / code : bank.bias;
    r.samples = kernel_samples(bank, r.placement);
    return r;
}

double difference(const MeasuredBank& a, const MeasuredBank& b) {
    double error = 0, energy = 0;
    for (std::size_t i = 0; i < a.weights.size(); ++i) {
        error += (a.weights[i] - b.weights[i]) * (a.weights[i] - b.weights[i]);
        energy += (a.weights[i] * a.weights[i] + b.weights[i] * b.weights[i]) / 2;
    }
    return energy > 0 ? std::sqrt(error / energy) : 0;
}

// ---- Alpha

AlphaReport test_alpha(Runs& run, const Ratio& ratio, double code) {
    try {
        return read_alpha(run(alpha_scene(ratio), ratio).view(), ratio, code);
    } catch (const std::exception& e) {
        AlphaReport report;
        report.ratio = ratio, report.mode = AlphaMode::failed, report.failure = e.what();
        return report;
    }
}

}  // namespace

bool KernelFinding::is_widened(const Ratio& ratio) const {
    if (!ratio.shrinks()) return true;
    // Half way between the nominal width and that of the source, on a scale of ratios.
    return candidate.kernel.form != Kernel::Form::nearest && candidate.widening > 1 / std::sqrt(ratio.stretch());
}

std::string_view name_of(Light light) {
    constexpr std::array<std::string_view, 5> words{"unknown", "codes", "srgb", "gamma-2.2", "bt709"};
    return words[static_cast<std::size_t>(light)];
}

std::string_view name_of(AlphaMode mode) {
    constexpr std::array<std::string_view, 5> words{"untested", "failed", "dropped", "bleeds", "weighted"};
    return words[static_cast<std::size_t>(mode)];
}

double decode(Light light, double stored) {
    const double v = std::abs(stored);
    switch (light) {
        case Light::srgb: return srgb_to_linear(stored);
        case Light::gamma22: return std::copysign(std::pow(v, 2.2), stored);
        case Light::bt709: return std::copysign(v < 0.081 ? v / 4.5 : std::pow((v + 0.099) / 1.099, 1 / 0.45), stored);
        default: return stored;
    }
}

double encode(Light light, double value) {
    const double v = std::abs(value);
    switch (light) {
        case Light::srgb: return linear_to_srgb(value);
        case Light::gamma22: return std::copysign(std::pow(v, 1 / 2.2), value);
        case Light::bt709: return std::copysign(v < 0.018 ? v * 4.5 : 1.099 * std::pow(v, 0.45) - 0.099, value);
        default: return value;
    }
}

AuditReport audit(const ResizeFunction& resize, const AuditOptions& options) {
    if (options.scales.empty()) fail("audit: no scale; pass at least one");
    const std::vector<Ratio> two = two_of(options.scales);
    const auto scales = static_cast<int>(options.scales.size()), pairs = static_cast<int>(two.size());
    Runs run(resize, options, 3 * scales + pairs * (options.alpha ? 2 : 1));
    AuditReport report;
    report.code = options.code;
    for (const Ratio& r : two) {
        report.light.push_back(read_light(run(light_scene(r, options.code), r).view(), r, options.code));
        if (report.filtered_in == Light::unknown) report.filtered_in = report.light.back().light;
    }
    const Light light = report.filtered_in == Light::unknown ? Light::codes : report.filtered_in;

    std::vector<Measured> measured;
    for (const Ratio& r : options.scales)
        measured.push_back(fit_all(
            {measure_axis(run, r, false, light, options.code), measure_axis(run, r, true, light, options.code)}));
    const std::vector<double> shrinking = joint_squares(measured, true), growing = joint_squares(measured, false);
    for (std::size_t i = 0; i < measured.size(); ++i) {
        const Measured& m = measured[i];
        const Ratio& ratio = options.scales[i];
        ScaleReport s;
        s.ratio = ratio;
        const PictureScene scene = picture_scene(ratio, light, options.code);
        const Image<float> result = run(draw(scene), ratio);
        s.separable = is_separable(scene, result.view(), s.not_separable);
        const std::vector<double>& joint = ratio.shrinks() ? shrinking : growing;
        s.x = report_axis(m, 0, joint, s.separable, options.code);
        s.y = report_axis(m, 1, joint, s.separable, options.code);
        s.axis_difference = difference(m.banks[0], m.banks[1]);
        read_pictures(scene, result.view(), s);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const AxisReport& a = axis == 0 ? s.x : s.y;
            if (a.kernel.is_known) report.edge_errors += edge_errors(m.banks[axis], a.kernel.candidate, a.placement);
        }
        report.scales.push_back(std::move(s));
    }
    report.edges = report.edge_errors.explained_by(known_residual);
    if (options.alpha)
        for (const Ratio& r : two) report.alpha.push_back(test_alpha(run, r, options.code));
    report.runs = run.done();
    return report;
}

}  // namespace bandlimit
