// Measures kernels and holds the tables of docs/kernels.md to what comes out. It prints them, so that a change of a
// kernel is a change of that page:
//   build/release/tests/apps --gtest_filter=KernelTables.*
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/zone_plate_test.h"
#include "bandlimit/core/sanitized_test.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit {
namespace {

using Row = std::vector<double>;

std::vector<Kernel> contenders() {
    return {box(),      mitchell(), catmull_rom(), magic_sharp_2013(), magic_sharp_2021(), kaiser(3, 2), kaiser(3, 3),
            lanczos(3), shrink3(),  grow3(),       lanczos(4)};
}

double decibels(double ratio) { return 10 * std::log10(ratio); }

/// Mean square of `image` where `counts(frequency)`: the larger of the frequencies of the plate along the two axes, in
/// cycles per pitch of the coarser grid; without the border.
template <class Counts>
double mean_square(View<const float> image, const plate::Case& c, Counts counts) {
    double sum = 0, n = 0;
    for (int y = c.border(); y < c.size - c.border(); ++y)
        for (int x = c.border(); x < c.size - c.border(); ++x) {
            const auto frequency = [&](int i) {
                return std::abs((i + 0.5) * c.step() - plate::size / 2.0) / plate::size * std::max(1.0, c.step());
            };
            if (!counts(std::max(frequency(x), frequency(y)))) continue;
            const double v = static_cast<double>(image(x, y));
            sum += v * v, ++n;
        }
    return sum / n;
}

Image<float> difference(View<const float> a, View<const float> b) {
    Image<float> out(a.width, a.height, a.channels);
    for (int c = 0; c < a.channels; ++c)
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x) out.view()(x, y, c) = a(x, y, c) - b(x, y, c);
    return out;
}

/// What an enlarged plate holds above the Nyquist frequency of its source: what an ideal low-pass takes away.
Image<float> replicas(View<const float> enlarged) {
    Kernel low_pass = plate::brick_wall();
    low_pass.radius *= 2;
    low_pass.value = [narrow = low_pass.value](double x) { return narrow(x / 2); };
    const Image<float> below =
        resample(enlarged, enlarged.width, enlarged.height, {.reconstruction = low_pass, .edge = Edge::reflect});
    return difference(enlarged, below.view());
}

/// PSNR, error below 0.7 of the Nyquist frequency, and what is left above 1.25 of it (replicas where it grows).
Row on_plate(const plate::Case& c, const Kernel& kernel, View<const float> exact) {
    const Image<float> out = plate::resized(c, kernel), error = difference(out.view(), exact);
    const double pass = mean_square(error.view(), c, [](double f) { return f < 0.7 * 0.5; });
    Image<float> flat(c.size, c.size);
    for (int y = 0; y < c.size; ++y)
        for (int x = 0; x < c.size; ++x) flat.view()(x, y) = 0.5f;
    const double alias = c.step() < 1 ? mean_square(replicas(out.view()).view(), c, [](double) { return true; })
                                      : mean_square(difference(out.view(), flat.view()).view(), c,
                                                    [](double f) { return f > 1.25 * 0.5; });
    return {psnr(out.view(), exact, c.border()), decibels(pass / plate::power), decibels(alias / plate::power)};
}

Image<float> resized(View<const float> image, int width, int height, const Kernel& kernel) {
    return resample(image, width, height, {.reconstruction = kernel, .edge = Edge::reflect});
}

Image<float> photograph(const std::string& name) {
    ImageReader reader(std::string(BANDLIMIT_EXAMPLES "/") + name + ".png");
    const ImageInfo& info = reader.info();
    Image<float> image(info.width, info.height, info.channels(), Layout::interleaved);
    AnyImage stored = make_image(info.depth, info.width, info.height, info.channels());
    reader.read_rows(0, view_of(stored));
    const auto length = static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.channels());
    for (int y = 0; y < info.height; ++y)
        decode_row(const_view(view_of(stored)), y, info.encoding(Space::automatic), false,
                   {&image.view()(0, y), length});
    return image;
}

/// The star and the photographs, linear light.
const std::vector<Image<float>>& pictures() {
    static const std::vector<Image<float>> all = [] {
        std::vector<Image<float>> images;
        images.push_back(render(with_range(siemens_star({512, 512}, {.spokes = 72}), 0.05, 0.95), 512, 512,
                                Sampling::supersampled(box(), 8)));
        for (const char* name : {"chelsea", "coffee", "gravel"}) images.push_back(photograph(name));
        return images;
    }();
    return all;
}

int border(View<const float> v) { return static_cast<int>(std::lround(std::min(v.width, v.height) * 0.05)); }

double quality(View<const float> a, View<const float> b) { return psnr(a, b, border(a)); }

int smaller(int size, double factor) { return static_cast<int>(std::lround(size / factor)); }

/// By how much the answer to a step exceeds it, by this factor, at worst: over positions in parts of 1 / 1000 of a
/// pitch.
double overshoot(const Kernel& kernel, int factor) {
    double worst = 0;
    const int reach = static_cast<int>(std::ceil(kernel.radius)) * factor;
    for (int p = 0; p < 1000 / factor; ++p) {
        double sum = 0, highest = 0;
        for (int j = -reach; j <= reach; ++j) {
            sum += kernel.value((j + p * factor / 1000.0) / factor);
            highest = std::max(highest, sum);
        }
        worst = std::max(worst, highest / sum - 1);
    }
    return 100 * worst;
}

