// zimg works on planes. Its sources are split, and its targets joined, outside the timing.
#include <zimg.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>

#include "bandlimit/core/error.h"
#include "bandlimit/core/parallel.h"
#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

constexpr std::size_t alignment = 64;  // what the 512-bit code of zimg asks for

using Bytes = std::unique_ptr<std::byte, void (*)(void*)>;
Bytes allocate(std::size_t bytes) {
    const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
    Bytes memory(static_cast<std::byte*>(std::aligned_alloc(alignment, whole)), &std::free);
    if (!memory) throw std::bad_alloc();
    std::memset(memory.get(), 0, whole);
    return memory;
}

/// The planes of a picture: rows padded to the alignment.
struct Planes {
    Planes(int w, int h, int channels, std::size_t sample_bytes)
        : width(w),
          height(h),
          sample(sample_bytes),
          stride((static_cast<std::size_t>(w) * sample_bytes + alignment - 1) / alignment * alignment) {
        for (int i = 0; i < channels; ++i) memory.push_back(allocate(stride * static_cast<std::size_t>(h)));
    }
    std::byte* row(std::size_t plane, std::size_t y) const { return memory[plane].get() + y * stride; }

    /// Calls body(where in the plane, where in interleaved samples) for every sample.
    template <class Body>
    void for_samples(const Body& body) const {
        for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
            for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x)
                for (std::size_t i = 0; i < memory.size(); ++i)
                    body(row(i, y) + x * sample,
                         ((y * static_cast<std::size_t>(width) + x) * memory.size() + i) * sample);
    }

    int width, height;
    std::size_t sample, stride;
    std::vector<Bytes> memory;
};

void check(bool good) {
    if (good) return;
    char message[256] = "";
    zimg_get_last_error(message, sizeof message);
    fail("zimg: ", message);
}

/// Output rows [first, first + count) of a resampling, or a conversion of as many rows.
class Graph {
public:
    Graph(const zimg_image_format& from, const zimg_image_format& to) {
        zimg_graph_builder_params params;
        zimg_graph_builder_params_default(&params, ZIMG_API_VERSION);
        params.resample_filter = ZIMG_RESIZE_LANCZOS;
        params.filter_param_a = 3;
        params.cpu_type = ZIMG_CPU_AUTO_64B;
        params.allow_approximate_gamma = 1;
        graph_.reset(zimg_filter_graph_build(&from, &to, &params));
        check(graph_ != nullptr);
        std::size_t bytes = 0;
        check(!zimg_filter_graph_get_tmp_size(graph_.get(), &bytes));
        scratch_ = allocate(bytes + alignment);
    }
    struct Callback {
        zimg_filter_graph_callback function = nullptr;
        void* user = nullptr;
    };
    void run(const zimg_image_buffer_const& from, const zimg_image_buffer& to, Callback unpack, Callback pack) const {
        check(!zimg_filter_graph_process(graph_.get(), &from, &to, scratch_.get(), unpack.function, unpack.user,
                                         pack.function, pack.user));
    }
    void run(const zimg_image_buffer_const& from, const zimg_image_buffer& to) const { run(from, to, {}, {}); }
    unsigned input_rows() const {
        unsigned rows = 0;
        check(!zimg_filter_graph_get_input_buffering(graph_.get(), &rows));
        return rows;
    }
    unsigned output_rows() const {
        unsigned rows = 0;
        check(!zimg_filter_graph_get_output_buffering(graph_.get(), &rows));
        return rows;
    }

private:
    struct Free {
        void operator()(zimg_filter_graph* graph) const { zimg_filter_graph_free(graph); }
    };
    std::unique_ptr<zimg_filter_graph, Free> graph_;
    Bytes scratch_{nullptr, &std::free};
};

