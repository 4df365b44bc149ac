#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tegotae::apps {

/// Adds an option for a length with a unit, like 5um, 0.05mm or 0.2in. `meters` is left alone unless the option is
/// given.
CLI::Option* add_length_option(CLI::App& app, const std::string& name, double& meters, const std::string& help);

}  // namespace tegotae::apps
