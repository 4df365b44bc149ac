#include "shared/length_option.hpp"

#include <charconv>
#include <cmath>

#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::apps {

namespace {

/// Meters; negative when `text` is no length.
double parse_length(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value) || value < 0) return -1;
  try {
    return value * unit_length(text.substr(static_cast<std::size_t>(end - text.data())));
  } catch (const Error&) {
    return -1;
  }
}

}  // namespace

CLI::Option* add_length_option(CLI::App& app, const std::string& name, double& meters, const std::string& help) {
  const auto set = [&meters](const std::string& text) { meters = parse_length(text); };
  return app.add_option_function<std::string>(name, set, help)
      ->check([](const std::string& text) -> std::string {
        return parse_length(text) >= 0 ? "" : text + " is no length with a unit (m, cm, mm, um, in), like 5um";
      })
      ->type_name("LENGTH");
}

}  // namespace tegotae::apps
