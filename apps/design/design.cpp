// bandlimit design: custom filters, their responses, and their costs.
#include "apps/design/design.h"

#include <fmt/core.h>

#include <memory>

#include "bandlimit/io/atomic_file.h"
#include "bandlimit/job/shaders.h"

namespace bandlimit::app {
namespace {

struct Options {
    std::string output, plot, size = "1920x1080", emit_to, name;
    std::optional<Dialect> emit;
    bool json = false;
};

void check_outputs(const Options& o) {
    parse_size("--size", o.size);
    if (!o.output.empty() && !o.output.ends_with(".json"))
        throw UsageError(fmt::format("-o: \"{}\" must end in .json; other verbs recognise taps by that", o.output));
    if (!o.plot.empty()) check_plot_format(o.plot);
    if (!o.name.empty()) check_shader_name(o.name);
    if (o.json && o.emit && o.emit_to.empty())
        throw UsageError("--emit and --json both write to stdout; add --emit-to DIR, or -o instead of --json");
}

/// "1.2 GB", of powers of 1000.
std::string bytes_text(double bytes) {
    if (bytes >= 1e9) return fmt::format("{:.2f} GB", bytes / 1e9);
    return fmt::format("{:.1f} MB", bytes / 1e6);
}

/// What runs of `d` over a picture of that many pixels cost.
std::string cost_line(const Design& d, const Size& size) {
    constexpr double texel = 8;  // RGBA16F
    const double pixels = static_cast<double>(size.width) * size.height;
    const double scale = static_cast<double>(d.enlarges) / d.file.factor;
    const double outputs = pixels * scale * scale, between = d.intermediates * pixels * scale;
    std::string line = fmt::format("cost          {:.6g} reads", d.file.cost.value_or(0));
    if (d.file.multiply_adds) line += fmt::format(", {:.6g} multiply-adds", *d.file.multiply_adds);
    return line + fmt::format(" per output; of {} x {} RGBA16F at least {} read, {} written", size.width, size.height,
                              bytes_text(texel * (pixels + between)), bytes_text(texel * (outputs + between)));
}

void print(Console& console, const Design& d, const Options& o) {
    for (const std::string& line : d.lines) console.print("{}\n", line);
    if (d.file.cost) console.print("{}\n", cost_line(d, parse_size("--size", o.size)));
    for (const std::string& line : d.table) console.print("{}\n", line);
}

void ship(Console& console, const Design& d, const Options& o, const ShaderInfo& info) {
    if (o.emit_to.empty()) {
        // What follows the first file are other ways to run the design, or whole compute shaders.
        const std::vector<ShaderFile> files = job::emit_shaders(d.file, info, *o.emit);
        console.write(files.front().text);
        for (std::size_t i = 1; i < files.size(); ++i)
            console.note(fmt::format("{} is for --emit-to DIR", files[i].name));
        return;
    }
    const auto all = all_dialects();
    const std::vector<Dialect> dialects = o.emit ? std::vector{*o.emit} : std::vector<Dialect>{all.begin(), all.end()};
    const auto names = job::write_shaders(d.file, info, dialects, o.emit_to);
    console.note(fmt::format("{} shaders in {}", names.size(), o.emit_to));
}

/// The name of a design's functions unless the user gives one.
std::string default_name(const std::string& kind) { return kind == "kernel" ? "sample_kernel" : kind; }

void run(const Options& o, Console& console, const std::string& command, const std::function<Design(Console&)>& make) {
    for (const std::string& path : {o.output, o.plot})
        if (!path.empty()) check_output_path(path);
    const Design design = make(console);
    if (!o.plot.empty()) draw(design.panels, o.plot, 420 * static_cast<int>(design.panels.size()), 380);
    if (!o.output.empty()) write_taps(o.output, design.file);
    if (o.emit || !o.emit_to.empty())
        ship(console, design, o, {o.name.empty() ? default_name(design.file.kind) : o.name, command, design.lines});
    if (o.json) console.write(taps_text(design.file));
    else if (!o.emit || !o.emit_to.empty()) print(console, design, o);
}

}  // namespace

Verb add_design_kind(const DesignVerb& verb, const std::string& name, const std::string& summary,
                     const std::string& example, std::function<void()> check, std::function<Design(Console&)> make) {
    auto o = std::make_shared<Options>();
    Verb app = verb.cli.add_subcommand(name, summary);
    app.example(example);
    app.add_option("-o,--output", o->output,
                   "Write the design as taps.json, which resize, mips, convolve and analyze read")
        .type_name("FILE.json");
    app.add_option("--plot", o->plot, "Draw weights and responses, as .svg or .png").type_name("OUT");
    app.add_option("--size", o->size, "Picture size for which costs are printed; default 1920x1080").type_name("WxH");
    app.add_flag("--json", o->json, "Print the taps.json on stdout, and nothing else there");
    app.add_option_function<std::string>(
           "--emit", [o](const std::string& s) { o->emit = parse_dialect(s); },
           "Print shader source that runs the design, instead of the report")
        .type_name("glsl|hlsl|wgsl|msl|slang|cpp");
    app.add_option("--emit-to", o->emit_to, "Write all its shaders, in all dialects or that of --emit, to a directory")
        .type_name("DIR");
    app.add_option("--name", o->name, "What its functions are called; default: the kind of design").type_name("NAME");
    verb.program.add_quiet(app);
    verb.program.on(
        app,
        [o, check = std::move(check)] {
            check_outputs(*o);
            check();
        },
        [o, &program = verb.program, make = std::move(make)](Console& console) {
            run(*o, console, program.command, make);
        });
    return app;
}

void add_design(Program& program) {
    Verb cli = program.add_verb("design", "Design a custom filter: its taps, its response, its cost",
                                "bandlimit design downsample --fetches 8 --plot downsample.svg");
    const DesignVerb verb{program, cli};
    add_design_downsample(verb);
    add_design_separable(verb);
    add_design_disk(verb);
    add_design_derivative(verb);
    add_design_gaussian(verb);
    add_design_sharpen(verb);
    add_design_kernel(verb);
    cli.require_one_subcommand("design");
}

}  // namespace bandlimit::app
