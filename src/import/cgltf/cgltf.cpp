// The one place that compiles cgltf, as its header asks for. Numbers are read alike in every locale.
#include <charconv>
#include <cstring>

namespace {
double number_of(const char* text) {
  double value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}
}  // namespace

#define CGLTF_ATOF(text) number_of(text)
#define CGLTF_IMPLEMENTATION
#include "cgltf.h"
