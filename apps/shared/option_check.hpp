#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "core/number_text.hpp"

namespace tegotae::apps {

/// That an option's value is one of `names`; what is not is told with them.
CLI::Validator one_of(const std::vector<std::string>& names);

/// That an option's value is a number from `low` to `high`, a whole one where T is; what is not is told with both.
template <class T>
CLI::Validator between(T low, T high) {
  const bool open = high == std::numeric_limits<T>::max();
  const std::string from = number_text(static_cast<double>(low), 9), to = number_text(static_cast<double>(high), 9);
  const std::string range = open ? "at least " + from : "from " + from + " to " + to;
  const auto check = [low, high, open, range](const std::string& text) {
    T value{};
    if (CLI::detail::lexical_cast(text, value) && low <= value && value <= high) return std::string();
    return text + " is not a " + (std::is_integral_v<T> ? "whole " : "") + "number " + (open ? "of " : "") + range;
  };
  return CLI::Validator(check, range);
}

/// The same without an upper end.
template <class T>
CLI::Validator at_least(T low) {
  return between(low, std::numeric_limits<T>::max());
}

/// What is wrong with the command line of `app`, which threw `error` when it read it: which option, what was given,
/// what there is instead.
std::string usage_error(const CLI::App& app, int argc, char** argv, const CLI::ParseError& error);

}  // namespace tegotae::apps
