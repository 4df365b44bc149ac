// main() of a fuzz target in an ordinary build: runs the target's seeds, mutations of them (of their bytes and, where a
// seed says what it is, of what they mean), and the files given
// (what fuzzing has found). A crash, a hang (the test's time limit), an exception other than Error, or a broken promise
// fails.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>

#include "fuzz/fuzz.hpp"
#include "fuzz/structured.hpp"

namespace fs = std::filesystem;

namespace {

constexpr int kMutationsPerSeed = 40, kStructuredPerSeed = 2000;
// An input takes less than this, s.
constexpr unsigned kLongest = 10;
constexpr std::size_t kLongestMutated = 20'000;

void run(const std::string& bytes) {
  ::alarm(kLongest);  // ends the process
  tegotae::LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

/// A few bytes changed, a piece doubled or taken out, or the end cut off.
std::string mutated(std::string bytes, std::mt19937& random) {
  if (bytes.empty()) return bytes;
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::size_t from = below(bytes.size());
  const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - from, 64));
  switch (below(4)) {
    case 0:
      bytes.resize(from);
      break;
    case 1:
      bytes.erase(from, length);
      break;
    case 2:
      bytes.insert(from, std::string(bytes, from, length));
      break;
    default:
      for (std::size_t i = 0; i < std::min<std::size_t>(length, 4); ++i)
        bytes[from + i] = static_cast<char>(below(256));
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  std::mt19937 random(8);
  int inputs = 0;
  for (const tegotae::Seed& seed : tegotae::seeds()) {
    run(seed.bytes);
    ++inputs;
    for (int i = 0; i < kMutationsPerSeed && seed.bytes.size() < kLongestMutated; ++i, ++inputs)
      run(mutated(seed.bytes, random));
    for (int i = 0; i < kStructuredPerSeed && seed.grammar != tegotae::Grammar::none; ++i, ++inputs) {
      std::string bytes = tegotae::structured_mutation(seed.bytes, seed.grammar, random);
      if (i % 3 == 0) bytes = tegotae::structured_mutation(bytes, seed.grammar, random);
      run(bytes);
    }
  }
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) {
      std::fprintf(stderr, "%s: no such folder\n", argv[i]);
      return 1;
    }
    for (const auto& entry : fs::directory_iterator(argv[i])) {
      std::ifstream in(entry.path(), std::ios::binary);
      run(std::string(std::istreambuf_iterator<char>(in), {}));
      ++inputs;
    }
  }
  std::printf("%d inputs\n", inputs);
}
