#include "apps/emit.h"

#include <filesystem>

#include "apps/common.h"
#include "bandlimit/core/error.h"
#include "bandlimit/design/fold.h"
#include "bandlimit/io/atomic_file.h"

namespace bandlimit::app {

std::vector<ShaderFile> shaders_of(const TapsFile& design, const ShaderInfo& info, Dialect dialect) {
    ShaderParts parts{.fetches = design.fetches, .pieces = design.pieces};
    ShaderInfo named = info;
    parts.terms = design.terms;
    if (parts.terms.empty() && !design.components.empty()) {
        parts.terms =
            separable_terms(design.components, usual_disk_radius, reach_for(design.components, usual_disk_radius));
        named.notes.push_back(message("For a radius of ", usual_disk_radius, " pixels; --radius PX is for others."));
    }
    if (!parts.terms.empty()) {  // as high as the shape; what is pasted shall keep the brightness of pictures
        parts.terms = with_unit_sum(parts.terms);
        named.notes.push_back("Weights below are divided by their sum.");
    }
    if (design.taps) {
        parts.taps = *design.taps;
        // Reads along one axis are the taps in fewer of them; others are a filter of both axes.
        bool are_along_x = !design.fetches.empty();
        for (const Fetch& fetch : design.fetches) are_along_x = are_along_x && fetch.y == 0;
        if (are_along_x) {
            for (const Fetch& fetch : design.fetches) parts.reads.push_back({fetch.x, fetch.weight});
            parts.fetches.clear();
        } else {
            parts.reads = fold(*design.taps);
        }
    }
    if (parts.fetches.empty() && parts.reads.empty() && parts.terms.empty() && parts.pieces.empty())
        throw UsageError("--emit: this design has no weights that a shader could run; leave it out");
    return bandlimit::shaders_of(parts, named, dialect);
}

std::vector<std::string> write_shaders(const TapsFile& design, const ShaderInfo& info,
                                       const std::vector<Dialect>& dialects, const std::string& directory) {
    std::vector<std::string> names;
    for (const Dialect dialect : dialects) {
        for (const ShaderFile& file : shaders_of(design, info, dialect)) {
            AtomicFile out((std::filesystem::path(directory) / file.name).string());
            out.write(file.text.data(), file.text.size());
            out.commit();
            names.push_back(file.name);
        }
    }
    return names;
}

}  // namespace bandlimit::app
