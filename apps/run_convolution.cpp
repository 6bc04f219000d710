#include "apps/run_convolution.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include <nlohmann/json.hpp>
#include "bandlimit/filter/bokeh.h"
#include "bandlimit/kernel/low_rank.h"

namespace bandlimit::app {
namespace {

/// By --rank, --exact and --fft, of which the command line has one at most; else as they are.
ConvolutionWeights approximated(ConvolutionWeights weights, int rank, const std::string& name) {
    if (rank == 0) return weights;
    const WeightSize size = size_of(weights);
    if (rank > std::min(size.width, size.height))
        throw std::runtime_error(
            fmt::format("--rank {}: {} has {} x {} weights, whose rank is at most {}; pass that or less", rank, name,
                        size.width, size.height, std::min(size.width, size.height)));
    constexpr double most = 1 << 22;  // as many as fetches may spread over
    if (size.count() > most)
        throw std::runtime_error(fmt::format("--rank {}: {} has {} x {} weights, too many to take apart; leave it out",
                                             rank, name, size.width, size.height));
    return {low_rank(grid_of(weights), rank), weights.first_x, weights.first_y};
}

/// Rows of a band: its first ones do anew what they share with the band before.
int rows_worth_a_band(int taps) { return std::max(64, 8 * taps); }

std::string line_of(const MethodCost& cost, WeightSize size) {
    const std::string terms =
        cost.method == Method::low_rank ? fmt::format(" of {} products", cost.rank) : std::string();
    return fmt::format("{} x {} weights, {}{}, {:.0f} multiply-adds per sample", size.width, size.height,
                       name_of(cost.method), terms, cost.multiply_adds);
}

nlohmann::ordered_json report_of(const Convolution& convolution, const ChosenWeights& chosen,
                                 const ConvolutionWeights& weights, double sum, Edge edge) {
    const MethodCost& cost = convolution.chosen();
    // Few products may run directly all the same, where that is cheaper.
    const auto* terms = std::get_if<Terms>(&weights.weights);
    const int rank = terms ? static_cast<int>(terms->size()) : cost.rank;
    const WeightSize size = size_of(weights);
    nlohmann::ordered_json report{{"weights", {{"of", chosen.name}, {"width", size.width}, {"height", size.height}}},
                                  {"sum", sum},
                                  {"method", name_of(cost.method)},
                                  {"rank", rank > 0 ? nlohmann::ordered_json(rank) : nullptr},
                                  {"multiply_adds", cost.multiply_adds}};
    if (chosen.components > 0) report["components"] = chosen.components;
    if (chosen.gamma != 1) report["hdr"] = chosen.gamma;
    report["edge"] = name_of(edge);
    for (const MethodCost& c : convolution.candidates())
        report["candidates"].push_back(
            {{"method", name_of(c.method)}, {"multiply_adds", c.multiply_adds}, {"relative_time", c.time / cost.time}});
    return report;
}

/// What is said once of weights that have no middle sample.
void note_shift(const Console& console, const ConvolutionWeights& weights) {
    const WeightSize size = size_of(weights);
    const double x = weights.first_x + (size.width - 1) / 2.0, y = weights.first_y + (size.height - 1) / 2.0;
    if (x == 0 && y == 0) return;
    console.note(
        fmt::format("the middle of the {} x {} weights lies {:g}, {:g} pixels from the pixel that they make: the "
                    "picture moves by {:g}, {:g}",
                    size.width, size.height, x, y, -x, -y));
}

}  // namespace

void add_choice(Verb verb, ConvolutionChoice& choice) {
    Option const rank =
        verb.add_option("--rank", choice.rank, "Run the nearest sum of N products instead: an approximation")
            .in_range(1, 4096)
            .type_name("N");
    Option const exact = verb.add_flag("--exact", choice.is_exact, "Run every weight by itself").excludes(rank);
    verb.add_flag("--fft", choice.is_fft, "Run by Fourier transforms").excludes(rank).excludes(exact);
    verb.add_flag("--keep-sum", choice.keeps_sum, "Run weights as they are; without, they are divided by their sum");
}

WeightGrid read_weights(const std::string& path) {
    ImageReader reader(path);
    const ImageInfo& in = reader.info();
    const std::uint64_t samples = static_cast<std::uint64_t>(in.width) * static_cast<std::uint64_t>(in.height);
    require_memory(samples * (sizeof(double) + static_cast<std::uint64_t>(in.channels()) * sizeof(float)),
                   "weights of " + path);
    AnyImage image = make_image(in.depth, in.width, 1, in.channels());
    std::vector<float> row(static_cast<std::size_t>(in.width) * static_cast<std::size_t>(in.channels()));
    WeightGrid grid(in.width, in.height);
    // Colour comes multiplied by alpha.
    const Encoding codes{Transfer::linear, in.alpha, in.associated};
    const int colours = in.channels() - (in.alpha >= 0 && in.channels() > 1 ? 1 : 0);
    for (int y = 0; y < in.height; ++y) {
        reader.read_rows(y, view_of(image));
        decode_row(const_view(view_of(image)), 0, codes, true, row);
        for (int x = 0; x < in.width; ++x) {
            double sum = 0;
            for (int c = 0; c < in.channels(); ++c)
                if (c != in.alpha || in.channels() == 1)
                    sum += static_cast<double>(row[static_cast<std::size_t>(x * in.channels() + c)]);
            if (!std::isfinite(sum))
                throw std::runtime_error(
                    fmt::format("{}: the weight at {}, {} is {}; weights must be finite", path, x, y, sum));
            grid.at(x, y) = sum / colours;
        }
    }
    return grid;
}

PictureFilter convolution_filter(const std::string& verb, ChosenWeights chosen, const ConvolutionChoice& choice,
                                 const PictureOptions& o, const ImageInfo& in, const Console& console) {
    ConvolutionWeights weights = approximated(std::move(chosen.weights), choice.rank, chosen.name);
    const double sum = sum_of(weights);
    const bool cancels = cancel(weights);
    if (!choice.keeps_sum) {
        if (cancels)
            throw std::runtime_error(fmt::format(
                "{}: the weights sum to {:.3g} and cannot be divided by that; add --keep-sum", chosen.name, sum));
        weights = with_unit_sum(std::move(weights));
    }
    ConvolveOptions options{
        .method = choice.method(), .premultiply = o.premultiplies(), .most_bytes = available_memory()};
    // What sums to 0 has nothing to renormalize to.
    options.edge_x = options.edge_y = o.edge.value_or(cancels ? Edge::reflect : Edge::renormalize);
    note_shift(console, weights);
    const auto convolution = std::make_shared<const Convolution>(weights, in.width, in.height, options);
    PictureFilter filter;
    filter.rows = {verb,
                   verb == "bokeh" ? "blurring" : "convolving",
                   [convolution](int first, int last) { return convolution->rows_needed(first, last); },
                   {},
                   rows_worth_a_band(size_of(weights).height)};
    filter.rows.run = [convolution, gamma = chosen.gamma, premultiply = options.premultiply](
                          const SourceRows& source, const TargetRows& target, Parallel parallel) {
        if (gamma == 1) return convolution->run(source, target, parallel);
        return run_boosted(*convolution, gamma, premultiply, source, target, parallel);
    };
    filter.memory = convolution->bytes(in.channels(), o.parallel);
    filter.line = line_of(convolution->chosen(), size_of(weights));
    filter.report = report_of(*convolution, chosen, weights, choice.keeps_sum ? sum : 1, options.edge_x);
    return filter;
}

}  // namespace bandlimit::app
