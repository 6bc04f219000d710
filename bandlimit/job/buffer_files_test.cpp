#include "bandlimit/job/buffer_files.h"

#include <gtest/gtest.h>

#include "bandlimit/io/files_test.h"
#include "bandlimit/job/option_error.h"

namespace bandlimit::job {
namespace {

TEST(BufferFiles, PatternsNameFilesByNumber) {
    const FilePattern pattern = parse_file_pattern("depth", "passes/depth_####_v2.exr:Z");
    EXPECT_EQ(pattern.folder, "passes");
    EXPECT_EQ(pattern.channel, "Z");
    EXPECT_EQ(pattern.name(), "depth_####_v2.exr");
    for (const int number : {0, 7, 12, 9999, 12345})
        EXPECT_EQ(pattern.number_of(pattern.name_of(number)), number) << pattern.name_of(number);
    EXPECT_EQ(pattern.name_of(12), "depth_0012_v2.exr");
    for (const char* name : {"depth_012_v2.exr", "depth_0012.exr", "color_0012_v2.exr", "depth_-012_v2.exr",
                             "depth_00x2_v2.exr", "depth_99999999999_v2.exr", "", "depth__v2.exr"})
        EXPECT_EQ(pattern.number_of(name), -1) << name;
}

TEST(BufferFiles, PatternsAreToldFromChannels) {
    for (const char* text : {"d_##.exr", "d_#.exr:Z", "one.exr", "one.exr:Z", "a/b:c/d_##.exr"})
        EXPECT_TRUE(is_file_pattern(text)) << text;
    for (const char* text : {"", "Depth.Z", "ViewLayer.Vector", "a:b"}) EXPECT_FALSE(is_file_pattern(text)) << text;
    EXPECT_EQ(parse_file_pattern("depth", "a/b:c/d_##.exr").folder, "a/b:c");
    for (const char* text :
         {"one.exr", "one.exr:Z", "a_##_b_##.exr", "a_##/b.exr", "a_##/b_##.exr", "d_##.png", "d_##"})
        EXPECT_THROW(parse_file_pattern("depth", text), OptionError) << text;
}

TEST(BufferFiles, FoldersAreSearched) {
    const Folder folder;
    for (const char* name : {"d_01.exr", "d_12.exr", "d_1.exr", "d_01.png", ".d_03.exr", "d_x.exr"})
        write_bytes(folder / name, "");
    const std::vector<FrameFile> found = files_of(parse_file_pattern("depth", "d_##.exr"), folder / "");
    EXPECT_EQ(found.size(), 2u);
    for (const FrameFile& file : found) EXPECT_TRUE(file.number == 1 || file.number == 12) << file.path;
    EXPECT_EQ(exr_files_in(folder / "").size(), 4u);
    EXPECT_THROW(files_of(parse_file_pattern("depth", "none/d_##.exr"), folder / ""), std::runtime_error);
    EXPECT_EQ(number_in("frame_0012.exr"), 12);
    EXPECT_EQ(number_in("frame.exr"), -1);
    EXPECT_EQ(number_in("v2_frame.exr"), -1);
}

}  // namespace
}  // namespace bandlimit::job
