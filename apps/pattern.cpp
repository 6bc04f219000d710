// bandlimit pattern: test signals as image files.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>
#include "apps/common.h"
#include "apps/pictures.h"
#include "bandlimit/core/pipeline.h"
#include "bandlimit/signal/render.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit::app {
namespace {

using MakeSignal = std::function<Signal(Size)>;

/// What all kinds have in common.
struct Options {
    std::string kind, out, size, antialias = "none";
    int samples = 8, channels = 0, tile = 0;  ///< 0: as the format likes
    double low = 0, high = 1;
    std::optional<Depth> depth;
    Space space = Space::automatic;
    Parallel parallel;
    bool json = false;
    MakeSignal make_signal;
    std::function<std::uint64_t(Size)> bytes = [](Size) { return 0; };  ///< that the signal takes
};

Sampling sampling_of(const Options& o) {
    if (o.antialias == "none") return Sampling::point();
    if (o.antialias == "exact") return Sampling::exact();
    return Sampling::supersampled(parse_kernel(o.antialias), o.samples);
}

Grid grid_of(Size size) { return {{size.width, 0, double(size.width)}, {size.height, 0, double(size.height)}}; }

int channels_of_file(const Options& o, const FormatAbilities& format) {
    const auto holds = [&](int n) {
        return format.channels.empty() ||
               std::find(format.channels.begin(), format.channels.end(), n) != format.channels.end();
    };
    if (o.channels == 0) return holds(1) ? 1 : 3;
    if (!holds(o.channels))
        throw UsageError(fmt::format("--channels: {} files do not hold {}; choose {}, or TIFF", format.name, o.channels,
                                     holds(1) ? "1" : "3"));
    return o.channels;
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    const Size size = parse_size("--size", o.size);
    const Sampling sampling = sampling_of(o);
    rendering_bytes(grid_of(size), sampling);
    // A small signal of the same kind knows whether it has an exact form; noise needs its memory first, see run().
    if (o.bytes(size) == 0) check_sampling(with_range(o.make_signal(size), o.low, o.high), sampling);
    check_output_format(o.out, o.depth, o.tile);
    channels_of_file(o, abilities_of(o.out));
}

/// The file to be written.
ImageTarget target_of(const Options& o, Size size) {
    const FormatAbilities format = abilities_of(o.out);
    const Depth depth = o.depth.value_or(nearest_depth(format, format.is_linear ? Depth::f32 : Depth::u8));
    const bool is_linear = o.space == Space::data || o.space == Space::linear || format.is_linear || !is_integer(depth);
    ImageTarget target;
    target.width = size.width;
    target.height = size.height;
    const int channels = channels_of_file(o, format);
    target.channel_names = channel_names(channels);
    target.alpha = alpha_among(channels);
    target.depth = depth;
    target.transfer = is_linear ? Transfer::linear : Transfer::srgb;
    target.is_data = o.space == Space::data;
    target.tile = o.tile;
    return target;
}

/// Encodes the rows of `linear`, one channel, to all channels of `stored` but alpha, which is opaque.
void encode_rows(View<const float> linear, const ImageTarget& target, const AnyView& stored, const Encoding& encoding,
                 Parallel parallel) {
    const int channels = static_cast<int>(target.channel_names.size());
    parallel_for(linear.height, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<float> row;
        for (int y = static_cast<int>(begin); y < end; ++y) {
            row.clear();
            for (int x = 0; x < linear.width; ++x)
                for (int c = 0; c < channels; ++c) row.push_back(c == target.alpha ? 1.0f : linear(x, y));
            encode_row(row, false, stored, y, encoding);
        }
    });
}

struct Seconds {
    double render = 0, write = 0;
};

constexpr int band_samples = 1 << 22;  // of the image held at a time: 16 MB of floats

