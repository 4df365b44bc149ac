// Meshes, and files of them.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>

#include "core/valid_pose.hpp"
#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/loading.hpp"
#include "python/mesh.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/assembly.hpp"
#include "tegotae/import/isolated_load.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"
#include "tegotae/mesh/weld.hpp"

namespace tegotae::python {

MeshLoader mesh_loader(bool trusted) {
  if (trusted) return load_mesh;
  IsolatedLoad how;
  how.helper = nb::cast<std::string>(nb::module_::import_("tegotae._programs").attr("program")(how.helper));
  return [how](const std::string& path, double unit_in_m) { return load_mesh_isolated(path, unit_in_m, how); };
}

namespace {

using VertexView = nb::ndarray<nb::numpy, const double, nb::shape<-1, 3>>;
using TriangleView = nb::ndarray<nb::numpy, const std::uint32_t, nb::shape<-1, 3>>;

/// A view of what `mesh` owns; the array keeps it.
template <class View, class T>
View view(const Mesh& mesh, const T* data, std::size_t rows) {
  auto* kept = new std::shared_ptr<const TriangleMesh>(mesh.shared);
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::shared_ptr<const TriangleMesh>*>(p); });
  return View(data, {rows, 3}, owner);
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(nb::handle value, std::size_t vertices) {
  const nb::object array = nb::module_::import_("numpy").attr("asarray")(value);
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (kind != "i" && kind != "u") throw Error(ErrorKind::setting, "triangles: indices must be whole numbers");
  const auto block = nb::cast<nb::ndarray<const std::int64_t, nb::c_contig, nb::device::cpu>>(
      nb::module_::import_("numpy").attr("ascontiguousarray")(array, nb::arg("dtype") = "int64"));
  if (block.ndim() != 2 || block.shape(1) != 3) throw Error(ErrorKind::setting, "triangles: the shape is not (m, 3)");
  std::vector<std::array<std::uint32_t, 3>> triangles(block.shape(0));
  for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
    const std::int64_t v = block.data()[i];
    if (v < 0 || static_cast<std::size_t>(v) >= vertices)
      throw Error(ErrorKind::setting, "triangles: row " + std::to_string(i / 3) + " names vertex " + std::to_string(v) +
                                          " of " + std::to_string(vertices));
    triangles[i / 3][i % 3] = static_cast<std::uint32_t>(v);
  }
  return triangles;
}

Mesh mesh_of(nb::handle vertices, nb::handle triangles, const std::string& name) {
  const Numbers points = numbers(vertices, {-1, 3}, "vertices");
  TriangleMesh mesh;
  mesh.name = name;
  for (std::size_t i = 0; i < points.rows; ++i) mesh.vertices.emplace_back(Vec3::Map(points.data + 3 * i));
  for (std::size_t i = 0; i < points.rows; ++i)
    if (!mesh.vertices[i].allFinite() || mesh.vertices[i].cwiseAbs().maxCoeff() > kFarthestVertex)
      throw Error(ErrorKind::setting,
                  "vertices: row " + std::to_string(i) + " is not finite, or beyond 1000 km; lengths are in m");
  mesh.triangles = triangles_of(triangles, points.rows);
  if (mesh.triangles.empty()) throw Error(ErrorKind::setting, "triangles: there are none");
  const nb::gil_scoped_release others_go_on;
  return Mesh(weld(mesh));
}

nb::dict report_of(const Mesh& mesh) {
  MeshReport r;
  {
    const nb::gil_scoped_release others_go_on;
    r = report(*mesh.shared);
  }
  nb::dict d;
  d["vertices"] = r.vertices;
  d["triangles"] = r.triangles;
  d["components"] = r.components;
  d["boundary_edges"] = r.boundary_edges;
  d["non_manifold_edges"] = r.non_manifold_edges;
  d["degenerate_faces"] = r.degenerate_faces;
  d["duplicate_faces"] = r.duplicate_faces;
  d["inverted_shells"] = r.inverted_shells;
  d["closed"] = r.closed;
  d["box_min"] = to_array(r.box_min);
  d["box_max"] = to_array(r.box_max);
  return d;
}

