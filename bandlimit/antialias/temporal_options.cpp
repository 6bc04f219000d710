#include "bandlimit/antialias/temporal_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

double parse_in(std::string_view name, std::string_view text, double least, double most) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size())
        fail(name, " = \"", text, "\" is not a number; use e.g. 0.5");
    if (!(value >= least && value <= most))
        fail(name, " = ", value, " is out of range; pass ", least,
             most < INFINITY ? message(" to ", most) : " or more");
    return value;
}

std::string text_of(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// The value of an enum, whose values count up from 0, that is called `text`.
template <class Value>
Value parse_one_of(std::string_view name, std::string_view text, Value last) {
    std::string list;
    for (int i = 0; i <= static_cast<int>(last); ++i) {
        const std::string_view candidate = name_of(static_cast<Value>(i));
        if (candidate == text) return static_cast<Value>(i);
        list += (list.empty() ? "" : ", ");
        list += candidate;
    }
    fail(name, " = \"", text, "\" is unknown; choose one of: ", list);
}

Kernel parse_separable(std::string_view text) {
    const Kernel kernel = parse_kernel(text);
    if (is_radial(kernel) || kernel.form == Kernel::Form::nearest)
        fail("kernel = \"", text, "\" is not separable; choose e.g. gaussian or lanczos2");
    return kernel;
}

/// How a member is read and written.
struct Member {
    TemporalOptionInfo info;
    std::string (*get)(const TemporalOptions&);
    void (*set)(TemporalOptions&, std::string_view name, std::string_view text);
};

template <double TemporalOptions::*member, int least, int most>
constexpr Member number(TemporalOptionInfo info) {
    return {info, [](const TemporalOptions& o) { return text_of(o.*member); },
            [](TemporalOptions& o, std::string_view name, std::string_view text) {
                o.*member = parse_in(name, text, least, most < 0 ? INFINITY : most);
            }};
}

template <bool TemporalOptions::*member>
constexpr Member flag(TemporalOptionInfo info) {
    return {info, [](const TemporalOptions& o) { return std::string(o.*member ? "yes" : "no"); },
            [](TemporalOptions& o, std::string_view name, std::string_view text) {
                if (text != "yes" && text != "no") fail(name, " = \"", text, "\" is not understood; pass yes or no");
                o.*member = text == "yes";
            }};
}

template <auto member, auto last>
constexpr Member choice(TemporalOptionInfo info) {
    return {info, [](const TemporalOptions& o) { return std::string(name_of(o.*member)); },
            [](TemporalOptions& o, std::string_view name, std::string_view text) {
                o.*member = parse_one_of(name, text, last);
            }};
}

using Options = TemporalOptions;

constexpr std::array members{
    Member{{"kernel", "a separable kernel, e.g. lanczos2", "of the samples, in output pixels"},
           [](const Options& o) { return o.kernel.name; },
           [](Options& o, std::string_view, std::string_view text) { o.kernel = parse_separable(text); }},
    choice<&Options::rule, Accumulation::input_sized>(
        {"rule", "weighted, per-frame or input-sized", "how a frame is added to the history"}),
    number<&Options::alpha, 0, 1>({"alpha", "0 to 1", "the share of a frame, for the plain rules"}),
    number<&Options::still_frames, 1, -1>(
        {"still-frames", "1 or more, or inf", "frames that a pixel remembers while it is still"}),
    number<&Options::forget_by_motion, 0, -1>(
        {"forget-by-motion", "0 or more", "divides that by 1 + this times its pixels per frame"}),
    choice<&Options::history_kernel, HistoryKernel::bspline>(
        {"history-kernel", "bilinear, catmull-rom, catmull-rom5, lanczos2 or bspline", "reads the history"}),
    flag<&Options::dilates_motion>({"dilate-motion", "yes or no", "take the motion of the nearest of 3 x 3 samples"}),
    number<&Options::depth_tolerance, 0, -1>(
        {"depth-tolerance", "0 or more, or inf", "relative; history of another depth is of something else"}),
    number<&Options::disocclusion_keep, 0, 1>(
        {"disocclusion-keep", "0 to 1", "the share of its memory that such a history keeps"}),
    choice<&Options::rectification, Rectification::variance>(
        {"rectification", "none, clamp, clip or variance", "of history unlike the samples about it"}),
    flag<&Options::rectifies_ycocg>({"rectify-ycocg", "yes or no", "in luma and chroma rather than RGB"}),
    number<&Options::box_size, 0, -1>({"box-size", "0 or more", "of the box, in standard deviations, for variance"}),
    number<&Options::rectify_share, 0, 1>(
        {"rectify-share", "0 to 1", "how far into the box what moves is taken per frame"}),
    number<&Options::lock_frames, 0, 1000000>(
        {"lock-frames", "0, or 1 or more", "how long thin things that move keep their colour"}),
    number<&Options::doubt, 0, -1>(
        {"doubt", "0 or more", "memory that history loses per standard deviation beyond the box"}),
    flag<&Options::compresses_highlights>(
        {"compress-highlights", "yes or no", "average values v above 1 as 1 + log(v)"}),
    number<&Options::anti_flicker, 0, -1>(
        {"anti-flicker", "0 or more", "frames weigh 1 / (1 + this x relative difference of luma)"}),
    number<&Options::deringing_frames, 0, 1000000>(
        {"deringing-frames", "0 or more", "until history is of so many, no ringing beyond the samples"}),
    number<&Options::sharpening, 0, 1>({"sharpening", "0 to 1", "of what is shown; history is not sharpened"}),
};

constexpr auto infos = [] {
    std::array<TemporalOptionInfo, members.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = members[i].info;
    return all;
}();

const Member& member_called(std::string_view name) {
    std::string list;
    for (const Member& m : members) {
        if (m.info.name == name) return m;
        list += (list.empty() ? "" : ", ");
        list += m.info.name;
    }
    fail("the temporal option \"", name, "\" is unknown; choose one of: ", list);
}

}  // namespace

std::span<const TemporalOptionInfo> temporal_option_infos() { return infos; }

std::string option_value(const TemporalOptions& options, std::string_view name) {
    return member_called(name).get(options);
}

void set_option(TemporalOptions& options, std::string_view name, std::string_view value) {
    member_called(name).set(options, name, value);
}

}  // namespace bandlimit