/// Draws and writes the image by bands of rows: one is written while the next is drawn.
Seconds draw(const Options& o, Console& console, const Signal& signal, const Sampling& sampling,
             const ImageTarget& target) {
    const Grid grid = grid_of({target.width, target.height});
    const int rows = std::clamp(band_samples / target.width, 1, target.height);
    const int channels = static_cast<int>(target.channel_names.size());
    const std::uint64_t band = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(target.width);
    require_memory(rendering_bytes(grid, sampling) +
                       band * (sizeof(float) + 2 * static_cast<std::uint64_t>(channels) * size_of(target.depth)),
                   fmt::format("drawing {} x {} pixels", target.width, target.height));
    const Shares shares = shares_of(o.parallel);
    ImageWriter writer(o.out, target, shares.codecs.threads);
    Image<float> linear(target.width, rows);
    std::array<AnyImage, 2> stored;
    for (AnyImage& image : stored) image = make_image(target.depth, target.width, rows, channels);
    const auto rows_of_band = [&](int i) { return std::min(rows, target.height - i * rows); };
    const auto encoded = [&](int i) {
        return rows_of(view_of(stored[static_cast<std::size_t>(i % 2)]), 0, rows_of_band(i));
    };
    Progress progress(console, "pattern", target.height);
    Stopwatch watch;
    Seconds seconds;
    const auto render_band = [&](int i, Parallel parallel) {
        watch.time(seconds.render, [&] {
            const View<float> drawn = cropped(linear.view(), 0, 0, target.width, rows_of_band(i));
            const int y = i * rows;
            render(signal, {grid.x, grid.y.cells(y, y + drawn.height)}, sampling, drawn, parallel);
            encode_rows(drawn, target, encoded(i), writer.encoding(), parallel);
        });
    };
    const auto write_band = [&](int i, Parallel) {
        watch.time(seconds.write, [&] { writer.write_rows(const_view(encoded(i))); });
        progress.advance_to(i * rows + rows_of_band(i));
    };
    run_pipeline((target.height - 1) / rows + 1, {{render_band, true}, {write_band}}, shares.stages);
    watch.time(seconds.write, [&] { writer.finish(); });
    return seconds;
}

Signal signal_of(const Options& o, Size size, const Sampling& sampling) {
    require_memory(o.bytes(size), fmt::format("{} of {} x {} pixels", o.kind, size.width, size.height));
    try {
        Signal signal = with_range(o.make_signal(size), o.low, o.high);
        check_sampling(signal, sampling);
        return signal;
    } catch (const Error& e) {
        throw UsageError(e.what());  // it is made of nothing but the command line
    }
}

void run(const Options& o, Console& console) {
    const Size size = parse_size("--size", o.size);
    check_output_path(o.out);
    const Sampling sampling = sampling_of(o);
    const ImageTarget target = target_of(o, size);
    const Seconds seconds = draw(o, console, signal_of(o, size, sampling), sampling, target);
    if (!o.json) return;
    console.print_json({{"kind", o.kind},
                        {"file", o.out},
                        {"width", size.width},
                        {"height", size.height},
                        {"channels", target.channel_names.size()},
                        {"antialias", o.antialias},
                        {"samples", sampling.mode == Sampling::Mode::supersampled ? o.samples : 1},
                        {"depth", name_of(target.depth)},
                        {"transfer", name_of(target.transfer)},
                        {"threads", o.parallel.count()},
                        {"seconds", {{"render", seconds.render}, {"write", seconds.write}}}});
}

/// Options of one kind: each sets a member of the options of its signal.
class KindOptions {
public:
    explicit KindOptions(Verb kind) : kind_(kind) {}

