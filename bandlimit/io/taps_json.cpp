#include "bandlimit/io/taps_json.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "bandlimit/core/error.h"
#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/limited_json.h"
#include "bandlimit/io/regular_file.h"

namespace bandlimit {
namespace {

using nlohmann::json;

constexpr int version = 1;
constexpr int largest_factor = 4096;
constexpr int largest_first = 1'000'000;
constexpr std::size_t most_weights = 65'536;
constexpr std::size_t most_terms = 64, most_components = 16, most_pieces = 64;

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
        fail_file(name, "\"", what, "\" is not a finite number; correct it");
    return value.get<double>();
}

std::optional<double> optional_number(const json& object, const char* key, const std::string& name) {
    const auto found = object.find(key);
    if (found == object.end() || found->is_null()) return {};
    return number(*found, name, key);
}

/// The member `key` of `object`, or null.
const json* member(const json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() || found->is_null() ? nullptr : &*found;
}

std::vector<double> numbers(const json* list, const std::string& name, const char* what) {
    if (!list || !list->is_array() || list->empty() || list->size() > most_weights)
        fail_file(name, "\"", what, "\" is not a list of 1 to ", most_weights, " numbers; correct it");
    std::vector<double> result;
    for (const json& value : *list) result.push_back(number(value, name, what));
    return result;
}

Taps parse_1d(const json& object, int factor, const std::string& name) {
    if (!object.is_object()) fail_file(name, "\"taps\" is not an object; write {\"first\": ..., \"weights\": [...]}");
    const json *first = member(object, "first"), *weights = member(object, "weights");
    if (!first || !weights) fail_file(name, "\"taps\" lacks \"first\" or \"weights\"; add them");
    return {integer(*first, -largest_first, largest_first, name, "first"), numbers(weights, name, "weights"), factor};
}

/// What parse_one makes of each object in the list `key`, which may be missing.
template <class Parse>
auto list_of(const json& root, const char* key, std::size_t most, const std::string& name, Parse parse_one) {
    std::vector<decltype(parse_one(root))> result;
    const json* list = member(root, key);
    if (!list) return result;
    if (!list->is_array() || list->size() > most)
        fail_file(name, "\"", key, "\" is not a list of at most ", most, " entries; correct it");
    for (const json& entry : *list) {
        if (!entry.is_object()) fail_file(name, "\"", key, "\" holds something that is not an object; correct it");
        result.push_back(parse_one(entry));
    }
    return result;
}

/// The number `key` of `object`, which must be there.
double part(const json& object, const char* key, const std::string& name) {
    const json* value = member(object, key);
    if (!value) fail_file(name, "\"", key, "\" is missing in a list; add it");
    return number(*value, name, key);
}

void parse_2d(const json& root, const std::string& name, TapsFile& file) {
    const auto part_of = [&](const json& object, const char* key) { return part(object, key, name); };
    file.fetches = list_of(root, "fetches", most_weights, name, [&](const json& fetch) {
        return Fetch{part_of(fetch, "x"), part_of(fetch, "y"), part_of(fetch, "weight")};
    });
    file.terms = list_of(root, "terms", most_terms, name, [&](const json& term) {
        return Term{numbers(member(term, "column"), name, "column"), numbers(member(term, "row"), name, "row")};
    });
    for (const Term& term : file.terms)
        if (term.column.size() != file.terms[0].column.size() || term.row.size() != file.terms[0].row.size())
            fail_file(name, "\"terms\" have columns or rows of different lengths; make them equal");
    file.components = list_of(root, "components", most_components, name, [&](const json& component) {
        return Component{part_of(component, "a"), part_of(component, "b"), part_of(component, "A"),
                         part_of(component, "B")};
    });
}

/// Throws what piecewise_kernel would say against them, as an error of the file.
void parse_pieces(const json& root, const std::string& name, TapsFile& file) {
    file.pieces = list_of(root, "pieces", most_pieces, name, [&](const json& piece) {
        return KernelPiece{part(piece, "begin", name), part(piece, "end", name),
                           numbers(member(piece, "coefficients"), name, "coefficients")};
    });
    if (file.pieces.empty()) return;
    try {
        piecewise_kernel(file.pieces, name);
    } catch (const Error& e) {
        fail_file(name, "\"pieces\" make no kernel: ", e.what());
    }
}

}  // namespace

