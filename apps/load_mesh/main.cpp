// tegotae-load-mesh: the process in which load_mesh_isolated reads a file. Not for people.
#include "import/mesh_pipe.hpp"

int main(int argc, char** argv) {
  return tegotae::run_mesh_helper(argc, argv);
}