    /// A number, or a fraction such as 1/6.
    template <class Number>
    void number(const std::string& name, Number& target, const std::string& help, const std::string& type) {
        kind_
            .add_option_function<std::string>(
                name, [&target, name](const std::string& s) { target = parse_number(name, s); }, help)
            .type_name(type);
    }
    template <class Integer>
    void integer(const std::string& name, Integer& target, const std::string& help) {
        Option option = kind_.add_option(name, target, help).type_name("N");
        if constexpr (std::is_unsigned_v<Integer>)
            option.in_range(0.0, 18446744073709551615.0);  // the parser would wrap it
    }
    void flag(const std::string& name, bool& target, const std::string& help) { kind_.add_flag(name, target, help); }
    void point(const std::string& name, std::optional<Point>& target, const std::string& help) {
        numbers(name, "X,Y", help, 2, [&target](const std::vector<double>& n) { target = Point{n[0], n[1]}; });
    }
    void cell(const std::string& name, std::optional<Cell>& target, const std::string& help) {
        numbers(name, "X,Y,W,H", help, 4, [&target](const std::vector<double>& n) {
            target = Cell{n[0], n[1], n[0] + n[2], n[1] + n[3]};
        });
    }

private:
    void numbers(const std::string& name, const std::string& type, const std::string& help, std::size_t count,
                 std::function<void(const std::vector<double>&)> set) {
        const auto parse = [=](const std::string& s) {
            const std::vector<double> values = parse_numbers(name, s);
            if (values.size() != count)
                throw UsageError(
                    fmt::format("{}: \"{}\" is not {}; write {} numbers with commas", name, s, type, count));
            set(values);
        };
        kind_.add_option_function<std::string>(name, parse, help).type_name(type);
    }

    Verb kind_;
};

void add_common(Program& program, Verb kind, const std::shared_ptr<Options>& o) {
    kind.add_option("OUT", o->out, "Image to write; the extension names the format").required();
    kind.add_option("--size", o->size, "Size in pixels, e.g. 512x512").required().type_name("WxH");
    kind.add_option("--antialias", o->antialias,
                    "none (default): the value at the centre of each pixel; exact: the mean over each pixel,\n"
                    "where a closed form is known (all but siemens and noise); or a kernel, supersampled")
        .type_name("none|exact|KERNEL");
    kind.add_option("--samples", o->samples, "Samples per pixel and axis for --antialias KERNEL; default 8")
        .in_range(1, 1024)
        .type_name("N");
    KindOptions numbers(kind);
    numbers.number("--low", o->low, "Linear light where the signal is 0; default 0", "L");
    numbers.number("--high", o->high, "Linear light where the signal is 1; default 1", "L");
    add_depth(kind, o->depth).description("Depth of the output; default: f32 for EXR, HDR and PFM, else u8");
    add_space(kind, o->space)
        .description(
            "What codes shall mean: auto (sRGB for 8 and 16 bit, else linear), srgb, or linear and data\n"
            "(codes are the values)");
    kind.add_option("--channels", o->channels,
                    "1 grey, 2 grey and alpha, 3 RGB, 4 RGBA, all colours alike, alpha opaque; default: 1, or 3 where\n"
                    "the format has no grey")
        .in_range(1, 4)
        .type_name("N");
    add_tiles(kind, o->tile);
    add_threads(kind, o->parallel);
    add_json(kind, o->json);
    program.add_quiet(kind);
}

