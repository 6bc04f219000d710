#include "bandlimit/analysis/recognise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr double tie = 1e-6;        // samples: decides between two equally near ones
constexpr double convincing = 0.8;  // a placement is better if the residual falls below this share
constexpr int most_rows = 100;      // that are compared: every phase of a ratio up to 100
constexpr int no_input = std::numeric_limits<int>::min();
constexpr const char* names[] = {"nearest",
                                 "box",
                                 "tent",
                                 "quadratic",
                                 "quadratic-interp",
                                 "bspline",
                                 "catmull-rom",
                                 "mitchell",
                                 "cubic:0:0.6",
                                 "cubic:0:0.75",
                                 "cubic:0:1",
                                 "cubic:0:0",
                                 "cubic:0.3782:0.3109",
                                 "cubic:0.262:0.369",
                                 "magic-sharp-2013",
                                 "magic-sharp-2021",
                                 "shrink3",
                                 "grow3",
                                 "lanczos2",
                                 "lanczos3",
                                 "lanczos4",
                                 "lanczos5",
                                 "sinc:3",
                                 "sinc:4",
                                 "gaussian:0.5",
                                 "blackman-harris",
                                 "blackman-harris-window",
                                 "kaiser:3:4",
                                 "kaiser:4:6",
                                 "jinc2",
                                 "jinc3",
                                 "jinc2-unscaled",
                                 "jinc3-unscaled",
                                 "radial-lanczos2",
                                 "radial-lanczos3"};

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// What a radial kernel does to a signal that does not vary along y, as a separable kernel: its integral along y.
Kernel projected(const Kernel& radial) {
    constexpr int steps = 256;
    std::vector<double> table;
    for (int i = 0; i <= steps + 1; ++i) {
        const double x = radial.radius * i / steps;
        double sum = 0;
        for (int k = -steps; k < steps; ++k) {  // midpoints
            const double y = radial.radius * (k + 0.5) / steps;
            const double r = std::hypot(x, y);
            if (r < radial.radius) sum += radial.value(r);
        }
        table.push_back(sum * radial.radius / steps);
    }
    const auto value = [table = std::move(table), radius = radial.radius](double x) {
        const double t = std::abs(x) / radius * steps;
        if (t >= steps) return 0.0;
        const int i = static_cast<int>(t);
        return std::lerp(table[at(i)], table[at(i + 1)], t - i);
    };
    return {radial.name, radial.radius, value, Kernel::Form::separable, {}};
}

/// The mean over a target's cell of sources that are constant on their cells, while growing; named as box is elsewhere.
Kernel area(double target_cell) {
    const auto value = [target_cell](double x) {
        return std::clamp((1 + target_cell) / 2 - std::abs(x), 0.0, target_cell);
    };
    return {"area", (1 + target_cell) / 2, value, Kernel::Form::separable, {}};
}

/// `kernel` with its radius multiplied.
Kernel widened(const Kernel& kernel, double factor) {
    if (factor == 1) return kernel;
    return {kernel.name,
            kernel.radius * factor,
            [value = kernel.value, factor](double x) { return value(x / factor); },
            Kernel::Form::separable,
            {}};
}

/// The rows of outputs [first, last) as they were before any edge: indices may lie outside the source.
Bank part_of_bank(const Candidate& candidate, Placement placement, int inputs, int outputs, int first, int last) {
    if (candidate.ties_down) placement.shift += tie;
    const Axis source{inputs, 0, double(inputs)}, target = target_axis(placement, inputs, outputs);
    return make_bank(widened(candidate.kernel, candidate.widening), source, target.cells(first, last), Edge::clamp);
}
Bank predict(const Candidate& candidate, const Placement& placement, const MeasuredBank& bank, int first, int last) {
    return part_of_bank(candidate, placement, bank.inputs, bank.outputs, first, last);
}

