#include "bandlimit/io/located_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bandlimit/io/regular_file.h"

namespace bandlimit {
namespace {

using nlohmann::json;

constexpr std::size_t most_values = 2'000'000, deepest = 16;

/// Characters of the text, for the parser, that note how far it is.
struct Reader {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at;
    const char** reached;

    reference operator*() const { return *at; }
    Reader& operator++() {
        ++at;
        if (at > *reached) *reached = at;
        return *this;
    }
    Reader operator++(int) {
        Reader before = *this;
        ++*this;
        return before;
    }
    bool operator==(const Reader& other) const { return at == other.at; }
    bool operator!=(const Reader& other) const { return at != other.at; }
};

/// The beginning of a text, for an error.
std::string shown(const std::string& text) { return message(text.substr(0, 40), text.size() <= 40 ? "" : "..."); }

/// What stops the parser.
struct Problem {
    int line;
    std::string text;
};

/// Builds values from the events of the parser.
class Builder : public json::json_sax_t {
public:
    Builder(std::string_view text, std::string_view wanted) : text_(text), wanted_(wanted), counted_(text.data()) {}

    const char* reached = nullptr;
    JsonValue root;

    bool null() override { return add(JsonValue::Kind::null), true; }
    bool boolean(bool value) override { return add(JsonValue::Kind::boolean).number = value, true; }
    bool number_integer(std::int64_t value) override { return add_number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) override { return add_number(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) override { return add_number(value); }
    bool string(std::string& value) override { return add(JsonValue::Kind::text).text = std::move(value), true; }
    bool binary(json::binary_t&) override { return false; }  // not in JSON text
    bool start_object(std::size_t) override { return open(JsonValue::Kind::object); }
    bool start_array(std::size_t) override { return open(JsonValue::Kind::list); }
    bool end_object() override {
        std::vector<std::string> keys = open_.back()->keys;
        std::sort(keys.begin(), keys.end());
        if (const auto twice = std::adjacent_find(keys.begin(), keys.end()); twice != keys.end())
            throw Problem{open_.back()->line,
                          "the object that begins here has \"" + shown(*twice) + "\" twice; leave one out"};
        return open_.pop_back(), true;
    }
    bool end_array() override { return open_.pop_back(), true; }
    bool key(std::string& key) override { return open_.back()->keys.push_back(key), true; }
    bool parse_error(std::size_t, const std::string&, const json::exception& e) override {
        const bool is_range = dynamic_cast<const json::out_of_range*>(&e) != nullptr;
        throw Problem{line(0), is_range ? "a number here is too large; correct it"
                                        : "not JSON from here on; correct it, or name " + std::string(wanted_)};
    }

private:
    /// The line of what the parser has just read, which looked `ahead` characters further.
    int line(std::ptrdiff_t ahead) {
        const char* end = reached - std::min<std::ptrdiff_t>(ahead, reached - text_.data());
        if (end > counted_) line_ += static_cast<int>(std::count(counted_, end, '\n')), counted_ = end;
        return line_;
    }
    JsonValue& add(JsonValue::Kind kind, std::ptrdiff_t ahead = 0) {
        if (++count_ > most_values) throw Problem{line(0), message("more than ", most_values, " values; use fewer")};
        JsonValue& value = open_.empty() ? root : open_.back()->items.emplace_back();
        value.kind = kind;
        value.line = line(ahead);
        return value;
    }
    bool add_number(double value) { return add(JsonValue::Kind::number, 1).number = value, true; }
    bool open(JsonValue::Kind kind) {
        if (open_.size() == deepest)
            throw Problem{line(0), message("nested deeper than ", deepest, " levels; name ", wanted_)};
        open_.push_back(&add(kind));
        return true;
    }

    std::string_view text_, wanted_;
    const char* counted_;
    int line_ = 1;
    std::size_t count_ = 0;
    std::vector<JsonValue*> open_;  // items of an object that is open do not move: only its own list grows
};

const char* name_of(JsonValue::Kind kind) {
    switch (kind) {
        case JsonValue::Kind::null: return "null";
        case JsonValue::Kind::boolean: return "true or false";
        case JsonValue::Kind::number: return "a number";
        case JsonValue::Kind::text: return "a text";
        case JsonValue::Kind::list: return "a list";
        case JsonValue::Kind::object: return "an object";
    }
    return "";
}

}  // namespace

LocatedJson::LocatedJson(std::string name, std::string_view text, std::string_view wanted) : name_(std::move(name)) {
    if (text.size() > most_bytes) fail_line(1, message("more than 16 MB; name ", wanted));
    Builder builder(text, wanted);
    builder.reached = text.data();
    const char* end = text.data() + text.size();
    try {
        json::sax_parse(Reader{text.data(), &builder.reached}, Reader{end, &builder.reached}, &builder);
    } catch (const Problem& problem) {
        fail_line(problem.line, problem.text);
    }
    root_ = std::move(builder.root);
}

LocatedJson LocatedJson::read(const std::string& path, std::string_view wanted) {
    return LocatedJson(path, read_text(path, most_bytes, wanted), wanted);
}

void LocatedJson::fail_line(int line, const std::string& text) const {
    throw std::runtime_error(message(name_, ", line ", line, ": ", text));
}

double LocatedJson::number(const JsonValue& value, std::string_view key, double low, double high) const {
    if (!value.is(JsonValue::Kind::number))
        fail_at(value, "\"", key, "\" is ", name_of(value.kind), "; write a number from ", low, " to ", high);
    if (!(value.number >= low && value.number <= high))
        fail_at(value, "\"", key, "\" is ", value.number, "; write a number from ", low, " to ", high);
    return value.number;
}

int LocatedJson::integer(const JsonValue& value, std::string_view key, int low, int high) const {
    if (!value.is(JsonValue::Kind::number) || value.number != std::floor(value.number) || !(value.number >= low) ||
        !(value.number <= high))
        fail_at(value, "\"", key, "\" is not a whole number from ", low, " to ", high, "; correct it");
    return static_cast<int>(value.number);
}

const std::string& LocatedJson::text(const JsonValue& value, std::string_view key) const {
    if (!value.is(JsonValue::Kind::text)) fail_at(value, "\"", key, "\" is ", name_of(value.kind), "; write a text");
    return value.text;
}

const std::vector<JsonValue>& LocatedJson::list(const JsonValue& value, std::string_view key) const {
    if (!value.is(JsonValue::Kind::list))
        fail_at(value, "\"", key, "\" is ", name_of(value.kind), "; write a list, as [...]");
    return value.items;
}

std::vector<double> LocatedJson::numbers(const JsonValue& value, std::string_view key, std::size_t least,
                                         std::size_t most, double low, double high) const {
    const std::vector<JsonValue>& items = list(value, key);
    if (items.size() < least || items.size() > most)
        fail_at(value, "\"", key, "\" has ", items.size(), " numbers; write ", least,
                least == most ? "" : message(" to ", most));
    std::vector<double> result;
    for (const JsonValue& item : items) result.push_back(number(item, key, low, high));
    return result;
}

LocatedObject::LocatedObject(const LocatedJson& file, const JsonValue& value,
                             std::initializer_list<std::string_view> known, std::string_view what)
    : file_(file), value_(value), what_(what) {
    if (!value.is(JsonValue::Kind::object))
        file.fail_at(value, what, " is ", name_of(value.kind), "; write an object, as {...}");
    for (std::size_t i = 0; i < value.keys.size(); ++i) {
        if (std::find(known.begin(), known.end(), value.keys[i]) != known.end()) continue;
        std::string list;
        for (const std::string_view key : known) list += (list.empty() ? "" : ", ") + std::string(key);
        file.fail_at(value.items[i], what, " has no \"", shown(value.keys[i]), "\"; choose among ", list);
    }
}

const JsonValue* LocatedObject::find(std::string_view key) const {
    const auto found = std::find(value_.keys.begin(), value_.keys.end(), key);
    return found == value_.keys.end() ? nullptr : &value_.items[static_cast<std::size_t>(found - value_.keys.begin())];
}

const JsonValue& LocatedObject::require(std::string_view key) const {
    const JsonValue* value = find(key);
    if (!value) file_.fail_at(value_, what_, " lacks \"", key, "\"; add it");
    return *value;
}

}  // namespace bandlimit