/// A table of the page: a row of numbers per kernel.
struct Table {
    std::string title;
    int decimals = 2;
    std::map<std::string, Row> rows;
};

std::string line_of(const std::string& name, const Row& row, int decimals) {
    std::string line = "| `" + name + "` |";
    for (const double v : row) line += fmt::format(" {:.{}f} |", v, decimals);
    return line;
}

/// The tables of the page by their headings ("### ..."), as far as their rows begin with a kernel in backquotes.
std::map<std::string, std::map<std::string, Row>> documented() {
    std::ifstream page(BANDLIMIT_EXAMPLES "/../docs/kernels.md");
    std::map<std::string, std::map<std::string, Row>> tables;
    std::string title;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("### ")) title = line.substr(4);
        if (!line.starts_with("| `")) continue;
        const auto end = line.find('`', 3);
        std::istringstream cells(line.substr(line.find('|', end) + 1));
        for (std::string cell; std::getline(cells, cell, '|');)
            if (cell.find_first_of("0123456789") != std::string::npos)
                tables[title][line.substr(3, end - 3)].push_back(std::atof(cell.c_str()));
    }
    return tables;
}

void expect_documented(const Table& table) {
    std::cout << "\n### " << table.title << '\n';
    for (const Kernel& kernel : contenders())
        std::cout << line_of(kernel.name, table.rows.at(kernel.name), table.decimals) << '\n';
    const auto page = documented();
    ASSERT_TRUE(page.contains(table.title)) << table.title;
    for (const auto& [name, row] : table.rows) {
        ASSERT_TRUE(page.at(table.title).contains(name)) << table.title << ": " << name;
        const Row& shown = page.at(table.title).at(name);
        ASSERT_EQ(shown.size(), row.size()) << table.title << ": " << name;
        // Half a unit of the last digit shown, and what instruction sets without fused multiply-add change.
        for (std::size_t i = 0; i < row.size(); ++i)
            EXPECT_NEAR(shown[i], row[i], 0.51 * std::pow(10, -table.decimals)) << table.title << ": " << name;
    }
}

TEST(KernelTables, ZonePlate) {
    if (is_sanitized) GTEST_SKIP() << "numbers alone, of half a minute; the other tables run the same code";
    for (const plate::Case& c : {plate::halve, plate::by_3_7, plate::twice}) {
        const Image<float> exact = plate::ideal(c);
        Table table{std::string("Zone plate ") + c.name, 2, {}};
        for (const Kernel& kernel : contenders()) table.rows[kernel.name] = on_plate(c, kernel, exact.view());
        expect_documented(table);
    }
}

TEST(KernelTables, PicturesThatShrink) {
    Table table{"Pictures that shrink", 2, {}};
    for (const double factor : {2.0, 3.7})
        for (const Image<float>& picture : pictures()) {
            const int w = smaller(picture.width(), factor), h = smaller(picture.height(), factor);
            const Image<float> exact = resized(picture.view(), w, h, plate::brick_wall());
            for (const Kernel& kernel : contenders())
                table.rows[kernel.name].push_back(quality(resized(picture.view(), w, h, kernel).view(), exact.view()));
        }
    expect_documented(table);
    const auto &ours = table.rows.at("shrink3"), &lanczos3 = table.rows.at("lanczos3");
    for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_GT(ours[i], lanczos3[i]) << i;
}

TEST(KernelTables, PicturesThatGrow) {
    Table table{"Pictures that grow", 2, {}};
    for (const Image<float>& picture : pictures()) {
        const int w = picture.width(), h = picture.height();
        const Image<float> small = resized(picture.view(), smaller(w, 2), smaller(h, 2), plate::brick_wall());
        for (const int times : {1, 2}) {
            const Image<float> exact = resized(small.view(), times * w, times * h, plate::brick_wall());
            for (const Kernel& kernel : contenders()) {
                const Image<float> out = resized(small.view(), times * w, times * h, kernel);
                table.rows[kernel.name].push_back(quality(out.view(), exact.view()));
                if (times == 1) table.rows[kernel.name].push_back(quality(out.view(), picture.view()));
            }
        }
    }
    expect_documented(table);
    const auto &ours = table.rows.at("grow3"), &lanczos3 = table.rows.at("lanczos3");
    for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_GT(ours[i], lanczos3[i]) << i;
}

TEST(KernelTables, RingingAndResponse) {
    Table table{"Ringing and response", 1, {}};
    for (const Kernel& kernel : contenders())
        table.rows[kernel.name] = {2 * kernel.radius,
                                   overshoot(kernel, 1),
                                   overshoot(kernel, 2),
                                   overshoot(kernel, 50),
                                   100 * passband_ripple(kernel, 0.35),
                                   20 * std::log10(stopband_leakage(kernel, 0.625, 4))};
    expect_documented(table);
}

}  // namespace
}  // namespace bandlimit
