// Mip maps: light, coverage, normals, and what a moving camera sees.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/metrics.h"
#include "bandlimit/job/make_texture.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/signal/render.h"

namespace bandlimit::app {
namespace {

using job::MipsJob;
using job::MipsRecipe;

MipsRecipe recipe_of(Role role, Edge edge = Edge::renormalize) {
    MipsRecipe recipe;
    recipe.role = role;
    recipe.edge_x = recipe.edge_y = edge;
    return recipe;
}

/// Runs what "bandlimit mips IN OUT" with the options of `recipe` runs, in the directory of the page.
void make_levels(const Tour& tour, const std::string& in, const std::string& out, const MipsRecipe& recipe) {
    MipsJob job;
    job.inputs = {tour.path(in)}, job.output = tour.path(out), job.recipe = recipe;
    make_texture(job, {.parallel = tour.parallel});
}

std::string level_file(const std::string& stem, int level) { return fmt::format("{}_{}.png", stem, level); }

Image<float> read_level(const Tour& tour, const std::string& stem, int level, Space space = Space::automatic) {
    return job::read_picture(tour.path(level_file(stem, level)), space, tour.parallel);
}

void light_part(Tour& tour) {
    tour.page.section("Mip maps, averaged as light and as codes",
                      "A texture of sRGB codes must be decoded before it is averaged. Averages of codes lose light at "
                      "every level where the texture has contrast, so a surface grows darker with its distance.",
                      {"J. Novak", "What every coder should know about gamma", "blog.johnnovak.net", "2016"});
    make_levels(tour, "gravel.png", "gravel-light_%d.png", recipe_of(Role::color));
    make_levels(tour, "gravel.png", "gravel-codes_%d.png", recipe_of(Role::data));
    const double before = job::mean_of(read_level(tour, "gravel-light", 0).view(), 0);
    std::vector<std::vector<std::string>> rows{{"level", "size", "mean light, role color", "averaged as codes"}};
    const auto change = [&](const std::string& stem, int level) {
        return fmt::format("{:+.2f} %", 100 * (job::mean_of(read_level(tour, stem, level).view(), 0) / before - 1));
    };
    for (int level = 1; level < 9; level += 1)
        rows.push_back({fmt::format("{}", level), fmt::format("{0} x {0}", 512 >> level), change("gravel-light", level),
                        change("gravel-codes", level)});
    const std::string command =
        "bandlimit mips gravel.png gravel-light_%d.png\nbandlimit mips gravel.png gravel-codes_%d.png --role data";
    tour.page.gallery(
        {{level_file("gravel-light", 4), "level 4, as light"}, {level_file("gravel-codes", 4), "level 4, as codes"}},
        "Gravel at a sixteenth of its size.", command, 256);
    tour.page.table(rows, "The mean light of each level relative to level 0.", command);
    tour.page.headline("mean light of mip level 4 of a photograph, as light / as codes",
                       change("gravel-light", 4) + " / " + change("gravel-codes", 4));
}

/// Blades of grass, 256 x 256: opaque or transparent, except at their borders. Transparent texels are magenta, as a
/// painting program may leave it.
Image<float> grass() {
    constexpr int size = 256, blades = 60;
    Image<float> image(size, size, 4, Layout::interleaved);
    const View<float> v = image.view();
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) v(x, y, 0) = v(x, y, 2) = 1;
    Random random(7);
    for (int i = 0; i < blades; ++i) {
        const double foot = random.uniform(0, size), lean = random.uniform(-90, 90), height = random.uniform(90, 235);
        const double half_width = random.uniform(0.5, 1.9), shade = random.uniform(0.35, 1);
        for (int y = std::max(0, size - static_cast<int>(height)); y < size; ++y) {
            const double t = (size - y) / height, middle = foot + lean * t * t, half = half_width * (1 - t) + 0.2;
            for (int x = 0; x < size; ++x) {
                const double alpha = std::clamp(half + 0.5 - std::abs(x + 0.5 - middle), 0.0, 1.0);
                if (alpha <= 0) continue;
                const double color[3] = {0.12 * shade, 0.42 * shade, 0.04 * shade};
                for (int c = 0; c < 3; ++c) v(x, y, c) = static_cast<float>(color[c]);
                v(x, y, 3) = std::max(v(x, y, 3), static_cast<float>(alpha));
            }
        }
    }
    return image;
}

/// What an alpha test at 1/2 lets through, in white.
void write_passing(const Tour& tour, const std::string& stem, int level) {
    const Image<float> picture = read_level(tour, stem, level);
    Image<float> passing(picture.width(), picture.height());
    const View<float> to = passing.view();
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) to(x, y) = picture.view()(x, y, 3) >= 0.5f ? 1.0f : 0.0f;
    job::write_picture(tour.path(level_file(stem + "-passing", level)), passing.view());
}

