#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What kind of thing is wrong.
enum class ErrorKind : std::uint8_t {
  other,    ///< none of the following
  file,     ///< a file is absent, damaged, or says what cannot be
  setting,  ///< a value is out of range
  overlap,  ///< parts intersect at the start
  device    ///< a device cannot be reached, or is another application's
};

/// Where it is wrong, beside Error::what(), as far as it is known.
struct ErrorPlace {
  std::string file = {};  ///< path; empty: none
  int line = 0;           ///< in the file, from 1 on; 0: none
  std::string key = {};   ///< dotted, as in scene files; empty: none
  std::string part = {};  ///< name of the part; empty: none
};

/// Bad input or a failed set-up step (a file, a scene, a setting, a device). `what()` is one line that names the file,
/// line, key or part, what is wrong with it and, where it helps, what to do. Never thrown from a tick or the servo.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// `text` for people, `kind` and `place` for programs.
  Error(ErrorKind kind, const std::string& text, ErrorPlace place = {})
      : std::runtime_error(text), kind_(kind), place_(std::make_shared<const ErrorPlace>(std::move(place))) {}

  ErrorKind kind() const noexcept { return kind_; }  ///< of what
  /// Where.
  ErrorPlace place() const { return place_ ? *place_ : ErrorPlace(); }

 private:
  ErrorKind kind_ = ErrorKind::other;
  std::shared_ptr<const ErrorPlace> place_;  // an exception is copied without throwing
};

}  // namespace tegotae
