// Rules of a batch: which pictures have which role and options.
// Stability: evolving.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/job/mips_recipe.h"

namespace bandlimit::job {

/// Whether `path` fits `pattern`, letters of both cases alike: * and ? stand for what a name holds, ** for folders.
/// A pattern without / is one of names, in any folder.
bool matches(std::string_view pattern, std::string_view path);

struct Rule {
    std::string match;
    bool is_skipped = false;
    std::string
        normal;  ///< name of a normal map in the folder of the picture; its * is what that of `match` stands for
    std::vector<std::function<void(MipsRecipe&)>> settings;
};

/// The content of a file of rules, docs/batch.md.
/// throws  std::runtime_error "PATH: what is wrong; what to do"
std::vector<Rule> read_rules(const std::string& path);

/// What the first rule that fits says of the picture `path`, relative to the directory `root`; null if none fits.
const Rule* rule_for(const std::vector<Rule>& rules, std::string_view path);
/// `recipe` with what `rule` says of the picture `path` below the directory `root`.
MipsRecipe apply(const Rule& rule, MipsRecipe recipe, const std::string& root, const std::string& path);

}  // namespace bandlimit::job
