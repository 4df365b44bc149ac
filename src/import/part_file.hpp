#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tegotae/import/assembly.hpp"

namespace tegotae {

/// A linear map and a translation.
using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// `a` after `b`.
Matrix34 product(const Matrix34& a, const Matrix34& b);

/// What a file of placed meshes holds, as it is in the file: meshes not welded, lengths in the file's unit.
struct PartFile {
  struct Placed {
    std::string name;
    std::vector<std::string> path;  ///< the groups that it is in, the outermost first
    Matrix34 X;                     ///< from the mesh to the file's frame
    std::size_t mesh = 0;           ///< index into PartFile::meshes
    std::optional<Color> color;
  };
  std::vector<TriangleMesh> meshes;
  std::vector<Placed> parts;
  std::string unit;  ///< "m", "mm", ...
  UpAxis up = UpAxis::z;
  std::vector<std::string> notes;  ///< what is not as the file says, a line each
};

/// Whether `path` is a file of placed meshes (glTF, GLB, 3MF), by its name.
bool is_part_file(const std::string& path);
PartFile read_part_file(const std::string& path);

/// Adds the triangles of `from`, mapped by `X` and then scaled by `unit` (m), to `to`. A map that mirrors turns the
/// faces round. Throws Error when `to` becomes larger than its indices reach.
void append(const TriangleMesh& from, const Matrix34& X, double unit, TriangleMesh& to);

}  // namespace tegotae
