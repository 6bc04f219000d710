// Programs in other languages: they hold their own buffers and use their own clock; bench/README.md has the protocol.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "bandlimit/core/error.h"
#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

/// A child whose standard input and output are ours.
class Child {
public:
    explicit Child(const std::string& command) {
        std::array<int, 2> in{}, out{};
        // Closed in every other child, or none would see the end of its input.
        if (pipe2(in.data(), O_CLOEXEC) || pipe2(out.data(), O_CLOEXEC)) fail("no pipe for: ", command);
        pid_ = fork();
        if (pid_ < 0) fail("no process for: ", command);
        if (pid_ == 0) {
            dup2(in[0], STDIN_FILENO), dup2(out[1], STDOUT_FILENO);
            execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
            _exit(127);
        }
        close(in[0]), close(out[1]);
        to_ = fdopen(in[1], "w"), from_ = fdopen(out[0], "r");
        signal(SIGPIPE, SIG_IGN);
    }
    ~Child() {
        fclose(to_), fclose(from_);
        waitpid(pid_, nullptr, 0);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// The line it answers with; empty when it has ended.
    std::string read() {
        std::string line;
        for (int c = std::fgetc(from_); c != EOF && c != '\n'; c = std::fgetc(from_)) line += static_cast<char>(c);
        return line;
    }
    std::string ask(const std::string& line) {
        std::fputs((line + "\n").c_str(), to_);
        std::fflush(to_);
        return read();
    }

private:
    pid_t pid_ = 0;
    FILE *to_ = nullptr, *from_ = nullptr;
};

/// A file of this process's own, gone at the end.
class Exchange {
public:
    Exchange()
        : path_((std::filesystem::temp_directory_path() / ("bandlimit-bench-" + std::to_string(getpid()))).string()) {}
    ~Exchange() { std::remove(path_.c_str()); }
    Exchange(const Exchange&) = delete;
    Exchange& operator=(const Exchange&) = delete;

    void write(std::span<const std::byte> bytes) const {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    void read(std::span<std::byte> bytes) const {
        std::ifstream(path_, std::ios::binary)
            .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

std::optional<Task> prepare(const std::shared_ptr<Child>& child, const Case& c, const Buffers& buffers, int threads) {
    const auto exchange = std::make_shared<Exchange>();
    exchange->write(buffers.sources[0]);
    std::ostringstream line;
    line << "prepare " << c.width << " " << c.height << " " << c.new_width << " " << c.new_height << " "
         << (c.channels == 1 ? "f32" : "rgba8") << " " << (c.filter == Filter::box ? "box" : "lanczos3") << " "
         << (c.chain ? "chain" : "one") << " " << (c.linear ? "linear" : "codes") << " " << threads << " "
         << buffers.count() << " " << exchange->path();
    const std::string answer = child->ask(line.str());
    if (answer == "none") return {};
    if (answer != "ready" && answer != "other") fail("a program answered \"", answer, "\" to: ", line.str());
    return Task{.run = [=](int k) { return std::strtod(child->ask("run " + std::to_string(k)).c_str(), nullptr); },
                .collect =
                    [=, &buffers](int k) {
                        child->ask("save " + std::to_string(k) + " " + exchange->path());
                        exchange->read(buffers.targets[static_cast<std::size_t>(k)]);
                    },
                .other = answer == "other"};
}

}  // namespace

std::optional<Peer> process_peer(const std::string& command) {
    const auto child = std::make_shared<Child>(command);
    // Name, number of threads and note, separated by tabulators.
    std::istringstream hello(child->ask("hello"));
    std::string name, threads, note;
    if (!std::getline(hello, name, '\t') || !std::getline(hello, threads, '\t') || !std::getline(hello, note))
        return {};
    return Peer{.name = name,
                .note = note,
                .threads = std::atoi(threads.c_str()),
                .prepare = [=](const Case& c, const Buffers& buffers, int n) { return prepare(child, c, buffers, n); }};
}

}  // namespace bandlimit::bench
