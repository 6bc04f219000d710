// bandlimit audit, from outside: other programs that are right, wrong, slow and broken.
#include <cstdlib>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

/// A shell whose program makes its temporary files in `tmp` of its folder.
class Auditor {
public:
    Auditor() {
        std::filesystem::create_directory(shell_ / "tmp");
        ::setenv("TMPDIR", (shell_ / "tmp").c_str(), 1);
        // The program finds itself by name, installed or not; the test, which runs in its place, does not.
        const std::string folder = std::filesystem::path(BANDLIMIT_PROGRAM).parent_path();
        ::setenv("PATH", (path_ + ":" + folder).c_str(), 1);
    }
    ~Auditor() {
        ::unsetenv("TMPDIR");
        ::setenv("PATH", path_.c_str(), 1);
    }
    Auditor(const Auditor&) = delete;
    Auditor& operator=(const Auditor&) = delete;

    Outcome operator()(const std::string& command, const std::string& options = "", const Circumstances& c = {}) const {
        std::vector<std::string> words{"audit", command};
        for (const std::string& word : words_of(options)) words.push_back(word);
        return shell_.run(words, c);
    }
    std::string operator/(const std::string& name) const { return shell_ / name; }
    bool left_nothing() const { return std::filesystem::is_empty(shell_ / "tmp"); }

private:
    Shell shell_{BANDLIMIT_PROGRAM};
    std::string path_ = ::getenv("PATH");
};

TEST(Audit, FindsOutAboutItself) {
    const Auditor audit;
    // The program finds itself by name, installed or not.
    const Outcome run = audit("bandlimit resize {in} {out} --size {width}x{height} --kernel mitchell --edge wrap",
                              "--scales 2 --json --html page --keep files");
    ASSERT_TRUE(succeeds(run));
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["filtered_in"], "srgb");
    EXPECT_EQ(report["edges"], nlohmann::json::array({"wrap"}));
    EXPECT_EQ(report["runs"], 5);
    EXPECT_EQ(report["channel_spread"], 0);
    EXPECT_EQ(report["alpha"][0]["mode"], "weighted");
    ASSERT_EQ(report["scales"].size(), 1u);
    for (const char* axis : {"x", "y"}) {
        const nlohmann::json& a = report["scales"][0][axis];
        EXPECT_EQ(a["kernel"]["name"], "mitchell");
        EXPECT_EQ(a["kernel"]["known"], true);
        EXPECT_LT(a["kernel"]["residual"].get<double>(), 0.015);
        EXPECT_EQ(a["alignment"], "corners");
        EXPECT_EQ(a["measured"]["x"].size(), a["measured"]["value"].size());
    }
    for (const nlohmann::json& finding : report["findings"]) EXPECT_FALSE(finding["wrong"].get<bool>()) << finding;
    for (const char* file :
         {"page/index.html", "page/kernel-1-to-2.png", "page/plate-1-to-2.png", "files/01-in.png", "files/05-out.png"})
        EXPECT_TRUE(std::filesystem::exists(audit / file)) << file;
    EXPECT_TRUE(audit.left_nothing());
}

TEST(Audit, SaysInWordsWhatIsWrong) {
    const Auditor audit;
    const Outcome run =
        audit("bandlimit resize {in} {out} --size {width}x{height} --kernel tent --align centers --space data",
              "--scales 2 --grey --depth u16");
    ASSERT_TRUE(succeeds(run));
    const auto found = run.out.find("\nFound\n");
    ASSERT_NE(found, std::string::npos) << run;
    const std::string wrong = run.out.substr(0, found);
    EXPECT_NE(wrong.find("align_corners"), std::string::npos) << run;
    EXPECT_NE(wrong.find("averages sRGB codes"), std::string::npos) << run;
    EXPECT_NE(run.out.find("kernel: tent"), std::string::npos) << run;
    EXPECT_TRUE(audit.left_nothing());
}

TEST(Audit, CommandsThatFailAreOneClearLine) {
    const Auditor audit;
    const std::string names = " # {in} {out} {width}x{height}";
    struct Case {
        std::string command, word, options = "";
    };
    for (const auto& [command, word, options] : {
             Case{"echo first >&2; echo last words >&2; exit 3" + names, "exit code 3"},
             {"echo first >&2; echo last words >&2; exit 3" + names, "last words"},
             {"no-such-program" + names, "exit code 127"},
             {"kill -SEGV $$" + names, "signal 11"},
             {"sleep 100 & sleep 100" + names, "0.3 s", "--timeout 0.3"},
             {"true" + names, "wrote no {out}"},
             {"cp {in} {out}" + names, "46 x"},
             {"echo rubbish > {out}" + names, "cannot be read"},
         })
        EXPECT_TRUE(fails(1, audit(command, options + " --scales 1/2"), word)) << command;
    EXPECT_TRUE(audit.left_nothing());
    EXPECT_TRUE(fails(1, audit("cp {in} {out}" + names, "--html no/such"), "no/such"));
}

TEST(Audit, WhatTheCommandLineAloneShowsToBeWrong) {
    const Auditor audit;
    struct Case {
        std::string command, word, options = "";
    };
    for (const auto& [command, word, options] : {
             Case{"cp {in} x {width}", "{in} and {out}"},
             {"cp {in} {out}", "{width}"},
             {"cp {in} {out} {scale}", "1/8", "--scales 1/20"},
             {"cp {in} {out} {scale}", "ratio", "--scales 0.123456"},
             {"cp {in} {out} {scale}", "timeout", "--timeout 0"},
             {"cp {in} {out} {scale}", "png, jpg", "--format xyz"},
             {"cp {in} {out} {scale}", "u8", "--format jpg --depth u16"},
         })
        EXPECT_TRUE(fails(2, audit(command, options), word)) << command << " " << options;
}

TEST(Audit, AnInterruptionEndsTheCommandAndRemovesItsFiles) {
    const Auditor audit;
    bool started = false;
    const Outcome run = audit("sleep 100 # {in} {out} {scale}", "", {.meanwhile = [&](pid_t program) {
                                  for (const auto& folder : std::filesystem::directory_iterator(audit / "tmp"))
                                      started = started || std::filesystem::exists(folder.path() / ".stderr");
                                  if (started) ::kill(program, SIGTERM);
                                  return started;
                              }});
    EXPECT_TRUE(started);
    EXPECT_EQ(run.signal, SIGTERM);
    EXPECT_TRUE(audit.left_nothing());
    EXPECT_LT(run.seconds, 60);
}

}  // namespace
}  // namespace bandlimit
