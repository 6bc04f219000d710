// Options and reports of verbs that make a picture file out of another.
#pragma once
#include <nlohmann/json.hpp>

#include "apps/console/common.h"
#include "bandlimit/job/convolve.h"
#include "bandlimit/job/picture_filter.h"

namespace bandlimit::app {

/// What such verbs have besides options of their own.
struct PictureOptions {
    job::PictureFiles files;
    Parallel parallel;
    bool json = false;
};

/// Adds IN and OUT, which come first.
void add_pictures(Verb verb, PictureOptions& o);
/// Adds --space and --alpha.
void add_colour(Verb verb, PictureOptions& o);
/// Adds --depth, --tiles, --threads, --json and --quiet.
void add_output(Program& program, Verb verb, PictureOptions& o);
/// Throws UsageError for what the command line alone shows to be wrong.
void check_pictures(const PictureOptions& o);

/// A file and the picture in it, for reports.
nlohmann::ordered_json file_json(const std::string& file, const job::PictureSummary& picture);

/// How weights are to run.
struct WeightChoice {
    job::WeightOptions given;
    bool is_exact = false, is_fft = false;

    job::WeightOptions options() const {
        job::WeightOptions options = given;
        options.method = is_exact ? Method::direct : is_fft ? Method::fft : Method::automatic;
        return options;
    }
};
/// Adds --rank, --exact, --fft and --keep-sum.
void add_weight_options(Verb verb, WeightChoice& weights);

/// Prints what a convolution by `verb` did. `components` and `gamma` are in the JSON where they are not 0 and 1.
void print_report(Console& console, const std::string& verb, const PictureOptions& o, const job::ConvolveReport& report,
                  int components = 0, double gamma = 1);

}  // namespace bandlimit::app