/// A predicted row by trains, as measured ones are; `resolve_index` says which input an index reads, below 0 for none.
template <class Resolve>
void fold(const Bank& bank, int output, int period, Resolve resolve_index, std::vector<double>& row) {
    row.assign(at(period), 0);
    int index = bank.first(output);
    for (const float w : bank.row(output))
        if (const int j = resolve_index(index++); j != no_input) row[at(((j % period) + period) % period)] += double(w);
}

int unresolved(int j) { return j; }

double squared_error(const MeasuredBank& bank, int output, const std::vector<double>& row) {
    double sum = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
        const double e = bank.row(output)[std::ptrdiff_t(c)] - row[c];
        sum += e * e;
    }
    return sum;
}

double energy(const MeasuredBank& bank, int output) {
    double sum = 0;
    for (int c = 0; c < bank.period; ++c) sum += bank.row(output)[c] * bank.row(output)[c];
    return sum;
}

/// Whether output i lies half way between two samples, one of which nearest takes: rounding decides, now so, now so.
bool is_undecided(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement, int i) {
    if (candidate.kernel.form != Kernel::Form::nearest || bank.ratio.is_whole()) return false;
    const Axis source{bank.inputs, 0, double(bank.inputs)};
    const double place = source.index(target_axis(placement, bank.inputs, bank.outputs).position(i));
    const double nearest = std::round(place);
    return std::abs(std::abs(place - nearest) * 2 - 1) < 2e-3;
}

struct Span {
    int begin, end;
};
Span compared_rows(const MeasuredBank& bank, int most = most_rows) {
    return {bank.interior_begin(), std::min(bank.interior_end(), bank.interior_begin() + most)};
}

/// The least value of f on [low, high], by golden section.
template <class F>
double minimise(F f, double low, double high, int steps = 24) {
    constexpr double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double fa = f(a), fb = f(b);
    for (int i = 0; i < steps; ++i) {
        if (fa < fb) {
            high = b, b = a, fb = fa;
            a = high - golden * (high - low), fa = f(a);
        } else {
            low = a, a = b, fa = fb;
            b = low + golden * (high - low), fb = f(b);
        }
    }
    return fa < fb ? a : b;
}

}  // namespace

Axis target_axis(const Placement& placement, int inputs, int outputs) {
    const Axis source{inputs, 0, double(inputs)};
    const Axis target = placement.centers ? center_aligned(source, outputs) : Axis{outputs, source.begin, source.end};
    const double left = placement.shift * target.pitch();  // what moves right is read further left
    return {outputs, target.begin - left, target.end - left};
}

double mean_shift(const MeasuredBank& bank) {
    double total = 0, rows = 0;
    for (int i = bank.interior_begin(); i < bank.interior_end(); ++i) {
        const double place = bank.corner_position(i);
        const int middle = static_cast<int>(std::lround(place));
        double moment = 0, sum = 0;
        for (int j = middle - bank.period / 2; j <= middle + bank.period / 2; ++j) {
            const double w = bank.weight(i, j);
            if (std::abs(w) < 4 * bank.noise) continue;
            moment += w * (j - place), sum += w;
        }
        if (std::abs(sum) < 0.1) continue;
        total += moment / sum, ++rows;
    }
    return rows > 0 ? -total / rows / bank.ratio.step() : 0;
}

double top_left_shift(const Ratio& ratio) {
    const Axis source{ratio.from, 0, double(ratio.from)}, target{ratio.to, source.begin, source.end};
    return (target.position(0) - source.position(0)) / target.pitch();
}

std::string_view alignment_name(const Placement& placement, const Ratio& ratio) {
    constexpr double close = 0.01;
    if (std::abs(placement.shift) <= close) return placement.centers ? "centers" : "corners";
    if (!placement.centers && std::abs(placement.shift - top_left_shift(ratio)) <= close) return "top-left";
    return "shifted";
}

