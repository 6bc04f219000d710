// How the tests meet the program: as a command line in a folder of their own, which runs in the process of the test or,
// where the process matters, starts the program.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/program.h"
#include "bandlimit/core/sanitized_test.h"
#include "bandlimit/io/files_test.h"

namespace bandlimit {

/// What became of a run.
struct Outcome {
    int code = -1;   ///< exit code; -1 after a signal
    int signal = 0;  ///< that ended it
    std::string out, err;
    double seconds = 0;

    nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline std::ostream& operator<<(std::ostream& to, const Outcome& o) {
    return to << "code " << o.code << ", signal " << o.signal << ", stdout \"" << o.out.substr(0, 500)
              << "\", stderr \"" << o.err.substr(0, 3000) << "\"";
}

/// What is unusual about a process.
struct Circumstances {
    std::vector<std::pair<int, rlim_t>> limits = {};  ///< resource and soft limit
    std::map<int, std::string> streams = {};          ///< standard streams that are this file, or closed if it is ""
    /// Called again and again while the program runs, with its process, until it returns true.
    std::function<bool(pid_t)> meanwhile = {};

    bool are_usual() const { return limits.empty() && streams.empty() && !meanwhile; }
};

/// The words of a line as a shell takes it apart: by blanks, but not between single quotes.
inline std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    bool in_word = false, in_quotes = false;
    for (const char c : line) {
        if (c == '\'') in_quotes = !in_quotes;
        const bool ends = c == ' ' && !in_quotes;
        if (!ends && !in_word) words.emplace_back();
        in_word = !ends;
        if (in_word && c != '\'') words.back() += c;
    }
    return words;
}

/// A folder in which the program runs.
class Shell {
public:
    explicit Shell(std::string program) : program_(std::move(program)) {}

    /// Runs the arguments that the blanks of `line` separate: in this process, if circumstances are usual.
    Outcome operator()(const std::string& line, const Circumstances& c = {}) const { return run(words_of(line), c); }
    Outcome run(const std::vector<std::string>& arguments, const Circumstances& c = {}) const {
        return c.are_usual() ? run_here(arguments) : start(arguments, c);
    }
    /// Starts the program.
    Outcome start(const std::vector<std::string>& arguments, const Circumstances& c = {}) const;
    Outcome start(const std::string& line, const Circumstances& c = {}) const { return start(words_of(line), c); }

    std::string operator/(const std::string& name) const { return folder_ / name; }
    /// The names of everything in the folder.
    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "."))
            names.insert(entry.path().filename());
        return names;
    }

private:
    Outcome run_here(const std::vector<std::string>& arguments) const;

    /// Between fork and exec: nothing that allocates or locks. Does not return.
    [[noreturn]] void become(char** arguments, const std::array<const char*, 3>& streams,
                             const Circumstances& c) const {
        for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
            const char* path = streams[static_cast<std::size_t>(stream)];
            ::close(stream);
            if (*path == '\0') continue;
            const int file = ::open(path, stream == STDIN_FILENO ? O_RDONLY : O_WRONLY | O_CREAT, 0600);
            if (file < 0 || (file != stream && (::dup2(file, stream) < 0 || ::close(file) != 0))) ::_exit(126);
        }
        if (::chdir(directory_.c_str()) != 0) ::_exit(126);
        for (const auto& [resource, value] : c.limits) {
            rlimit limit{};
            ::getrlimit(resource, &limit);
            limit.rlim_cur = value;
            ::setrlimit(resource, &limit);
        }
        ::execv(program_.c_str(), arguments);
        ::_exit(127);
    }

    Folder folder_, streams_;
    std::string program_, directory_ = folder_ / ".";
};

inline Outcome Shell::run_here(const std::vector<std::string>& arguments) const {
    std::vector<const char*> words;
    for (const std::string& argument : arguments) words.push_back(argument.c_str());
    char *out = nullptr, *err = nullptr;
    std::size_t out_size = 0, err_size = 0;
    const app::Streams streams{::open_memstream(&out, &out_size), ::open_memstream(&err, &err_size)};
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(directory_);
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome;
    outcome.code = app::run(words, streams);
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::filesystem::current_path(before);
    std::fclose(streams.out);
    std::fclose(streams.err);
    outcome.out.assign(out, out_size);
    outcome.err.assign(err, err_size);
    std::free(out);
    std::free(err);
    return outcome;
}

