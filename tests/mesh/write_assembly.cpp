// Writes the assembly that docs/python.md takes apart and that the page is walked through with: write_assembly
// FILE.step
#include <cstdio>

#include "mesh/step_assembly.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_assembly FILE.step\n");
    return 2;
  }
  tegotae::test::write_step_assembly(argv[1], {}, "MM", "AP214IS");
}