/// One plane of codes or floats.
zimg_image_format grey(int width, int height, std::size_t sample_bytes) {
    zimg_image_format format;
    zimg_image_format_default(&format, ZIMG_API_VERSION);
    format.width = static_cast<unsigned>(width);
    format.height = static_cast<unsigned>(height);
    format.pixel_type = sample_bytes == 1 ? ZIMG_PIXEL_BYTE : ZIMG_PIXEL_FLOAT;
    format.depth = sample_bytes == 1 ? 8 : 32;
    format.pixel_range = ZIMG_RANGE_FULL;
    return format;
}

/// sRGB codes or linear floats.
zimg_image_format color(int width, int height, bool linear, zimg_alpha_type_e alpha) {
    zimg_image_format format = grey(width, height, linear ? 4 : 1);
    format.color_family = ZIMG_COLOR_RGB;
    format.matrix_coefficients = ZIMG_MATRIX_RGB;
    format.color_primaries = ZIMG_PRIMARIES_BT709;
    format.transfer_characteristics = linear ? ZIMG_TRANSFER_LINEAR : ZIMG_TRANSFER_IEC_61966_2_1;
    format.alpha = alpha;
    return format;
}

template <class Buffer>
void point_to(Buffer& buffer, std::size_t plane, std::byte* data, std::size_t stride, unsigned mask) {
    buffer.plane[plane].data = data;
    buffer.plane[plane].stride = static_cast<std::ptrdiff_t>(stride);
    buffer.plane[plane].mask = mask;
}

/// The planes `first` to `last` from row y on, as many rows as there are.
template <class Buffer>
Buffer buffer_at(const Planes& planes, std::size_t first, std::size_t last, std::size_t y, std::size_t x_bytes = 0,
                 unsigned mask = ZIMG_BUFFER_MAX) {
    Buffer buffer{};
    buffer.version = ZIMG_API_VERSION;
    for (std::size_t i = first; i < last; ++i)
        point_to(buffer, i - first, planes.row(i, y) + x_bytes, planes.stride, mask);
    return buffer;
}

/// The part of a source that makes output rows [begin, end) of `height`.
void activate(zimg_image_format& source, int begin, int end, int height) {
    source.active_region.left = 0;
    source.active_region.width = source.width;
    source.active_region.top = static_cast<double>(source.height) * begin / height;
    source.active_region.height = static_cast<double>(source.height) * (end - begin) / height;
}

/// Sources and targets of a case as planes, and the way back.
struct Pictures {
    Pictures(const Case& c, const Buffers& buffers) {
        for (int k = 0; k < buffers.count(); ++k) {
            sources.emplace_back(c.width, c.height, c.channels, c.sample_bytes());
            const std::byte* from = buffers.sources[static_cast<std::size_t>(k)].data();
            sources.back().for_samples(
                [&](std::byte* to, std::size_t at) { std::memcpy(to, from + at, c.sample_bytes()); });
            targets.emplace_back();
            for (const Level& level : levels_of(c))
                targets.back().emplace_back(level.width, level.height, c.channels, c.sample_bytes());
        }
    }
    void collect(const Case& c, const Buffers& buffers, int k) const {
        const std::vector<Level> levels = levels_of(c);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            std::byte* to = buffers.targets[static_cast<std::size_t>(k)].data() + levels[i].offset;
            targets[static_cast<std::size_t>(k)][i].for_samples(
                [&](const std::byte* from, std::size_t at) { std::memcpy(to + at, from, c.sample_bytes()); });
        }
    }
    std::vector<Planes> sources;
    std::vector<std::vector<Planes>> targets;  ///< [k][level]
};

template <class Work>
Task task_of(const Case& c, const Buffers& buffers, std::shared_ptr<Pictures> pictures, Work work) {
    Task task = timed(work);
    task.collect = [=, &buffers](int k) { pictures->collect(c, buffers, k); };
    return task;
}

