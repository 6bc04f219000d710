// bandlimit audit: what does another program really do when it resizes?
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>
#include "apps/audit_report.h"
#include "apps/command.h"
#include "apps/common.h"
#include "apps/pictures.h"
#include "bandlimit/color/encoding.h"

namespace bandlimit::app {
namespace {

struct Options {
    std::string command, scales, format = "png", keep, html;
    std::optional<Depth> depth;
    double timeout = 30;
    Parallel parallel;
    bool grey = false, json = false;

    Depth file_depth() const { return nearest_depth(abilities_of("x." + format), depth.value_or(Depth::u8)); }
    double code() const {
        const Depth d = file_depth();
        return d == Depth::u8 ? 1.0 / 255 : d == Depth::u16 ? 1.0 / 65535 : 0;
    }
};

std::vector<Ratio> scales_of(const std::string& text) {
    if (text.empty()) return AuditOptions{}.scales;
    std::vector<Ratio> scales;
    for (const double scale : parse_numbers("--scales", text)) scales.push_back(ratio_of(scale));
    return scales;
}

void check(const Options& o) {
    scales_of(o.scales);
    if (o.command.find("{in}") == std::string::npos || o.command.find("{out}") == std::string::npos)
        throw UsageError(
            "the command must hold {in} and {out}, for the files to read and to write; write it as "
            "'program {in} --size {width}x{height} {out}'");
    const auto holds = [&](const char* word) { return o.command.find(word) != std::string::npos; };
    if (!holds("{width}") && !holds("{height}") && !holds("{scale}"))
        throw UsageError(
            "the command must hold {width} and {height}, or {scale}, for what size to make; write it as "
            "'program {in} --size {width}x{height} {out}'");
    if (holds("{out}."))
        throw UsageError(
            "{out} is a whole file name and has its extension already; write nothing behind it, and choose "
            "another extension by --format");
    check_output_format("x." + o.format, o.depth);
    if (!(o.timeout > 0))
        throw UsageError(fmt::format("--timeout: {} is not a time to run in; pass seconds above 0", o.timeout));
}

/// Values as stored, whatever they mean.
Image<float> read_stored(const std::string& path, int threads) {
    ImageReader reader(path, threads);
    const ImageInfo& info = reader.info();
    const int channels = info.channels();
    Image<float> image(info.width, info.height, channels, Layout::interleaved);
    AnyImage row = make_image(info.depth, info.width, 1, channels);
    for (int y = 0; y < info.height; ++y) {
        reader.read_rows(y, view_of(row));
        const auto length = static_cast<std::size_t>(info.width) * static_cast<std::size_t>(channels);
        decode_row(const_view(view_of(row)), 0, {}, false, {&image.view()(0, y), length});
        if (info.alpha < 0 || !info.associated) continue;
        for (int x = 0; x < info.width; ++x)
            for (int c = 0; c < channels; ++c)
                if (const float alpha = image.view()(x, y, info.alpha); c != info.alpha && alpha > 0)
                    image.view()(x, y, c) /= alpha;
    }
    return image;
}

/// A resizer that writes files, runs the command on them and reads what it wrote.
class CommandResizer {
public:
    /// Commands run in `folder`, and get the paths of files as long as these are plain, else their names in it: no
    /// shell takes either apart.
    CommandResizer(const Options& o, AuditSubject& subject, const std::string& folder)
        : o_(o), subject_(subject), folder_(folder), place_(is_plain(folder) ? folder + "/" : "") {}

