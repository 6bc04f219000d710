#include "bandlimit/io/limited_json.h"

#include "bandlimit/core/file_error.h"

namespace bandlimit {

using nlohmann::json;

json parse_limited_json(std::string_view text, const std::string& name, std::string_view wanted) {
    constexpr int deepest = 16;  // braces and brackets around anything in a file of ours
    if (text.size() > most_json_bytes) fail_file(name, "has more than 16 MB; name ", wanted);
    const auto limit_depth = [&](int depth, json::parse_event_t, json&) {
        if (depth > deepest) fail_file(name, "is nested deeper than ", deepest, " levels; name ", wanted);
        return true;
    };
    try {
        return json::parse(text, limit_depth);
    } catch (const json::parse_error& e) {
        fail_file(name, "is not JSON from byte ", e.byte, " on; mend it there, or name ", wanted);
    } catch (const json::exception&) {
        fail_file(name, "holds a number that no computer number can hold; correct it");
    }
}

}  // namespace bandlimit
