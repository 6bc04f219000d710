// Weights in two dimensions on a picture file.
//
//     job::ConvolveJob blur;
//     blur.files = {"photo.jpg", "soft.png"};
//     blur.weights = job::weights_of(read_taps("binomial.json"), "binomial.json");
//     job::convolve(blur);
// Stability: evolving.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/filter/convolve.h"
#include "bandlimit/job/picture_filter.h"

namespace bandlimit::job {

/// How weights are run.
struct WeightOptions {
    int rank = 0;                       ///< above 0: the nearest sum of so many products instead, an approximation
    Method method = Method::automatic;  ///< where rank is 0
    bool keeps_sum = false;             ///< run them as they are; without, they are divided by their sum
    /// Default: Edge::renormalize; for weights that sum to 0, which cannot be renormalized, Edge::reflect.
    std::optional<Edge> edge{};
};

struct ConvolveJob {
    PictureFiles files;
    ConvolutionWeights weights;    ///< weights.h reads them from files
    std::string name = "weights";  ///< what errors call them
    WeightOptions options{};
};

struct ConvolveReport : PictureReport {
    std::string name;  ///< what the weights were called
    WeightSize size;   ///< how many they are
    double sum = 1;    ///< of those that ran
    Edge edge = Edge::renormalize;
    int rank = 0;                        ///< products that they are a sum of; 0 where they are none
    MethodCost chosen;                   ///< how they ran
    std::vector<MethodCost> candidates;  ///< what there was to choose from, the cheapest first
};

/// Convolves a file into another, a band of rows at a time.
///
/// memory   that of Convolution and of stream_rows()
/// notes    as filter_picture(); and weights without a middle sample, which move the picture
/// throws   std::runtime_error for files, a rank that the weights do not have, and weights that would have to be
///          divided by 0; Error as Convolution; Stopped. The output appears whole or not at all
ConvolveReport convolve(const ConvolveJob& job, const Context& context = {});

/// The same for weights that are found once the input is known to be readable, on colours that are raised to the power
/// `gamma` as boosted() does. `doing` is what progress and errors call it.
ConvolveReport convolve_by(const std::function<ConvolutionWeights()>& weights, const std::string& name,
                           const PictureFiles& files, const WeightOptions& options, double gamma,
                           const std::string& doing, const Context& context);

}  // namespace bandlimit::job