std::vector<Candidate> all_candidates(const Ratio& ratio) {
    static const std::vector<Candidate> nominal = [] {  // integrals of radial kernels take a while
        std::vector<Candidate> made;
        for (const char* name : names) {
            const Kernel kernel = parse_kernel(name);
            const bool is_radial = kernel.form == Kernel::Form::radial;
            made.push_back({is_radial ? projected(kernel) : kernel, 1, false, is_radial});
        }
        return made;
    }();
    std::vector<Candidate> all;
    for (const Candidate& candidate : nominal) {
        all.push_back(candidate);
        Kernel kernel = candidate.kernel;
        if (kernel.name == "blackman-harris-window") all.push_back({kernel, 1.5 / kernel.radius});  // OpenImageIO's
        if (kernel.form == Kernel::Form::nearest) {
            all.push_back({kernel, 1, true});
        } else if (kernel.form == Kernel::Form::area) {
            kernel.form = Kernel::Form::separable;
            if (ratio.shrinks()) all.push_back({kernel, 1, false, false, true});
        } else if (ratio.shrinks() && !candidate.is_radial) {
            all.push_back({kernel, 1 / ratio.stretch()});
        }
    }
    if (!ratio.shrinks()) all.push_back({area(ratio.step())});
    return all;
}

Bank bank_of(const Candidate& candidate, const Placement& placement, int inputs, int outputs) {
    return part_of_bank(candidate, placement, inputs, outputs, 0, outputs);
}

CandidateFit fit(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement, int most) {
    const Span rows = compared_rows(bank, most);
    const Bank prediction = predict(candidate, placement, bank, rows.begin, rows.end);
    std::vector<double> row;
    double error = 0, all = 0;
    for (int i = rows.begin; i < rows.end; ++i) {
        if (is_undecided(bank, candidate, placement, i)) continue;
        fold(prediction, i - rows.begin, bank.period, unresolved, row);
        error += squared_error(bank, i, row);
        all += energy(bank, i);
    }
    return {placement, all > 0 ? std::sqrt(error / all) : 1};
}

double noise_floor(const MeasuredBank& bank) {
    const Span rows = compared_rows(bank);
    double all = 0;
    for (int i = rows.begin; i < rows.end; ++i) all += energy(bank, i);
    return all > 0 ? bank.noise * std::sqrt(double(rows.end - rows.begin) * bank.period / all) : 0;
}

CandidateFit best_fit(const MeasuredBank& bank, const Candidate& candidate, int rows) {
    CandidateFit best = fit(bank, candidate, {}, rows);
    const double floor = noise_floor(bank);
    for (const Placement& placement :
         {Placement{false, top_left_shift(bank.ratio)}, Placement{true, 0}, Placement{false, mean_shift(bank)}}) {
        const CandidateFit other = fit(bank, candidate, placement, rows);
        if (other.residual + floor / 4 < convincing * best.residual) best = other;
    }
    return best;
}

CandidateFit refined(const MeasuredBank& bank, const Candidate& candidate, const CandidateFit& start) {
    if (candidate.kernel.form == Kernel::Form::nearest || candidate.is_sampled) return start;
    const auto residual = [&](double shift) { return fit(bank, candidate, {start.placement.centers, shift}).residual; };
    constexpr double around = 0.25;
    const double middle = start.placement.shift;
    const CandidateFit better =
        fit(bank, candidate, {start.placement.centers, minimise(residual, middle - around, middle + around, 16)});
    return better.residual < start.residual ? better : start;
}

