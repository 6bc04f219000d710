// Other programs, run on files in a folder of their own.
#pragma once
#include <map>
#include <string>

namespace bandlimit::app {

/// A folder that is removed with all it holds when it is no longer needed, also when a signal ends the program.
class TemporaryFolder {
public:
    /// Throws std::runtime_error where no folder can be made.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// `word` as the shell reads it back: in quotes where it holds more than letters, digits and ./-_+:,@%= .
std::string quoted(const std::string& word);

/// Whether `path` holds only letters, digits and ./-_ , which mean themselves wherever a command may hold them: in
/// quotes of any kind, and in text for other interpreters.
bool is_plain(const std::string& path);

/// `command` with each {name} replaced by its value, as it is: values should be numbers or is_plain(). Other braces
/// stay.
std::string filled_in(const std::string& command, const std::map<std::string, std::string>& values);

/// What a command did.
struct CommandEnd {
    bool timed_out = false;
    int exit_code = -1;  ///< -1 after a signal
    int signal = 0;
    double seconds = 0;
    std::string last_words;  ///< the last line it wrote to stderr, or else to stdout
};

/// Runs `command` by /bin/sh in `folder`, in a process group of its own that is killed after so many seconds.
///
/// stdin is empty; stdout and stderr are read and never shown. The folder of this program is the last on PATH, so that
/// it can be called by its name.
/// throws   std::runtime_error where no process can be started
CommandEnd run_command(const std::string& command, const std::string& folder, double timeout_seconds);

/// Kills the running command and removes temporary folders. Safe to call from a signal handler.
void abandon_commands() noexcept;

}  // namespace bandlimit::app
