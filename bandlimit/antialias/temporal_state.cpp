#include "bandlimit/antialias/temporal_state.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

enum class Size { of_value, of_value_or_none, up_to_value };

/// An image that a value holds, and what it may be like.
template <class ImageType>
struct Part {
    ImageType& image;
    int channels;
    Layout layout;
    Size size;
};

void check_shape(const std::array<std::int32_t, 2>& found, Size size, int width, int height) {
    const auto [w, h] = found;
    const bool is_none = w == 0 && h == 0, is_whole = w == width && h == height;
    const bool is_part = w >= 1 && h >= 1 && w <= width && h <= height;
    if (is_whole || (is_none && size != Size::of_value) || (is_part && size == Size::up_to_value)) return;
    fail("restore: an image of ", w, " x ", h, " in a state of ", width, " x ", height, "; pass what store() wrote");
}

}  // namespace

/// The one list of what is stored.
class TemporalState {
public:
    template <class History>
    static auto parts(History& h, const TemporalHistory*) {
        using P = Part<std::conditional_t<std::is_const_v<History>, const Image<float>, Image<float>>>;
        return std::array{P{h.now_.sums, 4, Layout::interleaved, Size::of_value},
                          P{h.now_.transparency, 1, Layout::planar, Size::of_value_or_none},
                          P{h.now_.locks, 1, Layout::planar, Size::of_value_or_none},
                          P{h.now_.surface, 4, Layout::interleaved, Size::up_to_value}};
    }
    template <class Meter>
    static auto parts(Meter& m, const TemporalMeter*) {
        using P = Part<std::conditional_t<std::is_const_v<Meter>, const Image<float>, Image<float>>>;
        return std::array{
            P{m.mean_, 3, Layout::interleaved, Size::of_value}, P{m.spread_, 3, Layout::interleaved, Size::of_value},
            P{m.before_, 3, Layout::interleaved, Size::of_value}, P{m.moved_, 1, Layout::planar, Size::of_value}};
    }

    static std::array<double, 4> numbers(const TemporalHistory& h) {
        return {h.jitter_.x, h.jitter_.y, h.exposure_, static_cast<double>(h.frames_)};
    }
    static bool take(TemporalHistory& h, const std::array<double, 4>& n) {
        if (!(std::abs(n[0]) <= 1 && std::abs(n[1]) <= 1 && n[2] > 0 && n[2] < 1e30 && n[3] >= 0 && n[3] < 1e9))
            return false;
        h.jitter_ = {n[0], n[1]}, h.exposure_ = n[2], h.frames_ = static_cast<int>(n[3]);
        return true;
    }
    static std::array<double, 7> numbers(const TemporalMeter& m) {
        return {m.warped_,
                m.warped_count_,
                m.disoccluded_,
                m.disoccluded_count_,
                m.elsewhere_,
                m.elsewhere_count_,
                static_cast<double>(m.frames_)};
    }
    static bool take(TemporalMeter& m, const std::array<double, 7>& n) {
        for (const double v : n)
            if (!(v >= 0)) return false;
        if (!(n[6] < 1e9)) return false;
        m.warped_ = n[0], m.warped_count_ = n[1], m.disoccluded_ = n[2], m.disoccluded_count_ = n[3];
        m.elsewhere_ = n[4], m.elsewhere_count_ = n[5], m.frames_ = static_cast<int>(n[6]);
        return true;
    }
    static int width(const TemporalHistory& h) { return h.width(); }
    static int height(const TemporalHistory& h) { return h.height(); }
    static int width(const TemporalMeter& m) { return m.mean_.width(); }
    static int height(const TemporalMeter& m) { return m.mean_.height(); }
};

namespace {

template <class Value>
void store_value(const Value& value, const WriteBytes& write) {
    const auto numbers = TemporalState::numbers(value);
    write(numbers.data(), sizeof numbers);
    for (const auto& part : TemporalState::parts(value, static_cast<const Value*>(nullptr))) {
        const std::array<std::int32_t, 2> shape{part.image.width(), part.image.height()};
        write(shape.data(), sizeof shape);
        const View<const float> view = part.image.view();
        for (int y = 0; y < view.height; ++y)
            write(&view(0, y),
                  static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.channels) * sizeof(float));
    }
}

template <class Value>
void restore_value(Value& value, const ReadBytes& read) {
    const int width = TemporalState::width(value), height = TemporalState::height(value);
    auto numbers = TemporalState::numbers(value);
    read(numbers.data(), sizeof numbers);
    for (auto& part : TemporalState::parts(value, static_cast<const Value*>(nullptr))) {
        std::array<std::int32_t, 2> shape{};
        read(shape.data(), sizeof shape);
        check_shape(shape, part.size, width, height);
        part.image = shape[0] > 0 ? Image<float>(shape[0], shape[1], part.channels, part.layout) : Image<float>();
        const View<float> view = part.image.view();
        for (int y = 0; y < view.height; ++y) {
            const int samples = view.width * view.channels;
            read(&view(0, y), static_cast<std::size_t>(samples) * sizeof(float));
            for (int i = 0; i < samples; ++i)
                if (!std::isfinite((&view(0, y))[i])) fail("restore: a sample is not finite; pass what store() wrote");
        }
    }
    if (!TemporalState::take(value, numbers)) fail("restore: a number is out of range; pass what store() wrote");
}

}  // namespace

void store(const TemporalHistory& history, const WriteBytes& write) { store_value(history, write); }
void store(const TemporalMeter& meter, const WriteBytes& write) { store_value(meter, write); }
void restore(TemporalHistory& history, const ReadBytes& read) { restore_value(history, read); }
void restore(TemporalMeter& meter, const ReadBytes& read) { restore_value(meter, read); }

}  // namespace bandlimit
