// libFuzzer brings main(); this adds `fuzz_NAME --write-seeds FOLDER`, which writes the target's own seeds.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc != 3 || std::strcmp((*argv)[1], "--write-seeds") != 0) return 0;
  const std::filesystem::path folder = (*argv)[2];
  std::filesystem::create_directories(folder);
  for (const tegotae::Seed& seed : tegotae::seeds()) std::ofstream(folder / seed.name, std::ios::binary) << seed.bytes;
  std::exit(0);
}
