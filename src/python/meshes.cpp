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

constexpr char kMeshDoc[] =
    R"(A triangle surface in its own frame, in m.

The constructor welds coincident vertices and drops vertices that no triangle uses. So vertex indices may differ from
those given; the triangles keep their number and order. A mesh never changes. Any number of scenes, parts and threads
may share it.

Parameters
----------
vertices : (n, 3) array of float
    In m, in the mesh's frame.
triangles : (m, 3) array of int
    Indices into `vertices`, counterclockwise seen from outside.
name : str
    Origin of the mesh, for messages.

Raises
------
Error
    kind "setting": an index is out of range or not a whole number, a coordinate is not finite or beyond 1000 km, there
    is no triangle, or an array has another shape.
TypeError
    The coordinates are text or complex numbers.)";

void bind_mesh(nb::module_& m) {
  nb::class_<Mesh>(m, "Mesh", kMeshDoc)
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
          nb::rv_policy::automatic,
          "Vertices, (n, 3) float64, m, in the mesh's frame: a read-only view without a copy. It keeps the mesh alive.")
      .def_prop_ro(
          "triangles",
          [](const Mesh& mesh) {
            const auto& t = mesh.shared->triangles;
            return view<TriangleView>(mesh, t.front().data(), t.size());
          },
          nb::rv_policy::automatic,
          "Indices into `vertices`, (m, 3) uint32: a read-only view without a copy. It keeps the mesh alive.")
      .def_prop_ro(
          "name", [](const Mesh& mesh) { return mesh.shared->name; }, "Origin of the mesh, for messages.")
      .def_prop_ro(
          "notes", [](const Mesh& mesh) { return mesh.shared->notes; },
          "Deviations of the mesh from its file, one line each.")
      .def("report", &report_of, nb::sig("def report(self) -> dict[str, typing.Any]"),
           "Returns properties of the surface: the counts `vertices`, `triangles`, `components`, `boundary_edges`,\n"
           "`non_manifold_edges`, `degenerate_faces`, `duplicate_faces` and `inverted_shells`; whether it is\n"
           "`closed`; and the corners of its bounding box, `box_min` and `box_max`, each (3,) float64, m. Other\n"
           "Python threads continue meanwhile.")
      .def(
          "center_of_mass",
          [](const Mesh& mesh) {
            const nb::gil_scoped_release others_go_on;
            const Vec3 center = mass_properties(*mesh.shared, report(*mesh.shared).closed).center;
            const nb::gil_scoped_acquire python;
            return to_array(center);
          },
          "Returns the center of mass of the homogeneous solid, (3,) float64, m, in the mesh's frame. For a surface\n"
          "that is not closed or has no volume, it is the centroid of the area. Other Python threads continue\n"
          "meanwhile.")
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
      R"(Reads a file in STL, OBJ, PLY, OFF, glTF/GLB or 3MF as one surface.

Other Python threads continue meanwhile.

Parameters
----------
path : str or os.PathLike
unit : str
    Length of one unit of the file: "m", "cm", "mm", "um" or "in".
trusted : bool
    False: another process parses the file, within 60 s and 4 GB of memory. A damaged file then ends only that process.
    True: this process parses the file, which is a little faster.

Returns
-------
Mesh

Raises
------
Error
    kind "file": the file cannot be used; the message has the reason. kind "other": the unit is unknown.)");
}

void bind_assembly(nb::module_& m) {
  nb::class_<PlacedPart>(m, "AssemblyPart", "A leaf of an assembly: one placed instance of a shape.")
      .def_prop_ro(
          "name", [](const PlacedPart& p) { return p.part.name; }, "Name of the part, unique in the assembly.")
      .def_prop_ro(
          "path", [](const PlacedPart& p) { return p.part.path; },
          "Names of the groups that contain the part, the outermost first.")
      .def_prop_ro(
          "pose", [](const PlacedPart& p) { return to_array(p.part.pose); }, nb::rv_policy::automatic,
          "Pose X_WF of the mesh's frame in the frame of the assembly, (4, 4) float64, m.")
      .def_prop_ro(
          "color",
          [](const PlacedPart& p) -> std::optional<std::vector<double>> {
            if (!p.part.color) return std::nullopt;
            return std::vector<double>(p.part.color->begin(), p.part.color->end());
          },
          "Red, green, blue (sRGB) and opacity, each 0 to 1. None: the file gives no color.")
      .def_prop_ro(
          "mesh", [](const PlacedPart& p) { return p.mesh; },
          "Surface in its own frame, m. Instances of one shape share it.")
      .def("__repr__", [](const PlacedPart& p) { return "AssemblyPart(" + p.part.name + ")"; });
  nb::class_<PlacedAssembly>(m, "Assembly", "Contents of a file of parts, in the file's frame, in m.")
      .def_prop_ro(
          "parts", [](const PlacedAssembly& a) { return a.parts; }, "Leaves of the tree, in the order of the file.")
      .def_prop_ro(
          "unit", [](const PlacedAssembly& a) { return a.unit; },
          "Unit of the file (\"m\", \"mm\", ...), or the one in which its lengths were read.")
      .def_prop_ro(
          "notes", [](const PlacedAssembly& a) { return a.notes; },
          "Deviations of the assembly from its file, one line each.");
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
      R"(Reads a STEP, glTF/GLB or 3MF file with its tree, or another mesh file as one part.

This process parses the file. Other Python threads continue meanwhile.

Parameters
----------
path : str or os.PathLike
unit : str, optional
    "m", "cm", "mm", "um" or "in": unit of a file that does not state its own (STL, OBJ, PLY, OFF), or that states m
    wrongly (glTF). None: m; then a file more than 20 m across is refused, because it is most often in mm.
split : bool
    True: every connected component of a surface becomes a part.
chord, coarse_chord : float
    m: largest distance of a facet of a STEP file from its face. `chord` is for mating faces, which have a counterpart
    nearby; `coarse_chord` is for other curved faces. A part alone in its file gets less than `coarse_chord`, by its
    size.

Returns
-------
Assembly

Raises
------
Error
    kind "file": the file cannot be used, the unit is unknown, or a unit is given for a file that states its own (STEP,
    3MF); the message has the reason. kind "other": a chord is not a positive length.)");
}

}  // namespace

void bind_meshes(nb::module_& m) {
  bind_mesh(m);
  bind_load_mesh(m);
  bind_assembly(m);
  bind_read_assembly(m);
}

}  // namespace tegotae::python
