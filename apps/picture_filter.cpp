#include "apps/picture_filter.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace bandlimit::app {
namespace {

ImageTarget target_of(const PictureOptions& o, const ImageReader& reader) {
    const ImageInfo& in = reader.info();
    const FormatAbilities format = abilities_of(o.out);
    if (in.alpha >= 0 && !format.alpha)
        throw std::runtime_error(
            fmt::format("{} has an alpha channel, which {} files cannot hold; write .png, or lay "
                        "it over a colour first with bandlimit resize --scale 1 --background",
                        o.in, format.name));
    const Depth depth = o.depth.value_or(nearest_depth(format, in.depth));
    return {in.width,
            in.height,
            in.channel_names,
            depth,
            in.alpha,
            output_transfer(o.space, in, format, depth),
            o.space == Space::data,
            &reader.metadata(),
            o.tile};
}

}  // namespace

Transfer output_transfer(Space space, const ImageInfo& in, const FormatAbilities& format, Depth depth) {
    if (space == Space::data || space == Space::linear || format.is_linear || !is_integer(depth))
        return Transfer::linear;
    if (space == Space::automatic && is_integer(in.depth)) return in.transfer;
    return Transfer::srgb;
}

void treat_alpha_as_asked(Space space, bool premultiply, int source_alpha, bool associated, int target_alpha,
                          Encoding& from, Encoding& to) {
    if (space != Space::data) return;
    from.alpha = premultiply ? source_alpha : -1;
    from.associated = associated;
    to.alpha = premultiply ? target_alpha : -1;
}

void note_foreign_profile(const Console& console, const std::string& file, const ImageInfo& in, Space space) {
    if (in.has_foreign_profile && space == Space::automatic)
        console.note(
            fmt::format("{} has an ICC profile that is not sRGB: it is kept, its curve is treated as sRGB", file));
}

Option add_alpha(Verb verb, std::optional<bool>& premultiply) {
    return verb
        .add_option_function<std::string>(
            "--alpha",
            [&premultiply](const std::string& s) {
                if (s != "premultiply" && s != "straight")
                    throw UsageError("--alpha: \"" + s + "\" is unknown; choose premultiply or straight");
                premultiply = s == "premultiply";
            },
            "premultiply (default): transparent texels do not bleed, and come out with colour 0;\n"
            "straight: every channel by itself (default for --space data)")
        .type_name("premultiply|straight");
}

void add_pictures(Verb verb, PictureOptions& o) {
    verb.add_option("IN", o.in, "Image to read").required();
    verb.add_option("OUT", o.out, "Image to write; the extension names the format").required();
}

void add_picture_options(Program& program, Verb verb, PictureOptions& o) {
    add_edge(verb, o.edge);
    add_space(verb, o.space);
    add_alpha(verb, o.premultiply);
    add_depth(verb, o.depth);
    add_tiles(verb, o.tile);
    add_threads(verb, o.parallel);
    add_json(verb, o.json);
    program.add_quiet(verb);
}

void check_pictures(const PictureOptions& o) { check_output_format(o.out, o.depth, o.tile); }

void filter_picture(const PictureOptions& o, Console& console,
                    const std::function<PictureFilter(const ImageInfo& in)>& make) {
    check_output_path(o.out);
    Stopwatch watch;
    StreamReport stream;
    const Shares shares = shares_of(o.parallel);
    ImageReader reader = watch.time(stream.read, [&] { return ImageReader(o.in, shares.codecs.threads); });
    const ImageInfo& in = reader.info();
    const ImageTarget target = target_of(o, reader);
    double plan = 0;
    PictureFilter filter = watch.time(plan, [&] { return make(in); });
    require_memory(filter.memory, fmt::format("{} {} x {} pixels", filter.rows.doing, in.width, in.height));
    note_foreign_profile(console, o.in, in, o.space);

    ImageWriter writer(o.out, target, shares.codecs.threads);
    Encoding from = in.encoding(o.space), to = writer.encoding();
    treat_alpha_as_asked(o.space, o.premultiplies(), in.alpha, in.associated, target.alpha, from, to);
    stream_rows(filter.rows, reader, from, writer, to, target, {}, shares.stages, console, stream);
    watch.time(stream.write, [&] { writer.finish(); });
    if (stream.lost_non_finite) console.note(fmt::format("{} holds NaN or infinite values; they became 0", o.in));
    const double rate = double(in.width) * in.height / 1e6 / std::max(stream.filter, 1e-9);
    if (!o.json) {
        console.print("{}: {}, {:.3g} Mpixel/s\n", filter.rows.verb, filter.line, rate);
        return;
    }
    nlohmann::ordered_json report{
        {"input",
         {{"file", o.in},
          {"width", in.width},
          {"height", in.height},
          {"channels", in.channels()},
          {"depth", name_of(in.depth)}}},
        {"output", {{"file", o.out}, {"channels", target.channel_names.size()}, {"depth", name_of(target.depth)}}}};
    report.update(filter.report);
    report["megapixels_per_second"] = rate;
    report["space"] = name_of(o.space);
    report["alpha"] = o.premultiplies() ? "premultiply" : "straight";
    report["threads"] = o.parallel.count();
    report["seconds"] = {{"plan", plan},
                         {"read", stream.read},
                         {"filter", stream.filter},
                         {"write", stream.write},
                         {"total", watch.total()}};
    console.print_json(report);
}

}  // namespace bandlimit::app
