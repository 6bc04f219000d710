#include "bandlimit/antialias/temporal_shader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/core/error.h"

// The text is compiled and executed in shader/execute_temporal_test.cpp.
namespace bandlimit {
namespace {

std::string emitted(const TemporalOptions& options, Dialect dialect = Dialect::glsl) {
    return temporal_shader(options, {.name = "taa", .command = "a test"}, dialect);
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(TemporalShader, HasNothingThatTheOptionsDoNotAskFor) {
    const std::string balanced = emitted(temporal_preset("balanced")),
                      reference = emitted(temporal_preset("reference"));
    for (const char* part :
         {"taa_compressed", "taa_guide", "taa_mismatch", "surface_before", "taa_rectified", "speed", "jitter_before"}) {
        EXPECT_TRUE(holds(balanced, part)) << part;
        EXPECT_FALSE(holds(reference, part)) << part;
    }
    EXPECT_FALSE(holds(emitted(temporal_preset("fast")), "taa_history_weights"));
    EXPECT_FALSE(holds(balanced, "taa_sharpen"));
    EXPECT_TRUE(holds(emitted(temporal_preset("sharp")), "taa_sharpen"));
    EXPECT_FALSE(holds(balanced, "taa_ycocg"));
}

/// Every word of the template is replaced: names and constants are all that is left in capitals.
TEST(TemporalShader, IsReadyToPaste) {
    for (const char* preset : {"balanced", "fast", "sharp", "reference"})
        for (const Dialect dialect : all_dialects()) {
            const std::string text = emitted(temporal_preset(preset), dialect);
            for (const char* word : {"NAME", "LEAST", "MOST", "RADIUS", "COMPRESSED", "RESTORED", "YCOCG", "RGB(",
                                     "SUM", "WEIGHT", "FORGET", "MISMATCH", "GUIDE", "inf", "nan"})
                EXPECT_FALSE(holds(text, word)) << preset << ", " << name_of(dialect) << ": " << word;
        }
}

TEST(TemporalShader, SaysWhatItCosts) {
    TemporalOptions options;
    options.kernel = tent();
    options.history_kernel = HistoryKernel::bilinear;
    EXPECT_TRUE(holds(emitted(options), "about 4.0 / scale^2 of color"));
    EXPECT_TRUE(holds(emitted(options), "4 of history"));
}

TEST(TemporalShader, RefusesWhatHasNoShader) {
    EXPECT_THROW(emitted(temporal_preset("per-frame")), Error);
    EXPECT_THROW(emitted(temporal_preset("input-sized")), Error);
    TemporalOptions locked;
    locked.lock_frames = 4;
    EXPECT_THROW(emitted(locked), Error);
    TemporalOptions options;
    options.kernel = jinc_lanczos(3);
    EXPECT_THROW(emitted(options), Error);
    options = {};
    options.rectify_share = 2;
    EXPECT_THROW(emitted(options), Error);
    options = {};
    options.kernel.value = [](double x) { return std::sqrt(std::abs(x)); };
    EXPECT_THROW(emitted(options), Error);
    EXPECT_THROW(temporal_shader({}, {.name = "Not a name"}, Dialect::glsl), Error);
}

/// Kernels become polynomials piece by piece: all that are separable can be emitted.
TEST(TemporalShader, TakesEverySeparableKernel) {
    for (const KernelInfo& info : kernel_list()) {
        TemporalOptions options;
        options.kernel = parse_kernel(info.example);
        if (is_radial(options.kernel) || options.kernel.form == Kernel::Form::nearest) continue;
        EXPECT_NO_THROW(emitted(options)) << info.example;
    }
}

}  // namespace
}  // namespace bandlimit
