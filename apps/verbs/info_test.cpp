// What the program says about textures, from outside.
#include <sys/stat.h>

#include "apps/run_program_test.h"
#include "bandlimit/texture/container.h"

namespace bandlimit {
namespace {

using nlohmann::json;

/// A file of black texels.
struct Black {
    TexelFormat format;
    int width = 1, height = 1, levels = 1;
    bool is_cube = false;
    int layers = 0;  ///< 0: no array

    std::string written(Container container) const {
        Texture texture{.format = format, .is_cube = is_cube, .is_array = layers > 0, .layers = std::max(layers, 1)};
        for (int level = 0; level < levels; ++level) {
            texture.levels.emplace_back();
            for (int i = 0; i < texture.layers * texture.faces(); ++i)
                texture.levels.back().push_back(
                    make_image(format.depth, mip_length(width, level), mip_length(height, level), format.channels));
        }
        std::string file;
        write_container(texture, container, [&](std::span<const std::byte> part) {
            file.append(reinterpret_cast<const char*>(part.data()), part.size());
        });
        return file;
    }
};

TEST(InfoOfTextures, SaysWhatTheHeaderSays) {
    const Shell shell(BANDLIMIT_PROGRAM);
    // What a file is, its first bytes say.
    write_bytes(shell / "cubes.png", Black{{4, Depth::u8, true, true}, 5, 5, 2, true, 3}.written(Container::ktx2));
    const Outcome cubes = shell("info cubes.png --json");
    ASSERT_TRUE(succeeds(cubes));
    const json expected = {{"file", "cubes.png"},
                           {"format", "ktx2"},
                           {"width", 5},
                           {"height", 5},
                           {"channels", 4},
                           {"channel_names", {"R", "G", "B", "A"}},
                           {"depth", "u8"},
                           {"alpha", 3},
                           {"associated_alpha", true},
                           {"transfer", "srgb"},
                           {"levels", 2},
                           {"texel_format", "VK_FORMAT_R8G8B8A8_SRGB"},
                           {"srgb", true},
                           {"premultiplied", true},
                           {"array", true},
                           {"layers", 3},
                           {"cube", true},
                           {"faces", 6},
                           {"level_sizes",
                            {{{"width", 5}, {"height", 5}, {"bytes", 25 * 4 * 18}},
                             {{"width", 2}, {"height", 2}, {"bytes", 4 * 4 * 18}}}}};
    EXPECT_EQ(cubes.json(), expected) << cubes.out;

    write_bytes(shell / "grey.dds", Black{{1, Depth::f16}, 7, 3}.written(Container::dds));
    const Outcome grey = shell("info grey.dds");
    EXPECT_TRUE(succeeds(grey));
    for (const char* word : {"dds", "7 x 3", "DXGI_FORMAT_R16_FLOAT", "1 (R)", "f16", "linear", "42 bytes"})
        EXPECT_NE(grey.out.find(word), std::string::npos) << word << " in " << grey.out;
    for (const char* word : {"alpha", "layers", "faces"})
        EXPECT_EQ(grey.out.find(word), std::string::npos) << word << " in " << grey.out;
}

TEST(InfoOfTextures, TheHeaderIsEnoughAndDamageIsNamed) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::string file = Black{{4, Depth::f32}, 600, 300, 3}.written(Container::dds);
    write_bytes(shell / "large.dds", file);
    // The header alone is read: a quarter of a terabyte that the disk does not hold costs nothing.
    std::filesystem::resize_file(shell / "large.dds", std::uintmax_t{1} << 38);
    const Outcome large = shell("info large.dds --json");
    ASSERT_TRUE(succeeds(large));
    EXPECT_EQ(large.json()["level_sizes"][2]["bytes"], 150 * 75 * 16);
    std::filesystem::remove(shell / "large.dds");

    write_bytes(shell / "cut.dds", file.substr(0, file.size() - 1));
    EXPECT_TRUE(fails(1, shell("info cut.dds --json"), "cut.dds: ends at byte"));
    write_bytes(shell / "text", "DDS no more");
    EXPECT_TRUE(fails(1, shell("info text"), "text: ends at byte 11"));
}

}  // namespace
}  // namespace bandlimit
