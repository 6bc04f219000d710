#include "bandlimit/job/batch_rules.h"

#include <fmt/core.h>
#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <type_traits>

#include "bandlimit/core/error.h"
#include "bandlimit/core/file_error.h"
#include "bandlimit/io/limited_json.h"
#include "bandlimit/io/regular_file.h"

namespace bandlimit::job {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using Setting = std::function<void(MipsRecipe&)>;

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return result;
}

std::vector<std::string> parts_of(std::string_view path) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        parts.emplace_back(path.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

using Part = std::vector<std::string>::const_iterator;

bool matches_parts(Part pattern, Part pattern_end, Part path, Part path_end) {
    if (pattern == pattern_end) return path == path_end;
    if (*pattern == "**") {
        // More of them in a row mean no more than one, and would take time without bound.
        while (pattern + 1 != pattern_end && *(pattern + 1) == "**") ++pattern;
        for (; path != path_end; ++path)
            if (matches_parts(pattern + 1, pattern_end, path, path_end)) return true;
        return matches_parts(pattern + 1, pattern_end, path, path_end);
    }
    return path != path_end && ::fnmatch(pattern->c_str(), path->c_str(), FNM_NOESCAPE) == 0 &&
           matches_parts(pattern + 1, pattern_end, path + 1, path_end);
}

std::string name_in(std::string_view path) { return parts_of(path).back(); }

/// A value of type T, or an error that says what it should be.
template <class T>
T value_of(const json& value) {
    constexpr bool is_text = std::is_same_v<T, std::string>, is_flag = std::is_same_v<T, bool>;
    const bool fits = is_text                  ? value.is_string()
                      : is_flag                ? value.is_boolean()
                      : std::is_same_v<T, int> ? value.is_number_integer() && value >= -1000000 && value <= 1000000
                                               : value.is_number();
    if (!fits)
        throw Error(fmt::format("{} does not fit; write {}",
                                value.dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 32),
                                is_text                  ? "a text"
                                : is_flag                ? "true or false"
                                : std::is_same_v<T, int> ? "a whole number"
                                                         : "a number"));
    return value.get<T>();
}

/// What the value of an option of a rule does, or an error that says what it should be.
Setting setting_of(const RecipeOption& option, const json& value, const fs::path& folder) {
    const auto make = [&](auto set) -> Setting {
        using Set = decltype(set);
        if constexpr (std::is_same_v<Set, RecipeOption::Flag>) {
            return [set, flag = value_of<bool>(value)](MipsRecipe& recipe) { recipe.*set = flag; };
        } else if constexpr (std::is_same_v<Set, RecipeOption::SetText>) {
            std::string text = value_of<std::string>(value);
            // A taps.json lies where the rules say, as seen from their own folder.
            if (option.name == "filter" && is_taps_file(text)) text = (folder / text).string();
            return [set, text](MipsRecipe& recipe) { set(recipe, text); };
        } else if constexpr (std::is_same_v<Set, RecipeOption::SetInt>) {
            return [set, number = value_of<int>(value)](MipsRecipe& recipe) { set(recipe, number); };
        } else {
            return [set, number = value_of<double>(value)](MipsRecipe& recipe) { set(recipe, number); };
        }
    };
    return std::visit(make, option.set);
}

std::string known_keys() {
    std::string names = "match, skip";
    for (const RecipeOption& option : recipe_options()) names += ", " + std::string(option.name);
    return names;
}

/// Reads one entry of a rule into it.
void read_entry(const std::string& name, const json& value, const fs::path& folder, Rule& rule) {
    if (name == "match") {
        rule.match = value_of<std::string>(value);
    } else if (name == "skip") {
        rule.is_skipped = value_of<bool>(value);
    } else if (name == "normal") {
        rule.normal = value_of<std::string>(value);
    } else {
        const RecipeOption* const option = find_option(name);
        if (option == nullptr) fail("is not a key of a rule; choose one of: ", known_keys());
        rule.settings.push_back(setting_of(*option, value, folder));
        MipsRecipe trial;
        rule.settings.back()(trial);  // throws for what is wrong
    }
}

/// What the one * of the name in `pattern` stands for in the name of `path`.
std::string star_of(const std::string& pattern, std::string_view path) {
    const std::string name = name_in(path), mask = name_in(pattern);
    const std::size_t star = mask.find('*');
    return name.substr(star, name.size() - (mask.size() - 1));
}

void check_rule(const Rule& rule) {
    if (rule.match.empty()) throw Error("\"match\" is missing; write which pictures the rule is for, as *_n.png");
    if (rule.normal.find('*') == std::string::npos) return;
    const std::string name = name_in(rule.match);
    if (std::count(name.begin(), name.end(), '*') != 1 || name.find_first_of("?[") != std::string::npos)
        throw Error("the * of \"normal\" is what the one of \"match\" stands for; write one * in its file name");
}

Rule read_rule(const json& object, const fs::path& folder, const std::string& name) {
    if (!object.is_object()) fail_file(name, "is not an object; write {\"match\": \"*_n.png\", \"role\": \"normal\"}");
    Rule rule;
    for (const auto& [key, value] : object.items()) {
        try {
            read_entry(key, value, folder, rule);
        } catch (const std::exception& e) {
            fail_file(name, "\"", key, "\": ", e.what());
        }
    }
    try {
        check_rule(rule);
        const MipsRecipe recipe = apply(rule, {}, "", rule.match);
        if (recipe.role) check_recipe(recipe, *recipe.role);
    } catch (const std::exception& e) {
        fail_file(name, e.what());
    }
    return rule;
}

}  // namespace

bool matches(std::string_view pattern, std::string_view path) {
    std::vector<std::string> mask = parts_of(lower(pattern));
    if (mask.size() == 1) mask.insert(mask.begin(), "**");
    const std::vector<std::string> parts = parts_of(lower(path));
    return matches_parts(mask.begin(), mask.end(), parts.begin(), parts.end());
}

std::vector<Rule> read_rules(const std::string& path) {
    const json root = parse_limited_json(read_text(path, most_json_bytes, "a file of rules"), path, "a file of rules");
    const bool is_ours = root.is_object() && root.contains("version") && root["version"] == 1 &&
                         root.contains("rules") && root["rules"].is_array();
    if (!is_ours) fail_file(path, "holds no rules; write {\"version\": 1, \"rules\": [ ... ]}");
    std::vector<Rule> rules;
    for (const json& rule : root["rules"])
        rules.push_back(
            read_rule(rule, fs::path(path).parent_path(), fmt::format("{}: rule {}", path, rules.size() + 1)));
    return rules;
}

const Rule* rule_for(const std::vector<Rule>& rules, std::string_view path) {
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const Rule& r) { return matches(r.match, path); });
    return rule == rules.end() ? nullptr : &*rule;
}

MipsRecipe apply(const Rule& rule, MipsRecipe recipe, const std::string& root, const std::string& path) {
    for (const Setting& set : rule.settings) set(recipe);
    if (rule.normal.empty()) return recipe;
    if (!recipe.role) recipe.role = Role::roughness;
    std::string name = rule.normal;
    if (const std::size_t star = name.find('*'); star != std::string::npos)
        name.replace(star, 1, star_of(rule.match, path));
    recipe.normal = (fs::path(root) / fs::path(path).parent_path() / name).string();
    return recipe;
}

}  // namespace bandlimit::job
