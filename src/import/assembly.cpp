#include "tegotae/import/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/number_text.hpp"
#include "import/file_check.hpp"
#include "import/part_file.hpp"
#include "import/read_parts.hpp"
#include "import/reading.hpp"
#include "import/usable.hpp"
#include "import/utf8.hpp"
#include "mesh/components.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae {
namespace {

std::shared_ptr<const TriangleMesh> share(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Every piece of a shape becomes a shape; a part of several pieces becomes a group of parts.
void split_parts(Assembly& assembly) {
  std::vector<std::shared_ptr<const TriangleMesh>> shapes;
  std::vector<std::pair<std::size_t, std::size_t>> pieces_of;  // of each old shape: its first piece, and how many
  std::vector<std::uint32_t> first_face;
  for (const auto& shape : assembly.shapes) {
    std::vector<TriangleMesh> pieces = split(*shape, first_face);
    pieces_of.emplace_back(shapes.size(), pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      pieces[i].name = shape->name + (pieces.size() > 1 ? " " + std::to_string(i + 1) : "");
      shapes.push_back(share(std::move(pieces[i])));
    }
  }
  std::vector<AssemblyPart> parts;
  for (const AssemblyPart& part : assembly.parts) {
    const auto [first, count] = pieces_of[part.shape];
    for (std::size_t i = 0; i < count; ++i) {
      AssemblyPart piece = part;
      piece.shape = first + i;
      if (count > 1) {
        piece.path.push_back(part.name);
        piece.name = part.name + "_" + std::to_string(i + 1);
      }
      parts.push_back(std::move(piece));
    }
  }
  assembly.shapes = std::move(shapes);
  assembly.parts = std::move(parts);
}

/// Shapes equal to the bit become one: not every program that writes assemblies keeps instances. Those of no part go.
void share_shapes(Assembly& assembly) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> of_size;
  std::vector<std::size_t> number(assembly.shapes.size());
  std::vector<std::shared_ptr<const TriangleMesh>> shapes;
  std::vector<bool> used(assembly.shapes.size(), false);
  for (const AssemblyPart& part : assembly.parts) used[part.shape] = true;
  for (std::size_t i = 0; i < assembly.shapes.size(); ++i) {
    if (!used[i]) continue;
    const TriangleMesh& mesh = *assembly.shapes[i];
    std::vector<std::size_t>& alike = of_size[{mesh.vertices.size(), mesh.triangles.size()}];
    number[i] = shapes.size();
    for (const std::size_t other : alike) {
      if (shapes[other]->vertices != mesh.vertices || shapes[other]->triangles != mesh.triangles) continue;
      number[i] = other;
      break;
    }
    if (number[i] < shapes.size()) continue;
    alike.push_back(shapes.size());
    shapes.push_back(assembly.shapes[i]);
  }
  assembly.shapes = std::move(shapes);
  for (AssemblyPart& part : assembly.parts) part.shape = number[part.shape];
}

/// Gives shapes that lie farther from their origin than they are large an origin in the middle of their box.
void center_far_shapes(Assembly& assembly) {
  std::vector<Vec3> shift(assembly.shapes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < shift.size(); ++i) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : assembly.shapes[i]->vertices) box.extend(p);
    if (box.center().norm() <= box.diagonal().norm()) continue;
    shift[i] = box.center();
    TriangleMesh moved = *assembly.shapes[i];
    for (Vec3& p : moved.vertices) p -= shift[i];
    assembly.shapes[i] = share(std::move(moved));
  }
  for (AssemblyPart& part : assembly.parts) part.pose.p = part.pose * shift[part.shape];
}

void name_parts(Assembly& assembly) {
  std::set<std::string> given;  // names in the file: a number added to one must not make another of them
  for (AssemblyPart& part : assembly.parts) {
    part.name = printable(part.name);
    if (part.name.empty()) part.name = "part";
    given.insert(part.name);
    for (std::string& group : part.path) group = printable(group);
  }
  std::set<std::string> used;
  std::map<std::string, int> last;
  for (AssemblyPart& part : assembly.parts) {
    std::string name = part.name;
    while (!used.insert(name).second) {
      do {
        name = part.name + "_" + std::to_string(std::max(2, ++last[part.name]));
      } while (given.count(name) > 0);
    }
    part.name = name;
  }
}

/// 3MF has its unit, or the one that the format says; glTF says m, and many programs write something else.
bool says_its_unit(const std::string& path) {
  return is_step(path) || lower_extension(path) == ".3mf";
}

void check_unit(const std::string& path, const AssemblyOptions& options) {
  if (!options.unit) return;
  unit_length(*options.unit);
  if (says_its_unit(path)) throw Error(path + ": the file says its unit itself; give none");
}

/// Diagonal of the box around all parts, m.
double diagonal(const Assembly& assembly) {
  Eigen::AlignedBox3d box;
  for (const AssemblyPart& part : assembly.parts)
    for (const Vec3& p : assembly.shapes[part.shape]->vertices) box.extend(part.pose * p);
  return box.diagonal().norm();
}

/// A mock-up that a hand moves parts of is less than this across, m.
constexpr double kPlausible = 20;

/// Asks for the unit where a file is absurdly large without one.
void require_plausible(const std::string& path, const Assembly& assembly, const AssemblyOptions& options) {
  if (options.unit || says_its_unit(path)) return;
  const double size = diagonal(assembly);
  if (size <= kPlausible) return;
  const std::string number = number_text(size, 4);
  throw Error(path + ": " + number + " m across if its lengths are in m; give their unit: --unit mm makes it " +
              number + " mm, --unit m keeps it");
}

}  // namespace

Assembly read_assembly(const std::string& path, const AssemblyOptions& options) {
  for (const double chord : {options.chord, options.coarse_chord}) {
    if (!(chord > 0) || !std::isfinite(chord)) throw Error(path + ": the chord error must be a positive length");
  }
  return reading(path, [&] {
    check_unit(path, options);
    Assembly assembly = is_step(path)        ? read_step(path, options)
                        : is_part_file(path) ? read_tree(path, options)
                                             : read_flat(path, options);
    if (options.split) split_parts(assembly);
    share_shapes(assembly);
    center_far_shapes(assembly);
    name_parts(assembly);
    for (std::string& note : assembly.notes) note = printable(note);
    if (assembly.parts.empty()) throw Error(path + ": no parts with triangles" + cause_of(assembly.notes));
    require_plausible(path, assembly, options);
    return assembly;
  });
}

}  // namespace tegotae
