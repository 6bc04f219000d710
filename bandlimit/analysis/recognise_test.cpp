#include "bandlimit/analysis/recognise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/analysis/resizers_test.h"

namespace bandlimit {
namespace {

constexpr Ratio shrink{37, 100}, grow{100, 37};
constexpr double low = 64 / 255.0, high = 191 / 255.0;

MeasuredBank measured(const ResizeFunction& resize, const Ratio& ratio, bool bytes) {
    const LineProbe probe = line_probe(ratio);
    const Image<float> image = draw(probe, float(low), float(high));
    return measure(probe, resize(image.view(), probe.outputs, probe.out_height()).view(), low, high,
                   bytes ? 1 / 255.0 / std::sqrt(12.0) : 0);
}

struct Found {
    Candidate candidate;
    CandidateFit fit;
};
/// The candidate of the least residual.
Found recognise(const MeasuredBank& bank) {
    Found best;
    for (const Candidate& c : all_candidates(bank.ratio))
        if (const CandidateFit f = best_fit(bank, c, 24); f.residual < best.fit.residual) best = {c, f};
    return best;
}

void expect_kernel(const std::string& name, const MeasuredBank& bank, bool bytes) {
    const Found found = recognise(bank);
    const bool shrinks = bank.ratio.shrinks();
    const bool is_either = name == "box" && !shrinks;  // box picks the nearest sample while growing
    EXPECT_TRUE(found.candidate.kernel.name == name || (is_either && found.candidate.kernel.name == "nearest"))
        << name << " taken for " << found.candidate.kernel.name;
    EXPECT_EQ(found.candidate.widening, 1) << name;
    EXPECT_EQ(alignment_name(found.fit.placement, bank.ratio), "corners") << name;
    // Exact but for floats or rounding. Radial kernels that jump, or whose weights sum to very different numbers, are
    // only nearly their integral; the sums of |weights| of sinc reach over 2, and bytes clip that.
    const bool is_rough = name.find("unscaled") != std::string::npos || name.starts_with("radial");
    const bool is_clipped = bytes && name == "sinc:4" && !shrinks;
    const double bound = bytes ? 1.3 * noise_floor(bank) + 1e-6 : found.candidate.is_radial ? 3e-3 : 1e-5;
    EXPECT_LT(found.fit.residual, is_rough ? 0.03 : is_clipped ? 0.04 : bound) << name;
    EXPECT_LT(std::abs(bank.bias * 255), bytes ? 0.1 : 0.01) << name;  // few phases: roundings repeat
}

void expect_every_kernel(const Ratio& ratio) {
    const LineProbe probe = line_probe(ratio);
    const Image<float> image = draw(probe, float(low), float(high));
    for (const KernelInfo& info : kernel_list()) {
        const std::string name = info.example == "cubic:0.25:0.375" ? "cubic:0:0.75" : std::string(info.example);
        const OwnResize own{.options = {.reconstruction = parse_kernel(name)}};
        Image<float> result = own(image.view(), probe.outputs, probe.out_height());
        expect_kernel(name, measure(probe, result.view(), low, high), false);
        for_samples(result.view(), nearest_byte);
        expect_kernel(name, measure(probe, result.view(), low, high, 1 / 255.0 / std::sqrt(12.0)), true);
    }
}

// Few rows, for the slow radial kernels.
TEST(Recognise, EveryKernelWhileShrinking) { expect_every_kernel({3, 8}); }
TEST(Recognise, EveryKernelWhileGrowing) { expect_every_kernel({7, 3}); }

TEST(Recognise, EveryEdge) {
    for (const bool bytes : {false, true})
        for (const Ratio& ratio : {shrink, grow})
            for (const Edge edge : all_edges()) {
                const MeasuredBank bank = measured(
                    OwnResize{.options = {.reconstruction = lanczos(3), .edge = edge}, .bytes = bytes}, ratio, bytes);
                const EdgeErrors errors = edge_errors(bank, {lanczos(3)}, {});
                EXPECT_EQ(errors.explained_by(0.04), std::vector{name_of(edge)}) << name_of(edge) << ratio.to;
            }
}

TEST(Recognise, EdgesThatDoTheSameAreAllNamedAndNoneWhereNoRowReachesOutside) {
    const MeasuredBank bank =
        measured(OwnResize{.options = {.reconstruction = tent(), .edge = Edge::clamp}}, {2, 1}, false);
    // The weight 1/4 of sample -1 goes to sample 0 in all three.
    EXPECT_EQ(edge_errors(bank, {tent()}, {}).explained_by(0.04),
              (std::vector<std::string_view>{"clamp", "reflect", "renormalize"}));
    EXPECT_TRUE(edge_errors(bank, {nearest()}, {}).explained_by(0.04).empty());
    EXPECT_TRUE(edge_errors(bank, {lanczos(3)}, {}).explained_by(0.04).empty()) << "the wrong kernel explains nothing";
}

TEST(Recognise, EveryAlignment) {
    for (const bool bytes : {false, true})
        for (const Ratio& ratio : {shrink, grow, Ratio{1, 2}, Ratio{2, 1}})
            for (const auto& [placement, name] : {std::pair{Placement{}, "corners"},
                                                  {Placement{true, 0}, "centers"},
                                                  {Placement{false, top_left_shift(ratio)}, "top-left"},
                                                  {Placement{false, 0.23}, "shifted"}}) {
                const MeasuredBank bank =
                    measured(OwnResize{.options = {.reconstruction = catmull_rom(), .edge = Edge::clamp},
                                       .placement = placement,
                                       .bytes = bytes},
                             ratio, bytes);
                const CandidateFit fit = refined(bank, {catmull_rom()}, best_fit(bank, {catmull_rom()}));
                EXPECT_EQ(alignment_name(fit.placement, ratio), std::string_view(name))
                    << ratio.to << "/" << ratio.from;
                EXPECT_NEAR(fit.placement.shift, placement.shift, bytes ? 0.005 : 0.001) << name;
            }
    EXPECT_EQ(top_left_shift({2, 1}), -0.5);  // sample 1 of the target is at 1/2 instead of 1/4: half a pixel left
}

TEST(Recognise, KernelsThatAreNotWidened) {
    for (const Kernel& kernel : {tent(), catmull_rom(), lanczos(3)}) {
        const Candidate narrow{kernel, 1 / shrink.stretch()};
        const auto make = [&](int inputs, int outputs) { return bank_of(narrow, {}, inputs, outputs); };
        const Found found = recognise(measured(by_bank(make), shrink, true));
        EXPECT_EQ(found.candidate.kernel.name, kernel.name);
        EXPECT_EQ(found.candidate.widening, narrow.widening);
    }
}

TEST(Recognise, BoxByEqualWeights) {
    Kernel point_sampled = box();
    point_sampled.form = Kernel::Form::separable;
    const auto make = [&](int inputs, int outputs) {
        return make_bank(point_sampled, Axis{inputs}, Axis{outputs}, Edge::clamp);
    };
    const Found found = recognise(measured(by_bank(make), shrink, true));
    EXPECT_EQ(found.candidate.kernel.name, "box");
    EXPECT_TRUE(found.candidate.is_sampled);
}

TEST(Recognise, AreasWhileGrowing) {
    // Each target cell lies in one source cell or in two, and weighs them by what it covers.
    const auto make = [](int inputs, int outputs) {
        Bank bank;
        bank.inputs = inputs;
        const double step = double(inputs) / outputs;
        for (int i = 0; i < outputs; ++i) {
            const int first = static_cast<int>(i * step + 1e-9), next = std::min(inputs - 1, first + 1);
            const double in_next = std::max(0.0, (i + 1) * step - (first + 1)) / step;
            bank.rows.push_back({bank.weights.size(), 2, 0, 1});
            bank.weights.push_back(static_cast<float>(1 - in_next));
            bank.weights.push_back(static_cast<float>(in_next));
            bank.outputs.push_back({next - 1, i});
            if (next == first) std::swap(bank.weights.end()[-1], bank.weights.end()[-2]);
        }
        return bank;
    };
    const Found found = recognise(measured(by_bank(make), grow, true));
    EXPECT_EQ(found.candidate.kernel.name, "area");
    EXPECT_LT(found.fit.residual, 0.01);
}

TEST(Recognise, FreeParameters) {
    for (const char* name : {"cubic:0.21:0.55", "gaussian:0.43"}) {
        const MeasuredBank bank =
            measured(OwnResize{.options = {.reconstruction = parse_kernel(name)}, .bytes = true}, grow, true);
        const Found near = recognise(bank);
        const FittedCandidate fitted = fit_parameters(bank, near.candidate, near.fit);
        EXPECT_LT(fitted.fit.residual, 1.3 * noise_floor(bank)) << name << ": " << fitted.candidate.kernel.name;
        EXPECT_EQ(fitted.candidate.kernel.name.substr(0, 5), std::string(name).substr(0, 5));
    }
}

TEST(Recognise, TablesOfPhases) {
    for (const int count : {8, 32})
        for (const bool nearest : {false, true}) {
            const auto make = [&](int inputs, int outputs) {
                return table_bank(lanczos(3), count, nearest, inputs, outputs);
            };
            const MeasuredBank bank = measured(by_bank(make), grow, true);
            const CandidateFit fit = best_fit(bank, {lanczos(3)});
            EXPECT_EQ(find_phases(bank, {lanczos(3)}, fit.placement).count, count) << nearest;
        }
    const MeasuredBank exact =
        measured(OwnResize{.options = {.reconstruction = lanczos(3)}, .bytes = true}, grow, true);
    const Phases phases = find_phases(exact, {lanczos(3)}, {});
    EXPECT_FALSE(phases.count.has_value()) << *phases.count;
    EXPECT_GE(phases.finest, 32);
    EXPECT_EQ(find_phases(exact, {box()}, {}).finest, 0) << "jumps tell nothing";
}

TEST(Recognise, SupportInSourceSamples) {
    const MeasuredBank bank = measured(OwnResize{.options = {.reconstruction = tent()}}, shrink, false);
    EXPECT_NEAR(support(bank, {}), shrink.step(), 0.05);  // the last weights are below the threshold
    const KernelSamples samples = kernel_samples(bank, {});
    for (std::size_t i = 0; i < samples.x.size(); ++i)  // rows are divided by their sum, which ripples by 3 %
        EXPECT_NEAR(samples.y[i], std::max(0.0, 1 - std::abs(samples.x[i])), 0.035);
}

}  // namespace
}  // namespace bandlimit
