// bandlimit VERB: parses the command line, runs the verb, and turns exceptions into one line and an exit code.
#include <fmt/core.h>

#include <csignal>
#include <cstdio>
#include <new>

#include "apps/common.h"

namespace {

using namespace bandlimit;

extern "C" void stop(int signal_number) {
    remove_unfinished_files();
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

void handle_signals() {
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit then shows as an error of write, like a full disk
    for (const int s : {SIGINT, SIGTERM, SIGHUP}) std::signal(s, stop);
}

/// Sets program.selected, or returns the exit code of a command line that asks for nothing to run.
std::optional<int> parse(app::Program& program, int argc, char** argv) {
    try {
        program.cli.parse(argc, argv);
        return {};
    } catch (const CLI::CallForHelp& e) {
        return program.cli.exit(e);
    } catch (const CLI::CallForAllHelp& e) {
        return program.cli.exit(e);
    } catch (const CLI::CallForVersion& e) {
        return program.cli.exit(e);
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
    try {
        work();
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw std::runtime_error("stdout cannot be written; is the disk full?");
        return 0;
    } catch (const app::UsageError& e) {
        app::print_error(e.what());
        return 2;
    } catch (const std::bad_alloc&) {
        app::print_error("memory is exhausted; use a smaller size, or close other programs");
    } catch (const std::exception& e) {
        app::print_error(e.what());
    }
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    handle_signals();
    app::silence_codecs();
    app::Program program;
    program.cli.set_version_flag("--version", "bandlimit " BANDLIMIT_VERSION);
    program.cli.footer("bandlimit VERB --help shows the options of a verb, and an example.");
    app::add_resize(program);
    app::add_pattern(program);
    app::add_compare(program);
    app::add_analyze(program);
    app::add_info(program);
    app::add_tour(program);
    app::require_one_subcommand(program.cli, "verb");
    if (const auto code = parse(program, argc, argv)) return *code;
    return run(program.selected);
}
