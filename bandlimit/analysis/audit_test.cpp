#include "bandlimit/analysis/audit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/analysis/resizers_test.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr Ratio shrink{37, 100}, grow{100, 37};

AuditReport audit_at(const ResizeFunction& resize, std::vector<Ratio> scales, bool alpha = false,
                     double code = 1 / 255.0) {
    return audit(resize, {.scales = std::move(scales), .code = code, .alpha = alpha});
}

BankResize::MakeBank own_bank(const Kernel& kernel, Edge edge = Edge::clamp) {
    return [=](int inputs, int outputs) { return make_bank(kernel, Axis{inputs}, Axis{outputs}, edge); };
}

TEST(Audit, FindsNothingWrongWithAResizeThatIsRight) {
    int calls = 0;
    const OwnResize own{.transfer = Transfer::srgb, .bytes = true};
    const AuditReport report = audit(own, {.scales = {{1, 2}, grow}, .progress = [&](int done, int all) {
                                               EXPECT_EQ(done, calls++);
                                               EXPECT_EQ(all, 10);
                                           }});
    EXPECT_EQ(calls, report.runs);
    EXPECT_EQ(report.filtered_in, Light::srgb);
    EXPECT_NEAR(report.light[0].checker * 255, 188, 0.01);  // half the light
    EXPECT_LT(report.light[0].flat_error, 1e-6);            // floats against doubles
    EXPECT_EQ(report.edges, std::vector<std::string_view>{"renormalize"});
    for (const AlphaReport& a : report.alpha) {
        EXPECT_EQ(a.mode, AlphaMode::weighted);
        EXPECT_EQ(a.hidden, "zero");
        EXPECT_NEAR(a.coverage, 0.5, 0.005);
        EXPECT_LE(a.flat_error, 1 / 255.0);
    }
    for (const ScaleReport& s : report.scales)
        for (const AxisReport& a : {std::cref(s.x), std::cref(s.y)}) {
            EXPECT_EQ(a.kernel.name, s.ratio.shrinks() ? "shrink3" : "grow3");
            EXPECT_TRUE(a.kernel.is_known && a.kernel.is_widened(s.ratio));
            EXPECT_EQ(a.alignment, "corners");
            EXPECT_LT(std::abs(a.bias), 0.1);
            EXPECT_FALSE(a.phases.count.has_value());
        }
    EXPECT_EQ(report.scales[1].separable, true);
    EXPECT_LT(report.scales[0].alias, -25);
    EXPECT_NEAR(report.scales[1].overshoot, report.scales[1].expected_overshoot, 0.02);
}

TEST(Audit, FloatsAreMeasuredAsExactlyAsFloatsAre) {
    const AuditReport report =
        audit_at(OwnResize{.options = {.reconstruction = mitchell(), .edge = Edge::wrap}}, {{1, 2}, grow}, true, 0);
    EXPECT_EQ(report.filtered_in, Light::codes);
    EXPECT_EQ(report.edges, std::vector<std::string_view>{"wrap"});
    for (const ScaleReport& s : report.scales) {
        EXPECT_EQ(s.x.kernel.name, "mitchell");
        EXPECT_LT(s.x.kernel.residual, 1e-5);
        EXPECT_LT(s.not_separable, 1e-4);
        EXPECT_NEAR(s.overshoot, s.expected_overshoot, 1e-5);
        EXPECT_NEAR(s.overrange, s.expected_overshoot, 1e-5) << "floats are not clipped";
    }
}

TEST(Audit, AHalfPixelShift) {
    const auto make = [](int inputs, int outputs) {
        const Placement half_right{false, outputs > inputs ? 0.5 : 0};
        return bank_of({catmull_rom()}, half_right, inputs, outputs);
    };
    const AuditReport report = audit_at(by_bank(make), {{1, 2}, {2, 1}});
    EXPECT_NEAR(report.scales[0].x.shift, 0, 0.005);
    EXPECT_NEAR(report.scales[1].x.shift, 0.5, 0.005);
    EXPECT_EQ(report.scales[1].x.alignment, "shifted");
    EXPECT_EQ(report.scales[1].y.alignment, "shifted");
}

