#include "bandlimit/job/signals.h"

#include <cmath>

#include "bandlimit/core/error.h"

namespace bandlimit::job {
namespace {

/// Collects the parameters of a signal.
class Parameters {
public:
    explicit Parameters(std::vector<SignalParameter>& list) : list_(list) {}

    template <class Number>
    void add(const std::string& name, Number& value, const std::string& help, const std::string& type) {
        list_.push_back({name, type, help, &value});
    }
    void add(const std::string& name, int& value, const std::string& help) { add(name, value, help, "N"); }
    void add(const std::string& name, std::uint64_t& value, const std::string& help) { add(name, value, help, "N"); }
    void add(const std::string& name, bool& value, const std::string& help) { add(name, value, help, ""); }
    void add(const std::string& name, std::optional<Point>& value, const std::string& help) {
        add(name, value, help, "X,Y");
    }
    void add(const std::string& name, std::optional<Cell>& value, const std::string& help) {
        add(name, value, help, "X,Y,W,H");
    }

private:
    std::vector<SignalParameter>& list_;
};

/// Adds a kind whose signal is make(size, options); `add` names what can be set of these.
template <class SignalOptions>
void add_kind(std::vector<NamedSignal>& list, const std::string& name, const std::string& summary,
              const std::string& example, const std::function<void(Parameters&, SignalOptions&)>& add,
              const std::function<Signal(PatternSize, const SignalOptions&)>& make,
              const std::function<std::uint64_t(PatternSize, const SignalOptions&)>& bytes = {}) {
    auto own = std::make_shared<SignalOptions>();
    NamedSignal signal{name, summary, example, {}, [own, make](PatternSize size) { return make(size, *own); }};
    if (bytes) signal.bytes = [own, bytes](PatternSize size) { return bytes(size, *own); };
    signal.options = own;
    Parameters parameters(signal.parameters);
    add(parameters, *own);
    list.push_back(std::move(signal));
}

Frame frame_of(PatternSize size) { return {double(size.width), double(size.height)}; }

constexpr const char* angle_help = "Direction in which the signal varies, in degrees clockwise; 0: to the right";
constexpr const char* phase_help = "Phase in periods; default 0";
constexpr const char* center_help = "Centre in pixels; default: the middle of the image";

void add_waves(std::vector<NamedSignal>& list) {
    add_kind<ZonePlateOptions>(
        list, "zoneplate", "Rings: the frequency grows with the distance from the centre",
        "zoneplate.png --size 512x512 --antialias exact",
        [](Parameters& k, ZonePlateOptions& z) {
            k.add("max-frequency", z.max_frequency,
                  "Cycles per pixel at --radius; default 0.5, the most that pixels hold", "F");
            k.add("radius", z.radius, "Pixels; default: half the longer side", "R");
            k.add("center", z.center, center_help);
            k.add("phase", z.phase, phase_help, "P");
        },
        [](PatternSize size, const ZonePlateOptions& z) { return zone_plate(frame_of(size), z); });
    add_kind<SiemensStarOptions>(
        list, "siemens", "Spokes: the frequency grows towards the centre",
        "star.png --size 512x512 --antialias lanczos3 --spokes 36",
        [](Parameters& k, SiemensStarOptions& s) {
            k.add("spokes", s.spokes, "Bright spokes; default 72");
            k.add("radius", s.radius, "Pixels; default: half the shorter side", "R");
            k.add("center", s.center, center_help);
            k.add("phase", s.phase, "Turns the star by this share of the angle between spokes; default 0", "P");
            k.add("sinusoid", s.sinusoid, "A smooth wave around the centre instead of hard edges");
        },
        [](PatternSize size, const SiemensStarOptions& s) { return siemens_star(frame_of(size), s); });
    add_kind<ChirpOptions>(
        list, "chirp", "A wave whose frequency changes across the image",
        "chirp.png --size 1024x128 --from 0 --to 0.5 --antialias exact",
        [](Parameters& k, ChirpOptions& c) {
            k.add("from", c.from, "Cycles per pixel where the image begins; default 0.01", "F");
            k.add("to", c.to, "Cycles per pixel where it ends; default 0.5", "F");
            k.add("exponential", c.exponential, "Equal factors over equal distances, not equal steps");
            k.add("angle", c.angle, angle_help, "DEGREES");
            k.add("phase", c.phase, phase_help, "P");
        },
        [](PatternSize size, const ChirpOptions& c) { return chirp(frame_of(size), c); });
    add_kind<StripesOptions>(
        list, "stripes", "Stripes of one period, hard or sinusoidal",
        "stripes.png --size 256x256 --period 2.5 --angle 10 --antialias exact",
        [](Parameters& k, StripesOptions& s) {
            k.add("period", s.period, "Pixels; default 8", "PX");
            k.add("angle", s.angle, angle_help, "DEGREES");
            k.add("phase", s.phase, phase_help, "P");
            k.add("duty", s.duty, "Bright share of a period; default 0.5", "D");
            k.add("sinusoid", s.sinusoid, "A single frequency instead of hard edges, without duty");
        },
        [](PatternSize, const StripesOptions& s) { return stripes(s); });
    struct NoiseOptions {
        std::uint64_t seed = 1;
        std::optional<double> cutoff;
        double rms = 0.1;
        BandLimitedNoiseOptions limited() const { return {seed, *cutoff, rms}; }
    };
    add_kind<NoiseOptions>(
        list, "noise", "White noise, or noise without frequencies above a cut-off",
        "noise.png --size 256x256 --cutoff 0.25 --seed 7",
        [](Parameters& k, NoiseOptions& n) {
            k.add("seed", n.seed, "Another seed, other noise; default 1");
            k.add("cutoff", n.cutoff, "Highest frequency in cycles per pixel; without it the noise is white", "F");
            k.add("rms", n.rms, "Root mean square of noise with a cut-off, around 1/2; default 0.1", "R");
        },
        [](PatternSize size, const NoiseOptions& n) {
            return n.cutoff ? band_limited_noise(size.width, size.height, n.limited()) : white_noise({n.seed});
        },
        [](PatternSize size, const NoiseOptions& n) {
            return n.cutoff ? band_limited_noise_bytes(size.width, size.height, n.limited()) : 0;
        });
}

void add_shapes(std::vector<NamedSignal>& list) {
    add_kind<StepEdgeOptions>(
        list, "edge", "A straight edge between dark and bright", "edge.png --size 256x256 --angle 5 --antialias exact",
        [](Parameters& k, StepEdgeOptions& e) {
            k.add("angle", e.angle, "Direction of the bright side, in degrees clockwise; default 5", "DEGREES");
            k.add("offset", e.offset, "Pixels from the middle of the image, along the angle; default 0", "PX");
        },
        [](PatternSize size, const StepEdgeOptions& e) { return step_edge(frame_of(size), e); });
    add_kind<CheckerboardOptions>(
        list, "checker", "A checkerboard", "checker.png --size 256x256 --cell 16",
        [](Parameters& k, CheckerboardOptions& c) {
            k.add("cell", c.size, "Side of a square in pixels; default 8", "PX");
        },
        [](PatternSize, const CheckerboardOptions& c) { return checkerboard(c); });
    add_kind<RectangleOptions>(
        list, "box", "A bright rectangle", "box.png --size 256x256 --region 40.5,60,100,80.25 --antialias exact",
        [](Parameters& k, RectangleOptions& r) {
            k.add("region", r.cell, "Where it lies, in pixels; default: the middle half of the image each way");
        },
        [](PatternSize size, const RectangleOptions& r) { return rectangle(frame_of(size), r); });
    add_kind<DiscOptions>(
        list, "disc", "A bright disc", "disc.png --size 256x256 --radius 100 --antialias exact",
        [](Parameters& k, DiscOptions& d) {
            k.add("radius", d.radius, "Pixels; default: a quarter of the shorter side", "R");
            k.add("center", d.center, center_help);
        },
        [](PatternSize size, const DiscOptions& d) { return disc(frame_of(size), d); });
    add_kind<RampOptions>(
        list, "ramp", "A straight ramp from dark to bright", "ramp.png --size 256x64 --depth u16",
        [](Parameters& k, RampOptions& r) {
            k.add("angle", r.angle, angle_help, "DEGREES");
            k.add("length", r.length, "Pixels from dark to bright; default: all of the image", "PX");
        },
        [](PatternSize size, const RampOptions& r) { return ramp(frame_of(size), r); });
    add_kind<ImpulseOptions>(
        list, "impulse", "A single bright pixel", "impulse.exr --size 64x64 --at 31.25,31 --antialias exact",
        [](Parameters& k, ImpulseOptions& i) {
            k.add("at", i.corner, "Column and row of the pixel, fractions allowed; default: the middle");
        },
        [](PatternSize size, const ImpulseOptions& i) { return impulse(frame_of(size), i); });
    add_kind<ThinLineOptions>(
        list, "line", "A thin line across the image",
        "line.png --size 256x256 --angle 80 --width 0.5 --antialias exact",
        [](Parameters& k, ThinLineOptions& l) {
            k.add("angle", l.angle,
                  "Direction across the line, in degrees clockwise: 0 draws a vertical one; default 30", "DEGREES");
            k.add("offset", l.offset, "Pixels from the middle of the image, along the angle; default 0", "PX");
            k.add("width", l.width, "Pixels, below 1 if wanted; default 1", "PX");
        },
        [](PatternSize size, const ThinLineOptions& l) { return thin_line(frame_of(size), l); });
}

/// Writes numbers to where a parameter is kept.
struct Setter {
    const std::string& name;
    const std::vector<double>& n;