FittedCandidate fit_parameters(const MeasuredBank& bank, const Candidate& start, const CandidateFit& from) {
    const auto score = [&](const Candidate& c) { return fit(bank, c, from.placement).residual; };
    FittedCandidate best{start, from};
    const auto keep = [&](Candidate c) {
        const CandidateFit f = fit(bank, c, from.placement);
        if (f.residual < best.fit.residual) best = {std::move(c), f};
    };
    for (const double widening : {1.0, 1 / bank.ratio.stretch()}) {
        double b = 0, c = 0.5;
        for (int round = 0; round < 5; ++round) {
            b = minimise([&](double v) { return score({cubic(v, c), widening}); }, -0.5, 1.5, 14);
            c = minimise([&](double v) { return score({cubic(b, v), widening}); }, -0.5, 1.5, 14);
        }
        const auto hundredths = [](double v) { return std::round(v * 100) / 100; };
        keep({cubic(hundredths(b), hundredths(c)), widening});
    }
    const double sigma =
        minimise([&](double v) { return score({gaussian(std::exp(v))}); }, std::log(0.1), std::log(1.2), 20);
    keep({gaussian(std::round(std::exp(sigma) * 1000) / 1000)});
    if (start.kernel.form == Kernel::Form::separable && !start.is_sampled) {
        Candidate other = start;
        const auto with = [&](double w) { return other.widening = w, other; };
        const double width = minimise([&](double v) { return score(with(std::exp(v))); },
                                      std::log(0.6 / bank.ratio.stretch()), std::log(1.6), 18);
        // Another width is another program's intention only if it is far from the nominal one, and explains a lot.
        if (fit(bank, with(std::exp(width)), from.placement).residual < best.fit.residual / 2) keep(other);
    }
    return best;
}

double support(const MeasuredBank& bank, const Placement& placement) {
    const Axis source{bank.inputs, 0, double(bank.inputs)};
    const Axis target = target_axis(placement, bank.inputs, bank.outputs);
    double largest = 0, reach = 0;
    for (const double w : bank.weights) largest = std::max(largest, std::abs(w));
    const double threshold = std::max(6 * bank.noise, 0.004 * largest);
    for (int i = bank.interior_begin(); i < bank.interior_end(); ++i) {
        const double place = source.index(target.position(i));
        const int middle = static_cast<int>(std::lround(place));
        for (int j = middle - bank.period / 2; j <= middle + bank.period / 2; ++j)
            if (std::abs(bank.weight(i, j)) > threshold) reach = std::max(reach, std::abs(j - place));
    }
    return reach;
}

KernelSamples kernel_samples(const MeasuredBank& bank, const Placement& placement) {
    const Axis source{bank.inputs, 0, double(bank.inputs)};
    const Axis target = target_axis(placement, bank.inputs, bank.outputs);
    const double stretch = bank.ratio.stretch();
    KernelSamples samples;
    for (int i = bank.interior_begin(); i < bank.interior_end(); ++i) {
        const double place = source.index(target.position(i));
        const int middle = static_cast<int>(std::lround(place));
        for (int j = middle - bank.period / 2; j <= middle + bank.period / 2; ++j) {
            samples.x.push_back((j - place) / stretch);
            samples.y.push_back(bank.weight(i, j) * stretch);
        }
    }
    return samples;
}

EdgeErrors& EdgeErrors::operator+=(const EdgeErrors& other) {
    for (std::size_t r = 0; r < squares.size(); ++r) squares[r] += other.squares[r];
    energy += other.energy, noise += other.noise;
    variance = std::max(variance, other.variance);
    return *this;
}

double EdgeErrors::residual(std::size_t rule) const { return energy > 0 ? std::sqrt(squares[rule] / energy) : 1; }

std::vector<std::string_view> EdgeErrors::explained_by(double tolerance) const {
    std::vector<std::string_view> rules;
    const double least = *std::min_element(squares.begin(), squares.end());
    const double most = *std::max_element(squares.begin(), squares.end());
    // A rule is told from the right one if what it gets wrong is above four deviations of a weight, a millionth of
    // the whole, and half of what even the best does not explain.
    const double same = least + std::max({16 * variance, 1e-6 * energy, (least - noise) / 2});
    if (energy == 0 || std::sqrt(least / energy) > tolerance || most <= same) return rules;
    for (std::size_t r = 0; r < squares.size(); ++r)
        if (squares[r] <= same) rules.push_back(edge_rules[r]);
    return rules;
}

namespace {

/// What rule `r` of edge_rules reads for index j.
int resolve_by_rule(int j, int count, std::size_t rule) {
    if (j >= 0 && j < count) return j;
    if (edge_rules[rule] == "mirror") return count < 2 ? 0 : std::clamp(j < 0 ? -j : 2 * count - 2 - j, 0, count - 1);
    const int inside = resolve(j, count, all_edges()[rule]);
    return inside < 0 ? no_input : inside;
}

}  // namespace

