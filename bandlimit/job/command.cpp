#include "bandlimit/job/command.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/io/signals.h"

namespace bandlimit::job {
namespace {

// What a signal handler must know. One folder and one command at a time.
std::array<char, 4096> folder_to_remove{};
std::atomic<pid_t> running_group{0};

/// Removes a folder and all in it, without what a signal handler must not call.
void remove_tree(const char* path) noexcept {
    const pid_t child = ::_Fork();  // fork() takes locks, which the thread that was interrupted may hold
    if (child == 0) {
        ::execl("/bin/rm", "rm", "-rf", "--", path, static_cast<char*>(nullptr));
        ::_exit(127);
    }
    if (child > 0) ::waitpid(child, nullptr, 0);
}

bool needs_no_quotes(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::strchr("./-_+,:@%=", c) != nullptr;
}

/// The last line of a file that holds more than blanks, shortened.
std::string last_line(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string last;
    for (std::string line; std::getline(in, line);) {
        std::replace_if(
            line.begin(), line.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
        const auto begin = line.find_first_not_of(' '), end = line.find_last_not_of(' ');
        if (begin != std::string::npos) last = line.substr(begin, std::min<std::size_t>(end - begin + 1, 200));
    }
    return last;
}

/// PATH with the folder of this program at its end.
std::string search_path() {
    const char* path = std::getenv("PATH");
    std::string all = path && *path ? path : "/usr/local/bin:/usr/bin:/bin";
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? all : all + ":" + self.parent_path().string();
}

/// Between fork and exec: nothing that allocates or locks. Does not return.
[[noreturn]] void become(const char* command, const char* folder, const char* out, const char* err, char** variables,
                         const sigset_t& signals) {
    ::setpgid(0, 0);
    for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGXFSZ, SIGPIPE}) ::signal(s, SIG_DFL);
    ::pthread_sigmask(SIG_SETMASK, &signals, nullptr);
    const auto redirect = [](const char* path, int flags, int to) {
        const int file = ::open(path, flags, 0600);
        if (file < 0 || ::dup2(file, to) < 0) ::_exit(126);
        if (file > STDERR_FILENO) ::close(file);
    };
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect(out, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
    redirect(err, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
    for (int file = STDERR_FILENO + 1; file < 256; ++file) ::close(file);
    if (::chdir(folder) != 0) ::_exit(126);
    std::array<char*, 4> arguments{const_cast<char*>("sh"), const_cast<char*>("-c"), const_cast<char*>(command),
                                   nullptr};
    ::execve("/bin/sh", arguments.data(), variables);
    ::_exit(126);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
    std::error_code error;
    std::filesystem::path place = std::filesystem::temp_directory_path(error);
    if (!error) place = std::filesystem::absolute(place, error);  // commands run elsewhere
    path_ = ((error ? std::filesystem::path("/tmp") : place) / "bandlimit-XXXXXX").string();
    const BlockedSignals blocked;  // until the handler knows what to remove
    if (path_.size() >= folder_to_remove.size() || !::mkdtemp(path_.data()))
        throw std::runtime_error(message("a temporary folder cannot be made as ", path_, " (", std::strerror(errno),
                                         "); set TMPDIR to a folder that you may write to"));
    std::copy(path_.c_str(), path_.c_str() + path_.size() + 1, folder_to_remove.begin());
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
    folder_to_remove[0] = '\0';
}

std::string made_folder(const std::string& name) {
    std::error_code error;
    std::filesystem::create_directory(name, error);
    if (error || !std::filesystem::is_directory(name))
        throw std::runtime_error(message(name, ": cannot be made a directory (",
                                         error ? error.message() : "it is a file",
                                         "); give a path in an existing directory that you may write to"));
    return std::filesystem::canonical(name).string();
}

std::string quoted(const std::string& word) {
    if (!word.empty() && std::all_of(word.begin(), word.end(), needs_no_quotes)) return word;
    std::string out = "'";
    for (const char c : word) c == '\'' ? out += "'\\''" : out += c;
    return out + "'";
}

bool is_plain(const std::string& path) {
    return std::all_of(path.begin(), path.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || std::strchr("./-_", c);
    });
}

std::string filled_in(const std::string& command, const std::map<std::string, std::string>& values) {
    std::string out;
    for (std::size_t i = 0; i < command.size();) {
        const auto found = std::find_if(values.begin(), values.end(), [&](const auto& entry) {
            return command.compare(i, entry.first.size() + 2, "{" + entry.first + "}") == 0;
        });
        if (found == values.end()) {
            out += command[i++];
            continue;
        }
        out += found->second;
        i += found->first.size() + 2;
    }
    return out;
}

CommandEnd run_command(const std::string& command, const std::string& folder, double timeout_seconds) {
    using Clock = std::chrono::steady_clock;
    const std::string out = folder + "/.stdout", err = folder + "/.stderr", path = "PATH=" + search_path();
    std::vector<char*> variables{const_cast<char*>(path.c_str())};
    for (char** v = environ; *v; ++v)
        if (std::strncmp(*v, "PATH=", 5) != 0) variables.push_back(*v);
    variables.push_back(nullptr);

    const auto start = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    pid_t child = -1;
    {
        const BlockedSignals blocked;  // until the handler knows what to kill
        child = ::fork();
        if (child == 0)
            become(command.c_str(), folder.c_str(), out.c_str(), err.c_str(), variables.data(), blocked.before());
        if (child > 0) {
            ::setpgid(child, child);  // here and in the child: whoever comes first
            running_group = child;
        }
    }
    if (child < 0) throw std::runtime_error(message("no process can be started (", std::strerror(errno), ")"));
    CommandEnd end;
    int status = 0;
    auto pause = std::chrono::microseconds(200);
    while (::waitpid(child, &status, WNOHANG) == 0) {
        if (seconds() > timeout_seconds) {
            end.timed_out = true;
            ::kill(-child, SIGKILL);
            ::waitpid(child, &status, 0);
            break;
        }
        std::this_thread::sleep_for(pause);
        pause = std::min(pause * 2, std::chrono::microseconds(5000));
    }
    ::kill(-child, SIGKILL);  // what it left running in the background
    running_group = 0;
    end.seconds = seconds();
    if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    end.last_words = last_line(err);
    if (end.last_words.empty()) end.last_words = last_line(out);
    std::error_code ignored;
    std::filesystem::remove(out, ignored);
    std::filesystem::remove(err, ignored);
    return end;
}

void abandon_commands() noexcept {
    if (const pid_t group = running_group; group > 0) ::kill(-group, SIGKILL);
    if (folder_to_remove[0] != '\0') remove_tree(folder_to_remove.data());
}

}  // namespace bandlimit::job
