// tegotae-load-mesh: the process in which load_mesh_isolated reads a file. Not for people.
#include <cstdio>
#include <string>

#include "import/mesh_pipe.hpp"
#include "shared/process.hpp"
#include "tegotae/core/version.hpp"

namespace {

constexpr const char* kName = "tegotae-load-mesh";

int print(const char* text) {
  std::puts(text);
  return tegotae::apps::finish_output(kName, 0);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc == 2 ? argv[1] : "";
  if (only == "--version") return print("tegotae " TEGOTAE_VERSION_STRING);
  if (only == "--help" || only == "-h")
    return print(
        "Reads a mesh file for another program of tegotae, bounded in time and memory. Not for people: `tegotae check "
        "FILE` reports on a mesh.");
  if (argc != tegotae::kMeshHelperArguments) {
    std::fprintf(stderr, "%s: only other programs of tegotae call it; `tegotae check FILE` reports on a mesh\n", kName);
    return 2;
  }
  return tegotae::run_mesh_helper(argv);
}
