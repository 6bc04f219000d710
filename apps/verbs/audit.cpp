// bandlimit audit: what does another program really do when it resizes?
#include "bandlimit/job/audit.h"
#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "apps/verbs/audit_report.h"
#include "bandlimit/job/command.h"

namespace bandlimit::app {
namespace {

struct Options {
    job::AuditJob job;
    std::string scales, html;
    Parallel parallel;
    bool json = false;
};

void check(Options& o) {
    if (!o.scales.empty()) {
        o.job.scales.clear();
        for (const double scale : parse_numbers("--scales", o.scales)) o.job.scales.push_back(ratio_of(scale));
    }
    job::check_audit(o.job);
    check_output_format("x." + o.job.format, o.job.depth);
}

void run(const Options& o, Console& console) {
    const std::string html = o.html.empty() ? "" : job::made_folder(o.html);
    const job::CommandAudit audit = job::audit(o.job, context_of(console, o.parallel));
    if (!html.empty()) write_audit_page(audit, html);
    if (o.json) return console.print_json(json_of(audit));
    console.print_lines(text_of(audit));
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
            "COMMAND", o->job.command,
            "One line for /bin/sh, run in a temporary folder, where {in}, {out}, {width}, {height} and {scale}\n"
            "are replaced, in quotes or not: it must read the picture {in} and write it at the new size to {out}")
        .required();
    verb.add_option("--scales", o->scales,
                    "Scales to test, between commas: ratios of numbers up to 128, from 1/8 to 8;\n"
                    "default 1/2,37/100,2,100/37")
        .type_name("S,...");
    verb.add_option("--format", o->job.format, "Extension of the files; default png").type_name("png|tif|pfm|...");
    add_depth(verb, o->job.depth)
        .description("Depth of the files; default u8. u16 shows kernels more finely, f32 clipping");
    verb.add_flag("--grey", o->job.grey, "Files of one channel instead of RGB; alpha is not tested then");
    verb.add_option("--timeout", o->job.timeout, "Seconds that a run may take; default 30").type_name("SECONDS");
    verb.add_option("--keep", o->job.keep, "Keep all files that are read and written in this folder").type_name("DIR");
    verb.add_option("--html", o->html, "Write a page with plots and pictures to this folder").type_name("DIR");
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
