#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace tegotae::apps {

/// Adds an option for a length with a unit, like 5um, 0.05mm or 0.2in. `meters` is left alone unless the option is
/// given.
CLI::Option* add_length_option(CLI::App& app, const std::string& name, double& meters, const std::string& help);

/// Adds an option for two such lengths, the first less than the second; `set` gets them in meters.
CLI::Option* add_lengths_option(CLI::App& app, const std::string& name,
                                const std::function<void(double low, double high)>& set, const std::string& help);

}  // namespace tegotae::apps
