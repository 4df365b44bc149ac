#pragma once

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A linear map and a translation.
using Matrix34 = Eigen::Matrix<double, 3, 4>;

Matrix34 transform_of(const aiMatrix4x4& m);
/// `a` after `b`.
Matrix34 product(const Matrix34& a, const Matrix34& b);

/// Checks and reads the mesh file `path`, all faces triangles. The scene belongs to `importer`.
const aiScene& read_scene(Assimp::Importer& importer, const std::string& path);

/// Adds the triangles of `from`, mapped by `X` and then scaled by `unit` (m), to `to`. A map that mirrors turns the
/// faces round.
void append(const aiMesh& from, const Matrix34& X, double unit, TriangleMesh& to);

/// Throws Error unless `mesh` has triangles and its coordinates are finite and on this side of 1000 km.
void require_usable(const TriangleMesh& mesh);
/// Throws Error unless a triangle of the welded `mesh` has an area.
void require_area(const TriangleMesh& welded);

}  // namespace tegotae
