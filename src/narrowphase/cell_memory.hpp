#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "narrowphase/cell_anchor.hpp"

namespace tegotae {

/// Free cells that faces of A had near a fixed part. A cell is true wherever the part has been since, so what comes
/// back to where it was need not search again. One for each face, some 360 bytes; only those that are used are touched.
class CellMemory {
 public:
  struct Kept {
    std::uint32_t face, part;
    FreeCell cell;  ///< `clear` as in CellFront: rounded down
    CellCorridor corridor;
  };

  explicit CellMemory(std::size_t faces) : place_(faces, 0) { kept_.reserve(faces); }

  void clear() { kept_.clear(); }
  /// Instead of what the face had. Does not allocate.
  void keep(const Kept& kept);
  /// Null when nothing is known.
  const Kept* find(std::uint32_t face, std::uint32_t part) const;
  std::size_t bytes() const { return place_.capacity() * sizeof(std::uint32_t) + kept_.capacity() * sizeof(Kept); }

 private:
  bool has(std::uint32_t face) const { return place_[face] < kept_.size() && kept_[place_[face]].face == face; }

  std::vector<std::uint32_t> place_;  ///< of each face in kept_, where that is about the face
  std::vector<Kept> kept_;
};

inline void CellMemory::keep(const Kept& kept) {
  if (has(kept.face)) {
    kept_[place_[kept.face]] = kept;
    return;
  }
  place_[kept.face] = static_cast<std::uint32_t>(kept_.size());
  kept_.push_back(kept);
}

inline const CellMemory::Kept* CellMemory::find(std::uint32_t face, std::uint32_t part) const {
  if (!has(face)) return nullptr;
  const Kept& kept = kept_[place_[face]];
  return kept.part == part ? &kept : nullptr;
}

}  // namespace tegotae
