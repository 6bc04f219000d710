// Kernels by name.
#include <array>
#include <charconv>
#include <optional>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/kernel/name_parts.h"

namespace bandlimit {
namespace {

constexpr std::array kernels{
    KernelInfo{"nearest", "nearest", "one sample, never averaged; of two equally near ones the higher index"},
    KernelInfo{"box", "box", "exact mean over the output cell when minifying (area averaging), else nearest"},
    KernelInfo{"tent", "tent", "linear interpolation; widened when minifying [bilinear, triangle]"},
    KernelInfo{"quadratic", "quadratic", "quadratic B-spline: smooth, blurs a little"},
    KernelInfo{"quadratic-interp", "quadratic-interp", "Dodgson's interpolating quadratic"},
    KernelInfo{"bspline", "bspline", "cubic B-spline: smoothest, blurs most, never rings"},
    KernelInfo{"catmull-rom", "catmull-rom", "interpolating cubic, B = 0, C = 1/2"},
    KernelInfo{"mitchell", "mitchell", "cubic with B = C = 1/3: the compromise of Mitchell and Netravali"},
    KernelInfo{"cubic:B:C", "cubic:0.25:0.375", "any cubic of the Mitchell-Netravali family"},
    KernelInfo{"magic-sharp-2013", "magic-sharp-2013", "Magic Kernel Sharp of 2013, radius 2.5"},
    KernelInfo{"magic-sharp-2021", "magic-sharp-2021", "Magic Kernel Sharp of 2021, radius 4.5"},
    KernelInfo{"shrink3", "shrink3", "least squares, 3 lobes, to shrink: less error than lanczos3, rings no more"},
    KernelInfo{"grow3", "grow3", "least squares, 3 lobes, to grow: interpolates, less error than lanczos3"},
    KernelInfo{"lanczosN", "lanczos3", "sinc windowed by its own main lobe, N lobes: lanczos2, lanczos3, ..."},
    KernelInfo{"sinc:R", "sinc:4", "sinc cut off at radius R: rings; for study"},
    KernelInfo{"gaussian:SIGMA", "gaussian:0.5", "exp(-x^2 / (2 SIGMA^2)), cut off at 4 SIGMA"},
    KernelInfo{"blackman-harris", "blackman-harris", "exp(-2.29 x^2), the usual fit of the window below"},
    KernelInfo{"blackman-harris-window", "blackman-harris-window", "the 4-term window, 3.3 samples wide"},
    KernelInfo{"kaiser:R:BETA", "kaiser:4:6", "sinc of radius R in a Kaiser window; BETA trades sharpness for leakage"},
    KernelInfo{"jincN", "jinc3", "radial: jinc windowed by its main lobe, radius at its N-th zero [EWA Lanczos]"},
    KernelInfo{"jincN-unscaled", "jinc2-unscaled", "radial: pi jinc(r) jinc(r/N) for r < N; jumps at its edge"},
    KernelInfo{"radial-lanczosN", "radial-lanczos2",
               "radial and WRONG: 1D Lanczos of the distance; sharpens and aliases"},
};

std::string names() {
    std::string text;
    for (const KernelInfo& info : kernels) text += (text.empty() ? "" : ", ") + std::string(info.name);
    return text;
}

/// Words that other programs use for one of our kernels.
struct Alias {
    std::string_view word, meaning;
};
constexpr std::array aliases{
    Alias{"point", "nearest"},
    Alias{"area", "box"},
    Alias{"linear", "tent"},
    Alias{"bilinear", "tent"},
    Alias{"triangle", "tent"},
    Alias{"quadratic-bspline", "quadratic"},
    Alias{"biquadratic", "quadratic"},
    Alias{"b-spline", "bspline"},
    Alias{"cubic-bspline", "bspline"},
    Alias{"catrom", "catmull-rom"},
    Alias{"catmullrom", "catmull-rom"},
    Alias{"lanczos", "lanczos3"},
    Alias{"ewa-lanczos", "jinc3"},
    Alias{"jinc", "jinc3"},
};

/// Words that mean different kernels to different people.
struct Ambiguity {
    std::string_view word, advice;
};
constexpr std::array ambiguities{
    Ambiguity{"bicubic", "bspline, catmull-rom, mitchell or cubic:B:C"},
    Ambiguity{"cubic", "bspline, catmull-rom, mitchell or cubic:B:C"},
    Ambiguity{"gauss", "gaussian:SIGMA, as gaussian:0.5"},
};

/// `N` of a head that reads prefix N suffix.
std::optional<int> lobes_of(std::string_view head, std::string_view prefix, std::string_view suffix) {
    if (!head.starts_with(prefix) || !head.ends_with(suffix) || head.size() <= prefix.size() + suffix.size()) return {};
    const std::string_view digits = head.substr(prefix.size(), head.size() - prefix.size() - suffix.size());
    int lobes = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), lobes);
    if (status != std::errc{} || end != digits.data() + digits.size()) return {};
    return lobes;
}