    Image<float> operator()(View<const float> stored, int width, int height) {
        const std::string number = fmt::format("{:02}", ++runs_);
        const std::string in_name = number + "-in." + o_.format, out_name = number + "-out." + o_.format;
        const std::string in = folder_ + "/" + in_name, out = folder_ + "/" + out_name;
        write(in, stored);
        const std::string scale = fmt::format("{:.17g}", double(width) / stored.width);
        const CommandEnd end = run_command(filled_in(o_.command, {{"in", place_ + in_name},
                                                                  {"out", place_ + out_name},
                                                                  {"width", std::to_string(width)},
                                                                  {"height", std::to_string(height)},
                                                                  {"scale", scale}}),
                                           folder_, o_.timeout);
        const std::string task =
            fmt::format("from {} x {} to {} x {} pixels", stored.width, stored.height, width, height);
        check(end, out, task);
        subject_.seconds = std::max(subject_.seconds, end.seconds);
        Image<float> result = read(out, task);
        if (result.width() != width || result.height() != height)
            throw std::runtime_error(
                fmt::format("the command, asked {}, made {} x {}; it must make exactly {{width}} x {{height}} pixels",
                            task, result.width(), result.height()));
        if (o_.keep.empty()) {
            std::error_code ignored;
            std::filesystem::remove(in, ignored);
            std::filesystem::remove(out, ignored);
        }
        return stored.channels == 1 ? grey_of(result.view()) : coloured(std::move(result));
    }

private:
    void check(const CommandEnd& end, const std::string& out, const std::string& task) const {
        const std::string words = end.last_words.empty() ? "it says nothing" : "it says: " + end.last_words;
        const char* advice = "try it by hand, or with --keep DIR to keep the files";
        if (end.timed_out)
            throw std::runtime_error(fmt::format(
                "the command was stopped after {:g} s {}; give it longer with --timeout, or find out what it waits for",
                o_.timeout, task));
        if (end.exit_code != 0)
            throw std::runtime_error(fmt::format(
                "the command failed with {} {} ({}); {}",
                end.signal ? fmt::format("signal {}", end.signal) : fmt::format("exit code {}", end.exit_code), task,
                words, advice));
        if (!std::filesystem::is_regular_file(out))
            throw std::runtime_error(
                fmt::format("the command ended well but wrote no {{out}}, {} ({}); {}", task, words, advice));
    }

    void write(const std::string& path, View<const float> stored) const {
        const int channels = stored.channels == 4 ? 4 : o_.grey ? 1 : 3;
        ImageTarget target;
        target.width = stored.width, target.height = stored.height;
        target.channel_names = channel_names(channels);
        target.depth = o_.file_depth();
        target.alpha = alpha_among(channels);
        target.transfer = is_integer(target.depth) ? Transfer::srgb : Transfer::linear;
        ImageWriter writer(path, target, o_.parallel.threads);
        Encoding encoding = writer.encoding();
        encoding.transfer = Transfer::linear;  // codes are written as they are
        AnyImage row = make_image(target.depth, stored.width, 1, channels);
        std::vector<float> values;
        for (int y = 0; y < stored.height; ++y) {
            values.clear();
            for (int x = 0; x < stored.width; ++x)
                for (int c = 0; c < channels; ++c) values.push_back(stored(x, y, std::min(c, stored.channels - 1)));
            encode_row(values, false, view_of(row), 0, encoding);
            writer.write_rows(const_view(view_of(row)));
        }
        writer.finish();
    }

    Image<float> read(const std::string& path, const std::string& task) const {
        try {
            return read_stored(path, o_.parallel.threads);
        } catch (const std::exception& e) {
            throw std::runtime_error(fmt::format("what the command wrote, {}, cannot be read: {}", task, e.what()));
        }
    }

    /// The mean of the colours; how far they are apart is remembered.
    Image<float> grey_of(View<const float> v) {
        const int colours = v.channels <= 2 ? 1 : 3;
        Image<float> grey(v.width, v.height);
        for (int y = 0; y < v.height; ++y)
            for (int x = 0; x < v.width; ++x) {
                float sum = 0, least = v(x, y), most = least;
                for (int c = 0; c < colours; ++c) {
                    sum += v(x, y, c);
                    least = std::min(least, v(x, y, c)), most = std::max(most, v(x, y, c));
                }
                grey.view()(x, y) = sum / static_cast<float>(colours);
                subject_.channel_spread = std::max(subject_.channel_spread, double(most - least));
            }
        return grey;
    }

