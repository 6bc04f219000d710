#include "bandlimit/io/located_json.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace bandlimit {
namespace {

LocatedJson parsed(const std::string& text) { return LocatedJson("file.json", text, "a scene"); }

template <class F>
std::string refusal(const F& f) {
    try {
        f();
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return {};
}

TEST(LocatedJson, ValuesKnowTheirLines) {
    const LocatedJson file = parsed("\n{ \"a\": 1\n, \"b\":\n[true,\n null,\r\n\"x\\ty\",\n-2.5e1\n]\n}");
    const JsonValue& root = file.root();
    EXPECT_EQ(root.line, 2);
    EXPECT_EQ(root.keys, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(root.items[0].line, 2);  // a number ends where something else begins, on the next line
    EXPECT_EQ(root.items[1].line, 4);
    const std::vector<JsonValue>& list = root.items[1].items;
    const int lines[] = {4, 5, 6, 7};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(list[i].line, lines[i]);
    EXPECT_EQ(list[3].number, -25);
    EXPECT_TRUE(list[1].is(JsonValue::Kind::null));
}

TEST(LocatedJson, SaysWhereTheTextIsWrong) {
    struct Case {
        std::string text, words;
    };
    const std::string deep(100'000, '[');
    for (const Case& c :
         std::vector<Case>{{"", "line 1: not JSON"},
                           {"{\"a\": 1,\n\"b\": nan}", "line 2: not JSON"},
                           {"[1, 2]\n]", "line 2: not JSON"},
                           {"[1,\n1e999]", "line 2: a number here is too large"},
                           {"\n{\"a\": 1, \"b\": 2, \"a\": 3}", "line 2: the object that begins here has \"a\" twice"},
                           {"[\n" + deep, "line 2: nested deeper than 16"},
                           {"[\"\xff\"]", "line 1: not JSON"}})
        EXPECT_NE(refusal([&] { parsed(c.text); }).find(c.words), std::string::npos)
            << c.text.substr(0, 40) << ": " << refusal([&] { parsed(c.text); });
    std::string many = "[0";
    for (int i = 0; i < 2'000'000; ++i) many += ",0";
    EXPECT_NE(refusal([&] { parsed(many + "]"); }).find("more than 2000000 values"), std::string::npos);
    EXPECT_NE(refusal([&] { parsed(std::string(17 << 20, ' ')); }).find("more than 16 MB"), std::string::npos);
}

TEST(LocatedJson, SaysWhichValueIsWrong) {
    const LocatedJson file = parsed("{\"size\": 2.5,\n\"name\": 7,\n\"list\": [1, \"a\"]}");
    const LocatedObject root(file, file.root(), {"size", "name", "list"}, "a thing");
    EXPECT_NE(refusal([&] {
                  file.integer(root.require("size"), "size", 1, 9);
              }).find("file.json, line 1: \"size\" is not a whole"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  file.number(root.require("size"), "size", 3, 9);
              }).find("\"size\" is 2.5; write a number from 3 to 9"),
              std::string::npos);
    EXPECT_NE(
        refusal([&] { file.text(root.require("name"), "name"); }).find("line 2: \"name\" is a number; write a text"),
        std::string::npos);
    EXPECT_NE(
        refusal([&] { file.numbers(root.require("list"), "list", 2, 2, 0, 9); }).find("line 3: \"list\" is a text"),
        std::string::npos);
    EXPECT_NE(
        refusal([&] { file.numbers(root.require("list"), "list", 3, 4, 0, 9); }).find("has 2 numbers; write 3 to 4"),
        std::string::npos);
    EXPECT_NE(refusal([&] { root.require("color"); }).find("line 1: a thing lacks \"color\"; add it"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  LocatedObject(file, file.root(), {"size", "name"}, "a thing");
              }).find("line 3: a thing has no \"list\"; choose among size, name"),
              std::string::npos);
    EXPECT_EQ(root.find("other"), nullptr);
}

}  // namespace
}  // namespace bandlimit
