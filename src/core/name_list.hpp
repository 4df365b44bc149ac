#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tegotae {

/// Names for a message, in their order: "a, b, c"; of more than twelve the first twelve and how many more there are.
inline std::string name_list(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxShown = 12;
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == kMaxShown) return list + ", and " + std::to_string(names.size() - kMaxShown) + " more";
    list += (i > 0 ? ", " : "") + names[i];
  }
  return list;
}

}  // namespace tegotae
