#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Writes vertices and faces as the PLY file that assimp 5.2 reads without fail: binary, little-endian, nothing else.
class PlyBytes {
 public:
  void vertex(const Vec3& p) {
    for (const double x : p) put(vertex_bytes_, x);
    ++vertices_;
  }
  /// Faces of fewer than three corners are counted, not written.
  void face(const std::vector<std::uint32_t>& corners) {
    if (corners.size() < 3) {
      ++short_faces_;
      return;
    }
    put(face_bytes_, static_cast<std::uint32_t>(corners.size()));
    for (const std::uint32_t corner : corners) put(face_bytes_, corner);
    ++faces_;
  }
  void note_short(std::vector<std::string>& notes) const {
    if (short_faces_ > 0)
      notes.push_back("faces of fewer than three corners are left out, " + std::to_string(short_faces_) +
                      " of them; export anew if there is a hole");
  }
  bool has_faces() const { return faces_ > 0; }
  std::string file() const {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices_) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " + std::to_string(faces_) +
           "\nproperty list uint uint vertex_indices\nend_header\n" + vertex_bytes_ + face_bytes_;
  }

 private:
  template <class T>
  static void put(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }

  std::uint64_t vertices_ = 0, faces_ = 0, short_faces_ = 0;
  std::string vertex_bytes_, face_bytes_;
};

}  // namespace tegotae
