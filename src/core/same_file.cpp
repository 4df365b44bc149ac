#include "core/same_file.hpp"

#include <filesystem>

#include "tegotae/core/error.hpp"

namespace tegotae {

namespace fs = std::filesystem;

namespace {

/// Files that are there are compared by what they are, others by where they would be.
bool same(const std::string& a, const std::string& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed)) return true;
  const fs::path x = fs::weakly_canonical(fs::absolute(a, failed), failed);
  return !failed && !x.empty() && x == fs::weakly_canonical(fs::absolute(b, failed), failed) && !failed;
}

/// Devices and pipes hold nothing that could be lost.
bool holds_nothing(const std::string& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

void refuse_to_replace(const std::string& path, const std::vector<std::string>& inputs) {
  if (path.empty() || holds_nothing(path)) return;
  for (const std::string& input : inputs) {
    if (input.empty() || !same(path, input)) continue;
    throw Error(ErrorKind::file,
                path + ": would be replaced, but is read by the same command" + (input == path ? "" : " as " + input) +
                    "; write to another file",
                {path, 0, {}, {}});
  }
}

void refuse_to_replace(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    refuse_to_replace(outputs[i], inputs);
    if (outputs[i].empty() || holds_nothing(outputs[i])) continue;
    for (std::size_t k = 0; k < i; ++k)
      if (!outputs[k].empty() && same(outputs[i], outputs[k]))
        throw Error(ErrorKind::file, outputs[i] + ": the same command writes it twice; give each output its own file",
                    {outputs[i], 0, {}, {}});
  }
}

}  // namespace tegotae
