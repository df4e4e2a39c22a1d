// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace samestep::program {

/// Says what is wrong with the first argument that means nothing to the program, and what may have been
/// meant: "no option --tick; did you mean --ticks?". Empty where each is a word, an option or a value.
std::string suggestion(const CLI::App& app, std::span<char* const> arguments);

}  // namespace samestep::program
