// JSON whose values know where they are, so that an error can name the line and the key.
//
//     LocatedJson file("scene.json", text, "a scene");
//     const LocatedObject root(file, file.root(), {"width", "height"});
//     const int width = root.integer("width", 1, 65535);  // scene.json, line 3: "width" is ...; ...
//
// Limits: 16 MB of text, two million values, 16 levels. A key that appears twice in an object is an error.
// Stability: inner.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {

struct JsonValue {
    enum class Kind { null, boolean, number, text, list, object };
    Kind kind = Kind::null;
    int line = 0;                        ///< from 1 on
    double number = 0;                   ///< also 0 and 1 for booleans
    std::string text = {};               ///< of a text
    std::vector<JsonValue> items = {};   ///< of a list or an object
    std::vector<std::string> keys = {};  ///< of an object, one per item

    bool is(Kind k) const { return kind == k; }
};

class LocatedJson {
public:
    /// `name` is what errors call it; `wanted`, as "a scene", what the user should name instead.
    /// throws   std::runtime_error "NAME, line N: what is wrong; what to do" for text that is not JSON, and beyond limits
    LocatedJson(std::string name, std::string_view text, std::string_view wanted);
    /// Reads a file. throws also for what cannot be read.
    static LocatedJson read(const std::string& path, std::string_view wanted);
    static constexpr std::uint64_t most_bytes = 16 << 20;

    const JsonValue& root() const { return root_; }
    const std::string& name() const { return name_; }

    /// Throws std::runtime_error "NAME, line N: the joined parts".
    template <class... Parts>
    [[noreturn]] void fail_at(const JsonValue& value, const Parts&... parts) const {
        fail_line(value.line, message(parts...));
    }

    /// `value`, which `key` names in errors, as what it should be. They throw as above for anything else.
    double number(const JsonValue& value, std::string_view key, double low, double high) const;
    int integer(const JsonValue& value, std::string_view key, int low, int high) const;
    const std::string& text(const JsonValue& value, std::string_view key) const;
    const std::vector<JsonValue>& list(const JsonValue& value, std::string_view key) const;
    /// A list of `least` to `most` numbers.
    std::vector<double> numbers(const JsonValue& value, std::string_view key, std::size_t least, std::size_t most,
                                double low, double high) const;

private:
    [[noreturn]] void fail_line(int line, const std::string& text) const;

    std::string name_;
    JsonValue root_;
};

/// An object of which all keys are known.
class LocatedObject {
public:
    /// throws   as LocatedJson for what is no object, and for keys that are not among these, listing them
    LocatedObject(const LocatedJson& file, const JsonValue& value, std::initializer_list<std::string_view> known,
                  std::string_view what);

    const JsonValue& value() const { return value_; }
    const JsonValue* find(std::string_view key) const;     ///< null if it is missing
    const JsonValue& require(std::string_view key) const;  ///< throws if it is missing

private:
    const LocatedJson& file_;
    const JsonValue& value_;
    std::string what_;
};

}  // namespace bandlimit
