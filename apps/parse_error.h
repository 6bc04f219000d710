// Command lines that cannot be parsed, in words of ours.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace bandlimit::app {

/// What is wrong with the command line that made `cli` throw `error`, and what to do.
std::string explanation(const CLI::ParseError& error, const CLI::App& cli);

}  // namespace bandlimit::app
