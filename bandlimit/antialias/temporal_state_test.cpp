#include "bandlimit/antialias/temporal_state.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr int in_width = 9, in_height = 7, width = 18, height = 14;

/// A frame of noise in which half of everything moves.
struct Frame {
    Image<float> color, depth, motion;
    Point jitter;

    Frame(int number, int channels)
        : color(in_width, in_height, channels),
          depth(in_width, in_height),
          motion(in_width, in_height, 2),
          jitter{0.1 * (number % 5) - 0.2, 0.07 * (number % 7) - 0.2} {
        Random random(static_cast<std::uint64_t>(number + 1));
        for (int y = 0; y < in_height; ++y)
            for (int x = 0; x < in_width; ++x) {
                for (int c = 0; c < channels; ++c) color.view()(x, y, c) = static_cast<float>(random.uniform());
                depth.view()(x, y) = x < 4 ? 1 : 5;
                motion.view()(x, y, 0) = x < 4 ? 0.3f : 0;
            }
    }
    TemporalFrame view() const {
        return {.color = color.view(), .depth = depth.view(), .motion = motion.view(), .jitter = jitter};
    }
};

template <class Value>
std::string bytes_of(const Value& value) {
    std::string bytes;
    store(value, [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); });
    return bytes;
}

template <class Value>
void restore_from(Value& value, const std::string& bytes) {
    std::size_t at = 0;
    restore(value, [&](void* data, std::size_t size) {
        if (bytes.size() - at < size) throw std::runtime_error("ends too soon");
        std::memcpy(data, bytes.data() + at, size);
        at += size;
    });
    if (at != bytes.size()) throw std::runtime_error("goes on");
}

/// What frames `from` to `to` show at last.
Image<float> shown(TemporalHistory& history, int from, int to, int channels, const TemporalOptions& options) {
    Image<float> out(width, height, channels, Layout::interleaved);
    for (int f = from; f < to; ++f) accumulate(history, Frame(f, channels).view(), options, out.view(), {1});
    return out;
}

TEST(TemporalState, AHistoryGoesOnWithTheSameBits) {
    for (const int channels : {3, 4})
        for (const std::string_view preset : temporal_presets()) {
            const TemporalOptions options = temporal_preset(preset);
            TemporalHistory whole(width, height), first(width, height), second(width, height);
            const Image<float> wanted = shown(whole, 0, 6, channels, options);
            shown(first, 0, 3, channels, options);
            restore_from(second, bytes_of(first));
            EXPECT_EQ(second.frames(), 3);
            const Image<float> found = shown(second, 3, 6, channels, options);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    for (int c = 0; c < channels; ++c)
                        ASSERT_EQ(found.view()(x, y, c), wanted.view()(x, y, c)) << preset << " " << x << " " << y;
            EXPECT_EQ(bytes_of(whole), bytes_of(second));
        }
}

TEST(TemporalState, AnEmptyHistoryIsEmptyAgain) {
    TemporalHistory history(width, height), again(width, height);
    restore_from(again, bytes_of(history));
    EXPECT_EQ(again.frames(), 0);
    const TemporalOptions options;
    EXPECT_EQ(shown(again, 0, 1, 4, options).view()(3, 3, 1), shown(history, 0, 1, 4, options).view()(3, 3, 1));
}

TEST(TemporalState, AMeterGoesOnWithTheSameBits) {
    const auto add = [](TemporalMeter& meter, int from, int to) {
        for (int f = from; f < to; ++f) {
            const Frame frame(f, 3);
            meter.add({.shown = frame.color.view(), .truth = Frame(99, 3).color.view(), .motion = frame.motion.view()});
        }
    };
    TemporalMeter whole(in_width, in_height), first(in_width, in_height), second(in_width, in_height);
    add(whole, 0, 6);
    add(first, 0, 2);
    restore_from(second, bytes_of(first));
    add(second, 2, 6);
    EXPECT_EQ(bytes_of(whole), bytes_of(second));
    EXPECT_EQ(*whole.measures().flicker, *second.measures().flicker);
    EXPECT_EQ(*whole.measures().warped_difference, *second.measures().warped_difference);
    EXPECT_EQ(*whole.measures().error_elsewhere, *second.measures().error_elsewhere);
}

// Whatever bytes there are: an error, or a history that can be used.
TEST(TemporalState, RefusesOtherBytes) {
    TemporalHistory history(width, height);
    shown(history, 0, 2, 4, {});
    const std::string good = bytes_of(history);
    for (const std::size_t length : {std::size_t{0}, std::size_t{5}, good.size() / 2, good.size() - 1}) {
        TemporalHistory again(width, height);
        EXPECT_ANY_THROW(restore_from(again, good.substr(0, length))) << length;
    }
    TemporalHistory other(width + 1, height);
    EXPECT_THROW(restore_from(other, good), Error);
    const auto with = [&](std::size_t at, const auto& value) {
        std::string bytes = good;
        std::memcpy(bytes.data() + at, &value, sizeof value);
        return bytes;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const std::string& bytes :
         {with(0, nan), with(0, 1e9), with(16, 0.0), with(24, -1.0), with(24, nan), with(32, std::int32_t{1 << 30}),
          with(36, std::int32_t{-1}), with(44, std::numeric_limits<float>::infinity())}) {
        TemporalHistory again(width, height);
        EXPECT_THROW(restore_from(again, bytes), Error);
    }
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        std::string bytes = good;
        for (int n = 0; n < 4; ++n)
            bytes[static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1))] =
                static_cast<char>(random.integer(0, 255));
        TemporalHistory again(width, height);
        try {
            restore_from(again, bytes);
        } catch (const std::exception&) {
            continue;
        }
        shown(again, 2, 3, 4, {});
    }
}

}  // namespace
}  // namespace bandlimit
