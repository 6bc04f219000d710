#include "bandlimit/shader/shader.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/shader/kernels.h"
#include "bandlimit/shader/text.h"

namespace bandlimit {
namespace {

constexpr std::size_t longest_list = 64;  // reads that are written one by one; more become a table and a loop

void require_finite(const char* what, double value) {
    if (!std::isfinite(value)) fail(what, ": a weight or an offset is ", value, "; all must be finite");
}

/// The statements that leave the sum of `reads` in `sum`; a long list needs `table`, which goes before the function.
struct Gather {
    std::string table, statements;
};

Gather gather(const Fetches& reads, const std::string& name) {
    Gather out;
    if (reads.size() > longest_list) {
        out.table = message("table(float3, ", name, "_reads, ", reads.size(), ",");
        for (std::size_t i = 0; i < reads.size(); ++i)
            out.table += message(i == 0 ? "" : ",", "\n    float3(", number(reads[i].x), ", ", number(reads[i].y), ", ",
                                 number(reads[i].weight), ")");
        out.table += ");\n\n";
        out.statements = message("    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);\n    loop(i, 0, ", reads.size(),
                                 ", 1) {\n        let(float3, each) = ", name,
                                 "_reads[i];\n        sum += each.z * sample(source, source_sampler, uv + "
                                 "float2(each.x, each.y) * texel);\n    }\n");
        return out;
    }
    for (const Fetch& read : reads)
        out.statements += message("    ", out.statements.empty() ? "var(float4, sum) =" : "sum +=", " ",
                                  number(read.weight), " * sample(source, source_sampler, uv + float2(", number(read.x),
                                  ", ", number(read.y), ") * texel);\n");
    return out;
}

std::string gather_function(const Fetches& reads, const std::string& name) {
    if (reads.empty()) fail("shader ", name, ": there are no reads; pass at least one");
    for (const Fetch& read : reads)
        for (const double v : {read.x, read.y, read.weight}) require_finite("shader", v);
    const Gather sum = gather(reads, name);
    return message(sum.table, "function(float4, ", name,
                   ", texture(source), sampler(source_sampler), in(float2, uv), in(float2, texel)) {\n", sum.statements,
                   "    return sum;\n}\n");
}

Fetches along_x(const std::vector<LinearRead>& reads) {
    Fetches out;
    for (const LinearRead& r : reads) out.push_back({r.offset, 0, r.weight});
    return out;
}

Fetches along_y(const std::vector<LinearRead>& reads) {
    Fetches out;
    for (const LinearRead& r : reads) out.push_back({0, r.offset, r.weight});
    return out;
}

std::string weight_table(const std::string& name, const std::vector<double>& weights, std::size_t per_line) {
    if (weights.empty()) fail("shader: ", name, " is empty; pass at least one weight");
    std::string text = message("table(float, ", name, ", ", weights.size(), ",");
    for (std::size_t i = 0; i < weights.size(); ++i) {
        require_finite("shader", weights[i]);
        text += message(i == 0 ? "" : ",", i % per_line == 0 ? "\n    " : " ", number(weights[i]));
    }
    return text + ");\n\n";
}

/// "x - 3", "x + 2" or "x".
std::string shifted(const std::string& name, int by) {
    if (by == 0) return name;
    return message(name, by < 0 ? " - " : " + ", std::abs(by));
}

/// "x * 3", or "x".
std::string times(const std::string& name, int by) { return by == 1 ? name : message(name, " * ", by); }

std::string columns_parameters(std::size_t terms) {
    std::string text;
    for (std::size_t t = 0; t < terms; ++t) text += message(" texture(part", t, "),");
    return text;
}

// ---- Compute shaders

/// The threads of a workgroup and the texels they share, along the axis of the taps and across it.
struct Tile {
    int along = 128, across = 1, length = 0;
};

constexpr int largest_tile = 1024;  // float4, in 16 KiB

Tile tile_of(const Taps& taps, PassDirection direction) {
    // Rows of texels are read whole by neighbouring threads: a vertical tile is some columns wide.
    Tile tile{128, 1, 0};
    if (direction == PassDirection::vertical) tile = {16, 8, 0};
    const auto length = [&] { return (tile.along - 1) * taps.factor + static_cast<int>(taps.weights.size()); };
    while (length() * tile.across > largest_tile && tile.across > 1) tile.across /= 2, tile.along *= 2;
    while (length() > largest_tile && tile.along > 32) tile.along /= 2;
    tile.length = length();
    return tile;
}

/// int2(along, across) or int2(across, along).
std::string place(PassDirection direction, const std::string& along, const std::string& across) {
    return direction == PassDirection::horizontal ? message("int2(", along, ", ", across, ")")
                                                  : message("int2(", across, ", ", along, ")");
}

std::string compute_text(const Taps& taps, PassDirection direction, const std::string& name) {
    const Tile tile = tile_of(taps, direction);
    const bool horizontal = direction == PassDirection::horizontal;
    const std::string a = horizontal ? "x" : "y", b = horizontal ? "y" : "x";
    const std::string size = message(tile.length * tile.across);
    const int columns = horizontal ? tile.along : tile.across, rows = horizontal ? tile.across : tile.along;
    const std::string across = times("group." + b, tile.across) + " + thread." + b;
    const auto cell = [&](const std::string& along) { return times(along, tile.across) + " + thread." + b; };
    return message(
        "input_binding(0, source)\nsampler_binding(1, source_sampler)\nresult_binding(2, result)\n\n",
        weight_table(name + "_weights", taps.weights, 6), "tile(", name, "_tile, ", size, ")\n\nkernel(", name, ", ",
        columns, ", ", rows, ") {\n    tile_here(", name, "_tile, ", size,
        ")\n    texture_size(size, source)\n    image_size(result_size, result)\n"
        "    let(int2, group) = group_position;\n    let(int2, thread) = thread_position;\n"
        "    let(int, first) = ",
        shifted(message("group.", a, " * ", tile.along * taps.factor), taps.first),
        ";\n    let(int, across) = ", across, ";\n    loop(k, thread.", a, ", ", tile.length, ", ", tile.along,
        ") {\n        let(int2, at) = ", place(direction, "first + k", "across"), ";\n        ", name, "_tile[",
        cell("k"),
        "] = sample(source, source_sampler, (float2(at) + 0.5) / float2(size));\n    }\n    barrier();\n"
        "    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);\n    loop(j, 0, ",
        taps.weights.size(), ", 1) {\n        sum += ", name, "_weights[j] * ", name, "_tile[",
        cell("(" + times("thread." + a, taps.factor) + " + j)"), "];\n    }\n    let(int2, at) = ",
        place(direction, message("group.", a, " * ", tile.along, " + thread.", a), "across"),
        ";\n    if (at.x < result_size.x && at.y < result_size.y) {\n        store(result, at, sum);\n    }\n}\n");
}

}  // namespace

std::string fetch_shader(const Fetches& reads, const ShaderInfo& info, Dialect dialect) {
    const Header header{"One pass: a weighted sum of bilinear reads.",
                        message(reads.size(), " bilinear reads, ", reads.size(), " multiply-adds per channel")};
    return shader_text(info, header, gather_function(reads, info.name), dialect);
}

std::string separable_shader(const std::vector<LinearRead>& reads, const ShaderInfo& info, Dialect dialect) {
    const Header header{
        "Two passes: NAME_horizontal reads the source, NAME_vertical what the first pass wrote, with its texel.",
        message(reads.size(), " linear reads and multiply-adds per channel in each pass")};
    return shader_text(info, header,
                       gather_function(along_x(reads), info.name + "_horizontal") + "\n" +
                           gather_function(along_y(reads), info.name + "_vertical"),
                       dialect);
}

std::string load_shader(const WeightGrid& weights, const ShaderInfo& info, Dialect dialect) {
    const Header header{"One pass: a weighted sum of texels, those outside being the ones at the edge.",
                        message(weights.width, " x ", weights.height, " loads and multiply-adds per channel"),
                        Header::Reads::loads};
    const std::string& name = info.name;
    if (weights.width < 1 || weights.height < 1) fail("load_shader: there are no weights; pass at least one");
    return shader_text(
        info, header,
        message(weight_table(name + "_weights", weights.weights, static_cast<std::size_t>(weights.width)),
                "function(float4, ", name, ", texture(source), in(float2, uv), in(float2, texel)) {\n",
                "    let(int2, last) = int2(floor(1.0 / texel - 0.5));\n"
                "    let(int2, middle) = int2(floor(uv / texel));\n"
                "    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);\n    loop(y, 0, ",
                weights.height, ", 1) {\n        loop(x, 0, ", weights.width,
                ", 1) {\n            let(int2, at) = middle + int2(", shifted("x", centred_first(weights.width)), ", ",
                shifted("y", centred_first(weights.height)), ");\n            sum += ", name, "_weights[y * ",
                weights.width, " + x] * load(source, clamp(at, int2(0, 0), last));\n        }\n    }\n",
                "    return sum;\n}\n"),
        dialect);
}

std::string low_rank_shader(const Terms& terms, const ShaderInfo& info, Dialect dialect) {
    if (terms.empty()) fail("low_rank_shader: there are no terms; pass at least one");
    const std::string& name = info.name;
    const std::size_t n = terms.size(), width = terms[0].row.size(), height = terms[0].column.size();
    std::vector<double> rows, columns;  // texel after texel, the weights of all terms
    for (const Term& t : terms)
        if (t.row.size() != width || t.column.size() != height)
            fail("low_rank_shader: terms of different lengths; all rows must be as long, and all columns");
    for (std::size_t x = 0; x < width; ++x)
        for (const Term& t : terms) rows.push_back(t.row[x]);
    for (std::size_t y = 0; y < height; ++y)
        for (const Term& t : terms) columns.push_back(t.column[y]);

    std::string fields, zeros, row_sums, column_sums;
    for (std::size_t t = 0; t < n; ++t) {
        fields += message("    field(float4, part", t, ")\n");
        zeros += message("    parts.part", t, " = float4(0.0, 0.0, 0.0, 0.0);\n");
        row_sums += message("        parts.part", t, " += ", name, "_row_weights[x * ", n, " + ", t, "] * value;\n");
        column_sums += message("        sum += ", name, "_column_weights[y * ", n, " + ", t, "] * sample(part", t,
                               ", source_sampler, at);\n");
    }
    const Header header{message("Two passes of rank ", n, ": NAME_rows returns ", n, n == 1 ? " value" : " values",
                                ", each for a picture of its own; NAME_columns sums over these pictures."),
                        message(width, " reads and ", width * n, " multiply-adds per channel, then ", height * n,
                                " reads and multiply-adds")};
    return shader_text(
        info, header,
        message(weight_table(name + "_row_weights", rows, n), weight_table(name + "_column_weights", columns, n),
                "structure(", name, "_parts) {\n", fields, "};\n\nfunction(", name, "_parts, ", name,
                "_rows, texture(source), sampler(source_sampler), in(float2, uv), in(float2, texel)) {\n"
                "    declare(",
                name, "_parts, parts);\n", zeros, "    loop(x, 0, ", width,
                ", 1) {\n        let(float2, at) = uv + float2(float(",
                shifted("x", centred_first(static_cast<int>(width))),
                "), 0.0) * texel;\n        let(float4, value) = sample(source, source_sampler, at);\n", row_sums,
                "    }\n    return parts;\n}\n\nfunction(float4, ", name, "_columns,", columns_parameters(n),
                " sampler(source_sampler), in(float2, uv), in(float2, texel)) {\n"
                "    var(float4, sum) = float4(0.0, 0.0, 0.0, 0.0);\n    loop(y, 0, ",
                height, ", 1) {\n        let(float2, at) = uv + float2(0.0, float(",
                shifted("y", centred_first(static_cast<int>(height))), ")) * texel;\n", column_sums,
                "    }\n    return sum;\n}\n"),
        dialect);
}

bool compute_fits(const Taps& taps) {
    return taps.factor >= 1 && taps.factor <= largest_tile && taps.weights.size() <= largest_tile &&
           tile_of(taps, PassDirection::horizontal).length <= largest_tile;
}

std::string compute_shader(const Taps& taps, PassDirection direction, const ShaderInfo& info, Dialect dialect) {
    if (dialect == Dialect::cpp)
        fail("compute_shader: C++ has no workgroups; pass another dialect, or use separable_shader");
    if (taps.factor < 1) fail("compute_shader: factor = ", taps.factor, "; pass 1 or more");
    if (!compute_fits(taps))
        fail("compute_shader: ", taps.weights.size(), " taps of factor ", taps.factor,
             " do not fit 16 KiB of shared memory; use separable_shader");
    const Tile tile = tile_of(taps, direction);
    const bool horizontal = direction == PassDirection::horizontal;
    const Header header{
        message("A compute shader that goes along ", horizontal ? "rows" : "columns", ", in workgroups of ",
                horizontal ? tile.along : tile.across, " x ", horizontal ? tile.across : tile.along,
                " threads: one for each ", horizontal ? tile.along : tile.across, " x ",
                horizontal ? tile.across : tile.along, " outputs, rounded up.",
                taps.factor > 1
                    ? message(" Output i lies over the ", taps.factor, " texels from i * ", taps.factor, " on.")
                    : std::string()),
        message("per output ", number(static_cast<double>(tile.length) / tile.along, 3), " reads of the texture, ",
                taps.weights.size(), " of shared memory, ", taps.weights.size(), " multiply-adds per channel; ",
                tile.length * tile.across * 16, " bytes of shared memory"),
        Header::Reads::compute};
    return shader_text(info, header, compute_text(taps, direction, info.name), dialect);
}

std::vector<ShaderFile> shaders_of(const ShaderParts& parts, const ShaderInfo& info, Dialect dialect) {
    std::vector<ShaderFile> files;
    const auto add = [&](const std::string& suffix, std::string text) {
        files.push_back({info.name + suffix + std::string(extension_of(dialect)), std::move(text)});
    };
    if (!parts.fetches.empty()) add("", fetch_shader(parts.fetches, info, dialect));
    if (!parts.reads.empty())
        add(parts.fetches.empty() ? "" : "_separable", separable_shader(parts.reads, info, dialect));
    if (!parts.taps.weights.empty() && compute_fits(parts.taps) && dialect != Dialect::cpp) {
        for (const auto& [direction, suffix] : {std::pair{PassDirection::horizontal, "_compute_horizontal"},
                                                std::pair{PassDirection::vertical, "_compute_vertical"}}) {
            ShaderInfo named = info;
            named.name += suffix;
            add(suffix, compute_shader(parts.taps, direction, named, dialect));
        }
    }
    if (!parts.terms.empty()) add("_low_rank", low_rank_shader(parts.terms, info, dialect));
    if (!parts.pieces.empty()) add("", pieces_shader(parts.pieces, info, dialect));
    if (files.empty()) fail("shaders_of: the design has nothing to ship; pass fetches, reads, taps, terms or pieces");
    return files;
}

}  // namespace bandlimit