TapsFile parse_taps(std::string_view text, const std::string& name) {
    const json root = parse_limited_json(text, name, "a taps.json");
    if (!root.is_object()) fail_file(name, "holds no object; name a taps.json");
    const auto stated = root.find("version");
    if (stated == root.end()) fail_file(name, "has no \"version\"; name a taps.json");
    if (!stated->is_number_integer() || *stated != version)
        fail_file(name, "is of version ", stated->dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 32),
                  "; this program reads version ", version);

    TapsFile file;
    if (const auto kind = root.find("kind"); kind != root.end()) {
        if (!kind->is_string()) fail_file(name, "\"kind\" is not a text; correct it");
        file.kind = kind->get<std::string>();
    }
    if (const auto factor = root.find("factor"); factor != root.end())
        file.factor = integer(*factor, 1, largest_factor, name, "factor");
    file.error = optional_number(root, "error", name);
    file.cost = optional_number(root, "cost", name);
    file.multiply_adds = optional_number(root, "multiply_adds", name);
    file.loss = optional_number(root, "loss", name);
    file.radius = optional_number(root, "radius", name);
    if (const json* taps = member(root, "taps")) file.taps = parse_1d(*taps, file.factor, name);
    if (const json* values = member(root, "singular_values"))
        file.singular_values = numbers(values, name, "singular_values");
    parse_2d(root, name, file);
    parse_pieces(root, name, file);
    return file;
}

TapsFile read_taps(const std::string& path) {
    return parse_taps(read_text(path, most_json_bytes, "a taps.json"), path);
}

const Taps& taps_of(const TapsFile& file, const std::string& name) {
    if (!file.taps)
        fail_file(name, "holds no 1D taps", file.kind.empty() ? "" : " (its kind is \"" + file.kind + "\")",
                  "; name a file with \"taps\"");
    return *file.taps;
}

Kernel kernel_of(const TapsFile& file, const std::string& name) {
    if (file.pieces.empty())
        fail_file(name, "holds no kernel", file.kind.empty() ? "" : " (its kind is \"" + file.kind + "\")",
                  "; name a file with \"pieces\"");
    return piecewise_kernel(file.pieces, name);
}

std::string taps_text(const TapsFile& file) {
    if (file.taps && file.taps->factor != file.factor)
        fail("taps_text: taps of factor ", file.taps->factor, " in a file of factor ", file.factor,
             "; make them equal");
    nlohmann::ordered_json root;
    const auto add = [&](const char* key, const std::optional<double>& value) {
        if (value) root[key] = *value;
    };
    root["version"] = version;
    root["kind"] = file.kind;
    root["factor"] = file.factor;
    add("error", file.error);
    add("cost", file.cost);
    add("multiply_adds", file.multiply_adds);
    if (file.taps) root["taps"] = {{"first", file.taps->first}, {"weights", file.taps->weights}};
    for (const Fetch& f : file.fetches) root["fetches"].push_back({{"x", f.x}, {"y", f.y}, {"weight", f.weight}});
    for (const Term& t : file.terms) root["terms"].push_back({{"column", t.column}, {"row", t.row}});
    for (const Component& c : file.components)
        root["components"].push_back({{"a", c.a}, {"b", c.b}, {"A", c.A}, {"B", c.B}});
    for (const KernelPiece& p : file.pieces)
        root["pieces"].push_back({{"begin", p.begin}, {"end", p.end}, {"coefficients", p.coefficients}});
    add("loss", file.loss);
    if (!file.singular_values.empty()) root["singular_values"] = file.singular_values;
    add("radius", file.radius);
    const std::string text = root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    // What could not be read again is not written: a value that is not finite became null.
    try {
        const TapsFile again = parse_taps(text, "taps_text");
        if (again.error.has_value() != file.error.has_value() || again.cost.has_value() != file.cost.has_value() ||
            again.multiply_adds.has_value() != file.multiply_adds.has_value() ||
            again.loss.has_value() != file.loss.has_value() || again.radius.has_value() != file.radius.has_value())
            fail("taps_text: a number is not finite; leave it out");
    } catch (const std::runtime_error& e) {
        fail(e.what());
    }
    return text;
}

void write_taps(const std::string& path, const TapsFile& file) {
    const std::string text = taps_text(file);
    AtomicFile out(path);
    out.write(text.data(), text.size());
    out.commit();
}

}  // namespace bandlimit
