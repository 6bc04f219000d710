// Textures of all pictures below a directory.
// Stability: evolving.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bandlimit/job/context.h"
#include "bandlimit/job/mips_recipe.h"
#include "bandlimit/texture/container.h"

namespace bandlimit::job {

struct BatchJob {
    std::string in, out;  ///< directories; `out`, and what is below, is created
    Container format = Container::ktx2;
    std::string rules = {};    ///< path of a file of rules, or ""
    std::uint64_t memory = 0;  ///< bytes for the textures that are made at a time; 0: a quarter of what is available
    bool is_dry = false;
    MipsRecipe recipe = {};  ///< of every picture, but for what rules say
};

/// A picture below the directory, and what becomes of it.
struct PlannedFile {
    std::string input, output;  ///< relative to the directories
    std::string state;          ///< "make", "up to date", "left out", "fail"
    std::string role, because;  ///< because: what decided the role, or the reason of the failure
};

struct BatchReport {
    struct Failure {
        std::string file, error;
    };
    int made = 0, skipped = 0, left_out = 0;
    std::vector<Failure> failed;
    std::vector<std::string> notes;    ///< what the user should know about those made
    std::map<std::string, int> roles;  ///< of those made
    std::uint64_t pixels = 0;          ///< of level 0 of those made
    double seconds = 0;

    int files() const { return made + skipped + static_cast<int>(failed.size()); }
    double megapixels_per_second() const { return seconds > 0 ? static_cast<double>(pixels) / 1e6 / seconds : 0; }
};

/// What make_batch would do. Reads the bytes of all pictures, writes nothing. Throws as make_batch.
std::vector<PlannedFile> plan_batch(const BatchJob& job, const Context& context = {});

/// Makes what is not up to date, several textures at a time, as many as threads and memory allow. What fails is listed
/// and stops nothing. What is done is noted in a manifest in the output directory as work goes on, so that a later run
/// goes on from there, however this one ended.
///
/// throws   std::runtime_error for directories and rules that cannot be read or written; Stopped, once the textures that
///          are done are in the manifest: those that were being made leave nothing behind
/// example  BatchJob job{"pictures", "textures"};
///          for (const BatchReport::Failure& f : make_batch(job).failed) log(f.file + ": " + f.error);
BatchReport make_batch(const BatchJob& job, const Context& context = {});

}  // namespace bandlimit::job
