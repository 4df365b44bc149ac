#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tegotae/narrowphase/hierarchy_cache.hpp"

namespace tegotae::test {

/// The cache is in this folder for as long as the object lives.
struct UseCache {
  explicit UseCache(const std::string& path) { set_hierarchy_cache(path); }
  ~UseCache() { set_hierarchy_cache(""); }
};

/// What is in a folder, sorted; nothing when there is none.
inline std::vector<std::filesystem::path> entries(const std::string& folder) {
  std::vector<std::filesystem::path> all;
  if (std::filesystem::exists(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder)) all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace tegotae::test
