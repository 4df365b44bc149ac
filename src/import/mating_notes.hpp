#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "import/round_faces.hpp"

namespace tegotae {

/// Collects the pairs of parts that may mate in faces whose facets cannot be kept out of the clearance (all but
/// cylinders, see keep_clearance).
class MatingNotes {
 public:
  void add(const AssemblyPart& a, const AssemblyPart& b, FaceKind kind);
  /// Adds a line for each pair of shapes (instances mate alike), at most six lines, with what to do about a fit with
  /// less play than `chord` (m).
  void tell(double chord, std::vector<std::string>& notes) const;

 private:
  struct Pair {
    std::string names;  // of the first two instances
    std::set<FaceKind> kinds;
  };
  std::map<std::pair<std::size_t, std::size_t>, Pair> pairs_;  // by shape
};

}  // namespace tegotae
