#include "bandlimit/io/taps_json.h"

#include <gtest/gtest.h>

#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

TapsFile example() {
    TapsFile file{.kind = "downsample", .factor = 2, .error = 0.1, .cost = 4, .taps = Taps{}};
    file.taps->first = -3;
    file.taps->factor = 2;
    file.taps->weights = {0.1, -1.0 / 3, 1e-300, 5e-324, 1.7976931348623157e308, 0.30000000000000004};
    return file;
}

TEST(TapsJson, ComesBackBitForBit) {
    const Folder folder;
    const TapsFile file = example();
    write_taps(folder / "taps.json", file);
    const TapsFile again = read_taps(folder / "taps.json");
    EXPECT_EQ(again.kind, file.kind);
    EXPECT_EQ(again.factor, 2);
    EXPECT_EQ(again.error, file.error);
    EXPECT_EQ(again.cost, file.cost);
    const Taps& taps = taps_of(again, "taps.json");
    EXPECT_EQ(taps.first, -3);
    EXPECT_EQ(taps.factor, 2);
    EXPECT_EQ(taps.weights, file.taps->weights);
    EXPECT_EQ(folder.count(), 1);
}

TEST(TapsJson, ListsOfTwoDimensionsComeBackBitForBit) {
    TapsFile file{.kind = "disk", .factor = 1, .multiply_adds = 12};
    file.fetches = {{-0.75777, 1.0 / 3, 0.37487566}, {0, 2.907, -0.125}};
    file.terms = {{{1, 0.1, 5e-324}, {-0.3, 2}}, {{0, 1e300, 1}, {1, 0}}};
    file.components = {{0.862325, 1.624835, 0.767583, 1.862321}};
    file.loss = 0.02141;
    file.radius = 1.1;
    file.singular_values = {36.744, 9.127};
    const TapsFile again = parse_taps(taps_text(file), "x");
    EXPECT_EQ(taps_text(again), taps_text(file));
    ASSERT_EQ(again.fetches.size(), 2u);
    EXPECT_EQ(again.fetches[0].y, 1.0 / 3);
    ASSERT_EQ(again.terms.size(), 2u);
    EXPECT_EQ(again.terms[0].column, file.terms[0].column);
    EXPECT_EQ(again.terms[1].row, file.terms[1].row);
    ASSERT_EQ(again.components.size(), 1u);
    EXPECT_EQ(again.components[0].B, 1.862321);
    EXPECT_EQ(again.singular_values, file.singular_values);
    EXPECT_EQ(again.radius, 1.1);
    EXPECT_EQ(again.multiply_adds, 12);
}

TEST(TapsJson, AKernelComesBackBitForBit) {
    TapsFile file{.kind = "kernel"};
    file.pieces = {{0, 1.0 / 3, {1, 0, -0.1}}, {1.0 / 3, 2, {0.7, -0.2, 5e-324, 3}}};
    const TapsFile again = parse_taps(taps_text(file), "x");
    EXPECT_EQ(taps_text(again), taps_text(file));
    const Kernel kernel = kernel_of(again, "mine.json");
    EXPECT_EQ(kernel.name, "mine.json");
    EXPECT_EQ(kernel.radius, 2);
    for (const double x : {0.0, 0.25, 1.0, -1.5}) EXPECT_EQ(kernel.value(x), value_of(file.pieces, x));
    EXPECT_TRUE(fails_for(
        "x", [] { kernel_of(example(), "x"); }, "holds no kernel (its kind is \"downsample\")"));
    file.pieces[1].begin = 0.5;
    EXPECT_THROW(taps_text(file), Error);
}

TEST(TapsJson, HostileListsAreOneClearError) {
    for (const std::string text :
         {R"("fetches":1)", R"("fetches":[1])", R"("fetches":[{"x":0,"y":0}])", R"("terms":[{"column":[1]}])",
          R"("terms":[{"column":[],"row":[1]}])", R"("terms":[{"column":[1],"row":[1]},{"column":[1],"row":[1,2]}])",
          R"("components":[{"a":1,"b":1,"A":1}])", R"("components":[{"a":1,"b":1,"A":1,"B":"x"}])",
          R"("components":{})", R"("pieces":[{"begin":0,"end":1}])",
          R"("pieces":[{"begin":1,"end":2,"coefficients":[1]}])",
          R"("pieces":[{"begin":0,"end":1e300,"coefficients":[1]}])",
          R"("pieces":[{"begin":0,"end":1,"coefficients":[]}])", R"("singular_values":[])", R"("radius":"1")",
          R"("loss":1e999)"})
        EXPECT_TRUE(fails_for(
            "x", [&] { parse_taps("{\"version\":1," + text + "}", "x"); }, "; "))
            << text;
}