double passing_share(const Tour& tour, const std::string& stem, int level) {
    const Image<float> picture = read_level(tour, stem, level);
    int count = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) count += picture.view()(x, y, 3) >= 0.5f;
    return 100.0 * count / picture.width() / picture.height();
}

void alpha_part(Tour& tour) {
    tour.page.section("Leaves: colour that bleeds, and coverage that fades",
                      "Transparent texels hold some colour that nobody painted. Averaged with equal weights it bleeds; "
                      "weighted by alpha it does not. And an alpha test on averages passes fewer and fewer texels of "
                      "thin shapes, so that grass vanishes in the distance: alpha-tested scales the alpha "
                      "of each level until as many pass as at level 0.",
                      {"I. Castano", "Computing alpha mipmaps", "the-witness.net", "2010"});
    job::write_picture(tour.path("grass.png"), grass().view());
    make_levels(tour, "grass.png", "grass-data_%d.png", recipe_of(Role::data));
    make_levels(tour, "grass.png", "grass-color_%d.png", recipe_of(Role::color));
    make_levels(tour, "grass.png", "grass-tested_%d.png", recipe_of(Role::alpha_tested));
    tour.page.gallery({{"grass.png", "level 0"},
                       {level_file("grass-data", 2), "level 2, equal weights"},
                       {level_file("grass-color", 2), "level 2, weighted by alpha"}},
                      "Grass whose transparent texels are magenta. With equal weights the magenta bleeds.",
                      "bandlimit mips grass.png grass-data_%d.png --role data\nbandlimit mips grass.png "
                      "grass-color_%d.png --role color",
                      256);
    std::vector<Page::Tile> tiles;
    std::vector<std::vector<std::string>> rows{{"level", "role color", "role alpha-tested"}};
    for (int level = 0; level < 6; ++level) {
        const double plain = passing_share(tour, "grass-color", level),
                     kept = passing_share(tour, "grass-tested", level);
        rows.push_back({fmt::format("{}", level), fmt::format("{:.2f} %", plain), fmt::format("{:.2f} %", kept)});
        if (level != 3) continue;
        for (const char* stem : {"grass-color", "grass-tested"}) write_passing(tour, stem, level);
        tiles = {{level_file("grass-color-passing", level), fmt::format("level 3, color: {:.1f} % pass", plain)},
                 {level_file("grass-tested-passing", level), fmt::format("level 3, alpha-tested: {:.1f} %", kept)}};
        tour.page.headline("texels of grass that pass an alpha test at level 3, color / alpha-tested",
                           fmt::format("{:.1f} % / {:.1f} %", plain, kept));
    }
    const std::string command =
        "bandlimit mips grass.png grass-tested_%d.png --role alpha-tested --alpha-threshold 0.5";
    tour.page.gallery(tiles, "What an alpha test at 1/2 passes.", command, 256);
    tour.page.table(rows, "The share of texels that pass.", command);
}

