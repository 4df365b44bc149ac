#pragma once

#include <exception>
#include <new>
#include <string>
#include <utility>

#include "tegotae/core/error.hpp"

namespace tegotae {

/// Runs `read`, which reads `path`; whatever it throws becomes an Error about that file.
template <typename F>
auto reading(const std::string& path, F read) {
  try {
    return read();
  } catch (const Error& e) {
    ErrorPlace place = e.place();
    place.file = path;
    throw Error(ErrorKind::file, e.what(), std::move(place));
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::file, path + ": not enough memory to read it", {path, 0, {}, {}});
  } catch (const std::exception& e) {
    throw Error(ErrorKind::file, path + ": " + e.what(), {path, 0, {}, {}});
  }
}

}  // namespace tegotae