TEST(TapsJson, WhatIsOptionalMayBeMissingAndOtherKeysAreIgnored) {
    const TapsFile file = parse_taps(R"({"version":1,"terms":[{"column":[1],"row":[2]}],"author":{"name":"me"}})", "x");
    EXPECT_EQ(file.factor, 1);
    EXPECT_FALSE(file.taps || file.error || file.cost);
    EXPECT_TRUE(fails_for(
        "x", [&] { taps_of(file, "x"); }, "holds no 1D taps"));
}

TEST(TapsJson, HostileTextIsOneClearError) {
    const auto with_taps = [](const std::string& taps) { return R"({"version":1,"taps":)" + taps + "}"; };
    std::string many = "[0";
    for (int i = 0; i < 65536; ++i) many += ",0";
    const std::vector<std::string> texts{"",
                                         "x",
                                         "{",
                                         "[]",
                                         "1",
                                         "null",
                                         "\"taps\"",
                                         "{\"version\":1",
                                         std::string("\0\0", 2),
                                         "\xff\xfe",
                                         "{}",
                                         R"({"version":2})",
                                         R"({"version":"1"})",
                                         R"({"version":1.0})",
                                         R"({"version":18446744073709551617})",
                                         R"({"version":1,"factor":0})",
                                         R"({"version":1,"factor":4097})",
                                         R"({"version":1,"factor":2.5})",
                                         R"({"version":1,"factor":-9223372036854775808})",
                                         R"({"version":1,"factor":18446744073709551615})",
                                         R"({"version":1,"kind":3})",
                                         R"({"version":1,"error":"small"})",
                                         R"({"version":1,"cost":1e999})",
                                         with_taps("3"),
                                         with_taps("{}"),
                                         with_taps(R"({"first":0})"),
                                         with_taps(R"({"first":0,"weights":[]})"),
                                         with_taps(R"({"first":0,"weights":{"a":1}})"),
                                         with_taps(R"({"first":0,"weights":[1,"2"]})"),
                                         with_taps(R"({"first":0,"weights":[NaN]})"),
                                         with_taps(R"({"first":0,"weights":[Infinity]})"),
                                         with_taps(R"({"first":0,"weights":[1e400]})"),
                                         with_taps(R"({"first":0,"weights":[null]})"),
                                         with_taps(R"({"first":1000001,"weights":[1]})"),
                                         with_taps(R"({"first":-1000001,"weights":[1]})"),
                                         with_taps(R"({"first":18446744073709551615,"weights":[1]})"),
                                         with_taps(R"({"first":"0","weights":[1]})"),
                                         with_taps(R"({"first":0,"weights":)" + many + "]}"),
                                         std::string(1000000, '['),
                                         R"({"version":1,"a":)" + std::string(1000, '[') + std::string(1000, ']') + "}",
                                         std::string((16 << 20) + 1, ' ')};
    for (const std::string& text : texts)
        EXPECT_TRUE(fails_for("evil.json", [&] { parse_taps(text, "evil.json"); })) << text.substr(0, 100);
}

TEST(TapsJson, EveryPrefixFailsOrIsWhole) {
    const Folder folder;
    write_taps(folder / "a.json", example());
    const std::string text = bytes_of(folder / "a.json");
    for (std::size_t size = 0; size + 2 < text.size(); ++size)
        EXPECT_TRUE(fails_for("x", [&] { parse_taps(std::string_view(text).substr(0, size), "x"); }));
}

TEST(TapsJson, FilesThatCannotBeReadOrWritten) {
    const Folder folder;
    const std::string missing = folder / "none.json", nowhere = folder / "no/taps.json";
    EXPECT_TRUE(fails_for(
        missing, [&] { read_taps(missing); }, "does not exist"));
    EXPECT_TRUE(fails_for(
        folder / "", [&] { read_taps(folder / ""); }, "a directory"));
    EXPECT_TRUE(fails_for(
        nowhere, [&] { write_taps(nowhere, example()); }, "create it"));
    TapsFile file = example();
    file.taps->weights.push_back(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(write_taps(folder / "a.json", file), Error);
    file = example();
    file.factor = 3;
    EXPECT_THROW(write_taps(folder / "a.json", file), Error);
    EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace bandlimit
