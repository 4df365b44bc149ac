#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tegotae {

/// One fuzz target per program: this function, libFuzzer's entry point, and seeds(). Whatever the bytes, it returns;
/// what the library promises about them is checked by require(). An Error is an answer, any other exception a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// What the bytes of a seed are, for mutations that leave it one: else most end in the first check.
enum class Grammar { none, json, glb, xml };

/// A small input to begin with.
struct Seed {
  std::string name;
  std::string bytes;
  Grammar grammar = Grammar::none;
};
/// Defined by each target: valid inputs and broken ones of every kind that its reader knows.
std::vector<Seed> seeds();

/// Ends the program, in a way that libFuzzer and the replay notice, when `promise` does not hold.
void require(bool promise, const char* what);
/// Requires that the text of an Error begins with `beginning`, which names its file, and is one line.
void require_error_of(const std::string& beginning, const std::string& text);

/// A folder of this process in memory (/dev/shm where there is one) that goes away with the process.
const std::filesystem::path& scratch_folder();
/// Replaces `scratch_folder() / name`; returns its path.
std::string write_input(const std::string& name, const void* data, std::size_t size);

}  // namespace tegotae
