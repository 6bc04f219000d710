// bandlimit info: what a file says about itself.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include "apps/common.h"

namespace bandlimit::app {
namespace {

struct Options {
    std::string file;
    bool json = false;
};

void run(const Options& options) {
    const ImageReader reader(options.file, 1);
    const ImageInfo& info = reader.info();
    if (options.json) {
        print_json({{"file", options.file},
                    {"format", info.format},
                    {"width", info.width},
                    {"height", info.height},
                    {"channels", info.channels()},
                    {"channel_names", info.channel_names},
                    {"depth", name_of(info.depth)},
                    {"alpha", info.alpha < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(info.alpha)},
                    {"associated_alpha", info.associated},
                    {"color_hint", info.color_hint},
                    {"transfer", name_of(info.transfer)},
                    {"levels", info.levels},
                    {"subimages", info.subimages},
                    {"orientation", info.orientation}});
        return;
    }
    fmt::print("{}: {}\n", options.file, info.format);
    fmt::print("  size      {} x {}\n", info.width, info.height);
    fmt::print("  channels  {} ({})\n", info.channels(), fmt::join(info.channel_names, " "));
    fmt::print("  depth     {}\n", name_of(info.depth));
    if (info.alpha >= 0)
        fmt::print("  alpha     {}\n", info.associated ? "associated (premultiplied)" : "unassociated (straight)");
    fmt::print("  colour    {}, read as {}{}\n", info.color_hint.empty() ? "no hint" : info.color_hint,
               name_of(info.transfer), info.has_foreign_profile ? " (ICC profile kept)" : "");
    fmt::print("  levels    {}\n", info.levels);
    if (info.subimages > 1) fmt::print("  images    {} (the first is used)\n", info.subimages);
    if (info.orientation != 1) fmt::print("  turned    upright from orientation {}\n", info.orientation);
}

}  // namespace

void add_info(Program& program) {
    auto options = std::make_shared<Options>();
    CLI::App* verb = program.add_verb("info", "Show size, channels, depth, colour and levels of an image file",
                                      "bandlimit info examples/coffee.png");
    verb->add_option("FILE", options->file, "Image to look at")->required();
    add_json(verb, options->json);
    program.on(
        verb, [] {}, [options] { run(*options); });
}

}  // namespace bandlimit::app