/// A leaf of an assembly with its mesh.
struct PlacedPart {
  AssemblyPart part;
  Mesh mesh;
};

/// An assembly as Python sees it.
struct PlacedAssembly {
  std::vector<PlacedPart> parts;
  std::string unit;
  std::vector<std::string> notes;
};

PlacedAssembly placed(Assembly assembly) {
  PlacedAssembly all{{}, std::move(assembly.unit), std::move(assembly.notes)};
  for (AssemblyPart& part : assembly.parts) {
    const Mesh mesh(assembly.shapes[part.shape]);
    all.parts.push_back({std::move(part), mesh});
  }
  return all;
}

void bind_mesh(nb::module_& m) {
  nb::class_<Mesh>(m, "Mesh", R"(A triangle surface in its own frame, in m.

Coincident vertices are welded, and vertices that no triangle uses are dropped, so indices may differ from those that
were given; triangles keep their number and order. A mesh never changes, so any number of scenes, parts and threads may
share one.

Parameters
----------
vertices : (n, 3) array of float
    In m, in the mesh's frame.
triangles : (m, 3) array of int
    Indices into `vertices`, counter-clockwise seen from outside.
name : str
    For messages.

Raises
------
Error
    An index out of range, a number that is not finite or beyond 1000 km, no triangle, or another shape.)")
      .def(
          "__init__",
          [](Mesh* self, nb::handle vertices, nb::handle triangles, const std::string& name) {
            new (self) Mesh(mesh_of(vertices, triangles, name));
          },
          nb::arg("vertices"), nb::arg("triangles"), nb::arg("name") = "mesh",
          nb::sig("def __init__(self, vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike, name: str = "
                  "'mesh') -> None"))
      .def_prop_ro(
          "vertices",
          [](const Mesh& mesh) {
            const auto& v = mesh.shared->vertices;
            return view<VertexView>(mesh, v.front().data(), v.size());
          },
          nb::rv_policy::automatic, "(n, 3) float64, m: a read-only view without a copy, which keeps the mesh.")
      .def_prop_ro(
          "triangles",
          [](const Mesh& mesh) {
            const auto& t = mesh.shared->triangles;
            return view<TriangleView>(mesh, t.front().data(), t.size());
          },
          nb::rv_policy::automatic, "(m, 3) uint32: a read-only view without a copy, which keeps the mesh.")
      .def_prop_ro(
          "name", [](const Mesh& mesh) { return mesh.shared->name; }, "Where it came from, for messages.")
      .def_prop_ro(
          "notes", [](const Mesh& mesh) { return mesh.shared->notes; }, "What is not as the file says, a line each.")
      .def("report", &report_of, nb::sig("def report(self) -> dict[str, typing.Any]"),
           "What the surface is like: counts of vertices, triangles, components, boundary and non-manifold edges,\n"
           "degenerate and duplicate faces, inverted shells; `closed`; the corners of its box in m.")
      .def(
          "center_of_mass",
          [](const Mesh& mesh) {
            const nb::gil_scoped_release others_go_on;
            const Vec3 center = mass_properties(*mesh.shared, report(*mesh.shared).closed).center;
            const nb::gil_scoped_acquire python;
            return to_array(center);
          },
          "(3,) float64, m, of the homogeneous solid; of an open surface that of its box.")
      .def("__repr__", [](const Mesh& mesh) {
        return "Mesh(" + mesh.shared->name + ": " + std::to_string(mesh.shared->vertices.size()) + " vertices, " +
               std::to_string(mesh.shared->triangles.size()) + " triangles)";
      });
}

void bind_load_mesh(nb::module_& m) {
  m.def(
      "load_mesh",
      [](const std::filesystem::path& path, const std::string& unit, bool trusted) {
        const MeshLoader load = mesh_loader(trusted);
        const nb::gil_scoped_release others_go_on;
        return Mesh(load(path.string(), unit_length(unit)));
      },
      nb::arg("path"), nb::arg("unit") = "mm", nb::arg("trusted") = false,
      nb::sig("def load_mesh(path: str | os.PathLike[str], unit: str = 'mm', trusted: bool = False) -> Mesh"),
      R"(Reads STL, OBJ, PLY, OFF, glTF/GLB or 3MF as one surface.

Other Python threads go on meanwhile.

Parameters
----------
path : str or os.PathLike
unit : str
    Length of one unit of the file: "m", "cm", "mm", "um" or "in".
trusted : bool
    False: another process parses the file, bounded in time (60 s) and memory (4 GB), so that a damaged file ends that
    process alone. True: this one does, which is a little faster.

Returns
-------
Mesh

Raises
------
Error
    kind "file": the file cannot be used, with the reason.)");
}

