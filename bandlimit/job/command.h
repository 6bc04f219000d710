// Other programs, run on files in a folder of their own.
// Stability: inner.
#pragma once
#include <map>
#include <string>

namespace bandlimit::job {

/// A temporary folder. It is removed with its contents by the destructor, or by abandon_commands(). One at a time.
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

/// The full path of the folder `name`, which is made if it does not exist; its parent must.
/// throws   std::runtime_error where it cannot be made, or is a file
std::string made_folder(const std::string& name);

/// `word` as a shell reads it: quoted if it holds anything but letters, digits and ./-_+:,@%= .
std::string quoted(const std::string& word);

/// Whether `path` holds only letters, digits and ./-_ , which no shell or interpreter changes, in quotes or not.
bool is_plain(const std::string& path);

/// `command` with each {name} replaced by its value, unquoted: values should be numbers or is_plain(). Other braces
/// stay.
std::string filled_in(const std::string& command, const std::map<std::string, std::string>& values);

/// What a command did.
struct CommandEnd {
    bool timed_out = false;
    int exit_code = -1;  ///< -1 after a signal
    int signal = 0;
    double seconds = 0;
    std::string last_words;  ///< the last line it wrote to stderr, or to stdout if stderr is empty
};

/// Runs `command` with /bin/sh in `folder`, in its own process group, which is killed after `timeout_seconds`.
///
/// stdin is empty; stdout and stderr are captured. The folder of this program is appended to PATH, so that commands can
/// call it by name. One command at a time.
/// throws   std::runtime_error where no process can be started
CommandEnd run_command(const std::string& command, const std::string& folder, double timeout_seconds);

/// Kills the running command and removes temporary folders. Safe to call from a signal handler.
void abandon_commands() noexcept;

}  // namespace bandlimit::job