    /// Grey and alpha as RGBA; anything else as it is.
    static Image<float> coloured(Image<float> image) {
        if (image.channels() != 2) return image;
        Image<float> out(image.width(), image.height(), 4);
        for (int y = 0; y < out.height(); ++y)
            for (int x = 0; x < out.width(); ++x)
                for (int c = 0; c < 4; ++c) out.view()(x, y, c) = image.view()(x, y, c / 3);
        return out;
    }

    const Options& o_;
    AuditSubject& subject_;
    std::string folder_, place_;
    int runs_ = 0;
};

/// A folder that the user names: made if its parent exists.
std::string made_folder(const std::string& name) {
    std::error_code error;
    std::filesystem::create_directory(name, error);
    if (error || !std::filesystem::is_directory(name))
        throw std::runtime_error(fmt::format(
            "{}: cannot be made a directory ({}); give a path in an existing directory that you may write to", name,
            error ? error.message() : "it is a file"));
    return std::filesystem::canonical(name).string();
}

void run(const Options& o, Console& console) {
    const FormatAbilities format = abilities_of("x." + o.format);
    AuditSubject subject{o.command, format.name, std::string(name_of(o.file_depth())), o.grey ? 1 : 3};
    const std::string html = o.html.empty() ? "" : made_folder(o.html);
    std::optional<TemporaryFolder> temporary;
    if (o.keep.empty()) temporary.emplace();
    CommandResizer resizer(o, subject, o.keep.empty() ? temporary->path() : made_folder(o.keep));
    std::optional<Progress> progress;
    AuditOptions options{scales_of(o.scales), o.code(), format.alpha && !o.grey, [&](int done, int all) {
                             if (!progress) progress.emplace(console, "audit", all);
                             progress->advance_to(done);
                         }};
    const AuditReport report = audit([&](View<const float> v, int w, int h) { return resizer(v, w, h); }, options);
    progress.reset();
    if (!html.empty()) write_audit_page(report, subject, html);
    if (o.json) return console.print_json(json_of(report, subject));
    console.print_lines(text_of(report, subject));
    if (!html.empty()) console.print("\n{}/index.html\n", html);
}

}  // namespace

void add_audit(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb(
        "audit", "Find out what another program really does when it resizes: kernel, shift, light, alpha, borders",
        "bandlimit audit 'bandlimit resize {in} {out} --size {width}x{height}' --scales 1/2\n"
        "Others:\n"
        "  bandlimit audit 'convert {in} -resize {width}x{height}! {out}'\n"
        "  bandlimit audit 'vips resize {in} {out} {scale}' --depth u16 --html vips");
    verb.add_option(
            "COMMAND", o->command,
            "One line for /bin/sh, run in a temporary folder, where {in}, {out}, {width}, {height} and {scale}\n"
            "are replaced, in quotes or not: it must read the picture {in} and write it at the new size to {out}")
        .required();
    verb.add_option("--scales", o->scales,
                    "Scales to test, between commas: ratios of numbers up to 128, from 1/8 to 8;\n"
                    "default 1/2,37/100,2,100/37")
        .type_name("S,...");
    verb.add_option("--format", o->format, "Extension of the files; default png").type_name("png|tif|pfm|...");
    add_depth(verb, o->depth)
        .description("Depth of the files; default u8. u16 shows kernels more finely, f32 clipping");
    verb.add_flag("--grey", o->grey, "Files of one channel instead of RGB; alpha is not tested then");
    verb.add_option("--timeout", o->timeout, "Seconds that a run may take; default 30").type_name("SECONDS");
    verb.add_option("--keep", o->keep, "Keep all files that are read and written in this folder").type_name("DIR");
    verb.add_option("--html", o->html, "Write a page with plots and pictures to this folder").type_name("DIR");
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