inline Outcome Shell::start(const std::vector<std::string>& arguments, const Circumstances& c) const {
    constexpr std::chrono::seconds patience(120);
    const std::string out = streams_ / "out", err = streams_ / "err";
    write_bytes(out, "");
    write_bytes(err, "");
    std::array<const char*, 3> streams{"/dev/null", out.c_str(), err.c_str()};
    for (const auto& [stream, path] : c.streams) streams[static_cast<std::size_t>(stream)] = path.c_str();
    std::vector<std::string> words{program_};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);

    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] { return std::chrono::steady_clock::now() - start; };
    const pid_t child = ::fork();
    if (child == 0) become(pointers.data(), streams, c);
    int status = 0;
    for (bool is_busy = static_cast<bool>(c.meanwhile); ::waitpid(child, &status, WNOHANG) == 0;) {
        if (is_busy) is_busy = !c.meanwhile(child);
        if (elapsed() > patience) ::kill(child, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    Outcome outcome;
    if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    outcome.out = bytes_of(out);
    outcome.err = bytes_of(err);
    outcome.seconds = std::chrono::duration<double>(elapsed()).count();
    // A sanitizer's exit code could pass for one of ours.
    for (const char* word : {"ERROR: AddressSanitizer", "ERROR: LeakSanitizer", "runtime error:"})
        EXPECT_EQ(outcome.err.find(word), std::string::npos) << outcome;
    return outcome;
}

/// The lines on stderr that are the program's own. Under a sanitizer codecs may print there too.
inline std::vector<std::string> stderr_lines(const Outcome& outcome) {
    std::vector<std::string> lines;
    std::istringstream in(outcome.err);
    for (std::string line; std::getline(in, line);)
        if (!is_sanitized || line.starts_with("bandlimit: ")) lines.push_back(line);
    return lines;
}

/// Whether the run ended with exit code 0 and without a word on stderr.
[[nodiscard]] inline ::testing::AssertionResult succeeds(const Outcome& outcome) {
    if (outcome.code != 0 || !stderr_lines(outcome).empty()) return ::testing::AssertionFailure() << outcome;
    return ::testing::AssertionSuccess();
}

/// Whether the run ended with this exit code, nothing on stdout, and on stderr the one line that an error is, with
/// `word`.
[[nodiscard]] inline ::testing::AssertionResult fails(int code, const Outcome& outcome, const std::string& word = "") {
    const std::vector<std::string> lines = stderr_lines(outcome);
    const bool is_right = outcome.code == code && outcome.out.empty() && lines.size() == 1 &&
                          lines[0].starts_with("bandlimit: error: ") && lines[0].find("; ") != std::string::npos &&
                          lines[0].find(word) != std::string::npos && outcome.err.ends_with('\n');
    if (is_right) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "expected code " << code << " and one line with \"" << word << "\"; "
                                         << outcome;
}

/// A picture whose samples are f(x, y, channel), which must be numbers that T holds.
template <class T, class F>
AnyImage image_of(int width, int height, int channels, F f) {
    Image<T> image(width, height, channels, Layout::interleaved);
    const View<T> view = image.view();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) view(x, y, c) = static_cast<T>(f(x, y, c));
    return image;
}

/// Writes `image` in the depth it has; the last of an even number of channels is alpha.
inline void save(const std::string& path, AnyImage& image) {
    const AnyConstView view = pixels(image);
    const auto [width, height, channels] = std::visit(
        [](const auto& v) {
            return std::array{v.width, v.height, v.channels};
        },
        view);
    write_image(path, target_of(depth_of(view), width, height, channels), view);
}

template <class T>
Image<T> load(const std::string& path) {
    return std::get<Image<T>>(read_image(path));
}

}  // namespace bandlimit
