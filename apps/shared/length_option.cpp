#include "shared/length_option.hpp"

#include <charconv>
#include <cmath>

#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::apps {

namespace {

/// Meters; negative when `text` is not a length.
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

std::string check_length(const std::string& text) {
  return parse_length(text) >= 0 ? "" : text + " is not a length with a unit (m, cm, mm, um, in), like 5um";
}

}  // namespace

CLI::Option* add_length_option(CLI::App& app, const std::string& name, double& meters, const std::string& help) {
  const auto set = [&meters](const std::string& text) { meters = parse_length(text); };
  return app.add_option_function<std::string>(name, set, help)->check(check_length)->type_name("LENGTH");
}

CLI::Option* add_lengths_option(CLI::App& app, const std::string& name,
                                const std::function<void(double low, double high)>& set, const std::string& help) {
  const auto both = [set, name](const std::vector<std::string>& texts) {
    const double low = parse_length(texts.at(0)), high = parse_length(texts.at(1));
    if (!(low < high)) throw CLI::ValidationError(name, texts[0] + " is not less than " + texts[1]);
    set(low, high);
  };
  return app.add_option_function<std::vector<std::string>>(name, both, help)
      ->check(check_length)
      ->expected(2)
      ->type_name("LOW HIGH");
}

}  // namespace tegotae::apps
