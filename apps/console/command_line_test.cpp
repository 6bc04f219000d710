#include "apps/console/command_line.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace bandlimit::app {
namespace {

/// A command line of one verb, `do`.
struct OneVerb {
    CommandLine line{"version 1"};
    Verb verb = line.program().add_subcommand("do", "Does it");

    OneVerb() { line.program().require_one_subcommand("verb"); }
    OneVerb(const OneVerb&) = delete;

    std::optional<std::string> parse(std::vector<const char*> words) {
        words.insert(words.begin(), "do");
        return line.parse(words);
    }
    /// The words of the UsageError; "" where there is none.
    std::string error_of(const std::vector<const char*>& words) {
        try {
            parse(words);
            return "";
        } catch (const UsageError& e) {
            return e.what();
        }
    }
};

TEST(Options, SetTargetsOfEveryType) {
    OneVerb v;
    std::string text;
    int whole = 0;
    std::uint64_t large = 0;
    double real = 0;
    std::optional<int> maybe_whole;
    std::optional<double> maybe_real, absent;
    std::vector<std::string> words;
    bool flag = false;
    int doubled = 0;
    v.verb.add_option("--text", text, "");
    v.verb.add_option("--whole", whole, "");
    v.verb.add_option("--large", large, "");
    v.verb.add_option("--real", real, "");
    v.verb.add_option("--maybe-whole", maybe_whole, "");
    v.verb.add_option("--maybe-real", maybe_real, "");
    v.verb.add_option("--absent", absent, "");
    v.verb.add_option("WORDS", words, "");
    const Option given = v.verb.add_flag("--flag", flag, "");
    v.verb.add_option_function<int>(
        "--function", [&](int n) { doubled = 2 * n; }, "");
    EXPECT_EQ(v.parse({"a", "b", "--text", "t", "--whole", "-3", "--large", "18446744073709551615", "--real", "0.25",
                       "--maybe-whole", "4", "--maybe-real", "1e-3", "--flag", "--function", "21"}),
              std::nullopt);
    EXPECT_EQ(text, "t");
    EXPECT_EQ(whole, -3);
    EXPECT_EQ(large, 18446744073709551615u);
    EXPECT_EQ(real, 0.25);
    EXPECT_EQ(maybe_whole, 4);
    EXPECT_EQ(maybe_real, 1e-3);
    EXPECT_EQ(absent, std::nullopt);
    EXPECT_EQ(words, (std::vector<std::string>{"a", "b"}));
    EXPECT_TRUE(flag && given.is_given());
    EXPECT_FALSE(v.verb.option("--absent").is_given());
    EXPECT_EQ(given.name(), "--flag");
    EXPECT_EQ(doubled, 42);
}

TEST(Options, OneAtATimeLeavesTheRestToOthers) {
    OneVerb v;
    std::vector<std::string> set;
    std::string in, out;
    v.verb.add_option("--set", set, "").one_at_a_time();
    v.verb.add_option("IN", in, "");
    v.verb.add_option("OUT", out, "");
    v.parse({"--set", "a=1", "in", "--set", "b=2", "out"});
    EXPECT_EQ(set, (std::vector<std::string>{"a=1", "b=2"}));
    EXPECT_EQ(in + out, "inout");
}

TEST(Options, RangesHoldTheirEnds) {
    int whole = 0;
    double real = 0;
    const auto error_of = [&](const char* name, const char* value) {
        OneVerb v;
        v.verb.add_option("--whole", whole, "").in_range(1, 4);
        v.verb.add_option("--real", real, "").in_range(0.5, 2.0);
        return v.error_of({name, value});
    };
    for (const char* value : {"1", "4"}) EXPECT_EQ(error_of("--whole", value), "");
    for (const char* value : {"0.5", "2"}) EXPECT_EQ(error_of("--real", value), "");
    for (const char* value : {"0", "5", "-1", "2.5", "x", "99999999999"})
        EXPECT_NE(error_of("--whole", value).find("is out of range; pass 1 to 4"), std::string::npos) << value;
    for (const char* value : {"0.49", "2.01", "nan", "inf", "x"})
        EXPECT_NE(error_of("--real", value).find("is out of range; pass 0.5 to 2"), std::string::npos) << value;
}

TEST(Options, NeedAndExcludeEachOther) {
    bool a = false, b = false, c = false;
    const auto error_of = [&](const std::vector<const char*>& words) {
        OneVerb v;
        const Option first = v.verb.add_flag("--first", a, "");
        v.verb.add_flag("--with", b, "").needs(first);
        v.verb.add_flag("--without", c, "").excludes(first);
        return v.error_of(words);
    };
    EXPECT_EQ(error_of({"--first", "--with"}), "");
    EXPECT_EQ(error_of({"--without"}), "");
    EXPECT_EQ(error_of({"--with"}), "--with works only with --first; see bandlimit do --help");
    EXPECT_NE(error_of({"--without", "--first"}).find("cannot be used together"), std::string::npos);
}

TEST(Options, TheFirstUnexpectedArgumentIsNamed) {
    EXPECT_EQ(OneVerb().error_of({"one", "two"}), "unexpected argument \"one\"; see bandlimit do --help");
    EXPECT_EQ(OneVerb().error_of({"--one", "two"}), "unexpected argument \"--one\"; see bandlimit do --help");
}

TEST(Options, HelpAndVersionAreTextToPrint) {
    OneVerb v;
    int selected = 0;
    v.verb.example("bandlimit do it");
    v.verb.on([&] { ++selected; });
    const std::optional<std::string> help = v.parse({"--help"});
    ASSERT_TRUE(help.has_value());
    EXPECT_NE(help->find("Example:\n  bandlimit do it"), std::string::npos);
    EXPECT_EQ(v.line.parse(std::vector<const char*>{"--version"}), "version 1\n");
    EXPECT_EQ(selected, 0);
    EXPECT_EQ(v.parse({}), std::nullopt);
    EXPECT_EQ(selected, 1);
}

TEST(Options, AmountsOfMemory) {
    EXPECT_EQ(parse_bytes("--memory", "1"), 1u);
    EXPECT_EQ(parse_bytes("--memory", "512MB"), 512u << 20);
    EXPECT_EQ(parse_bytes("--memory", "4G"), std::uint64_t{4} << 30);
    EXPECT_EQ(parse_bytes("--memory", "18446744073709551615"), 18446744073709551615u);
    for (const std::string text : {"", "0", "-5", "-5GB", "1.5GB", "4X", "GB", "1e3", "nan", "18446744073709551616",
                                   "99999999999999999999G", "16EB"}) {
        try {
            parse_bytes("--memory", text);
            ADD_FAILURE() << text;
        } catch (const UsageError& e) {
            EXPECT_EQ(std::string(e.what()),
                      "--memory: \"" + text + "\" is not an amount of memory; use e.g. 512MB or 4GB");
        }
    }
}

}  // namespace
}  // namespace bandlimit::app
