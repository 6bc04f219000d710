// Making one texture: from the files of its pictures to its own file, or to a file per level.
// Stability: evolving.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/job/context.h"
#include "bandlimit/job/mips_recipe.h"
#include "bandlimit/texture/texture.h"

namespace bandlimit::job {

/// One texture to be made.
struct MipsJob {
    std::vector<std::string> inputs;
    std::string output;  ///< .ktx2, .dds, or images of a pattern, "name_%d.png"
    bool is_cube = false, is_array = false;
    bool keep_levels = false;  ///< copy the levels of the one texture that is read; the recipe has no say
    MipsRecipe recipe;
};

/// Throws OptionError or Error for what names, numbers and options alone show to be wrong. Opens no file.
void check_job(const MipsJob& job);

/// What was made.
struct MipsReport {
    struct Level {
        int width = 0, height = 0;
        std::uint64_t bytes = 0;         ///< of its texels, all layers and faces
        std::string file;                ///< where each level has its own
        std::optional<double> coverage;  ///< share of texels that pass the threshold of alpha
    };
    std::string format;  ///< "VK_FORMAT_R8G8B8A8_SRGB", "png"
    int layers = 1, faces = 1, channels = 4;
    Depth depth = Depth::u8;
    bool is_srgb = false, is_premultiplied = false;
    std::optional<RoleChoice> role;  ///< none where levels were copied, and then no filter
    std::string filter_x, filter_y;
    Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
    std::vector<Level> levels;
    bool lost_non_finite = false;            ///< NaN or infinity became the code 0
    bool has_foreign_profile = false;        ///< an ICC profile that is not sRGB; its curve was treated as sRGB
    double read = 0, filter = 0, write = 0;  ///< seconds
};

/// What the user should know about the picture `path` that became this.
std::vector<std::string> notes_of(const MipsReport& report, const std::string& path);

/// Reads, filters, writes. Whatever fails, and where it is stopped, nothing of the output appears.
///
/// cost     as make_mips(); a picture that MipStream can take goes by rows, and need not fit into memory
/// throws   OptionError for options that do not fit the role; std::runtime_error and Error for files and pictures;
///          Stopped
/// example  MipsJob job{{"wall_n.png"}, "wall_n.ktx2"};
///          job.recipe.role = Role::normal;
///          make_texture(job).levels.size();
MipsReport make_texture(const MipsJob& job, const Context& context = {});

/// What a job takes, as far as headers tell.
struct MipsCost {
    std::uint64_t pixels = 0;  ///< of level 0, all layers and faces
    std::uint64_t bytes = 0;   ///< of memory, about, for one thread
};
MipsCost cost_of(const MipsJob& job);

}  // namespace bandlimit::job
