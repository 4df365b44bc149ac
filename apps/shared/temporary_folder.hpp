#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tegotae/core/error.hpp"

namespace tegotae::apps {

/// A folder that is there as long as the object. Throws Error when none can be made.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tegotae-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw Error(pattern + ": no temporary folder can be made there");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;  // what is left in the temporary folder is the system's to clear
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tegotae::apps
