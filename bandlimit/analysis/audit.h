// What another resizer really does: which kernel, where its samples lie, in which light, with what at the borders.
//
// All values are as stored: 0 to 1, a code over the largest code, or floats. Runs of the resizer are few, because each
// may be the start of a program: three for a scale, two for light, two for alpha.
// Stability: evolving.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/analysis/recognise.h"
#include "bandlimit/core/image.h"

namespace bandlimit {

/// The resizer under test: gets an image of 1 channel (grey) or 4 (RGB and alpha, not multiplied), and gives one of
/// width x height with as many channels, or without alpha. What it throws ends the audit, except where alpha is tested.
using ResizeFunction = std::function<Image<float>(View<const float> stored, int width, int height)>;

struct AuditOptions {
    std::vector<Ratio> scales = {{1, 2}, {37, 100}, {2, 1}, {100, 37}};
    double code = 1.0 / 255;  ///< distance of two codes; 0 for floats
    bool alpha = true;        ///< whether to test alpha
    /// Called before each run with the number of runs done and the total.
    std::function<void(int, int)> progress = {};
};

/// In which numbers averages are taken.
enum class Light {
    unknown,  ///< nothing was averaged (nearest), or the transfer function is not known here
    codes,    ///< as they are stored
    srgb,     ///< decoded by the sRGB curve: linear light
    gamma22,  ///< decoded by a power of 2.2
    bt709     ///< decoded by the curve of ITU-R BT.709
};
std::string_view name_of(Light light);
double decode(Light light, double stored);
double encode(Light light, double value);

struct LightReport {
    Light light = Light::unknown;
    double checker = 0;     ///< mean of what became of a checkerboard of 0 and 1: 0.5 in codes, 0.735 in sRGB light
    double error = 0;       ///< of the best explanation, root mean square, as stored; 0 too where nothing was averaged
    double flat_error = 0;  ///< largest change of a constant grey
};

/// The kernel that explains the weights along one axis at one scale.
struct KernelFinding {
    std::string name;  ///< as parse_kernel() reads it
    Candidate candidate;
    bool is_known = false;  ///< the residual is small; else `name` is only the nearest
    double residual = 1, noise = 0;
    std::string runner_up;
    double runner_up_residual = 1;
    std::vector<std::string> same;  ///< other candidates that explain this scale as well

    /// Whether the kernel is as wide as the coarser grid asks; true while growing.
    bool is_widened(const Ratio& ratio) const;
};

struct AxisReport {
    KernelFinding kernel;
    Placement placement;
    std::string alignment;                           ///< corners, centers, top-left or shifted
    double shift = 0;                                ///< of the middle of the image, in target samples to the right
    double support_source = 0, support_coarser = 0;  ///< radius, in pitches of the source and of the coarser grid
    Phases phases;
    double bias = 0;  ///< mean error, in the light that is filtered; in codes for integers
    KernelSamples samples;
};

struct ScaleReport {
    Ratio ratio;
    AxisReport x, y;
    double axis_difference = 0;     ///< of the weights along x and y, root mean square over that of the weights
    double not_separable = 0;       ///< what is left of impulses after the best product of a column and a row, likewise
    std::optional<bool> separable;  ///< none where rounding hides it
    double pass_error = 0, alias = 0;  ///< on the zone plate, in dB of its power
    double overshoot = 0;              ///< next to an edge inside the range, of its height
    double expected_overshoot = 0;     ///< what the kernel predicts
    double overrange = 0;              ///< beyond [0, 1] next to an edge from 0 to 1
    Image<float> plate;                ///< what became of the zone plate, as stored
};

enum class AlphaMode { untested, failed, dropped, bleeds, weighted };
std::string_view name_of(AlphaMode mode);

struct AlphaReport {
    Ratio ratio;
    AlphaMode mode = AlphaMode::untested;
    std::string failure;    ///< what the resizer said, if it failed
    double leak = 0;        ///< of the colour under alpha 0 into pixels that can be seen, at most
    std::string hidden;     ///< what becomes of that colour where nothing else is: kept, zero or changed
    double coverage = 0;    ///< mean alpha of a checkerboard of 0 and 1; 0.5 is right
    double flat_error = 0;  ///< largest change of a constant, half transparent colour
};

struct AuditReport {
    std::vector<LightReport> light;  ///< at the first scale that shrinks, at the first that grows
    Light filtered_in = Light::unknown;
    std::vector<ScaleReport> scales;
    std::vector<std::string_view> edges;  ///< the edge rules that explain all rows; empty: unknown or not visible
    EdgeErrors edge_errors;
    std::vector<AlphaReport> alpha;  ///< at the same scales as light
    double code = 0;
    int runs = 0;
};

/// Tests a resizer.
///
/// cost    the runs (16 for the default scales), and about a second of one core
/// throws  Error for no scale, or images of another shape than asked for; what the resizer throws
AuditReport audit(const ResizeFunction& resize, const AuditOptions& options = {});

}  // namespace bandlimit