void bind_assembly(nb::module_& m) {
  nb::class_<PlacedPart>(m, "AssemblyPart", "A leaf of an assembly: one placed instance of a shape.")
      .def_prop_ro(
          "name", [](const PlacedPart& p) { return p.part.name; }, "Unique in the assembly.")
      .def_prop_ro(
          "path", [](const PlacedPart& p) { return p.part.path; }, "The groups that it is in, the outermost first.")
      .def_prop_ro(
          "pose", [](const PlacedPart& p) { return to_array(p.part.pose); }, nb::rv_policy::automatic,
          "(4, 4) float64, X_WF, m: of the shape's frame in the assembly's.")
      .def_prop_ro(
          "color",
          [](const PlacedPart& p) -> std::optional<std::vector<double>> {
            if (!p.part.color) return std::nullopt;
            return std::vector<double>(p.part.color->begin(), p.part.color->end());
          },
          "Red, green, blue (sRGB), opacity, each 0 to 1; None where the file has none.")
      .def_prop_ro(
          "mesh", [](const PlacedPart& p) { return p.mesh; }, "In its own frame, m; instances share it.")
      .def("__repr__", [](const PlacedPart& p) { return "AssemblyPart(" + p.part.name + ")"; });
  nb::class_<PlacedAssembly>(m, "Assembly", "What a file of parts holds.")
      .def_prop_ro(
          "parts", [](const PlacedAssembly& a) { return a.parts; }, "In the order of the file.")
      .def_prop_ro(
          "unit", [](const PlacedAssembly& a) { return a.unit; },
          "Of the file, or the one that its lengths were read in.")
      .def_prop_ro(
          "notes", [](const PlacedAssembly& a) { return a.notes; }, "What is not as the file says, a line each.");
}

void bind_read_assembly(nb::module_& m) {
  m.def(
      "read_assembly",
      [](const std::filesystem::path& path, const std::optional<std::string>& unit, bool split, double chord,
         double coarse_chord) {
        const nb::gil_scoped_release others_go_on;
        AssemblyOptions how;
        how.unit = unit;
        how.split = split;
        how.chord = chord;
        how.coarse_chord = coarse_chord;
        return placed(read_assembly(path.string(), how));
      },
      nb::arg("path"), nb::arg("unit") = nb::none(), nb::kw_only(), nb::arg("split") = false,
      nb::arg("chord") = AssemblyOptions().chord, nb::arg("coarse_chord") = AssemblyOptions().coarse_chord,
      nb::sig("def read_assembly(path: str | os.PathLike[str], unit: str | None = None, *, split: bool = False, chord: "
              "float = 5e-06, coarse_chord: float = 5e-05) -> Assembly"),
      R"(Reads STEP, glTF/GLB or 3MF with its tree, or another mesh file as one part.

The file is parsed in this process. Other Python threads go on meanwhile.

Parameters
----------
path : str or os.PathLike
unit : str, optional
    "m", "cm", "mm", "um" or "in": of the lengths of a file that does not say it (STL, OBJ, PLY, OFF), or that says m and
    is wrong (glTF). None: m, and a file that is more than 20 m across is refused, for it is most often in mm.
split : bool
    Every connected piece of a surface is a part.
chord, coarse_chord : float
    m: how far a facet of a STEP file may be from a face with a counterpart nearby, and from any other curved face (a
    part alone in its file is between the two, by its size).

Returns
-------
Assembly

Raises
------
Error
    kind "file": the file cannot be used, with the reason.)");
}

}  // namespace

void bind_meshes(nb::module_& m) {
  bind_mesh(m);
  bind_load_mesh(m);
  bind_assembly(m);
  bind_read_assembly(m);
}

}  // namespace tegotae::python
