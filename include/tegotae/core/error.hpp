#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Category of an error.
enum class ErrorKind : std::uint8_t {
  other,    ///< none of the following
  file,     ///< a file is absent, damaged, or has impossible content
  setting,  ///< a value is out of range
  overlap,  ///< parts intersect at the start
  device    ///< a device cannot be reached, or another application uses it
};

/// Place of an error, as far as it is known, for programs. Error::what() names it for people.
struct ErrorPlace {
  std::string file = {};  ///< path; empty: none
  int line = 0;           ///< in the file, from 1 on; 0: none
  std::string key = {};   ///< dotted, as in scene files; empty: none
  std::string part = {};  ///< name of the part; empty: none
};

/// Bad input or a failed set-up step (a file, a scene, a setting, a device). `what()` is one line. It names the file,
/// line, key or part, says what is wrong and, where it helps, what to do. Neither a tick nor the servo throws it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// `text` is for people; `kind` and `place` are for programs.
  Error(ErrorKind kind, const std::string& text, ErrorPlace place = {})
      : std::runtime_error(text), kind_(kind), place_(std::make_shared<const ErrorPlace>(std::move(place))) {}

  ErrorKind kind() const noexcept { return kind_; }  ///< category
  /// Returns the place of the error.
  ErrorPlace place() const { return place_ ? *place_ : ErrorPlace(); }

 private:
  ErrorKind kind_ = ErrorKind::other;
  std::shared_ptr<const ErrorPlace> place_;  // an exception is copied without throwing
};

}  // namespace tegotae