/// Planes are shared among threads, each with its own graphs, through all levels; a single plane is cut into runs of
/// rows.
Task planar(const Case& c, const Buffers& buffers, int threads) {
    const auto pictures = std::make_shared<Pictures>(c, buffers);
    const std::vector<Level> levels = levels_of(c);
    const int parts = c.channels == 1 ? threads : 1, graph_sets = threads;
    const auto graphs = std::make_shared<std::vector<std::vector<Graph>>>();
    for (int set = 0; set < graph_sets; ++set) {
        graphs->emplace_back();
        int width = c.width, height = c.height;
        for (const Level& level : levels) {
            zimg_image_format from = grey(width, height, c.sample_bytes());
            const int begin = parts == 1 ? 0 : level.height * set / parts;
            const int end = parts == 1 ? level.height : level.height * (set + 1) / parts;
            activate(from, begin, end, level.height);
            graphs->back().emplace_back(from, grey(level.width, end - begin, c.sample_bytes()));
            width = level.width, height = level.height;
        }
    }
    return task_of(c, buffers, pictures, [=](int k) {
        const auto kk = static_cast<std::size_t>(k);
        parallel_for(threads, 1, {threads}, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
            for (auto t = static_cast<std::size_t>(first); t < static_cast<std::size_t>(last); ++t) {
                const auto n = static_cast<std::size_t>(threads), channels = static_cast<std::size_t>(c.channels);
                const std::size_t begin = parts == 1 ? channels * t / n : 0;
                const std::size_t end = parts == 1 ? channels * (t + 1) / n : channels;
                for (std::size_t plane = begin; plane < end; ++plane) {
                    const Planes* from = &pictures->sources[kk];
                    for (std::size_t i = 0; i < levels.size(); ++i) {
                        const Planes& to = pictures->targets[kk][i];
                        const std::size_t y = parts == 1 ? 0 : static_cast<std::size_t>(to.height) * t / n;
                        (*graphs)[t][i].run(buffer_at<zimg_image_buffer_const>(*from, plane, plane + 1, 0),
                                            buffer_at<zimg_image_buffer>(to, plane, plane + 1, y));
                        from = &to;
                    }
                }
            }
        });
    });
}

/// A piece of a row from codes to linear floats or back. Alpha goes by itself: a graph for both would multiply colour
/// by alpha before it decodes.
class Converter {
public:
    Converter(int width, bool from_linear)
        : color_(color(width, 1, from_linear, ZIMG_ALPHA_NONE), color(width, 1, !from_linear, ZIMG_ALPHA_NONE)),
          alpha_(grey(width, 1, from_linear ? 4 : 1), grey(width, 1, from_linear ? 1 : 4)) {}

    void run(const Planes& from, std::size_t from_row, std::size_t from_bytes, const Planes& to, std::size_t to_row,
             std::size_t to_bytes) const {
        color_.run(buffer_at<zimg_image_buffer_const>(from, 0, 3, from_row, from_bytes),
                   buffer_at<zimg_image_buffer>(to, 0, 3, to_row, to_bytes));
        alpha_.run(buffer_at<zimg_image_buffer_const>(from, 3, 4, from_row, from_bytes),
                   buffer_at<zimg_image_buffer>(to, 3, 4, to_row, to_bytes));
    }

private:
    Graph color_, alpha_;
};

/// Decoding, resizing and encoding in one go: zimg resizes rows that it asks for, and they are decoded when it does, so
/// that no linear picture is ever in memory. One for each run of output rows.
class LinearLight {
public:
    LinearLight(const Case& c, int begin, int end)
        : first_(begin),
          resize_(source_format(c, begin, end), color(c.new_width, end - begin, true, ZIMG_ALPHA_STRAIGHT)),
          in_mask_(zimg_select_buffer_mask(resize_.input_rows())),
          out_mask_(zimg_select_buffer_mask(resize_.output_rows())),
          in_(c.width, rows_of(in_mask_, c.height), 4, 4),
          out_(c.new_width, rows_of(out_mask_, end - begin), 4, 4) {}

