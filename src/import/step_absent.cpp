#include "import/read_parts.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

bool reads_step() {
  return false;
}

Assembly read_step(const std::string& path, const AssemblyOptions&) {
  throw Error(path +
              ": this build reads no STEP files: install OpenCASCADE (libocct-data-exchange-dev) and build again");
}

}  // namespace tegotae
