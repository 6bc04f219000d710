#include "apps/console/console.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

namespace bandlimit::app {
namespace {

TEST(Visible, LeavesTextAndShowsWhatTerminalsActOn) {
    EXPECT_EQ(visible("a\\b %s {} Größe 寸法 🙂"), "a\\b %s {} Größe 寸法 🙂");
    EXPECT_EQ(visible(std::string("\x1b[31m\0\r\t\x7f", 9)), "\\x1b[31m\\x00\\x0d\\x09\\x7f");
    EXPECT_EQ(visible("two\nlines"), "two\\nlines");
    EXPECT_EQ(visible("two\nlines\r", true), "two\nlines\\x0d");
    EXPECT_EQ(visible("\xc2\x9b"
                      "31m \u202e \u2066 \u2028"),
              "\\u009b31m \\u202e \\u2066 \\u2028");
}

TEST(Visible, ShowsBytesThatAreNotUtf8) {
    EXPECT_EQ(visible("\xff\xfe.png"), "\\xff\\xfe.png");
    EXPECT_EQ(visible("\xc3"), "\\xc3");                             // cut short
    EXPECT_EQ(visible("\xe2\x80"), "\\xe2\\x80");                    // cut short
    EXPECT_EQ(visible("\xc0\xaf"), "\\xc0\\xaf");                    // longer than it need be
    EXPECT_EQ(visible("\xe0\x82\x9b"), "\\xe0\\x82\\x9b");           // so too, a control character
    EXPECT_EQ(visible("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // half a pair of UTF-16
    EXPECT_EQ(visible("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last
    EXPECT_EQ(visible("\x9b"
                      "31m"),
              "\\x9b31m");
}

/// What `work` makes a console write.
template <class Work>
std::string written(Work work) {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* const to = ::open_memstream(&text, &size);
    Console console({to, to});
    work(console);
    std::fclose(to);
    const std::string all(text, size);
    std::free(text);
    return all;
}

TEST(Console, TextThatIsFilledInIsVisible) {
    const std::string nasty = "\x1b[2J\n";
    EXPECT_EQ(written([&](Console& c) { c.print("{}:\n{:>4}\n", nasty, 3); }), "\\x1b[2J\\n:\n   3\n");
    EXPECT_EQ(written([&](Console& c) { c.print("{}\n", nasty.c_str()); }), "\\x1b[2J\\n\n");
    EXPECT_EQ(written([&](Console& c) { c.print_lines("a\n" + nasty); }), "a\n\\x1b[2J\n");
    EXPECT_EQ(written([&](Console& c) { c.note(nasty); }), "bandlimit: note: \\x1b[2J\n");
    EXPECT_EQ(written([&](Console& c) { c.error("a\nb.\n"); }), "bandlimit: error: a\\nb\n");
}

TEST(Console, JsonIsVisibleAndMeansTheSame) {
    const nlohmann::ordered_json report{{"file", "\x1b\x7f\xc2\x9b \u202e ö"}};
    const std::string text = written([&](Console& c) { c.print_json(report); });
    EXPECT_EQ(nlohmann::ordered_json::parse(text), report);
    EXPECT_EQ(visible(text, true), text);
    EXPECT_NE(text.find("ö"), std::string::npos);
}

}  // namespace
}  // namespace bandlimit::app
