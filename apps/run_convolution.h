// Weights on pictures: what the verbs convolve and bokeh share.
#pragma once
#include <string>

#include "apps/picture_filter.h"
#include "bandlimit/filter/convolve.h"

namespace bandlimit::app {

/// How weights shall be run, as the command line has it.
struct ConvolutionChoice {
    int rank = 0;
    bool is_exact = false, is_fft = false, keeps_sum = false;

    Method method() const { return is_exact ? Method::direct : is_fft ? Method::fft : Method::automatic; }
};
/// Adds --rank, --exact, --fft and --keep-sum.
void add_choice(Verb verb, ConvolutionChoice& choice);

/// The weights of an image: the mean of its colours, times alpha, as its codes have them, which are not decoded.
WeightGrid read_weights(const std::string& path);

/// Weights that came from `name`, as they are to be run.
struct ChosenWeights {
    ConvolutionWeights weights;
    int components = 0;  ///< phasors that they are made of
    double gamma = 1;    ///< that colours are raised to
    std::string name;
};

/// The filter that runs them: approximated, normalised, and planned.
PictureFilter convolution_filter(const std::string& verb, ChosenWeights chosen, const ConvolutionChoice& choice,
                                 const PictureOptions& o, const ImageInfo& in, const Console& console);

}  // namespace bandlimit::app
