#include "bandlimit/job/make_texture.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "bandlimit/core/file_error.h"
#include "bandlimit/job/level_images.h"
#include "bandlimit/job/shares.h"
#include "bandlimit/job/stopwatch.h"
#include "bandlimit/job/texture_file.h"
#include "bandlimit/job/texture_pictures.h"
#include "bandlimit/job/texture_stream.h"
#include "bandlimit/texture/alpha_coverage.h"

namespace bandlimit::job {
namespace {

constexpr int cube_faces = 6, alpha_channel = 3;

/// The inputs of a job, by their headers.
struct Inputs {
    std::vector<TexturePictureInfo> infos;
    int width = 0, height = 0, channels = 0;  ///< the most channels of any
    Depth depth = Depth::u8;                  ///< the widest of any
    int layers = 1, faces = 1;
    bool is_array = false, has_alpha = false, has_foreign_profile = false, is_linear = true;
};

/// Gathers what the headers say, one after another.
void add_input(const MipsJob& job, const std::string& path, Inputs& in) {
    const TexturePictureInfo info = picture_info(path);
    if (in.infos.empty()) in.width = info.width, in.height = info.height;
    if (info.width != in.width || info.height != in.height)
        fail_file(path, "is ", info.width, " x ", info.height, ", and ", job.inputs.front(), " is ", in.width, " x ",
                  in.height, "; give pictures of one size (bandlimit resize)");
    in.channels = std::max(in.channels, info.channels);
    in.depth = std::max(in.depth, info.depth);
    in.is_array = in.is_array || job.is_array || info.is_array();
    in.has_alpha = in.has_alpha || info.has_alpha;
    in.has_foreign_profile = in.has_foreign_profile || info.has_foreign_profile;
    in.is_linear = in.is_linear && info.texture && !info.texture->texels.srgb;
    in.infos.push_back(info);
}

Inputs inputs_of(const MipsJob& job) {
    Inputs in;
    for (const std::string& path : job.inputs) add_input(job, path, in);
    const std::string& first = job.inputs.front();
    int images = 0;
    bool is_cube = true;
    for (const TexturePictureInfo& info : in.infos) {
        images += info.images;
        is_cube = is_cube && info.is_cube();
    }
    in.faces = job.is_cube || is_cube ? cube_faces : 1;
    if (images % in.faces != 0)
        fail_file(first, "and the others are ", images, " pictures, and a cube has ", cube_faces,
                  " faces; give all of them");
    in.layers = images / in.faces;
    if (in.faces > 1 && in.width != in.height)
        fail_file(first, "is ", in.width, " x ", in.height,
                  ", and the faces of a cube are square; crop them (bandlimit resize --region)");
    const int most = mip_count(in.width, in.height);
    if (job.recipe.levels > most)
        fail_file(first, "has ", most, " levels at ", in.width, " x ", in.height, ", not ", job.recipe.levels,
                  "; ask for fewer, or leave the number out for all");
    return in;
}

/// What the levels are stored as.
struct Target {
    TexelFormat texels;
    std::optional<LevelFormat> images;  ///< where each level is a file of its own
};

int texture_channels(const MipsJob& job, const Inputs& in, Role role, bool is_srgb) {
    const bool is_color = traits_of(role).is_light;
    if (job.recipe.two_channel) return 2;
    // A grey picture stays one where its codes have no curve: few programs read sRGB of one channel.
    const int needed = in.channels == 1 ? (is_srgb ? 4 : 1) : in.channels == 2 && !is_color ? 2 : 4;
    if (job.recipe.channels == 0) return needed;
    const int least = is_color && in.channels > 1 ? 4 : traits_of(role).least_channels;
    if (job.recipe.channels < least)
        fail_file(job.inputs.front(), "has ", in.channels, " channels, and as ", name_of(role), " they need ", least,
                  "; leave the number out, or take the first channels as they are by the role data");
    return job.recipe.channels;
}

Target texture_target(const MipsJob& job, const Inputs& in, Role role, Container container) {
    TexelFormat texels;
    texels.depth = job.recipe.depth.value_or(in.depth);
    texels.srgb = traits_of(role).may_be_srgb && texels.depth == Depth::u8;
    texels.channels = texture_channels(job, in, role, texels.srgb);
    texels.premultiplied = job.recipe.premultiplied && texels.channels == 4;
    check_container(container, texels);
    return {texels, {}};
}

Target image_target(const MipsJob& job, const Inputs& in, Role role) {
    const FormatAbilities format = abilities_of(job.output);
    const bool is_color = traits_of(role).is_light;
    LevelFormat images;
    images.channels = in.channels;
    images.depth = job.recipe.depth.value_or(nearest_depth(format, in.depth));
    images.is_data = !is_color;
    const bool has_curve = traits_of(role).may_be_srgb && !format.is_linear && is_integer(images.depth);
    images.transfer = has_curve ? Transfer::srgb : Transfer::linear;
    if (is_color && in.has_alpha && !format.alpha)
        fail_file(job.inputs.front(), "has an alpha channel, which ", format.name,
                  " files cannot hold; write .png or .tif");
    TexelFormat texels;
    texels.channels = in.channels == 3 || (in.channels == 2 && is_color) ? 4 : in.channels;
    // Texels of 16 bits have no curve: they are floats on their way to codes that have one.
    texels.depth = has_curve && images.depth != Depth::u8 ? Depth::f32 : images.depth;
    texels.srgb = has_curve && images.depth == Depth::u8;
    return {texels, images};
}

Target target_of(const MipsJob& job, const Inputs& in, Role role) {
    if (role == Role::normal && in.channels < 2)
        fail_file(job.inputs.front(), "has one channel, and a normal has two or more; choose another role, as height");
    if (role == Role::alpha_tested && !in.has_alpha)
        fail_file(job.inputs.front(), "has no alpha to test; choose another role, as color");
    const auto container = container_of_path(job.output);
    return container ? texture_target(job, in, role, *container) : image_target(job, in, role);
}

/// The samples of `picture` that fit texels of so many channels: of data the first ones. Two channels make a normal of
/// three themselves.
AnyConstView samples_of(const TexturePicture& picture, int channels, Role role) {
    return std::visit(
        [&](const auto& image) -> AnyConstView {
            auto view = image.view();
            if (!traits_of(role).is_light && role != Role::normal) view.channels = std::min(view.channels, channels);
            return view;
        },
        picture.image);
}

MipOptions options_of(const MipsRecipe& recipe, Role role) {
    MipOptions options;
    options.role = role;
    options.filter = filter_of(recipe);
    options.from = recipe.from;
    options.edge_x = recipe.edge_x.value_or(options.edge_x);
    options.edge_y = recipe.edge_y.value_or(options.edge_y);
    options.levels = recipe.levels;
    options.alpha_threshold = recipe.alpha_threshold.value_or(options.alpha_threshold);
    return options;
}

/// The chains of one layer: one of its picture, or those of its faces.
std::vector<MipChain> make_layer(std::span<const TexturePicture> faces, const TexelFormat& texels,
                                 const MipOptions& options, Parallel parallel) {
    std::vector<AnyConstView> views;
    for (const TexturePicture& face : faces) views.push_back(samples_of(face, texels.channels, options.role));
    const Encoding& stored = faces.front().encoding;
    if (faces.size() == 1) {
        std::vector<MipChain> chains;
        chains.push_back(make_mips(views.front(), stored, texels, options, parallel));
        return chains;
    }
    return make_cube_mips(views, stored, texels, options, parallel);
}

bool are_alike(const Encoding& a, const Encoding& b) {
    return a.transfer == b.transfer && a.alpha == b.alpha && a.associated == b.associated;
}

/// All levels of all pictures, which are given away as they are done with.
Texture filter(const MipsJob& job, const Inputs& in, std::vector<TexturePicture> pictures, const TexelFormat& texels,
               const MipOptions& options, Parallel parallel, bool& lost_non_finite) {
    Texture texture;
    texture.format = texels;
    texture.is_cube = in.faces > 1;
    texture.is_array = in.is_array;
    texture.layers = in.layers;
    const auto faces = static_cast<std::size_t>(in.faces);
    for (std::size_t first = 0; first < pictures.size(); first += faces) {
        const std::span<TexturePicture> layer = std::span(pictures).subspan(first, faces);
        for (const TexturePicture& face : layer)
            if (!are_alike(face.encoding, layer.front().encoding))
                fail_file(job.inputs.front(),
                          "and the other faces do not mean their codes alike (sRGB, linear, "
                          "alpha); make them one kind of file");
        for (MipChain& chain : make_layer(layer, texels, options, parallel)) {
            texture.levels.resize(chain.images.size());
            for (std::size_t level = 0; level < chain.images.size(); ++level)
                texture.levels[level].push_back(std::move(chain.images[level]));
            lost_non_finite = lost_non_finite || chain.lost_non_finite;
        }
        for (TexturePicture& face : layer) face.image = {};
    }
    return texture;
}

/// The share of texels whose alpha is not below `threshold`.
double coverage_of(const std::vector<AnyImage>& images, const MipsReport::Level& level, double threshold) {
    std::size_t passing = 0;
    for (const AnyImage& image : images)
        passing += std::visit([&](const auto& i) { return count_passing(i.view(), alpha_channel, threshold); }, image);
    return static_cast<double>(passing) / (double(level.width) * level.height * static_cast<double>(images.size()));
}

/// What the levels are, before they are written.
std::vector<MipsReport::Level> levels_of(const TextureShape& shape, const MipsJob& job) {
    const bool has_files = !container_of_path(job.output);
    std::vector<MipsReport::Level> levels;
    for (int level = 0; level < shape.levels; ++level) {
        MipsReport::Level& l = levels.emplace_back();
        l.width = mip_length(shape.width, level), l.height = mip_length(shape.height, level);
        l.bytes = shape.image_bytes(level) * static_cast<std::uint64_t>(shape.layers * shape.faces());
        if (has_files) l.file = path_of_level(job.output, level);
    }
    return levels;
}

/// Fills in what is made, in a container unless `images` says how images store it.
void describe(const TextureShape& shape, const MipsJob& job, const std::optional<LevelFormat>& images,
              MipsReport& report) {
    report.layers = shape.layers, report.faces = shape.faces();
    report.channels = images ? images->channels : shape.format.channels;
    report.depth = images ? images->depth : shape.format.depth;
    report.is_srgb = images ? images->transfer == Transfer::srgb : shape.format.srgb;
    report.is_premultiplied = !images && shape.format.premultiplied;
    report.levels = levels_of(shape, job);
}

/// Writes `texture`.
void write(const MipsJob& job, const Texture& texture, const std::optional<LevelFormat>& images, int threads,
           MipsReport& report) {
    if (images) {
        write_level_images(job.output, texture, *images, threads);
        report.format = abilities_of(job.output).name;
    } else {
        write_texture(job.output, texture);
        report.format = texture_info(job.output).format;
    }
}

/// Levels as they are, into another kind of file.
MipsReport copy_levels(const MipsJob& job, int threads) {
    const std::string& path = job.inputs.front();
    if (!picture_info(path).texture)
        fail_file(path, "is an image, which has no levels to keep; make them, instead of keeping them");
    Stopwatch watch;
    MipsReport report;
    const Texture texture = watch.time(report.read, [&] { return read_texture(path); });
    std::optional<LevelFormat> images;
    if (!container_of_path(job.output)) {
        if (texture.levels.front().size() > 1)
            fail_file(path, "holds ", texture.levels.front().size(),
                      " layers and faces, and an image holds one; write a .ktx2 or .dds file");
        images = LevelFormat{texture.format.channels, nearest_depth(abilities_of(job.output), texture.format.depth),
                             texture.format.srgb ? Transfer::srgb : Transfer::linear, !texture.format.srgb};
    }
    describe(texture.shape(), job, images, report);
    watch.time(report.write, [&] { write(job, texture, images, threads, report); });
    return report;
}

/// Whether the levels can be made while the one picture is read.
bool goes_by_rows(const MipsJob& job, const Inputs& in, const TexelFormat& texels, const MipOptions& options) {
    return container_of_path(job.output) && in.infos.size() == 1 && !in.infos.front().texture &&
           in.channels <= texels.channels && MipStream::is_possible(options, in.channels);
}

/// The same as make_texture(), by rows.
void make_by_rows(const MipsJob& job, const TexelFormat& texels, const MipOptions& options, const Context& context,
                  MipsReport& report) {
    const Shares shares = shares_of(context.parallel);
    ImageReader reader(job.inputs.front(), shares.codecs.threads);
    const ImageInfo& info = reader.info();
    const MipsStreamReport stream =
        stream_texture(reader, encoding_of_image(info, options.role, job.recipe.space), texels, options, job.is_array,
                       job.output, *container_of_path(job.output), shares.stages, context.progress);
    TextureShape shape{texels, info.width, info.height};
    shape.levels = options.levels > 0 ? options.levels : mip_count(info.width, info.height);
    describe(shape, job, {}, report);
    report.format = texture_info(job.output).format;
    report.lost_non_finite = stream.lost_non_finite;
    report.read += stream.read, report.filter = stream.filter, report.write = stream.write;
}

/// Pictures, texture, and what is between them: levels as floats, a row of them or all, and the moments of normals.
MipsCost cost_of(const Inputs& in, const TexelFormat& texels, const MipsRecipe& recipe, bool by_rows) {
    const auto pixels = static_cast<std::uint64_t>(in.width) * static_cast<std::uint64_t>(in.height);
    const auto images = static_cast<std::uint64_t>(in.layers) * static_cast<std::uint64_t>(in.faces);
    const std::uint64_t source = static_cast<std::uint64_t>(in.channels) * size_of(in.depth);
    const std::uint64_t stored = static_cast<std::uint64_t>(texels.channels) * size_of(texels.depth);
    const std::uint64_t floats = sizeof(float) * static_cast<std::uint64_t>(texels.channels * in.faces);
    const std::uint64_t moments = recipe.normal.empty() ? 0 : 8 * sizeof(float);
    constexpr std::uint64_t codec = 32 << 20;
    if (by_rows) {  // bands of the picture and of the levels, as stream_texture() says
        const int most = recipe.edge_y == Edge::wrap ? in.height : 600;  // the first rows need the last ones
        const auto rows = static_cast<std::uint64_t>(std::min(in.height, most));
        return {pixels, rows * static_cast<std::uint64_t>(in.width) * (source + stored + floats) + codec};
    }
    return {pixels * images, pixels * (images * (source + stored + stored / 3 + 1) + floats + moments) + codec};
}

}  // namespace

void check_job(const MipsJob& job) {
    const bool is_texture = container_of_path(job.output).has_value();
    if (!is_texture) check_level_pattern(job.output);
    if (job.keep_levels && job.inputs.size() != 1)
        throw OptionError("keep-levels", message(job.inputs.size(), " inputs; give the one texture to copy from"));
    if (job.inputs.size() > 1 && !job.is_cube && !job.is_array)
        fail("mips: ", job.inputs.size(),
             " inputs make one texture only as an array or a cube; choose one of these, or "
             "make a batch of a directory");
    if (job.is_cube && (job.inputs.size() % cube_faces != 0 || (!job.is_array && job.inputs.size() != cube_faces)))
        throw OptionError("cube", message(job.inputs.size(), " inputs; give the six faces +x -x +y -y +z -z",
                                          job.is_array ? " of every layer" : ""));
    if (job.is_cube && !job.recipe.normal.empty())
        throw OptionError("normal", "six faces have no one map of normals; leave it out for a cube");
    if (job.is_cube && job.recipe.edge_x)
        throw OptionError("edge", "what lies beyond a face of a cube is its neighbour; leave it out for a cube");
    check_recipe(job.recipe, choose_role(job.recipe, job.inputs.front(), false).role);
    if (is_texture) return;
    const auto refuse = [&](bool is_given, const std::string& option) {
        if (is_given)
            throw OptionError(option, job.output + " names images, which cannot hold that; write a .ktx2 or .dds file");
    };
    refuse(job.is_cube, "cube");
    refuse(job.is_array, "array");
    refuse(job.recipe.channels != 0, "channels");
    refuse(job.recipe.two_channel, "two-channel");
    refuse(job.recipe.premultiplied, "premultiplied");
}

std::vector<std::string> notes_of(const MipsReport& report, const std::string& path) {
    std::vector<std::string> notes;
    if (report.has_foreign_profile)
        notes.push_back(path + " has an ICC profile that is not sRGB: its curve is treated as sRGB");
    if (report.lost_non_finite) notes.push_back(path + " holds NaN or infinite values; they became 0");
    return notes;
}

MipsCost cost_of(const MipsJob& job) {
    const Inputs in = inputs_of(job);
    const RoleChoice choice = choose_role(job.recipe, job.inputs.front(), in.is_linear);
    const Target target = target_of(job, in, choice.role);
    return cost_of(in, target.texels, job.recipe,
                   goes_by_rows(job, in, target.texels, options_of(job.recipe, choice.role)));
}

MipsReport make_texture(const MipsJob& job, const Context& context) {
    const Parallel& parallel = context.parallel;
    const bool has_files = !container_of_path(job.output);
    check_output_path(has_files ? path_of_level(job.output, 0) : job.output);
    if (job.keep_levels) return copy_levels(job, parallel.threads);
    Stopwatch watch;
    MipsReport report;
    const Inputs in = watch.time(report.read, [&] { return inputs_of(job); });
    report.role = choose_role(job.recipe, job.inputs.front(), in.is_linear);
    report.has_foreign_profile = in.has_foreign_profile;
    const Role role = report.role->role;
    check_recipe(job.recipe, role);
    if (has_files && in.layers * in.faces > 1)
        fail_file(job.inputs.front(), "holds ", in.layers * in.faces,
                  " layers and faces, and an image holds one; write a .ktx2 or .dds file");
    const Target target = target_of(job, in, role);
    MipOptions options = options_of(job.recipe, role);
    report.filter_x = name_of(options.filter, in.width), report.filter_y = name_of(options.filter, in.height);
    report.edge_x = options.edge_x, report.edge_y = options.edge_y;
    if (goes_by_rows(job, in, target.texels, options)) {
        make_by_rows(job, target.texels, options, context, report);
        return report;
    }
    require_memory(cost_of(in, target.texels, job.recipe, false).bytes,
                   fmt::format("making the levels of {} x {} texels", in.width, in.height));

    std::vector<TexturePicture> pictures, normals;
    watch.time(report.read, [&] {
        for (const std::string& path : job.inputs)
            read_texture_pictures(path, role, job.recipe.space, parallel.threads, pictures);
        if (!job.recipe.normal.empty())
            read_texture_pictures(job.recipe.normal, Role::normal, Space::automatic, parallel.threads, normals);
    });
    if (!normals.empty()) options.normals = samples_of(normals.front(), 4, Role::normal);
    const Texture texture = watch.time(report.filter, [&] {
        return filter(job, in, std::move(pictures), target.texels, options, parallel, report.lost_non_finite);
    });
    describe(texture.shape(), job, target.images, report);
    if (role == Role::alpha_tested)
        for (std::size_t level = 0; level < report.levels.size(); ++level)
            report.levels[level].coverage =
                coverage_of(texture.levels[level], report.levels[level], options.alpha_threshold);
    watch.time(report.write, [&] { write(job, texture, target.images, parallel.threads, report); });
    return report;
}

}  // namespace bandlimit::job
