#pragma once

#include <exception>
#include <new>
#include <string>

#include "tegotae/core/error.hpp"

namespace tegotae {

/// Runs `read`, which reads `path`; whatever it throws becomes an Error about that file.
template <typename F>
auto reading(const std::string& path, F read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(path + ": not enough memory to read it");
  } catch (const std::exception& e) {
    throw Error(path + ": " + e.what());
  }
}

}  // namespace tegotae
