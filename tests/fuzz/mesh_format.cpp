#include "fuzz/mesh_format.hpp"

namespace tegotae {

const char* const kFormat = TEGOTAE_FUZZ_FORMAT;

}  // namespace tegotae
