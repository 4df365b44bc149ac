// tegotae-load-mesh: the process in which load_mesh_isolated reads a file. Not for people.
#include <cstdio>
#include <string>

#include "import/mesh_pipe.hpp"
#include "tegotae/core/version.hpp"

int main(int argc, char** argv) {
  const std::string only = argc == 2 ? argv[1] : "";
  if (only == "--version" || only == "--help" || only == "-h") {
    std::puts(only == "--version" ? "tegotae " TEGOTAE_VERSION_STRING
                                  : "Reads a mesh file for another program of tegotae, bounded in time and memory. Not "
                                    "for people: `tegotae check FILE` reports on a mesh.");
    return std::fflush(stdout) == 0 ? 0 : 2;
  }
  if (argc != 5) {
    std::fputs("tegotae-load-mesh: not for people, see --help; `tegotae check FILE` reports on a mesh\n", stderr);
    return 2;
  }
  return tegotae::run_mesh_helper(argc, argv);
}
