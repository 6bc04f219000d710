// bandlimit info: what a file says about itself.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "bandlimit/job/texture_file.h"

namespace bandlimit::app {
namespace {

using namespace job;

struct Options {
    std::string file;
    bool json = false;
};

void run_image(const Options& options, Console& console) {
    const ImageReader reader(options.file, 1);
    const ImageInfo& info = reader.info();
    if (options.json) {
        console.print_json({{"file", options.file},
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
    console.print("{}: {}\n", options.file, info.format);
    console.print("  size      {} x {}\n", info.width, info.height);
    console.print("  channels  {} ({})\n", info.channels(), fmt::join(info.channel_names, " "));
    console.print("  depth     {}\n", name_of(info.depth));
    if (info.alpha >= 0)
        console.print("  alpha     {}\n", info.associated ? "associated (premultiplied)" : "unassociated (straight)");
    console.print("  colour    {}, read as {}{}\n", info.color_hint.empty() ? "no hint" : info.color_hint,
                  name_of(info.transfer), info.has_foreign_profile ? " (ICC profile kept)" : "");
    console.print("  levels    {}\n", info.levels);
    if (info.subimages > 1) console.print("  images    {} (the first is used)\n", info.subimages);
    if (info.orientation != 1) console.print("  turned    upright from orientation {}\n", info.orientation);
}

std::vector<std::string> channel_names(const TexelFormat& texels) {
    std::vector<std::string> names{"R", "G", "B", "A"};
    names.resize(static_cast<std::size_t>(texels.channels));
    return names;
}

/// The bytes of all images of a level, as the file stores them.
std::uint64_t level_bytes(const ContainerInfo& info, int level) {
    std::uint64_t bytes = static_cast<std::uint64_t>(info.texel_bytes);
    for (const int factor :
         {mip_length(info.width, level), mip_length(info.height, level), info.layers, info.is_cube ? 6 : 1})
        bytes *= static_cast<std::uint64_t>(factor);
    return bytes;
}

nlohmann::ordered_json json_of(const Options& options, const ContainerInfo& info) {
    const TexelFormat& texels = info.texels;
    const bool has_alpha = texels.channels == 4;
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (int level = 0; level < info.levels; ++level)
        levels.push_back({{"width", mip_length(info.width, level)},
                          {"height", mip_length(info.height, level)},
                          {"bytes", level_bytes(info, level)}});
    return {{"file", options.file},
            {"format", info.container == Container::ktx2 ? "ktx2" : "dds"},
            {"width", info.width},
            {"height", info.height},
            {"channels", texels.channels},
            {"channel_names", channel_names(texels)},
            {"depth", name_of(texels.depth)},
            {"alpha", has_alpha ? nlohmann::ordered_json(3) : nlohmann::ordered_json()},
            {"associated_alpha", texels.premultiplied},
            {"transfer", name_of(encoding_of(texels, false).transfer)},
            {"levels", info.levels},
            {"texel_format", info.format},
            {"srgb", texels.srgb},
            {"premultiplied", texels.premultiplied},
            {"array", info.is_array},
            {"layers", info.layers},
            {"cube", info.is_cube},
            {"faces", info.is_cube ? 6 : 1},
            {"level_sizes", levels}};
}

void run_texture(const Options& options, Console& console) {
    const ContainerInfo info = texture_info(options.file);
    if (options.json) {
        console.print_json(json_of(options, info));
        return;
    }
    const TexelFormat& texels = info.texels;
    console.print("{}: {}\n", options.file, info.container == Container::ktx2 ? "ktx2" : "dds");
    console.print("  size      {} x {}\n", info.width, info.height);
    if (info.is_array) console.print("  layers    {}\n", info.layers);
    if (info.is_cube) console.print("  faces     6 (+x -x +y -y +z -z)\n");
    console.print("  texels    {}\n", info.format);
    console.print("  channels  {} ({})\n", texels.channels, fmt::join(channel_names(texels), " "));
    console.print("  depth     {}\n", name_of(texels.depth));
    if (texels.channels == 4)
        console.print("  alpha     {}\n",
                      texels.premultiplied ? "associated (premultiplied)" : "unassociated (straight)");
    console.print("  colour    {}\n", name_of(encoding_of(texels, false).transfer));
    console.print("  levels    {}\n", info.levels);
    for (int level = 0; level < info.levels; ++level)
        console.print("  {:7}   {} x {}, {} bytes\n", level, mip_length(info.width, level),
                      mip_length(info.height, level), level_bytes(info, level));
}

void run(const Options& options, Console& console) {
    container_of_file(options.file) ? run_texture(options, console) : run_image(options, console);
}

}  // namespace

void add_info(Program& program) {
    auto options = std::make_shared<Options>();
    Verb verb = program.add_verb("info", "Show size, channels, depth, colour and levels of an image or texture file",
                                 "bandlimit info examples/coffee.png");
    verb.add_option("FILE", options->file, "Image, .ktx2 or .dds to look at").required();
    add_json(verb, options->json);
    program.on(
        verb, [] {}, [options](Console& console) { run(*options, console); });
}

}  // namespace bandlimit::app
