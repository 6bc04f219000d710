#include "bandlimit/job/local_models_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

std::string offset_name(int guide) { return fmt::format("offset.u{}", guide); }

/// What the channels of models are called, in their order.
std::vector<std::string> coefficient_names(int guides, int signals, int order) {
    std::vector<std::string> names;
    for (int s = 0; s < signals; ++s) {
        names.push_back(fmt::format("signal{}.constant", s));
        for (int k = 0; k < guides; ++k) names.push_back(fmt::format("signal{}.u{}", s, k));
        for (int k = 0; order == 2 && k < guides; ++k)
            for (int l = k; l < guides; ++l) names.push_back(fmt::format("signal{}.u{}u{}", s, k, l));
    }
    return names;
}

/// The channels of a file by their names.
using Channels = std::map<std::string, int>;

/// How many of "BEFORE0AFTER", "BEFORE1AFTER", .. there are.
int count_of(const Channels& channels, const std::string& before, const std::string& after) {
    int count = 0;
    while (channels.count(before + std::to_string(count) + after) > 0) ++count;
    return count;
}

}  // namespace

void write_local_models(const std::string& path, const LocalModels& models) {
    if (abilities_of(path).name != "openexr") fail(path, ": only EXR files can hold models; use the extension .exr");
    const View<const float> from = models.coefficients.view();
    ImageTarget target;
    target.width = from.width, target.height = from.height, target.depth = Depth::f32;
    target.transfer = Transfer::linear, target.is_data = true;
    target.channel_names = coefficient_names(models.guides, models.signals, models.order);
    for (int k = 0; k < models.guides; ++k) target.channel_names.push_back(offset_name(k));
    PictureWriter writer(path, target, true);
    Image<float> row(from.width, 1, static_cast<int>(target.channel_names.size()), Layout::interleaved);
    for (int y = 0; y < from.height; ++y) {
        for (int x = 0; x < from.width; ++x) {
            for (int c = 0; c < from.channels; ++c) row.view()(x, 0, c) = from(x, y, c);
            for (int k = 0; k < models.guides; ++k)
                row.view()(x, 0, from.channels + k) =
                    static_cast<float>(models.offsets[static_cast<std::size_t>(k)]);  // they are floats
        }
        writer.write(row.view());
    }
    writer.finish();
}

LocalModels read_local_models(const std::string& path) {
    const ImageInfo info = ImageReader(path).info();
    Channels channels;
    for (int c = 0; c < info.channels(); ++c) channels[info.channel_names[static_cast<std::size_t>(c)]] = c;
    LocalModels models;
    models.guides = count_of(channels, "offset.u", "");
    models.signals = count_of(channels, "signal", ".constant");
    models.order = channels.count("signal0.u0u0") > 0 ? 2 : 1;
    const std::vector<std::string> names = coefficient_names(models.guides, models.signals, models.order);
    const auto is_there = [&](const std::string& name) { return channels.count(name) > 0; };
    if (models.guides < 1 || models.signals < 1 || models.terms() > LocalModels::most_terms ||
        info.depth != Depth::f32 || !std::all_of(names.begin(), names.end(), is_there))
        throw std::runtime_error(path + ": this picture holds no local models; pass a file that they were saved in");
    const Image<float> all = read_codes(path);
    for (int k = 0; k < models.guides; ++k)
        models.offsets.push_back(static_cast<double>(all.view()(0, 0, channels[offset_name(k)])));
    models.coefficients = Image<float>(info.width, info.height, static_cast<int>(names.size()));
    for (int c = 0; c < static_cast<int>(names.size()); ++c)
        for (int y = 0; y < info.height; ++y)
            for (int x = 0; x < info.width; ++x)
                models.coefficients.view()(x, y, c) = all.view()(x, y, channels[names[static_cast<std::size_t>(c)]]);
    return models;
}

}  // namespace bandlimit::job
