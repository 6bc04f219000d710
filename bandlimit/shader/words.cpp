#include "bandlimit/shader/words.h"

#include <algorithm>
#include <array>

namespace bandlimit {
namespace {

// ---- What languages with the syntax of C share

constexpr Word c_calls[] = {
    {"let", "const {0} {1}"},
    {"var", "{0} {1}"},
    {"declare", "{0} {1}"},
    {"structure", "struct {0}"},
    {"field", "{0} {1};"},
    {"function", "{0} {1}({2*})"},
    {"in", "{0} {1}"},
    {"loop", "for (int {0} = {1}; {0} < {2}; {0} += {3})"},
    {"choose", "({0} ? {1} : {2})"},
    {"tile_here", ""},
};

// ---- GLSL: texture and sampler are one

constexpr Word glsl_calls[] = {
    {"let", "{0} {1}"},  // const is for constants only in GLSL ES 3.0
    {"table", "const {0} {1}[{2}] = {0}[{2}]({3*})"},
    {"texture", "sampler2D {0}"},
    {"sampler", ""},
    {"sample", "textureLod({0}, {2}, 0.0)"},
    {"load", "texelFetch({0}, {1}, 0)"},
    {"input_binding", "layout(binding = {0}) uniform sampler2D {1};"},
    {"sampler_binding", ""},
    {"result_binding", "layout(binding = {0}, rgba16f) uniform writeonly image2D {1};"},
    {"tile", "shared vec4 {0}[{1}];"},
    {"kernel", "layout(local_size_x = {1}, local_size_y = {2}) in;\nvoid main()"},
    {"texture_size", "ivec2 {0} = textureSize({1}, 0);"},
    {"image_size", "ivec2 {0} = imageSize({1});"},
    {"store", "imageStore({0}, {1}, {2})"},
};
constexpr Word glsl_words[] = {
    {"float2", "vec2"},
    {"float3", "vec3"},
    {"float4", "vec4"},
    {"int2", "ivec2"},
    {"group_position", "ivec2(gl_WorkGroupID.xy)"},
    {"thread_position", "ivec2(gl_LocalInvocationID.xy)"},
};

// ---- HLSL, and Slang which reads it

constexpr Word hlsl_calls[] = {
    {"table", "static const {0} {1}[{2}] = {{3*}}"},
    {"texture", "Texture2D<float4> {0}"},
    {"sampler", "SamplerState {0}"},
    {"sample", "{0}.SampleLevel({1}, {2}, 0.0)"},
    {"load", "{0}.Load(int3({1}, 0))"},
    {"input_binding", "Texture2D<float4> {1} : register(t{0});"},
    {"sampler_binding", "SamplerState {1} : register(s0);"},
    {"result_binding", "RWTexture2D<float4> {1} : register(u0);"},
    {"tile", "groupshared float4 {0}[{1}];"},
    {"kernel",
     "[numthreads({1}, {2}, 1)]\n"
     "void {0}(uint3 group_index : SV_GroupID, uint3 thread_index : SV_GroupThreadID)"},
    {"texture_size",
     "uint {0}_x, {0}_y;\n    {1}.GetDimensions({0}_x, {0}_y);\n    const int2 {0} = int2({0}_x, {0}_y);"},
    {"image_size",
     "uint {0}_x, {0}_y;\n    {1}.GetDimensions({0}_x, {0}_y);\n    const int2 {0} = int2({0}_x, {0}_y);"},
    {"barrier", "GroupMemoryBarrierWithGroupSync()"},
    {"store", "{0}[{1}] = {2}"},
};
constexpr Word hlsl_words[] = {
    {"group_position", "int2(group_index.xy)"},
    {"thread_position", "int2(thread_index.xy)"},
};
constexpr Word slang_calls[] = {
    {"kernel",
     "[shader(\"compute\")]\n[numthreads({1}, {2}, 1)]\n"
     "void {0}(uint3 group_index : SV_GroupID, uint3 thread_index : SV_GroupThreadID)"},
    {"input_binding", "[[vk::binding({0})]] Texture2D<float4> {1} : register(t{0});"},
    {"sampler_binding", "[[vk::binding({0})]] SamplerState {1} : register(s0);"},
    {"result_binding",
     "[[vk::binding({0})]] [[vk::image_format(\"rgba16f\")]] RWTexture2D<float4> {1} : register(u0);"},
};

// ---- WGSL

constexpr Word wgsl_calls[] = {
    {"let", "let {1}: {0}"},
    {"var", "var {1}: {0}"},
    {"declare", "var {1}: {0}"},
    {"structure", "struct {0}"},
    {"field", "{1}: {0},"},
    {"function", "fn {1}({2*}) -> {0}"},
    {"in", "{1}: {0}"},
    {"loop", "for (var {0}: i32 = {1}; {0} < {2}; {0} += {3})"},
    {"choose", "select({2}, {1}, {0})"},
    {"table", "const {1} = array<{0}, {2}>({3*})"},
    {"texture", "{0}: texture_2d<f32>"},
    {"sampler", "{0}: sampler"},
    {"sample", "textureSampleLevel({0}, {1}, {2}, 0.0)"},
    {"load", "textureLoad({0}, {1}, 0)"},
    {"input_binding", "@group(0) @binding({0}) var {1}: texture_2d<f32>;"},
    {"sampler_binding", "@group(0) @binding({0}) var {1}: sampler;"},
    {"result_binding", "@group(0) @binding({0}) var {1}: texture_storage_2d<rgba16float, write>;"},
    {"tile", "var<workgroup> {0}: array<vec4f, {1}>;"},
    {"tile_here", ""},
    {"kernel",
     "@compute @workgroup_size({1}, {2})\n"
     "fn {0}(@builtin(workgroup_id) group_index: vec3u, @builtin(local_invocation_id) thread_index: vec3u)"},
    {"texture_size", "let {0} = vec2i(textureDimensions({1}));"},
    {"image_size", "let {0} = vec2i(textureDimensions({1}));"},
    {"barrier", "workgroupBarrier()"},
    {"store", "textureStore({0}, {1}, {2})"},
};
constexpr Word wgsl_words[] = {
    {"float", "f32"},
    {"float2", "vec2f"},
    {"float3", "vec3f"},
    {"float4", "vec4f"},
    {"int", "i32"},
    {"int2", "vec2i"},
    {"group_position", "vec2i(group_index.xy)"},
    {"thread_position", "vec2i(thread_index.xy)"},
};

// ---- Metal

constexpr Word msl_calls[] = {
    {"function", "inline {0} {1}({2*})"},
    {"table", "constant {0} {1}[{2}] = {{3*}}"},
    {"texture", "texture2d<float> {0}"},
    {"sampler", "sampler {0}"},
    {"sample", "{0}.sample({1}, {2}, level(0.0))"},
    {"load", "{0}.read(uint2({1}))"},
    {"input_binding", ""},  // parameters of the kernel, in this order
    {"sampler_binding", ""},
    {"result_binding", ""},
    {"tile", ""},
    {"tile_here", "threadgroup float4 {0}[{1}];"},
    {"kernel",
     "// In threadgroups of {1} x {2}.\n"
     "kernel void {0}(texture2d<float> source [[texture(0)]], sampler source_sampler [[sampler(0)]],\n"
     "    texture2d<float, access::write> result [[texture(1)]],\n"
     "    uint2 group_index [[threadgroup_position_in_grid]],\n"
     "    uint2 thread_index [[thread_position_in_threadgroup]])"},
    {"texture_size", "const int2 {0} = int2({1}.get_width(), {1}.get_height());"},
    {"image_size", "const int2 {0} = int2({1}.get_width(), {1}.get_height());"},
    {"barrier", "threadgroup_barrier(mem_flags::mem_threadgroup)"},
    {"store", "{0}.write({2}, uint2({1}))"},
};
constexpr Word msl_words[] = {
    {"group_position", "int2(group_index)"},
    {"thread_position", "int2(thread_index)"},
};

// ---- C++20: a texture is whatever has sample(uv) and load(at)

constexpr Word cpp_calls[] = {
    {"function", "inline {0} {1}({2*})"}, {"table", "inline constexpr {0} {1}[{2}] = {{3*}}"},
    {"texture", "const auto& {0}"},       {"sampler", ""},
    {"sample", "{0}.sample({2})"},        {"load", "{0}.load({1})"},
};

constexpr std::string_view metal_before = "#include <metal_stdlib>\nusing namespace metal;\n\n";

constexpr std::string_view cpp_before = R"(#ifndef BANDLIMIT_SHADER_TYPES
#define BANDLIMIT_SHADER_TYPES
#include <cmath>
namespace bandlimit_shader {
struct float2 {
    float x = 0, y = 0;
    constexpr float2() = default;
    constexpr float2(float x_, float y_) : x(x_), y(y_) {}
    template <class Integers>
    explicit constexpr float2(Integers v) : x(static_cast<float>(v.x)), y(static_cast<float>(v.y)) {}
};
struct float3 {
    float x, y, z;
    constexpr float3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
};
struct float4 {
    float x = 0, y = 0, z = 0, w = 0;
    constexpr float4() = default;
    constexpr float4(float x_, float y_, float z_, float w_) : x(x_), y(y_), z(z_), w(w_) {}
    constexpr float operator[](int i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};
struct int2 {
    int x, y;
    constexpr int2(int x_, int y_) : x(x_), y(y_) {}
    explicit constexpr int2(float2 v) : x(static_cast<int>(v.x)), y(static_cast<int>(v.y)) {}
};
inline float2 operator+(float2 a, float2 b) { return {a.x + b.x, a.y + b.y}; }
inline float2 operator-(float2 a, float2 b) { return {a.x - b.x, a.y - b.y}; }
inline float2 operator-(float2 a) { return {-a.x, -a.y}; }
inline float2 operator*(float2 a, float2 b) { return {a.x * b.x, a.y * b.y}; }
inline float2 operator/(float2 a, float2 b) { return {a.x / b.x, a.y / b.y}; }
inline float2 operator+(float2 a, float b) { return {a.x + b, a.y + b}; }
inline float2 operator-(float2 a, float b) { return {a.x - b, a.y - b}; }
inline float2 operator*(float2 a, float b) { return {a.x * b, a.y * b}; }
inline float2 operator/(float2 a, float b) { return {a.x / b, a.y / b}; }
inline float2 operator+(float a, float2 b) { return {a + b.x, a + b.y}; }
inline float2 operator-(float a, float2 b) { return {a - b.x, a - b.y}; }
inline float2 operator*(float a, float2 b) { return {a * b.x, a * b.y}; }
inline float2 operator/(float a, float2 b) { return {a / b.x, a / b.y}; }
inline float4 operator+(float4 a, float4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline float4 operator-(float4 a, float4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
inline float4 operator*(float4 a, float4 b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }
inline float4 operator*(float a, float4 b) { return {a * b.x, a * b.y, a * b.z, a * b.w}; }
inline float4 operator/(float4 a, float b) { return {a.x / b, a.y / b, a.z / b, a.w / b}; }
inline float4& operator+=(float4& a, float4 b) { return a = a + b; }
inline int2 operator+(int2 a, int2 b) { return {a.x + b.x, a.y + b.y}; }
inline int2 operator-(int2 a, int2 b) { return {a.x - b.x, a.y - b.y}; }
inline float floor(float v) { return std::floor(v); }
inline float2 floor(float2 v) { return {std::floor(v.x), std::floor(v.y)}; }
inline float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
inline float pow(float a, float b) { return std::pow(a, b); }
inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float exp(float v) { return std::exp(v); }
inline float log(float v) { return std::log(v); }
inline float abs(float v) { return std::abs(v); }
inline float sqrt(float v) { return std::sqrt(v); }
inline float clamp(float v, float low, float high) { return min(max(v, low), high); }
inline float2 ceil(float2 v) { return {std::ceil(v.x), std::ceil(v.y)}; }
inline float2 min(float2 a, float2 b) { return {min(a.x, b.x), min(a.y, b.y)}; }
inline float2 max(float2 a, float2 b) { return {max(a.x, b.x), max(a.y, b.y)}; }
inline float4 min(float4 a, float4 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z), min(a.w, b.w)}; }
inline float4 max(float4 a, float4 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z), max(a.w, b.w)}; }
inline float4 abs(float4 v) { return {abs(v.x), abs(v.y), abs(v.z), abs(v.w)}; }
inline float4 sqrt(float4 v) { return {sqrt(v.x), sqrt(v.y), sqrt(v.z), sqrt(v.w)}; }
inline int clamp(int v, int low, int high) { return v < low ? low : high < v ? high : v; }
inline int2 clamp(int2 v, int2 low, int2 high) { return {clamp(v.x, low.x, high.x), clamp(v.y, low.y, high.y)}; }
}  // namespace bandlimit_shader
#endif

namespace bandlimit_shader {

)";

constexpr std::array<Words, 6> table{{
    {{glsl_calls, c_calls}, glsl_words, "", "", ""},
    {{hlsl_calls, c_calls}, hlsl_words, "", "", ""},
    {{wgsl_calls}, wgsl_words, "", "", ""},
    {{msl_calls, c_calls}, msl_words, "f", metal_before, ""},
    {{slang_calls, hlsl_calls, c_calls}, hlsl_words, "", "", ""},
    {{cpp_calls, c_calls}, {}, "f", cpp_before, "\n}  // namespace bandlimit_shader\n"},
}};

std::optional<std::string_view> find(std::span<const Word> words, std::string_view name) {
    const auto found = std::find_if(words.begin(), words.end(), [&](const Word& w) { return w.name == name; });
    if (found == words.end()) return std::nullopt;
    return found->pattern;
}

}  // namespace

std::optional<std::string_view> Words::call(std::string_view name) const {
    for (const auto& family : calls)
        if (const auto found = find(family, name)) return found;
    return std::nullopt;
}

std::string_view Words::word(std::string_view name) const { return find(words, name).value_or(name); }

const Words& words_of(Dialect dialect) { return table.at(static_cast<std::size_t>(dialect)); }

}  // namespace bandlimit