using Vector = std::array<double, 3>;

Vector unit(Vector v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

constexpr int bumps_size = 512, bumps_level = 4;

/// The normal map of a rough surface, as codes in [0, 1]; periodic.
Image<float> bumps() {
    const Signal height = band_limited_noise(bumps_size, bumps_size, {.seed = 3, .cutoff = 0.2, .rms = 0.42});
    Image<float> normals(bumps_size, bumps_size, 3, Layout::interleaved);
    const View<float> v = normals.view();
    const auto at = [&](int x, int y) {
        const auto wrapped = [](int i) { return (i + bumps_size) % bumps_size + 0.5; };
        return height.value(wrapped(x), wrapped(y));
    };
    for (int y = 0; y < bumps_size; ++y)
        for (int x = 0; x < bumps_size; ++x) {
            const Vector n = unit({(at(x - 1, y) - at(x + 1, y)) / 2, (at(x, y - 1) - at(x, y + 1)) / 2, 1});
            for (int c = 0; c < 3; ++c) v(x, y, c) = static_cast<float>((n[static_cast<std::size_t>(c)] + 1) / 2);
        }
    return normals;
}

/// The light that a surface of one roughness reflects to a viewer far above it from a lamp near it: the lobe of
/// Trowbridge and Reitz (GGX) around the half vector, no shadows.
Image<float> shaded(View<const float> normals, View<const float> roughness) {
    Image<float> light(normals.width, normals.height);
    for (int y = 0; y < normals.height; ++y)
        for (int x = 0; x < normals.width; ++x) {
            const Vector n = unit({2.0 * normals(x, y, 0) - 1, 2.0 * normals(x, y, 1) - 1, 2.0 * normals(x, y, 2) - 1});
            const Vector lamp = unit({0.5 - (x + 0.5) / normals.width, 0.5 - (y + 0.5) / normals.height, 0.6});
            const Vector h = unit({lamp[0], lamp[1], lamp[2] + 1});
            const double facing = std::max(0.0, n[0] * lamp[0] + n[1] * lamp[1] + n[2] * lamp[2]);
            const double cosine = std::max(0.0, n[0] * h[0] + n[1] * h[1] + n[2] * h[2]);
            const double alpha2 = std::pow(static_cast<double>(roughness(x, y)), 4);
            const double lobe = alpha2 / (std::numbers::pi * std::pow(cosine * cosine * (alpha2 - 1) + 1, 2));
            light.view()(x, y) = static_cast<float>(0.08 * lobe * facing);
        }
    return light;
}

void normal_part(Tour& tour) {
    tour.page.section(
        "Normals grow smooth, so roughness must grow",
        "A level of a normal map holds unit vectors again, and no longer knows how far the normals below it spread: a "
        "rough "
        "surface becomes a mirror in the distance. The length of their mean tells the spread; role roughness adds it. "
        "The reference shades every texel of level 0 and averages the light.",
        {"M. Toksvig", "Mipmapping normal maps", "Journal of Graphics Tools 10(3)", "2005"});
    Image<float> plain(bumps_size, bumps_size);
    std::fill_n(plain.view().data, bumps_size * bumps_size, 0.3f);
    job::write_data(tour.path("bumps_normal.png"), bumps().view());
    job::write_data(tour.path("bumps_rough.png"), plain.view());
    const std::string command =
        "bandlimit mips bumps_normal.png bumps-normal_%d.png --role normal --edge wrap\nbandlimit mips "
        "bumps_rough.png bumps-rough_%d.png --role roughness --normal bumps_normal.png --edge wrap";
    make_levels(tour, "bumps_normal.png", "bumps-normal_%d.png", recipe_of(Role::normal, Edge::wrap));
    MipsRecipe rough_recipe = recipe_of(Role::roughness, Edge::wrap);
    rough_recipe.normal = tour.path("bumps_normal.png");
    make_levels(tour, "bumps_rough.png", "bumps-rough_%d.png", rough_recipe);
    const auto level = [&](const std::string& stem, int l) { return read_level(tour, stem, l, Space::data); };
    const Image<float> fine = shaded(level("bumps-normal", 0).view(), level("bumps-rough", 0).view());
    const Image<float> normals = level("bumps-normal", bumps_level), grown = level("bumps-rough", bumps_level);
    Image<float> kept(grown.width(), grown.height());
    std::fill_n(kept.view().data, grown.width() * grown.height(), 0.3f);
    const Image<float> reference =
        resample(fine.view(), grown.width(), grown.height(), {.reconstruction = box()}, tour.parallel);
    std::vector<Page::Tile> tiles;
    const auto add = [&](const std::string& name, const Image<float>& image, const std::string& caption) {
        job::write_picture(tour.path("shaded-" + name + ".png"), image.view());
        tiles.push_back({"shaded-" + name + ".png", caption});
        return psnr(image.view(), reference.view(), 0);
    };
    add("reference", reference, "level 0, shaded and then averaged");
    const Image<float> mirror = shaded(normals.view(), kept.view()), rough = shaded(normals.view(), grown.view());
    const double wrong = psnr(mirror.view(), reference.view(), 0), right = psnr(rough.view(), reference.view(), 0);
    add("kept", mirror, fmt::format("level 4, roughness as it was: {:.1f} dB", wrong));
    add("grown", rough, fmt::format("level 4, roughness grown: {:.1f} dB", right));
    tour.page.gallery(tiles, "A bumpy floor under a lamp, at a sixteenth of its size.", command, 256);
    std::vector<std::vector<std::string>> rows{{"level", "mean roughness"}};
    for (int l = 0; l < 8; ++l)
        rows.push_back({fmt::format("{}", l), fmt::format("{:.3f}", job::mean_of(level("bumps-rough", l).view(), 0))});
    tour.page.table(rows, "Roughness level by level; code 77 everywhere at level 0.", command);
    tour.page.headline("a bumpy floor shaded at mip level 4, roughness kept / grown, against the average",
                       fmt::format("{:.1f} dB / {:.1f} dB", wrong, right));
}

/// A striped floor that a camera moves over, seen a column of pixels per frame. Rows are screen
/// rows r below the horizon; there lies texel Z / r of the floor, and a pixel covers Z / r^2 texels.
struct Floor {
    static constexpr int texels = 4096, levels = 7, rows = 192, frames = 640, first_row = 27;
    static constexpr double z = 216.0 * 216.0;  ///< a pixel covers one texel at row 216, and 64 at row 27

    static double position(double row, int frame) { return z / row + 0.75 * frame; }
    static double footprint(double row) { return z / (row * row); }
};

/// Planks of 128 texels, each with waves of its own length, 2.2 to 4 texels.
Image<float> stripes_of_floor() {
    constexpr int plank = 128;
    Image<float> stripes(1, Floor::texels);
    for (int y = 0; y < Floor::texels; ++y) {
        const double length = 2.2 + 1.8 * ((y / plank * 5) % 8) / 7.0;
        stripes.view()(0, y) = static_cast<float>(0.5 + 0.4 * std::cos(2 * std::numbers::pi * (y % plank) / length));
    }
    return stripes;
}

/// The texture at a position in texels of level 0, between the two nearest texels of `level`.
double linear_read(const Image<float>& level, double position) {
    const int n = level.height();
    const double at = position * n / Floor::texels - 0.5, below = std::floor(at);
    const auto texel = [&](double i) {
        return static_cast<double>(level.view()(0, static_cast<int>(i - n * std::floor(i / n))));
    };
    return texel(below) + (at - below) * (texel(below + 1) - texel(below));
}

/// What a graphics processor shows: the levels nearest to the footprint, both read and blended (trilinear).
Image<float> drawn(const std::vector<Image<float>>& levels) {
    Image<float> strip(Floor::frames, Floor::rows);
    for (int y = 0; y < Floor::rows; ++y) {
        const double row = Floor::first_row + y + 0.5, lod = std::max(0.0, std::log2(Floor::footprint(row)));
        const auto finer = static_cast<std::size_t>(lod);
        for (int frame = 0; frame < Floor::frames; ++frame) {
            const double at = Floor::position(row, frame), fine = linear_read(levels[finer], at),
                         coarse = linear_read(levels[finer + 1], at);
            strip.view()(frame, y) = static_cast<float>(fine + (lod - std::floor(lod)) * (coarse - fine));
        }
    }
    return strip;
}

/// What an ideal camera sees: very many samples per pixel behind a long low-pass.
Image<float> seen(const Image<float>& stripes, Parallel parallel) {
    constexpr int samples = 64;
    Image<float> fine(Floor::frames, Floor::rows * samples);
    for (int y = 0; y < fine.height(); ++y) {
        const double row = Floor::first_row + (y + 0.5) / samples;
        for (int frame = 0; frame < Floor::frames; ++frame) {
            const double at = Floor::position(row, frame) / Floor::texels;
            const auto texel = static_cast<int>((at - std::floor(at)) * Floor::texels);
            fine.view()(frame, y) = stripes.view()(0, std::min(texel, Floor::texels - 1));
        }
    }
    return resample(fine.view(), Floor::frames, Floor::rows, {.reconstruction = kaiser(8, 6), .edge = Edge::reflect},
                    parallel);
}

void motion_part(Tour& tour) {
    tour.page.section(
        "A camera moves over a striped floor",
        "Each column is a frame, each row a line of the screen, the horizon above. The floor has planks with waves of "
        "2.2 to 4 texels each, which must turn grey at a distance. Aliases that a box lets into a level return as "
        "broad, drifting waves.",
        {"B. Wronski", "Fast, GPU friendly, antialiasing downsampling filter", "bartwronski.com", "2022"});
    job::write_data(tour.path("floor.png"), stripes_of_floor().view());
    const Image<float> truth = seen(job::read_picture(tour.path("floor.png"), Space::data), tour.parallel);
    std::vector<Page::Tile> tiles;
    std::string quality, command;
    for (const char* filter : {"box", "shrink3"}) {
        const std::string stem = fmt::format("floor-{}", filter);
        MipsRecipe recipe = recipe_of(Role::data, Edge::wrap);
        recipe.filter = filter;
        make_levels(tour, "floor.png", stem + "_%d.png", recipe);
        command += fmt::format("{}bandlimit mips floor.png {}_%d.png --role data --filter {} --edge wrap",
                               command.empty() ? "" : "\n", stem, filter);
        std::vector<Image<float>> levels;
        for (int level = 0; level <= Floor::levels; ++level)
            levels.push_back(read_level(tour, stem, level, Space::data));
        const Image<float> strip = drawn(levels);
        const double decibels = psnr(strip.view(), truth.view(), 8);
        job::write_picture(tour.path(stem + ".png"), strip.view());
        tiles.push_back({stem + ".png", fmt::format("trilinear, mip maps by {}: {:.2f} dB", filter, decibels)});
        quality += fmt::format("{}{:.2f} dB", quality.empty() ? "" : " / ", decibels);
    }
    job::write_picture(tour.path("floor-ideal.png"), truth.view());
    tiles.push_back({"floor-ideal.png", "the ideal camera"});
    tour.page.gallery(tiles, "The floor over 640 frames. The commands make the mip maps.", command, 640);
    tour.page.headline("a striped floor in motion, mip maps by box / shrink3, against an ideal camera", quality);
}

}  // namespace

void tour_mips(Tour& tour) {
    light_part(tour);
    alpha_part(tour);
    normal_part(tour);
    motion_part(tour);
}

}  // namespace bandlimit::app
