#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "import/import_notes.hpp"
#include "import/round_faces.hpp"

namespace tegotae {

/// Collects the pairs of parts that may mate in faces whose facets cannot be kept out of the clearance (all but
/// cylinders, see keep_clearance).
class MatingNotes {
 public:
  void add(const AssemblyPart& a, const AssemblyPart& b, FaceKind kind);
  /// Says it of each pair of shapes (instances mate alike), whose facets keep within `chord` (m).
  void report(double chord, ImportNotes& notes) const;

 private:
  struct Pair {
    std::string names;  // of the first two instances
    std::set<FaceKind> kinds;
  };
  std::map<std::pair<std::size_t, std::size_t>, Pair> pairs_;  // by shape
};

}  // namespace tegotae
