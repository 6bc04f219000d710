// bandlimit VERB: parses the command line, runs the verb, and turns exceptions into one line and an exit code.
#include <fcntl.h>
#include <fmt/core.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <new>

#include "apps/command.h"
#include "apps/common.h"
#include "bandlimit/core/targets.h"

namespace {

using namespace bandlimit;

extern "C" void stop(int signal_number) {
    app::abandon_commands();
    remove_unfinished_files();
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

void handle_signals() {
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit then shows as an error of write, like a full disk
    for (const int s : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(s, stop) == SIG_IGN) std::signal(s, SIG_IGN);  // nohup means it
}

/// Keeps the numbers of closed standard streams from going to files. What is written there fails, as it did before.
void reserve_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0) (void)!open("/dev/null", O_RDONLY);  // takes the lowest free number: this one
}

/// Gives buffers back when they are freed. By itself the allocator of glibc raises this limit to the largest that was
/// freed, up to 32 MiB, and keeps what is below: a fifth more memory for `compare` of large pictures.
void keep_no_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

/// Sets program.selected, or returns the exit code of a command line that is wrong.
std::optional<int> parse(app::Program& program, int argc, char** argv) {
    try {
        program.cli.parse(argc, argv);
        current_target();  // throws where BANDLIMIT_TARGETS holds none
        return {};
    } catch (const CLI::Success& asks) {  // for help or the version
        program.selected = [&program, asks] { program.cli.exit(asks); };
        return {};
    } catch (const CLI::ParseError& e) {
        app::print_error(std::string(e.what()) + "; see bandlimit --help, or bandlimit VERB --help");
    } catch (const app::UsageError& e) {
        app::print_error(e.what());
    } catch (const Error& e) {
        app::print_error(e.what());
    } catch (const std::exception& e) {  // of the file system: an output that is no regular file
        app::print_error(e.what());
        return 1;
    }
    return 2;
}

int run(const std::function<void()>& work) {
    constexpr const char* no_stdout = "stdout cannot be written; is it closed, or the disk full?";
    try {
        work();
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw std::runtime_error(no_stdout);
        return 0;
    } catch (const app::UsageError& e) {
        app::print_error(e.what());
        return 2;
    } catch (const std::bad_alloc&) {
        app::print_error("memory is exhausted; use a smaller size, or close other programs");
    } catch (const std::exception& e) {
        app::print_error(std::ferror(stdout) ? no_stdout : e.what());
    }
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    keep_no_freed_memory();
    reserve_standard_streams();
    handle_signals();
    app::silence_codecs();
    app::Program program;
    program.command = "bandlimit";
    for (int i = 1; i < argc; ++i) program.command += " " + app::quoted(argv[i]);
    program.cli.set_version_flag("--version", "bandlimit " BANDLIMIT_VERSION);
    program.cli.footer("bandlimit VERB --help shows the options of a verb, and an example.");
    app::add_resize(program);
    app::add_convolve(program);
    app::add_bokeh(program);
    app::add_mips(program);
    app::add_pattern(program);
    app::add_compare(program);
    app::add_analyze(program);
    app::add_design(program);
    app::add_audit(program);
    app::add_info(program);
    app::add_tour(program);
    app::require_one_subcommand(program.cli, "verb");
    if (const auto code = parse(program, argc, argv)) return *code;
    return run(program.selected);
}
