#include "bandlimit/job/shaders.h"

#include "bandlimit/job/option_error.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "bandlimit/core/error.h"
#include "bandlimit/design/fold.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/shader/kernels.h"

namespace bandlimit::job {

std::vector<ShaderFile> emit_shaders(const TapsFile& design, const ShaderInfo& info, Dialect dialect) {
    ShaderParts parts{.fetches = design.fetches, .pieces = design.pieces};
    ShaderInfo named = info;
    parts.terms = design.terms;
    if (parts.terms.empty() && !design.components.empty()) {
        parts.terms =
            separable_terms(design.components, usual_disk_radius, reach_for(design.components, usual_disk_radius));
        named.notes.push_back(
            message("For a radius of ", usual_disk_radius, " pixels; pass another radius for others."));
    }
    if (!parts.terms.empty()) {  // as high as the shape; a shader must keep the brightness of pictures
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
        throw Error(
            "emit: this design has no weights that a shader could run; design one that has taps, fetches or terms");
    return shaders_of(parts, named, dialect);
}

std::vector<std::string> write_shaders(const TapsFile& design, const ShaderInfo& info,
                                       const std::vector<Dialect>& dialects, const std::string& directory) {
    std::vector<std::string> names;
    for (const Dialect dialect : dialects) {
        for (const ShaderFile& file : emit_shaders(design, info, dialect)) {
            AtomicFile out((std::filesystem::path(directory) / file.name).string());
            out.write(file.text.data(), file.text.size());
            out.commit();
            names.push_back(file.name);
        }
    }
    return names;
}

std::vector<std::string_view> kernel_shader_names(const std::string& name) {
    const auto shaders = kernel_shaders();
    if (const auto exact = std::ranges::find(shaders, name, &KernelShader::name); exact != shaders.end())
        return {exact->name};
    std::vector<std::string_view> names, all;
    const std::string kernel = parse_kernel(name).name;
    for (const KernelShader& s : shaders) {
        if (s.kernel == kernel) names.push_back(s.name);
        const std::string_view each = s.kernel.empty() ? s.name : s.kernel;
        if (all.empty() || all.back() != each) all.push_back(each);
    }
    if (!names.empty()) return names;
    throw OptionError("emit",
                      fmt::format("there is no shader of {}; there are shaders of {}", name, fmt::join(all, ", ")));
}

}  // namespace bandlimit::job
