// bandlimit resize: the command line of the resampler.
#include <fmt/core.h>

#include <cmath>

#include <nlohmann/json.hpp>
#include "apps/common.h"
#include "apps/picture_filter.h"
#include "apps/row_stream.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {
namespace {

struct Options {
    std::string in, out;
    std::string size, scale, region, kernel = "auto", background;
    int width = 0, height = 0, tile = 0;
    bool centers = false;
    double antiring = 0;
    std::optional<Edge> edge;
    Space space = Space::automatic;
    std::optional<bool> premultiply;
    std::optional<Depth> depth;
    Parallel parallel;
    bool json = false;

    bool is_taps_file() const { return kernel.ends_with(".json"); }
};

struct Rectangle {
    double x, y, width, height;
};

Rectangle parse_region(const std::string& text) {
    const std::vector<double> n = parse_numbers("--region", text);
    if (n.size() != 4 || n[2] <= 0 || n[3] <= 0)
        throw UsageError(fmt::format(
            "--region: \"{}\" is not a region; write X,Y,WIDTH,HEIGHT in source pixels, e.g. 10,20,300,200", text));
    return {n[0], n[1], n[2], n[3]};
}

/// "ff8000" or "#ff8000" as three codes.
std::array<double, 3> parse_background(const std::string& text) {
    const std::string digits = text.starts_with('#') ? text.substr(1) : text;
    if (digits.size() != 6 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw UsageError(fmt::format("--background: \"{}\" is not a colour; write RRGGBB, as ffffff for white", text));
    const auto code = [&](std::size_t i) { return std::stoi(digits.substr(2 * i, 2), nullptr, 16) / 255.0; };
    return {code(0), code(1), code(2)};
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    const int sizes = !o.size.empty() + !o.scale.empty() + (o.width > 0 || o.height > 0);
    if (sizes != 1)
        throw UsageError(
            "resize: a new size is given no times or twice; give one of --size WxH, --scale S, or --width W and/or "
            "--height H");
    if (!o.size.empty()) parse_size("--size", o.size);
    if (!o.scale.empty() && !(parse_number("--scale", o.scale) > 0))
        throw UsageError("--scale: a size cannot be 0 or less; pass a number above 0, e.g. 0.5 or 2");
    if (!(o.antiring >= 0 && o.antiring <= 1))  // a range check of the parser lets NaN pass
        throw UsageError(fmt::format("--antiring: {} is out of range; pass 0 to 1", o.antiring));
    if (!o.region.empty()) parse_region(o.region);
    if (!o.background.empty()) parse_background(o.background);
    if (o.kernel != "auto" && !o.is_taps_file()) parse_kernel(o.kernel);
    check_output_format(o.out, o.depth, o.tile);
}

int rounded_length(double length) {
    const double rounded = std::max(1.0, std::floor(length + 0.5));
    if (!(rounded <= 2147483647))
        throw UsageError(fmt::format("the new size would be {:.6g} pixels long; the limit is 2147483647", length));
    return static_cast<int>(rounded);
}

Size target_size(const Options& o, const Rectangle& region) {
    if (!o.size.empty()) return parse_size("--size", o.size);
    if (!o.scale.empty()) {
        const double scale = parse_number("--scale", o.scale);
        return {rounded_length(region.width * scale), rounded_length(region.height * scale)};
    }
    return {o.width > 0 ? o.width : rounded_length(region.width * o.height / region.height),
            o.height > 0 ? o.height : rounded_length(region.height * o.width / region.width)};
}

Rectangle source_region(const Options& o, const ImageInfo& info) {
    if (o.region.empty()) return {0, 0, double(info.width), double(info.height)};
    const Rectangle r = parse_region(o.region);
    if (r.x < 0 || r.y < 0 || r.x + r.width > info.width || r.y + r.height > info.height)
        throw std::runtime_error(fmt::format("--region {} reaches outside {}, which is {} x {}; stay inside", o.region,
                                             o.in, info.width, info.height));
    return r;
}

/// The axis of `count` samples over `length` source pixels from `begin`.
Axis target_axis(double begin, double length, int count, bool centers) {
    const Axis corners{count, begin, begin + length};
    // Pixels have a pitch of 1: as many cells as the length holds, at least one.
    return centers ? center_aligned({std::max(1, static_cast<int>(std::lround(length))), begin, begin + length}, count)
                   : corners;
}

ResizeOptions resize_options(const Options& o) {
    ResizeOptions options;
    options.antiring = o.antiring;
    options.premultiply = o.premultiply.value_or(o.space != Space::data);
    if (o.is_taps_file()) {
        const TapsFile file = read_taps(o.kernel);
        if (is_kernel(file)) {
            options.reconstruction = kernel_of(file, o.kernel);
        } else {
            const Taps& taps = taps_of(file, o.kernel);
            double sum = 0;
            for (const double w : taps.weights) sum += w;
            if (std::abs(sum) < 1e-9) options.edge = Edge::reflect;  // nothing to renormalize to
            options.reconstruction = taps;
        }
    } else if (o.kernel != "auto") {
        options.reconstruction = parse_kernel(o.kernel);
    }
    if (o.edge) options.edge = *o.edge;
    return options;
}

/// What the file to be written holds, and how.
struct Output {
    ImageTarget target;
    std::vector<float> background;
};

std::vector<float> background_of(const Options& o, const Encoding& source, int colours) {
    const std::array<double, 3> codes = parse_background(o.background);
    const bool is_grey = codes[0] == codes[1] && codes[1] == codes[2];
    if (colours != 3 && !(colours == 1 && is_grey))
        throw std::runtime_error(
            fmt::format("--background {} does not fit {} colour channels of {}; use a grey for grey pictures",
                        o.background, colours, o.in));
    std::vector<float> linear;
    for (int c = 0; c < colours; ++c)
        linear.push_back(static_cast<float>(decode(source.transfer, codes[static_cast<std::size_t>(c)])));
    return linear;
}

Output output_of(const Options& o, const ImageReader& reader, Size size) {
    const ImageInfo& in = reader.info();
    const FormatAbilities format = abilities_of(o.out);
    const Depth depth = o.depth.value_or(nearest_depth(format, in.depth));
    Output out{{size.width, size.height, in.channel_names, depth, in.alpha, output_transfer(o.space, in, format, depth),
                o.space == Space::data, &reader.metadata(), o.tile},
               {}};
    if (in.alpha >= 0 && !o.background.empty()) {
        out.background =
            background_of(o, in.encoding(o.space == Space::data ? Space::linear : o.space), in.channels() - 1);
        out.target.channel_names.erase(out.target.channel_names.begin() + in.alpha);
        out.target.alpha = -1;
    } else if (in.alpha >= 0 && !format.alpha) {
        throw std::runtime_error(
            fmt::format("{} has an alpha channel, which {} files cannot hold; lay it over a colour with "
                        "--background RRGGBB, or write .png",
                        o.in, format.name));
    }
    return out;
}

Resizer make_resizer(const Options& o, const Grid& src, const Grid& dst, int channels, const ResizeOptions& options) {
    try {
        require_memory(Resizer::bytes(src, dst, channels, options, o.parallel),
                       fmt::format("resizing to {} x {} pixels", dst.x.count, dst.y.count));
        return Resizer(src, dst, channels, options);
    } catch (const Error& e) {
        if (o.is_taps_file()) throw UsageError(fmt::format("{}: {}", o.kernel, e.what()));
        throw;
    }
}

nlohmann::ordered_json report_of(const Options& o, const ImageInfo& in, const ImageTarget& out, const Resizer& resizer,
                                 const ResizeOptions& options, const StreamReport& stream, double total) {
    return {{"input",
             {{"file", o.in},
              {"width", in.width},
              {"height", in.height},
              {"channels", in.channels()},
              {"depth", name_of(in.depth)}}},
            {"output",
             {{"file", o.out},
              {"width", out.width},
              {"height", out.height},
              {"channels", out.channel_names.size()},
              {"depth", name_of(out.depth)}}},
            {"kernel", {{"x", resizer.kernel_x()}, {"y", resizer.kernel_y()}}},
            {"edge", name_of(options.edge)},
            {"align", o.centers ? "centers" : "corners"},
            {"antiring", options.antiring},
            {"space", name_of(o.space)},
            {"alpha", options.premultiply ? "premultiply" : "straight"},
            {"threads", o.parallel.count()},
            {"seconds", {{"read", stream.read}, {"filter", stream.filter}, {"write", stream.write}, {"total", total}}}};
}

void run(const Options& o, Console& console) {
    check_output_path(o.out);
    Stopwatch watch;
    StreamReport stream;
    const Shares shares = shares_of(o.parallel);
    ImageReader reader = watch.time(stream.read, [&] { return ImageReader(o.in, shares.codecs.threads); });
    const ImageInfo& in = reader.info();
    const Rectangle region = source_region(o, in);
    const Size size = target_size(o, region);
    const ResizeOptions options = resize_options(o);
    const Grid src{{in.width, 0, double(in.width)}, {in.height, 0, double(in.height)}};
    const Grid dst{target_axis(region.x, region.width, size.width, o.centers),
                   target_axis(region.y, region.height, size.height, o.centers)};
    const Output out = output_of(o, reader, size);
    const Resizer resizer = make_resizer(o, src, dst, in.channels(), options);
    note_foreign_profile(console, o.in, in, o.space);

    ImageWriter writer(o.out, out.target, shares.codecs.threads);
    Encoding from = in.encoding(o.space), to = writer.encoding();
    treat_alpha_as_asked(o.space, options.premultiply, in.alpha, in.associated, out.target.alpha, from, to);
    const RowFilter filter{"resize", "resizing", [&](int first, int last) { return resizer.rows_needed(first, last); },
                           [&](const SourceRows& source, const TargetRows& target, Parallel threads) {
                               return resizer.run(source, target, threads);
                           }};
    stream_rows(filter, reader, from, writer, to, out.target, out.background, shares.stages, console, stream);
    watch.time(stream.write, [&] { writer.finish(); });
    if (stream.lost_non_finite) console.note(fmt::format("{} holds NaN or infinite values; they became 0", o.in));
    if (o.json) console.print_json(report_of(o, in, out.target, resizer, options, stream, watch.total()));
}

}  // namespace

void add_resize(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("resize", "Resample an image: in linear light, without bleeding, shift or aliasing",
                                 "bandlimit resize examples/coffee.png half.png --scale 0.5");
    verb.add_option("IN", o->in, "Image to read").required();
    verb.add_option("OUT", o->out, "Image to write; the extension names the format").required();
    verb.add_option("--size", o->size, "New size").type_name("WxH");
    verb.add_option("--width", o->width, "New width; the height follows unless given")
        .in_range(1, 2147483647)
        .type_name("W");
    verb.add_option("--height", o->height, "New height; the width follows unless given")
        .in_range(1, 2147483647)
        .type_name("H");
    verb.add_option("--scale", o->scale, "New size as a multiple of the old, e.g. 0.5 or 1/3").type_name("S");
    verb.add_option("--kernel", o->kernel,
                    "Kernel (bandlimit analyze --list), or a taps.json; auto: shrink3 along an axis that shrinks,\n"
                    "grow3 along one that grows or keeps its size")
        .type_name("K|auto");
    add_edge(verb, o->edge);
    verb.add_option_function<std::string>(
            "--align",
            [o](const std::string& s) {
                if (s != "corners" && s != "centers")
                    throw UsageError("--align: \"" + s + "\" is unknown; choose corners or centers");
                o->centers = s == "centers";
            },
            "What both images share: their corners (default), or the centres of their first and last\n"
            "samples, which other libraries call align_corners")
        .type_name("corners|centers");
    verb.add_option("--region", o->region,
                    "Part of the source to resample, in source pixels, fractions allowed;\n"
                    "what lies around it contributes at its borders")
        .type_name("X,Y,W,H");
    verb.add_option("--antiring", o->antiring, "Share of the overshoot to remove, 0 (default) to 1").type_name("A");
    add_space(verb, o->space);
    add_alpha(verb, o->premultiply);
    verb.add_option("--background", o->background, "Opaque colour to lay the picture over; drops alpha")
        .type_name("RRGGBB");
    add_depth(verb, o->depth);
    add_tiles(verb, o->tile);
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
