#pragma once

#include <stdexcept>
#include <string>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Bad input or a failed set-up step (a file, a scene, a setting, a device). `what()` is one line that names the file,
/// line, key or part, what is wrong with it and, where it helps, what to do. Never thrown from a tick or the servo.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tegotae
