// Signals as images.
//
// Supersampling is a reduction of a fine image, and reductions have one engine here: so this room may include
// `resample`, which knows nothing of signals.
// Stability: evolving.
#pragma once
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// How a pixel gets its value from a continuous signal.
struct Sampling {
    enum class Mode {
        point,        ///< the value at its centre: aliases
        exact,        ///< the integral of signal times kernel
        supersampled  ///< the same by a sum over `samples` x `samples` points per pixel
    };
    Mode mode = Mode::point;
    Kernel kernel = box();  ///< in pitches of the image; not used by point
    int samples = 8;        ///< per pixel and axis, 1 to 1024

    static Sampling point() { return {}; }
    static Sampling exact(Kernel kernel = box()) { return {Mode::exact, std::move(kernel), 8}; }
    static Sampling supersampled(Kernel kernel, int samples = 8) {
        return {Mode::supersampled, std::move(kernel), samples};
    }
};

/// Draws `signal` at the samples of `grid` into `image`, linear light.
///
/// Kernels are normalised to preserve constants, and never meet an edge: the signal continues outside the image. With
/// box, exact needs a signal with a mean over cells (all except siemens and noise); with other separable kernels, a
/// product of waves (zoneplate, sinusoidal stripes, chirp along x or y). supersampled takes any signal and any kernel
/// except nearest, including radial ones.
///
/// shapes   image [grid.x.count x grid.y.count x 1]
/// units    grid in the pixels of the signal; {width, 0, width} is the image, {width / 2, 0, width} its half size
/// error    point and exact: the float nearest to the value to within about 1e-12. supersampled with box: a jump of the
///          signal costs up to 1 / samples of a pixel; with smooth kernels, frequencies above samples - 1/2 cycles per
///          pixel alias. Same bits for any number of threads, and for a part of the image (Axis::cells) on whole pixels
/// cost     point: one value per pixel. exact: one mean per pixel, or, for products, one 1D integral per row and
///          column. supersampled: samples^2 values per pixel, one pass of Resizer, and about 64 MB
/// throws   Error if shapes disagree, the signal has no exact form for this kernel, or `samples` is out of range
void render(const Signal& signal, const Grid& grid, const Sampling& sampling, View<float> image,
            Parallel parallel = {});

/// Throws the Error with which render() would refuse this signal with this sampling.
void check_sampling(const Signal& signal, const Sampling& sampling);

/// About how many bytes render() takes for an image of `grid`, beside the image itself.
std::uint64_t rendering_bytes(const Grid& grid, const Sampling& sampling);

/// The image [0, width] x [0, height] of `signal`.
///
/// example  render(zone_plate({512, 512}), 512, 512, Sampling::exact())
Image<float> render(const Signal& signal, int width, int height, const Sampling& sampling = {}, Parallel parallel = {});

/// The names of the signals that Sampling::exact() can draw, for messages: "zoneplate, chirp, ...".
std::string exact_signals();

}  // namespace bandlimit
