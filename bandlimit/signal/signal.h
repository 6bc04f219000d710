// Test signals: functions of position whose content, and often whose exact filtered answer, is known.
//
// Common to all of them
//   units      positions and lengths in pixels: pixel (i, j) of an image of width x height covers [i, i+1] x [j, j+1],
//              the image the Frame [0, width] x [0, height]; frequencies in cycles per pixel, so that 0.5 is Nyquist;
//              phases in periods (0.25 is a quarter of a wave); angles in degrees, clockwise, since y points down
//   direction  an angle says along which direction a signal varies: 0 across vertical lines, 90 across horizontal ones
//   range      values lie in [0, 1] and are linear light (noise of a given RMS may leave the range); with_range()
//              changes it. At a jump the value is the mean of both sides
//   extent     signals continue outside the frame, so that filters need no edge mode
//   throws     Error for options that are not finite or out of the range stated with them
// Stability: evolving.
#pragma once
#include <complex>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "bandlimit/core/point.h"

namespace bandlimit {

/// The rectangle [0, width] x [0, height] that an image shows. Both above 0.
struct Frame {
    double width = 0, height = 0;
};

/// A rectangle of the plane: x0 < x1, y0 < y1.
struct Cell {
    double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
};

/// An oscillation along one coordinate.
struct Wave {
    std::function<std::complex<double>(double)> value;
    std::function<double(double)>
        frequency;  ///< >= 0, at least the local one; over an interval largest at an end of it
};

/// offset + Re(x(X) * y(Y)): seen through a separable kernel it stays a product of two functions of one coordinate.
struct WaveProduct {
    double offset = 0;
    Wave x, y;
};

/// A continuous signal. Draw it with render.h.
struct Signal {
    std::string name;                             ///< one word: "zoneplate"
    std::function<double(double, double)> value;  ///< at a point (x, y); safe to call from several threads
    std::function<double(const Cell&)> mean;      ///< exact mean over a cell; empty where no closed form is known
    std::optional<WaveProduct> product;           ///< the same function, for signals of this form
};

/// `signal` with values mapped linearly: 0 to `low`, 1 to `high`.
Signal with_range(const Signal& signal, double low, double high);

/// The same value everywhere.
Signal constant(double value);

/// 1/2 + cos(2 pi (f r^2 / (2 radius) + phase)) / 2, f = max_frequency: the local frequency grows in proportion to the
/// distance r from the centre and is max_frequency at `radius`.
///
/// Along each axis it is max_frequency at most wherever |x|, |y| <= radius. The default radius reaches the midpoint of
/// the farther border; with 0.5 no pixel of the frame then exceeds what the pixel grid can represent.
struct ZonePlateOptions {
    double max_frequency = 0.5;  ///< > 0
    double phase = 0;
    std::optional<Point> center = {};   ///< default: the middle of the frame
    std::optional<double> radius = {};  ///< > 0; default: half the longer side
};
Signal zone_plate(const Frame& frame, const ZonePlateOptions& options = {});

/// Spokes around a centre: at radius r their frequency is spokes / (2 pi r). 1/2 outside the radius.
struct SiemensStarOptions {
    int spokes = 72;                    ///< >= 1 bright ones
    double phase = 0;                   ///< turns the star by this share of the angle between two spokes
    bool sinusoid = false;              ///< a smooth wave around the centre instead of 0 and 1
    std::optional<Point> center = {};   ///< default: the middle of the frame
    std::optional<double> radius = {};  ///< > 0; default: half the shorter side
};
Signal siemens_star(const Frame& frame, const SiemensStarOptions& options = {});

/// 1/2 + cos(2 pi phase(t)) / 2 with a frequency that rises or falls across the frame: linearly, or by equal factors
/// over equal distances.
struct ChirpOptions {
    double from = 0.01, to = 0.5;  ///< frequencies >= 0 where the frame begins and ends; both > 0 if exponential
    bool exponential = false;
    double angle = 0;
    double phase = 0;  ///< where the frame begins
};
Signal chirp(const Frame& frame, const ChirpOptions& options = {});

/// 0 on one side of a straight line, 1 on the other, towards which `angle` points.
struct StepEdgeOptions {
    double angle = 5;
    double offset = 0;  ///< distance of the edge from the middle of the frame, along `angle`
};
Signal step_edge(const Frame& frame, const StepEdgeOptions& options = {});

/// Bright stripes from the origin on: 1 where t / period + phase, without its whole part, is below duty.
struct StripesOptions {
    double period = 8;  ///< >= 0.01
    double angle = 0;
    double phase = 0;
    double duty = 0.5;      ///< 0 to 1: the bright share of a period
    bool sinusoid = false;  ///< (1 + sin(2 pi (t / period + phase))) / 2 instead: a single frequency, without duty
};
Signal stripes(const StripesOptions& options = {});

/// Squares of 1 and 0; the one with its corner at the origin is 1.
struct CheckerboardOptions {
    double size = 8;  ///< >= 0.01: the side of a square
};
Signal checkerboard(const CheckerboardOptions& options = {});

/// 1 inside a cell, 0 outside.
struct RectangleOptions {
    std::optional<Cell> cell = {};  ///< default: the middle half of the frame each way
};
Signal rectangle(const Frame& frame, const RectangleOptions& options = {});

/// 1 inside a circle, 0 outside.
struct DiscOptions {
    std::optional<Point> center = {};   ///< default: the middle of the frame
    std::optional<double> radius = {};  ///< > 0; default: a quarter of the shorter side
};
Signal disc(const Frame& frame, const DiscOptions& options = {});

/// From 0 to 1 along a straight line, and constant beyond.
struct RampOptions {
    double angle = 0;
    std::optional<double> length =
        {};  ///< > 0, centred in the frame; default: from the first of its corners to the last
};
Signal ramp(const Frame& frame, const RampOptions& options = {});

/// 1 on a unit square, the cell of a pixel; 0 elsewhere. Its integral is 1 at any position.
struct ImpulseOptions {
    std::optional<Point> corner =
        {};  ///< the square's least x and y; default: those of the pixel at width / 2, height / 2
};
Signal impulse(const Frame& frame, const ImpulseOptions& options = {});

/// 1 within width / 2 of a straight line without ends, 0 elsewhere.
struct ThinLineOptions {
    double angle = 30;  ///< across the line: 0 draws a vertical one
    double offset = 0;  ///< distance from the middle of the frame, along `angle`
    double width = 1;   ///< > 0, may be below a pixel
};
Signal thin_line(const Frame& frame, const ThinLineOptions& options = {});

/// Uniform noise in [0, 1), constant on each pixel and independent between pixels. A pixel's value depends on its
/// indices and the seed alone: not on the size of the image, nor on earlier calls.
struct WhiteNoiseOptions {
    std::uint64_t seed = 1;
};
Signal white_noise(const WhiteNoiseOptions& options = {});

/// Normally distributed noise of mean 1/2, periodic with the frame, without frequencies above a cut-off: white noise
/// after an ideal low-pass that is round in two dimensions.
///
/// error    exact to double precision at the centres of pixels; elsewhere within 1e-6 of the RMS, by interpolation
/// cost     16 bytes and one Fourier transform per pixel, four times that for each doubling of the cut-off beyond 0.25;
///          a value away from the centres takes a few microseconds
/// throws   Error also if the only frequency of the frame within the cut-off is 0
struct BandLimitedNoiseOptions {
    std::uint64_t seed = 1;
    double cutoff = 0.25;  ///< > 0, up to 16, cycles per pixel
    double rms = 0.1;      ///< > 0: root of the mean square of the difference to 1/2
};
Signal band_limited_noise(int width, int height, const BandLimitedNoiseOptions& options = {});

/// The memory that this noise holds, in bytes.
std::uint64_t band_limited_noise_bytes(int width, int height, const BandLimitedNoiseOptions& options = {});

}  // namespace bandlimit