EdgeErrors edge_errors(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement) {
    EdgeErrors errors;
    const Bank whole = predict(candidate, placement, bank, 0, bank.outputs);
    std::vector<double> row;
    for (int i = 0; i < bank.outputs; ++i) {
        const int first = whole.first(i), last = first + static_cast<int>(whole.row(i).size()) - 1;
        if (first >= 0 && last < bank.inputs) continue;
        errors.energy += energy(bank, i);
        errors.noise += bank.noise * bank.noise * bank.period;
        errors.variance = bank.noise * bank.noise;
        for (std::size_t rule = 0; rule < edge_rules.size(); ++rule) {
            fold(
                whole, i, bank.period, [&](int j) { return resolve_by_rule(j, bank.inputs, rule); }, row);
            if (edge_rules[rule] == "renormalize") {
                double sum = 0;
                for (const double w : row) sum += w;
                for (double& w : row) w /= sum != 0 ? sum : 1;
            }
            errors.squares[rule] += squared_error(bank, i, row);
        }
    }
    return errors;
}

Phases find_phases(const MeasuredBank& bank, const Candidate& candidate, const Placement& placement) {
    Phases result;
    if (candidate.kernel.radius * candidate.widening <= 0.5) return result;
    constexpr double h = 0.02;  // target samples: far below any kernel's detail
    const Span rows = compared_rows(bank);
    const auto shifted = [&](double by) {
        return predict(candidate, {placement.centers, placement.shift + by}, bank, rows.begin, rows.end);
    };
    const Bank middle = shifted(0), right = shifted(h), left = shifted(-h);
    const Axis source{bank.inputs, 0, double(bank.inputs)};
    const Axis target = target_axis(placement, bank.inputs, bank.outputs);
    std::vector<double> place, delta, m, r, l;  // source samples, to the right
    double variance = 0;
    for (int i = rows.begin; i < rows.end; ++i) {
        fold(middle, i - rows.begin, bank.period, unresolved, m);
        fold(right, i - rows.begin, bank.period, unresolved, r);
        fold(left, i - rows.begin, bank.period, unresolved, l);
        double product = 0, square = 0;
        for (int c = 0; c < bank.period; ++c) {
            const double slope = (l[at(c)] - r[at(c)]) / (2 * h * target.pitch());  // per source sample of the place
            product += (bank.row(i)[c] - m[at(c)]) * slope;
            square += slope * slope;
        }
        if (square == 0) continue;
        place.push_back(source.index(target.position(i)));
        delta.push_back(product / square);
        variance += bank.noise * bank.noise / square;
    }
    if (delta.size() < 8) return result;
    const auto centred = [](std::vector<double>& v) {
        double mean = 0, square = 0;
        for (const double x : v) mean += x / double(v.size());
        for (double& x : v) x -= mean, square += x * x;
        return square / double(v.size());
    };
    const double measured = centred(delta);
    result.deviation = std::sqrt(measured);
    const double seen = variance / double(delta.size());
    double best = 0.5;  // of the variance must be explained
    for (int count = 4; count <= 256; count *= 2) {
        for (const bool nearest : {true, false}) {
            std::vector<double> table;
            for (const double p : place)
                table.push_back((nearest ? std::round(p * count) : std::floor(p * count)) / count - p);
            const double expected = centred(table);
            if (expected > 16 * seen + 1e-10) result.finest = count;
            double error = 0;
            for (std::size_t i = 0; i < delta.size(); ++i) error += (delta[i] - table[i]) * (delta[i] - table[i]);
            const double explained = 1 - error / double(delta.size()) / (measured > 0 ? measured : 1);
            // What a table of so many phases would do is there, in size too, and is no mere noise.
            if (explained > best && measured > 4 * seen && expected > 1e-10) best = explained, result.count = count;
        }
    }
    return result;
}

}  // namespace bandlimit