/// Adds a kind whose signal is make(size, options); `add` adds the options of its own.
template <class SignalOptions>
void add_kind(Program& program, Verb verb, const std::string& name, const std::string& summary,
              const std::string& example, const std::function<void(KindOptions&, SignalOptions&)>& add,
              const std::function<Signal(Size, const SignalOptions&)>& make,
              const std::function<std::uint64_t(Size, const SignalOptions&)>& bytes = {}) {
    auto own = std::make_shared<SignalOptions>();
    auto o = std::make_shared<Options>();
    o->kind = name;
    o->make_signal = [own, make](Size size) { return make(size, *own); };
    if (bytes) o->bytes = [own, bytes](Size size) { return bytes(size, *own); };
    Verb kind = verb.add_subcommand(name, summary);
    kind.example(fmt::format("bandlimit pattern {} {}", name, example));
    KindOptions options(kind);
    add(options, *own);
    add_common(program, kind, o);
    program.on(
        kind, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

Frame frame_of(Size size) { return {double(size.width), double(size.height)}; }

constexpr const char* angle_help = "Direction in which the signal varies, in degrees clockwise; 0: to the right";
constexpr const char* phase_help = "Phase in periods; default 0";
constexpr const char* center_help = "Centre in pixels; default: the middle of the image";

void add_waves(Program& program, Verb verb) {
    add_kind<ZonePlateOptions>(
        program, verb, "zoneplate", "Rings: the frequency grows with the distance from the centre",
        "zoneplate.png --size 512x512 --antialias exact",
        [](KindOptions& k, ZonePlateOptions& z) {
            k.number("--max-frequency", z.max_frequency,
                     "Cycles per pixel at --radius; default 0.5, the most that pixels hold", "F");
            k.number("--radius", z.radius, "Pixels; default: half the longer side", "R");
            k.point("--center", z.center, center_help);
            k.number("--phase", z.phase, phase_help, "P");
        },
        [](Size size, const ZonePlateOptions& z) { return zone_plate(frame_of(size), z); });
    add_kind<SiemensStarOptions>(
        program, verb, "siemens", "Spokes: the frequency grows towards the centre",
        "star.png --size 512x512 --antialias lanczos3 --spokes 36",
        [](KindOptions& k, SiemensStarOptions& s) {
            k.integer("--spokes", s.spokes, "Bright spokes; default 72");
            k.number("--radius", s.radius, "Pixels; default: half the shorter side", "R");
            k.point("--center", s.center, center_help);
            k.number("--phase", s.phase, "Turns the star by this share of the angle between spokes; default 0", "P");
            k.flag("--sinusoid", s.sinusoid, "A smooth wave around the centre instead of hard edges");
        },
        [](Size size, const SiemensStarOptions& s) { return siemens_star(frame_of(size), s); });
    add_kind<ChirpOptions>(
        program, verb, "chirp", "A wave whose frequency changes across the image",
        "chirp.png --size 1024x128 --from 0 --to 0.5 --antialias exact",
        [](KindOptions& k, ChirpOptions& c) {
            k.number("--from", c.from, "Cycles per pixel where the image begins; default 0.01", "F");
            k.number("--to", c.to, "Cycles per pixel where it ends; default 0.5", "F");
            k.flag("--exponential", c.exponential, "Equal factors over equal distances, not equal steps");
            k.number("--angle", c.angle, angle_help, "DEGREES");
            k.number("--phase", c.phase, phase_help, "P");
        },
        [](Size size, const ChirpOptions& c) { return chirp(frame_of(size), c); });
    add_kind<StripesOptions>(
        program, verb, "stripes", "Stripes of one period, hard or sinusoidal",
        "stripes.png --size 256x256 --period 2.5 --angle 10 --antialias exact",
        [](KindOptions& k, StripesOptions& s) {
            k.number("--period", s.period, "Pixels; default 8", "PX");
            k.number("--angle", s.angle, angle_help, "DEGREES");
            k.number("--phase", s.phase, phase_help, "P");
            k.number("--duty", s.duty, "Bright share of a period; default 0.5", "D");
            k.flag("--sinusoid", s.sinusoid, "A single frequency instead of hard edges, without duty");
        },
        [](Size, const StripesOptions& s) { return stripes(s); });
    struct NoiseOptions {
        std::uint64_t seed = 1;
        std::optional<double> cutoff;
        double rms = 0.1;
        BandLimitedNoiseOptions limited() const { return {seed, *cutoff, rms}; }
    };
    add_kind<NoiseOptions>(
        program, verb, "noise", "White noise, or noise without frequencies above a cut-off",
        "noise.png --size 256x256 --cutoff 0.25 --seed 7",
        [](KindOptions& k, NoiseOptions& n) {
            k.integer("--seed", n.seed, "Another seed, other noise; default 1");
            k.number("--cutoff", n.cutoff, "Highest frequency in cycles per pixel; without it the noise is white", "F");
            k.number("--rms", n.rms, "Root mean square of noise with a cut-off, around 1/2; default 0.1", "R");
        },
        [](Size size, const NoiseOptions& n) {
            return n.cutoff ? band_limited_noise(size.width, size.height, n.limited()) : white_noise({n.seed});
        },
        [](Size size, const NoiseOptions& n) {
            return n.cutoff ? band_limited_noise_bytes(size.width, size.height, n.limited()) : 0;
        });
}

void add_shapes(Program& program, Verb verb) {
    add_kind<StepEdgeOptions>(
        program, verb, "edge", "A straight edge between dark and bright",
        "edge.png --size 256x256 --angle 5 --antialias exact",
        [](KindOptions& k, StepEdgeOptions& e) {
            k.number("--angle", e.angle, "Direction of the bright side, in degrees clockwise; default 5", "DEGREES");
            k.number("--offset", e.offset, "Pixels from the middle of the image, along the angle; default 0", "PX");
        },
        [](Size size, const StepEdgeOptions& e) { return step_edge(frame_of(size), e); });
    add_kind<CheckerboardOptions>(
        program, verb, "checker", "A checkerboard", "checker.png --size 256x256 --cell 16",
        [](KindOptions& k, CheckerboardOptions& c) {
            k.number("--cell", c.size, "Side of a square in pixels; default 8", "PX");
        },
        [](Size, const CheckerboardOptions& c) { return checkerboard(c); });
    add_kind<RectangleOptions>(
        program, verb, "box", "A bright rectangle",
        "box.png --size 256x256 --region 40.5,60,100,80.25 --antialias exact",
        [](KindOptions& k, RectangleOptions& r) {
            k.cell("--region", r.cell, "Where it lies, in pixels; default: the middle half of the image each way");
        },
        [](Size size, const RectangleOptions& r) { return rectangle(frame_of(size), r); });
    add_kind<DiscOptions>(
        program, verb, "disc", "A bright disc", "disc.png --size 256x256 --radius 100 --antialias exact",
        [](KindOptions& k, DiscOptions& d) {
            k.number("--radius", d.radius, "Pixels; default: a quarter of the shorter side", "R");
            k.point("--center", d.center, center_help);
        },
        [](Size size, const DiscOptions& d) { return disc(frame_of(size), d); });
    add_kind<RampOptions>(
        program, verb, "ramp", "A straight ramp from dark to bright", "ramp.png --size 256x64 --depth u16",
        [](KindOptions& k, RampOptions& r) {
            k.number("--angle", r.angle, angle_help, "DEGREES");
            k.number("--length", r.length, "Pixels from dark to bright; default: all of the image", "PX");
        },
        [](Size size, const RampOptions& r) { return ramp(frame_of(size), r); });
    add_kind<ImpulseOptions>(
        program, verb, "impulse", "A single bright pixel", "impulse.exr --size 64x64 --at 31.25,31 --antialias exact",
        [](KindOptions& k, ImpulseOptions& i) {
            k.point("--at", i.corner, "Column and row of the pixel, fractions allowed; default: the middle");
        },
        [](Size size, const ImpulseOptions& i) { return impulse(frame_of(size), i); });
    add_kind<ThinLineOptions>(
        program, verb, "line", "A thin line across the image",
        "line.png --size 256x256 --angle 80 --width 0.5 --antialias exact",
        [](KindOptions& k, ThinLineOptions& l) {
            k.number("--angle", l.angle,
                     "Direction across the line, in degrees clockwise: 0 draws a vertical one; default 30", "DEGREES");
            k.number("--offset", l.offset, "Pixels from the middle of the image, along the angle; default 0", "PX");
            k.number("--width", l.width, "Pixels, below 1 if wanted; default 1", "PX");
        },
        [](Size size, const ThinLineOptions& l) { return thin_line(frame_of(size), l); });
}

}  // namespace

void add_pattern(Program& program) {
    Verb verb = program.add_verb("pattern", "Draw a test signal whose right answer is known",
                                 "bandlimit pattern zoneplate zoneplate.png --size 512x512 --antialias exact");
    add_waves(program, verb);
    add_shapes(program, verb);
    verb.require_one_subcommand("kind of signal");
}

}  // namespace bandlimit::app
