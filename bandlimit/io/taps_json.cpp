#include "bandlimit/io/taps_json.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <nlohmann/json.hpp>

#include "bandlimit/core/error.h"
#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"

namespace bandlimit {
namespace {

using nlohmann::json;

constexpr int version = 1;
constexpr int largest_factor = 4096;
constexpr int largest_first = 1'000'000;
constexpr std::size_t most_weights = 65'536;
constexpr std::uintmax_t most_bytes = 16 << 20;
constexpr int deepest = 16;  // braces and brackets around anything in such a file

/// `value` as an integer in [low, high]; `what` names it in the error.
int integer(const json& value, int low, int high, const std::string& name, const char* what) {
    const bool is_in_range =
        value.is_number_integer() &&
        (value.is_number_unsigned() ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(high)
                                    : value.get<std::int64_t>() >= low) &&
        value.get<std::int64_t>() >= low && value.get<std::int64_t>() <= high;
    if (!is_in_range) fail_file(name, "\"", what, "\" is no whole number from ", low, " to ", high, "; correct it");
    return value.get<int>();
}

double number(const json& value, const std::string& name, const char* what) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        fail_file(name, "\"", what, "\" is no finite number; correct it");
    return value.get<double>();
}

std::optional<double> optional_number(const json& object, const char* key, const std::string& name) {
    const auto found = object.find(key);
    if (found == object.end() || found->is_null()) return {};
    return number(*found, name, key);
}

json parse(std::string_view text, const std::string& name) {
    if (text.size() > most_bytes) fail_file(name, "has more than 16 MB; name a taps.json");
    const auto limit_depth = [&](int depth, json::parse_event_t, json&) {
        if (depth > deepest) fail_file(name, "is nested deeper than ", deepest, " levels; name a taps.json");
        return true;
    };
    try {
        return json::parse(text, limit_depth);
    } catch (const json::exception& e) {
        fail_file(name, "is no JSON: ", e.what(), "; name a taps.json");
    }
}

Taps parse_1d(const json& object, int factor, const std::string& name) {
    if (!object.is_object()) fail_file(name, "\"taps\" is no object; write {\"first\": ..., \"weights\": [...]}");
    const auto first = object.find("first"), weights = object.find("weights");
    if (first == object.end() || weights == object.end())
        fail_file(name, "\"taps\" lacks \"first\" or \"weights\"; add them");
    if (!weights->is_array() || weights->empty() || weights->size() > most_weights)
        fail_file(name, "\"weights\" is no list of 1 to ", most_weights, " numbers; correct it");
    Taps taps;
    taps.factor = factor;
    taps.first = integer(*first, -largest_first, largest_first, name, "first");
    for (const json& weight : *weights) taps.weights.push_back(number(weight, name, "weights"));
    return taps;
}

/// Throws Error for what could not be read again.
void check(const TapsFile& file) {
    const auto is_finite = [](double v) { return std::isfinite(v); };
    if (file.factor < 1 || file.factor > largest_factor)
        fail("write_taps: factor = ", file.factor, "; pass 1 to ", largest_factor);
    if (!is_finite(file.error.value_or(0)) || !is_finite(file.cost.value_or(0)))
        fail("write_taps: error or cost is not finite; leave it out");
    if (!file.taps) return;
    const Taps& taps = *file.taps;
    if (taps.factor != file.factor)
        fail("write_taps: taps of factor ", taps.factor, " in a file of factor ", file.factor, "; make them equal");
    if (std::abs(static_cast<long long>(taps.first)) > largest_first)
        fail("write_taps: first = ", taps.first, "; pass at most ", largest_first, " either way");
    if (taps.weights.empty() || taps.weights.size() > most_weights)
        fail("write_taps: ", taps.weights.size(), " weights; pass 1 to ", most_weights);
    for (const double weight : taps.weights)
        if (!is_finite(weight)) fail("write_taps: a weight is ", weight, "; pass finite ones");
}

}  // namespace

TapsFile parse_taps(std::string_view text, const std::string& name) {
    const json root = parse(text, name);
    if (!root.is_object()) fail_file(name, "holds no object; name a taps.json");
    const auto stated = root.find("version");
    if (stated == root.end()) fail_file(name, "has no \"version\"; name a taps.json");
    if (!stated->is_number_integer() || *stated != version)
        fail_file(name, "is of version ", stated->dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 32),
                  "; this program reads version ", version);

    TapsFile file;
    if (const auto kind = root.find("kind"); kind != root.end()) {
        if (!kind->is_string()) fail_file(name, "\"kind\" is no text; correct it");
        file.kind = kind->get<std::string>();
    }
    if (const auto factor = root.find("factor"); factor != root.end())
        file.factor = integer(*factor, 1, largest_factor, name, "factor");
    file.error = optional_number(root, "error", name);
    file.cost = optional_number(root, "cost", name);
    if (const auto taps = root.find("taps"); taps != root.end()) file.taps = parse_1d(*taps, file.factor, name);
    return file;
}

TapsFile read_taps(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) fail_file(path, "does not exist or cannot be reached; check the path");
    if (!fs::is_regular_file(status)) fail_file(path, "is no regular file; name a taps.json");
    if (fs::file_size(path, error) > most_bytes) fail_file(path, "has more than 16 MB; name a taps.json");
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) fail_file(path, "cannot be read; check its permissions");
    return parse_taps(text, path);
}

const Taps& taps_of(const TapsFile& file, const std::string& name) {
    if (!file.taps)
        fail_file(name, "holds no 1D taps", file.kind.empty() ? "" : " (its kind is \"" + file.kind + "\")",
                  "; name a file with \"taps\"");
    return *file.taps;
}

void write_taps(const std::string& path, const TapsFile& file) {
    check(file);
    nlohmann::ordered_json root;
    root["version"] = version;
    root["kind"] = file.kind;
    root["factor"] = file.factor;
    if (file.error) root["error"] = *file.error;
    if (file.cost) root["cost"] = *file.cost;
    if (file.taps) root["taps"] = {{"first", file.taps->first}, {"weights", file.taps->weights}};
    const std::string text = root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    AtomicFile out(path);
    out.write(text.data(), text.size());
    out.commit();
}

}  // namespace bandlimit
