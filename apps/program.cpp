#include "apps/program.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "apps/console/common.h"
#include "bandlimit/core/targets.h"
#include "bandlimit/job/command.h"
#include "bandlimit/job/option_error.h"

namespace bandlimit::app {
namespace {

/// A word as a shell reads it back; by $'...', which most do, where a terminal would not show it.
std::string pasted(const std::string& word) {
    if (visible(word) == word) return job::quoted(word);
    std::string escaped;
    for (const char c : word) (c == '\\' || c == '\'' ? escaped += '\\' : escaped) += c;
    return "$'" + visible(escaped) + "'";
}

void add_verbs(Program& program) {
    add_resize(program);
    add_convolve(program);
    add_bokeh(program);
    add_bilateral(program);
    add_guided(program);
    add_gradients(program);
    add_mips(program);
    add_pattern(program);
    add_supersample(program);
    add_temporal(program);
    add_raster(program);
    add_compare(program);
    add_analyze(program);
    add_design(program);
    add_audit(program);
    add_info(program);
    add_tour(program);
    program.command_line.program().require_one_subcommand("verb");
}

/// Sets program.selected. Throws UsageError, or what the file system says of an output that exists.
void parse(Program& program, std::span<const char* const> arguments) {
    try {
        if (const auto text = program.command_line.parse(arguments)) {
            program.selected = [&program, text] { program.console.write(*text); };
            return;
        }
        current_target();  // throws where BANDLIMIT_TARGETS holds none
    } catch (const job::OptionError&) {
        throw;
    } catch (const Error& e) {
        throw UsageError(e.what());
    }
}

void try_to_run(std::span<const char* const> arguments, Console& console) {
    Program program{console, "bandlimit", CommandLine("bandlimit " BANDLIMIT_VERSION)};
    for (const char* argument : arguments) program.command += " " + pasted(argument);
    add_verbs(program);
    parse(program, arguments);
    program.selected();
    console.finish();
}

}  // namespace

int run(std::span<const char* const> arguments, const Streams& streams) noexcept {
    constexpr const char* no_memory = "memory is exhausted; use a smaller size, or close other programs";
    Console console(streams);
    try {
        try_to_run(arguments, console);
        return 0;
    } catch (const UsageError& e) {
        console.error(e.what());
        return 2;
    } catch (const job::OptionError& e) {  // jobs name options without the dashes
        console.error((e.option.empty() ? "" : "--") + std::string(e.what()));
        return 2;
    } catch (const std::bad_alloc&) {
        console.error(no_memory);
    } catch (const std::length_error&) {  // a container that no memory could hold
        console.error(no_memory);
    } catch (const std::filesystem::filesystem_error& e) {
        const std::string path = e.path1().empty() ? "the current directory" : e.path1().string();
        console.error(path + ": cannot be reached: " + e.code().message() + "; check the path and its permissions");
    } catch (const std::system_error& e) {
        console.error("the system refuses: " + e.code().message() + "; close other programs, or use --threads 1");
    } catch (const std::exception& e) {
        console.error(e.what());
    }
    return 1;
}

}  // namespace bandlimit::app
