#include "bandlimit/shader/library_test.h"

#include <dlfcn.h>

#include <stdexcept>

#include "bandlimit/core/error.h"

namespace bandlimit::test {
namespace {

/// A texture as the library sees it.
struct Source {
    const Picture* picture;
    Edge edge;
    int bits;
    void (*sample)(const Source*, float, float, float*);
    void (*load)(const Source*, int, int, float*);
};

void put(const Colour& colour, float* out) {
    for (std::size_t c = 0; c < 4; ++c) out[c] = static_cast<float>(colour[c]);
}

void sample(const Source* s, float u, float v, float* out) {
    const Picture& p = *s->picture;
    put(bilinear(p, s->edge, static_cast<double>(u) * p.width, static_cast<double>(v) * p.height, s->bits), out);
}

void load(const Source* s, int x, int y, float* out) {
    const bool inside = x >= 0 && y >= 0 && x < s->picture->width && y < s->picture->height;
    if (!inside) throw std::logic_error("a load outside the texture");
    put(s->picture->texel(x, y, Edge::zero), out);
}

/// The same in the library, without our types.
constexpr const char* texture_class = R"(
struct Source {
    const void* picture;
    int edge, bits;
    void (*read)(const Source*, float, float, float*);
    void (*read_texel)(const Source*, int, int, float*);
    bandlimit_shader::float4 sample(bandlimit_shader::float2 uv) const {
        float v[4];
        read(this, uv.x, uv.y, v);
        return {v[0], v[1], v[2], v[3]};
    }
    bandlimit_shader::float4 load(bandlimit_shader::int2 at) const {
        float v[4];
        read_texel(this, at.x, at.y, v);
        return {v[0], v[1], v[2], v[3]};
    }
};
)";

/// What emitted Metal uses of Metal's library.
constexpr const char* metal_library = R"(
#define kernel
#define constant static const
#define threadgroup static
namespace metal {
using namespace bandlimit_shader;
using uint = unsigned;
struct uint2 {
    int x, y;
    uint2(int x_, int y_) : x(x_), y(y_) {}
    explicit uint2(int2 v) : x(v.x), y(v.y) {}
    explicit operator int2() const { return {x, y}; }
};
struct sampler {};
struct level {
    explicit level(float) {}
};
enum class access { sample, write };
template <class T, access = access::sample>
struct texture2d : ::Source {
    float4 sample(sampler, float2 uv, level) const { return ::Source::sample(uv); }
    float4 read(uint2 at) const { return load(int2(at.x, at.y)); }
    void write(float4, uint2) const {}
    int get_width() const { return 1; }
    int get_height() const { return 1; }
};
enum class mem_flags { mem_threadgroup };
inline void threadgroup_barrier(mem_flags) {}
}  // namespace metal
)";

std::string evaluation(Dialect dialect, const std::vector<std::string>& calls) {
    const bool metal = dialect == Dialect::msl;
    std::string text = metal ? "using Texture = texture2d<float>;\n" : "using Texture = Source;\n";
    text +=
        "extern \"C\" void evaluate(int call, const void* const* textures, float u, float v, float tx, float ty, "
        "float* out) {\n"
        "    const auto texture = [&](int i) -> const Texture& { return *static_cast<const Texture*>(textures[i]); };\n"
        "    [[maybe_unused]] const Texture& source = texture(0);\n"
        "    [[maybe_unused]] const Texture& other = texture(1);\n    using namespace bandlimit_shader;\n"
        "    [[maybe_unused]] const float2 uv(u, v), texel(tx, ty);\n    float4 value;\n";
    if (metal) text += "    [[maybe_unused]] const sampler source_sampler;\n";
    for (std::size_t i = 0; i < calls.size(); ++i)
        text += message("    if (call == ", i, ") value = ", calls[i], ";\n");
    return text + "    out[0] = value.x, out[1] = value.y, out[2] = value.z, out[3] = value.w;\n}\n";
}

}  // namespace

Library::Library(Dialect dialect, const std::string& functions, const std::vector<std::string>& calls) {
    const std::string types = in_context("", Dialect::cpp) + texture_class;
    if (dialect == Dialect::msl)
        write_text(folder_ / "metal_stdlib", "#ifndef METAL\n#define METAL\n" + types + metal_library + "#endif\n");
    const std::string before = dialect == Dialect::msl ? "" : types;
    write_text(folder_ / "library.cpp", before + functions + evaluation(dialect, calls));
    const std::string library = (folder_ / "library.so").string();
    run_command(message(BANDLIMIT_CXX " -O0 -shared -fPIC -Wall -Wextra -Wconversion -Wno-attributes -Werror ",
                        dialect == Dialect::msl ? "-std=c++17 -Wno-unused" : "-std=c++20", " -I ",
                        (folder_ / "").string(), " -o ", library, " ", (folder_ / "library.cpp").string()));
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) throw std::runtime_error(dlerror());
    evaluate_ = reinterpret_cast<decltype(evaluate_)>(dlsym(handle, "evaluate"));
}

Colour Library::operator()(int call, const std::vector<const Picture*>& textures, Edge edge, int bits, float u,
                           float v) const {
    std::vector<Source> sources;
    for (const Picture* picture : textures) sources.push_back({picture, edge, bits, sample, load});
    std::vector<const void*> pointers;
    for (const Source& source : sources) pointers.push_back(&source);
    float out[4];
    evaluate_(call, pointers.data(), u, v, 1 / static_cast<float>(textures[0]->width),
              1 / static_cast<float>(textures[0]->height), out);
    return {out[0], out[1], out[2], out[3]};
}

Colour Library::operator()(int call, const Picture& source, const Picture& other, Edge edge, int bits, float u,
                           float v) const {
    return (*this)(call, {&source, &other}, edge, bits, u, v);
}

}  // namespace bandlimit::test