    void need(std::size_t count) const {
        if (n.size() != count) fail(name, ": ", n.size(), " numbers; pass ", count);
    }
    void operator()(double* to) const { need(1), *to = n[0]; }
    void operator()(std::optional<double>* to) const { need(1), *to = n[0]; }
    void operator()(int* to) const { *to = static_cast<int>(whole(-2147483648.0, 2147483647.0)); }
    void operator()(std::uint64_t* to) const { *to = static_cast<std::uint64_t>(whole(0, 9007199254740992.0)); }
    void operator()(bool* to) const { need(1), *to = n[0] != 0; }
    void operator()(std::optional<Point>* to) const { need(2), *to = Point{n[0], n[1]}; }
    void operator()(std::optional<Cell>* to) const { need(4), *to = Cell{n[0], n[1], n[0] + n[2], n[1] + n[3]}; }

private:
    double whole(double least, double most) const {
        need(1);
        if (!(n[0] >= least && n[0] <= most) || n[0] != std::floor(n[0]))
            fail(name, ": ", n[0], "; pass a whole number from ", least, " to ", most);
        return n[0];
    }
};

}  // namespace

std::vector<NamedSignal> named_signals() {
    std::vector<NamedSignal> list;
    add_waves(list);
    add_shapes(list);
    return list;
}

NamedSignal named_signal(std::string_view name) {
    std::string names;
    for (NamedSignal& signal : named_signals()) {
        if (signal.name == name) return std::move(signal);
        names += (names.empty() ? "" : ", ") + signal.name;
    }
    fail("signal \"", name, "\" is unknown; choose one of: ", names);
}

void set(NamedSignal& signal, std::string_view parameter, const std::vector<double>& numbers) {
    std::string names;
    for (const SignalParameter& p : signal.parameters) {
        if (p.name == parameter) return std::visit(Setter{p.name, numbers}, p.value);
        names += (names.empty() ? "" : ", ") + p.name;
    }
    fail(signal.name, ": \"", parameter, "\" is unknown; choose one of: ", names);
}

}  // namespace bandlimit::job
