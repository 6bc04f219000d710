#include "bandlimit/antialias/temporal_options.h"

#include <gtest/gtest.h>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

TEST(TemporalOptions, AreWrittenAsTheyAreRead) {
    for (const std::string_view preset : temporal_presets()) {
        const TemporalOptions from = temporal_preset(preset);
        TemporalOptions to = temporal_preset(preset == "sharp" ? "per-frame" : "sharp");
        for (const TemporalOptionInfo& info : temporal_option_infos())
            set_option(to, info.name, option_value(from, info.name));
        for (const TemporalOptionInfo& info : temporal_option_infos())
            EXPECT_EQ(option_value(to, info.name), option_value(from, info.name)) << preset << ' ' << info.name;
        EXPECT_EQ(to.kernel.value(0.3), from.kernel.value(0.3));
    }
}

TEST(TemporalOptions, ChangeTheMemberThatTheyName) {
    TemporalOptions options;
    set_option(options, "still-frames", "inf");
    EXPECT_EQ(options.still_frames, INFINITY);
    set_option(options, "history-kernel", "bspline");
    EXPECT_EQ(options.history_kernel, HistoryKernel::bspline);
    set_option(options, "rectification", "clip");
    EXPECT_EQ(options.rectification, Rectification::clip);
    set_option(options, "rule", "input-sized");
    EXPECT_EQ(options.rule, Accumulation::input_sized);
    set_option(options, "dilate-motion", "no");
    EXPECT_FALSE(options.dilates_motion);
    set_option(options, "kernel", "mitchell");
    EXPECT_EQ(options.kernel.name, "mitchell");
}

TEST(TemporalOptions, RefuseWhatTheyCannotBe) {
    TemporalOptions options;
    for (const auto& [name, value] : {std::pair{"alpha", "2"},
                                      {"alpha", "-0.1"},
                                      {"alpha", "a"},
                                      {"alpha", "nan"},
                                      {"alpha", ""},
                                      {"still-frames", "0.5"},
                                      {"history-kernel", "cubic"},
                                      {"dilate-motion", "maybe"},
                                      {"kernel", "no-kernel"},
                                      {"speed", "1"}})
        EXPECT_THROW(set_option(options, name, value), Error) << name << '=' << value;
}

}  // namespace
}  // namespace bandlimit
