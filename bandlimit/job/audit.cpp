#include "bandlimit/job/audit.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "bandlimit/core/error.h"
#include "bandlimit/job/command.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

Depth file_depth(const AuditJob& job) {
    return nearest_depth(abilities_of("x." + job.format), job.depth.value_or(Depth::u8));
}

/// The distance of two codes; 0 for floats.
double code_of(Depth depth) {
    if (depth == Depth::u8) return 1.0 / 255;
    return depth == Depth::u16 ? 1.0 / 65535 : 0;
}

/// A resizer that writes files, runs the command on them and reads what it wrote.
class CommandResizer {
public:
    /// Commands run in `folder`. They get full paths if these are plain, and otherwise the names of files in `folder`:
    /// neither needs quotes.
    CommandResizer(const AuditJob& job, const Context& context, AuditSubject& subject, const std::string& folder)
        : job_(job),
          context_(context),
          subject_(subject),
          folder_(folder),
          place_(is_plain(folder) ? folder + "/" : "") {}

    Image<float> operator()(View<const float> stored, int width, int height) {
        const std::string number = fmt::format("{:02}", ++runs_);
        const std::string in_name = number + "-in." + job_.format, out_name = number + "-out." + job_.format;
        const std::string in = folder_ + "/" + in_name, out = folder_ + "/" + out_name;
        write(in, stored);
        const std::string scale = fmt::format("{:.17g}", double(width) / stored.width);
        const CommandEnd end = run_command(filled_in(job_.command, {{"in", place_ + in_name},
                                                                    {"out", place_ + out_name},
                                                                    {"width", std::to_string(width)},
                                                                    {"height", std::to_string(height)},
                                                                    {"scale", scale}}),
                                           folder_, job_.timeout);
        const std::string task =
            fmt::format("from {} x {} to {} x {} pixels", stored.width, stored.height, width, height);
        check(end, out, task);
        subject_.seconds = std::max(subject_.seconds, end.seconds);
        Image<float> result = read(out, task);
        if (result.width() != width || result.height() != height)
            throw std::runtime_error(
                fmt::format("the command, asked {}, made {} x {}; it must make exactly {{width}} x {{height}} pixels",
                            task, result.width(), result.height()));
        if (job_.keep.empty()) {
            std::error_code ignored;
            std::filesystem::remove(in, ignored);
            std::filesystem::remove(out, ignored);
        }
        return stored.channels == 1 ? grey_of(result.view()) : coloured(std::move(result));
    }

private:
    void check(const CommandEnd& end, const std::string& out, const std::string& task) const {
        const std::string words = end.last_words.empty() ? "it says nothing" : "it says: " + end.last_words;
        const char* advice = "try it by hand, or keep the files and look at them";
        if (end.timed_out)
            throw std::runtime_error(fmt::format(
                "the command was stopped after {:g} s {}; give it a longer timeout, or find out what it waits for",
                job_.timeout, task));
        if (end.exit_code != 0)
            throw std::runtime_error(fmt::format(
                "the command failed with {} {} ({}); {}",
                end.signal ? fmt::format("signal {}", end.signal) : fmt::format("exit code {}", end.exit_code), task,
                words, advice));
        if (!std::filesystem::is_regular_file(out))
            throw std::runtime_error(
                fmt::format("the command succeeded but wrote no {{out}}, {} ({}); {}", task, words, advice));
    }

    void write(const std::string& path, View<const float> stored) const {
        const int channels = stored.channels == 4 ? 4 : job_.grey ? 1 : 3;
        ImageTarget target;
        target.width = stored.width, target.height = stored.height;
        target.channel_names = channel_names(channels);
        target.alpha = alpha_among(channels);
        target.depth = file_depth(job_);
        target.transfer = is_integer(target.depth) ? Transfer::srgb : Transfer::linear;
        View<const float> all = stored;  // one channel becomes each colour
        if (stored.channels < channels) all.channels = channels, all.dc = 0;
        write_codes(path, target, all, context_.parallel.threads);
    }

    Image<float> read(const std::string& path, const std::string& task) const {
        try {
            return read_codes(path, context_.parallel);
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

    const AuditJob& job_;
    const Context& context_;
    AuditSubject& subject_;
    std::string folder_, place_;
    int runs_ = 0;
};

}  // namespace

void check_audit(const AuditJob& job) {
    if (job.command.find("{in}") == std::string::npos || job.command.find("{out}") == std::string::npos)
        throw Error(
            "the command must hold {in} and {out}, for the files to read and to write; write it as "
            "'program {in} --size {width}x{height} {out}'");
    const auto holds = [&](const char* word) { return job.command.find(word) != std::string::npos; };
    if (!holds("{width}") && !holds("{height}") && !holds("{scale}"))
        throw Error(
            "the command must hold {width} and {height}, or {scale}, for what size to make; write it as "
            "'program {in} --size {width}x{height} {out}'");
    if (holds("{out}."))
        throw Error(
            "{out} is a whole file name and has its extension already; write nothing behind it; choose another "
            "extension with the option format");
    if (!(job.timeout > 0))
        throw OptionError("timeout", message(job.timeout, " is not a duration; pass seconds above 0"));
}

CommandAudit audit(const AuditJob& job, const Context& context) {
    check_audit(job);
    const FormatAbilities format = abilities_of("x." + job.format);
    const Depth depth = file_depth(job);
    CommandAudit result{{}, {job.command, format.name, std::string(name_of(depth)), job.grey ? 1 : 3}, {}};
    std::optional<TemporaryFolder> temporary;
    if (job.keep.empty()) temporary.emplace();
    CommandResizer resizer(job, context, result.subject, temporary ? temporary->path() : made_folder(job.keep));
    result.report = bandlimit::audit(
        [&](View<const float> stored, int width, int height) { return resizer(stored, width, height); },
        {job.scales, code_of(depth), format.alpha && !job.grey, [&](int done, int all) {
             context.parallel.check_stop();
             context.report({"audit", double(done), double(all)});
         }});
    result.findings = findings_of(result.report, result.subject);
    return result;
}

}  // namespace bandlimit::job