TEST(Audit, CentersAreNoShift) {
    const AuditReport report = audit_at(OwnResize{.placement = {true, 0}, .bytes = true}, {grow});
    EXPECT_EQ(report.scales[0].x.alignment, "centers");
    EXPECT_NEAR(report.scales[0].x.shift, 0, 0.005);
}

TEST(Audit, AveragesOfCodesAndOfOtherPowers) {
    EXPECT_EQ(audit_at(OwnResize{.bytes = true}, {{1, 2}}).filtered_in, Light::codes);
    const auto power = [](View<const float> v, int width, int height) {
        Image<float> in = copy_of(v);
        for_samples(in.view(), [](float x) { return std::pow(x, 2.2f); });
        Image<float> out = OwnResize{}(in.view(), width, height);
        for_samples(out.view(), [](float x) { return nearest_byte(std::pow(std::max(x, 0.0f), 1 / 2.2f)); });
        return out;
    };
    EXPECT_EQ(audit_at(power, {{1, 2}}).filtered_in, Light::gamma22);
    const auto video = [](View<const float> v, int width, int height) {
        Image<float> in = copy_of(v);
        for_samples(in.view(), [](float x) { return float(decode(Light::bt709, double(x))); });
        Image<float> out = OwnResize{}(in.view(), width, height);
        for_samples(out.view(), [](float x) { return nearest_byte(float(encode(Light::bt709, double(x)))); });
        return out;
    };
    EXPECT_EQ(audit_at(video, {{1, 2}}).filtered_in, Light::bt709);
    for (const double v : {0.01, 0.05, 0.5, 1.0, -0.3})
        for (const Light light : {Light::srgb, Light::gamma22, Light::bt709})
            EXPECT_NEAR(encode(light, decode(light, v)), v, 1e-4) << name_of(light);  // constants of four digits
    const AuditReport picks = audit_at(OwnResize{.options = {.reconstruction = nearest()}, .bytes = true}, {shrink});
    EXPECT_EQ(picks.filtered_in, Light::unknown) << "nothing was averaged";
    EXPECT_EQ(picks.scales[0].x.kernel.name, "nearest");
    EXPECT_FALSE(picks.scales[0].x.kernel.is_widened(shrink));
}

TEST(Audit, NearestIsNoShiftHoweverTiesAreDecided) {
    for (const bool down : {false, true}) {
        const auto make = [=](int inputs, int outputs) { return bank_of({nearest(), 1, down}, {}, inputs, outputs); };
        for (const ScaleReport& s : audit_at(by_bank(make), {{1, 2}, shrink}).scales) {
            EXPECT_EQ(s.x.kernel.name, "nearest");
            EXPECT_TRUE(s.x.kernel.is_known);
            EXPECT_EQ(s.x.alignment, "corners");
        }
    }
}

TEST(Audit, AKernelThatIsNotWidenedAliases) {
    const auto make = [](int inputs, int outputs) {
        return bank_of({tent(), std::min(1.0, double(outputs) / inputs)}, {}, inputs, outputs);
    };
    // At 1/2 a box does the same; the other scale decides.
    const AuditReport report = audit_at(by_bank(make), {{1, 2}, shrink});
    for (const ScaleReport& s : report.scales) {
        EXPECT_EQ(s.x.kernel.name, "tent");
        EXPECT_FALSE(s.x.kernel.is_widened(s.ratio));
        EXPECT_NEAR(s.x.support_source, 1, 0.51);
    }
    EXPECT_GT(report.scales[1].alias, -10);
}

TEST(Audit, TruncationIsABiasOfHalfACode) {
    const AuditReport report = audit_at(by_bank(own_bank(lanczos(3)), truncated_byte), {shrink});
    EXPECT_NEAR(report.scales[0].x.bias, -0.5, 0.05);
    EXPECT_EQ(report.scales[0].x.kernel.name, "lanczos3");
}

TEST(Audit, ATableOf32Phases) {
    const auto make = [](int inputs, int outputs) { return table_bank(lanczos(3), 32, true, inputs, outputs); };
    const AuditReport report = audit_at(by_bank(make), {grow});
    EXPECT_EQ(report.scales[0].x.phases.count, 32);
}

