// bandlimit VERB: what belongs to the process. All else is run().
#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "apps/program.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/command.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define REPORTS_OF_SANITIZERS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define REPORTS_OF_SANITIZERS
#endif
#endif

namespace {

using namespace bandlimit;

std::FILE* real_stderr = nullptr;  ///< for those that cannot be given it; none yet: stderr is it

std::FILE* err() { return real_stderr ? real_stderr : stderr; }

extern "C" void stop(int signal_number) {
    job::abandon_commands();
    remove_unfinished_files();
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

void handle_signals() {
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit then shows as an error of write, like a full disk
    std::signal(SIGPIPE, SIG_IGN);  // and so does a reader that has gone
    for (const int s : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(s, stop) == SIG_IGN) std::signal(s, SIG_IGN);  // nohup means it
}

/// Keeps the numbers of closed standard streams from going to files. What is written to stdout then fails, as it did
/// before; errors have nowhere to go.
void reserve_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0)  // open() takes the lowest free number: this one
            (void)!open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

/// Gives buffers back when they are freed. By itself the allocator of glibc raises this limit to the largest that was
/// freed, up to 32 MiB, and keeps what is below: a fifth more memory for `compare` of large pictures.
void keep_no_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

/// Routes what codecs print by themselves to nowhere, and keeps the real stderr as err().
void silence_codecs() {
#ifndef REPORTS_OF_SANITIZERS  // which go to the same place
    const int kept = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    std::FILE* const real = kept < 0 ? nullptr : fdopen(kept, "w");
    if (!real) return;
    std::setvbuf(real, nullptr, _IONBF, 0);
    real_stderr = real;
    if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
        dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
#endif
}

/// Where memory runs out and nothing may be thrown, as in a thread or an initialiser of a library. All else is a
/// mistake in the program.
[[noreturn]] void give_up() noexcept {
    try {
        if (std::current_exception()) std::rethrow_exception(std::current_exception());
    } catch (const std::bad_alloc&) {
        app::Console({stdout, err()}).error("memory is exhausted; use a smaller size, or close other programs");
        remove_unfinished_files();
        _exit(1);
    } catch (...) {
    }
    std::abort();
}

extern "C" void end_without_memory_in_words() { std::set_terminate(give_up); }

#if defined(__GLIBC__) && !defined(REPORTS_OF_SANITIZERS)
// What runs first of all: memory may run out in the initialisers of libraries too, long before main().
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)() = end_without_memory_in_words;
#endif

}  // namespace

int main(int argc, char** argv) {
    keep_no_freed_memory();
    reserve_standard_streams();
    handle_signals();
    silence_codecs();
    end_without_memory_in_words();
    const std::size_t count = argc > 0 ? static_cast<std::size_t>(argc - 1) : 0;
    return app::run({argv + argc - count, count}, {stdout, err()});
}