/// Kernels without parameters.
struct Plain {
    std::string_view name;
    Kernel (*make)();
};
constexpr std::array plain_kernels{
    Plain{"nearest", nearest},
    Plain{"box", box},
    Plain{"tent", tent},
    Plain{"quadratic", quadratic_bspline},
    Plain{"quadratic-interp", quadratic_interpolating},
    Plain{"bspline", bspline},
    Plain{"catmull-rom", catmull_rom},
    Plain{"mitchell", mitchell},
    Plain{"magic-sharp-2013", magic_sharp_2013},
    Plain{"magic-sharp-2021", magic_sharp_2021},
    Plain{"shrink3", shrink3},
    Plain{"grow3", grow3},
    Plain{"blackman-harris", blackman_harris},
    Plain{"blackman-harris-window", blackman_harris_window},
};

/// Kernels with a number of lobes inside the name.
struct Lobed {
    std::string_view prefix, suffix;
    Kernel (*make)(int);
};
constexpr std::array lobed_kernels{
    Lobed{"lanczos", "", lanczos},
    Lobed{"jinc", "", jinc_lanczos},
    Lobed{"jinc", "-unscaled", jinc_lanczos_unscaled},
    Lobed{"radial-lanczos", "", radial_lanczos},
};

std::optional<Kernel> with_parameters(const NameParts& parts) {
    const auto take = [&](std::size_t count, std::string_view form) {
        return number_parameters(parts, "kernel", count, form);
    };
    if (parts.head == "cubic") {
        const auto p = take(2, "cubic:B:C, as cubic:0.25:0.375");
        return cubic(p[0], p[1]);
    }
    if (parts.head == "sinc") return truncated_sinc(take(1, "sinc:R, as sinc:4")[0]);
    if (parts.head == "gaussian") return gaussian(take(1, "gaussian:SIGMA, as gaussian:0.5")[0]);
    if (parts.head == "kaiser") {
        const auto p = take(2, "kaiser:R:BETA, as kaiser:4:6");
        return kaiser(p[0], p[1]);
    }
    return {};
}

}  // namespace

std::span<const KernelInfo> kernel_list() { return kernels; }

Kernel parse_kernel(std::string_view name) {
    for (const Ambiguity& a : ambiguities)
        if (a.word == name)
            fail("kernel \"", name, "\" means different kernels in different programs; choose ", a.advice);
    for (const Alias& a : aliases)
        if (a.word == name) name = a.meaning;

    const NameParts parts = split_name(name);
    if (auto kernel = with_parameters(parts)) return *std::move(kernel);
    for (const Plain& k : plain_kernels)
        if (k.name == parts.head) return expect_parameters(parts, "kernel", 0, k.name), k.make();
    for (const Lobed& k : lobed_kernels)
        if (const auto lobes = lobes_of(parts.head, k.prefix, k.suffix))
            return expect_parameters(parts, "kernel", 0, parts.head), k.make(*lobes);
    fail("kernel \"", name, "\" is unknown; choose one of: ", names());
}

}  // namespace bandlimit