TEST(Audit, AlphaThatBleedsAndAlphaThatIsLost) {
    const AuditReport straight = audit_at(
        OwnResize{.options = {.reconstruction = lanczos(3), .premultiply = false}, .bytes = true}, {{1, 2}}, true);
    ASSERT_EQ(straight.alpha.size(), 1u);
    EXPECT_EQ(straight.alpha[0].mode, AlphaMode::bleeds);
    EXPECT_EQ(straight.alpha[0].hidden, "kept");
    EXPECT_GT(straight.alpha[0].leak, 0.9);
    const AuditReport box_alone =
        audit_at(OwnResize{.options = {.reconstruction = box(), .premultiply = false}, .bytes = true}, {{1, 2}}, true);
    EXPECT_EQ(box_alone.alpha[0].mode, AlphaMode::bleeds) << "a box sees no neighbour, only its own cell";

    const auto without = [](View<const float> v, int width, int height) {
        return copy_of(
            channels_of(View<const float>(OwnResize{}(v, width, height).view()), 0, std::min(3, v.channels)));
    };
    EXPECT_EQ(audit_at(without, {{1, 2}}, true).alpha[0].mode, AlphaMode::dropped);
    const auto refusing = [](View<const float> v, int width, int height) {
        if (v.channels == 4) throw std::runtime_error("no alpha here");
        return OwnResize{.bytes = true}(v, width, height);
    };
    const AuditReport refused = audit_at(refusing, {{1, 2}}, true);
    EXPECT_EQ(refused.alpha[0].mode, AlphaMode::failed);
    EXPECT_EQ(refused.alpha[0].failure, "no alpha here");
}

TEST(Audit, OvershootThatIsTakenAway) {
    for (const double antiring : {0.0, 1.0}) {
        const OwnResize own{.options = {.reconstruction = lanczos(3), .antiring = antiring}};
        const ScaleReport scale = std::move(audit_at(own, {grow}, false, 0).scales[0]);
        if (antiring == 0) EXPECT_GT(std::min(scale.overshoot, scale.overrange), 0.08);
        else EXPECT_LT(std::max(scale.overshoot, scale.overrange), 1e-6);
    }
    const OwnResize bytes{.options = {.reconstruction = lanczos(3)}, .bytes = true};
    const ScaleReport scale = std::move(audit_at(bytes, {grow}).scales[0]);
    EXPECT_GT(scale.overshoot, 0.08);
    EXPECT_EQ(scale.overrange, 0) << "codes cannot hold it";
}

TEST(Audit, RadialKernelsAndDifferentAxes) {
    const AuditReport radial =
        audit_at(OwnResize{.options = {.reconstruction = jinc_lanczos(2)}, .bytes = true}, {{2, 1}});
    EXPECT_EQ(radial.scales[0].separable, false);
    EXPECT_EQ(radial.scales[0].x.kernel.name, "jinc2");
    EXPECT_LT(radial.scales[0].axis_difference, 0.01);
    const AuditReport mixed = audit_at(BankResize{own_bank(lanczos(3)), own_bank(mitchell()), nearest_byte}, {{2, 1}});
    EXPECT_EQ(mixed.scales[0].x.kernel.name, "lanczos3");
    EXPECT_EQ(mixed.scales[0].y.kernel.name, "mitchell");
    EXPECT_GT(mixed.scales[0].axis_difference, 0.1);
    EXPECT_EQ(mixed.scales[0].separable, true);
}

TEST(Audit, AnUnknownKernelIsCalledSo) {
    const Kernel odd{"odd", 2.5, [](double x) { return std::abs(x) < 2.5 ? 1 + std::cos(3 * x) : 0; }, {}, {}};
    const AuditReport report = audit_at(by_bank(own_bank(odd)), {shrink});
    EXPECT_FALSE(report.scales[0].x.kernel.is_known);
    EXPECT_TRUE(report.edges.empty());
}

TEST(Audit, WrongShapesAndNoScale) {
    const auto wrong = [](View<const float>, int width, int height) { return Image<float>(width + 1, height); };
    EXPECT_THROW(audit_at(wrong, {{1, 2}}), Error);
    const auto coloured = [](View<const float>, int width, int height) { return Image<float>(width, height, 3); };
    EXPECT_THROW(audit_at(coloured, {{1, 2}}), Error);
    EXPECT_THROW(audit_at(OwnResize{}, {}), Error);
}

}  // namespace
}  // namespace bandlimit