    void run(const Planes& from, const Planes& to) {
        from_ = &from, to_ = &to;
        resize_.run(buffer_at<zimg_image_buffer_const>(in_, 0, 4, 0, 0, in_mask_),
                    buffer_at<zimg_image_buffer>(out_, 0, 4, 0, 0, out_mask_), {&decode, this}, {&encode, this});
    }

private:
    static zimg_image_format source_format(const Case& c, int begin, int end) {
        zimg_image_format format = color(c.width, c.height, true, ZIMG_ALPHA_STRAIGHT);
        activate(format, begin, end, c.new_height);
        return format;
    }
    static int rows_of(unsigned mask, int all) { return mask == ZIMG_BUFFER_MAX ? all : static_cast<int>(mask) + 1; }

    /// Columns [left, right) widened to where vectors of codes are aligned; zimg asks for columns in tiles.
    struct Columns {
        Columns(unsigned left, unsigned right, int width)
            : begin(left / alignment * alignment),
              count(std::min((right + alignment - 1) / alignment * alignment, static_cast<std::size_t>(width)) -
                    begin) {}
        std::size_t begin, count;
    };

    static int decode(void* user, unsigned y, unsigned left, unsigned right) {
        auto& self = *static_cast<LinearLight*>(user);
        const Columns columns(left, right, self.in_.width);
        converter(self.decoders_, columns.count, false)
            .run(*self.from_, y, columns.begin, self.in_, y & self.in_mask_, columns.begin * sizeof(float));
        return 0;
    }
    static int encode(void* user, unsigned y, unsigned left, unsigned right) {
        auto& self = *static_cast<LinearLight*>(user);
        const Columns columns(left, right, self.out_.width);
        const auto row = static_cast<std::size_t>(self.first_) + y;
        converter(self.encoders_, columns.count, true)
            .run(self.out_, y & self.out_mask_, columns.begin * sizeof(float), *self.to_, row, columns.begin);
        return 0;
    }
    using Converters = std::map<std::size_t, Converter>;
    /// Made when first needed, which is before the timing.
    static const Converter& converter(Converters& made, std::size_t width, bool from_linear) {
        return made.try_emplace(width, static_cast<int>(width), from_linear).first->second;
    }

    int first_;
    Graph resize_;
    unsigned in_mask_, out_mask_;
    Planes in_, out_;
    Converters decoders_, encoders_;
    const Planes* from_ = nullptr;
    const Planes* to_ = nullptr;
};

Task linear_light(const Case& c, const Buffers& buffers, int threads) {
    const auto pictures = std::make_shared<Pictures>(c, buffers);
    const auto parts = std::make_shared<std::vector<LinearLight>>();
    for (int t = 0; t < threads; ++t)
        parts->emplace_back(c, c.new_height * t / threads, c.new_height * (t + 1) / threads);
    return task_of(c, buffers, pictures, [=](int k) {
        const auto kk = static_cast<std::size_t>(k);
        parallel_for(threads, 1, {threads}, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
            for (std::ptrdiff_t t = first; t < last; ++t)
                (*parts)[static_cast<std::size_t>(t)].run(pictures->sources[kk], pictures->targets[kk][0]);
        });
    });
}

}  // namespace

std::vector<Peer> zimg_peers() {
    unsigned major = 0, minor = 0, micro = 0;
    zimg_get_version_info(&major, &minor, &micro);
    const auto prepare = [](const Case& c, const Buffers& buffers, int threads) -> std::optional<Task> {
        if (c.filter == Filter::box) return {};
        return c.linear ? linear_light(c, buffers, threads) : planar(c, buffers, threads);
    };
    return {{.name = "zimg " + std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(micro),
             .note =
                 "on planes, which are split and joined outside the timing; has no box; two threads take two planes "
                 "each, or half the rows; g: graphs of zimg decode and encode the rows as the one that resizes asks "
                 "for them, with its approximate transfer functions",
             .prepare = prepare}};
}

}  // namespace bandlimit::bench
