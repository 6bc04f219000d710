#include "bandlimit/shader/wgpu_test.h"

#include <cstring>
#include <stdexcept>

#include "bandlimit/core/error.h"
#include "bandlimit/shader/compilers_test.h"

namespace bandlimit::test {
namespace {

const std::filesystem::path python = std::filesystem::path(BANDLIMIT_SHADER_TOOLS) / "bin" / "python3";

const char* address_mode(Edge edge) {
    if (edge == Edge::wrap) return "repeat";
    return edge == Edge::reflect ? "mirror-repeat" : "clamp-to-edge";
}

template <class T>
std::vector<T> values_of(const std::string& bytes) {
    std::vector<T> out(bytes.size() / sizeof(T));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
    return out;
}

}  // namespace

std::string missing_wgpu() {
    std::error_code none;
    if (!std::filesystem::exists(python, none)) return "no wgpu in " BANDLIMIT_SHADER_TOOLS ": run scripts/setup";
    return "";
}

std::vector<std::vector<float>> run_by_wgpu(const std::vector<WgpuJob>& jobs) {
    const Folder folder;
    std::string list;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const Dispatch& d = jobs[i].dispatch;
        write_text(folder / message(i, ".wgsl"), jobs[i].shader);
        std::string textures, sizes;
        for (std::size_t t = 0; t < d.textures.size(); ++t) {
            const bool is_fed_back = static_cast<int>(t) == jobs[i].feedback;
            const std::string name = is_fed_back ? message(i - 1, ".out") : message(i, "-", t);
            if (!is_fed_back) write_text(folder / name, bytes_of(*d.textures[t], d.loads_floats));
            textures += message(t == 0 ? "" : ", ", '"', name, '"');
            sizes += message(t == 0 ? "[" : ", [", d.textures[t]->width, ", ", d.textures[t]->height, "]");
        }
        list += message(i == 0 ? "" : ",\n", R"({"shader": ")", i, R"(.wgsl", "entry": ")", d.entry,
                        R"(", "textures": [)", textures, R"(], "texture_sizes": [)", sizes, R"(], "floats": )",
                        d.loads_floats ? "true" : "false", R"(, "address": ")", address_mode(d.edge), R"(", "size": [)",
                        d.width, ", ", d.height, R"(], "groups": [)", d.groups_x, ", ", d.groups_y, R"(], "format": ")",
                        d.half_result ? "rgba16float" : "rgba32float", R"(", "output": ")", i, R"(.out"})");
    }
    write_text(folder / "jobs.json", "[" + list + "]\n");
    run_command("GALLIVM_PERF=nopt LP_NATIVE_VECTOR_WIDTH=128 WGPU_BACKEND_TYPE=Vulkan " + python.string() + " " +
                BANDLIMIT_SHADER_TESTS "/wgpu_test.py " + (folder / "").string());
    std::vector<std::vector<float>> results;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::string bytes = read_text(folder / message(i, ".out"));
        if (!jobs[i].dispatch.half_result) {
            results.push_back(values_of<float>(bytes));
            continue;
        }
        results.emplace_back();
        for (const Half h : values_of<Half>(bytes)) results.back().push_back(to_float(h));
    }
    return results;
}

}  // namespace bandlimit::test
