// STEP assemblies, written with OpenCASCADE and known in closed form.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "mesh/step_assembly.hpp"
#include "mesh/step_products.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/import/write.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const TriangleMesh& mesh_of(const Assembly& assembly, const std::string& name) {
  return *assembly.shapes[part(assembly, name).shape];
}

double disc(double diameter_mm, double height_mm) {
  return M_PI / 4 * diameter_mm * diameter_mm * height_mm * 1e-9;
}

/// Nearest and farthest distance (m) from the line along z through (x, y, 0) of the triangles that lie between the
/// radii `from` and `to` (mm) with all corners and are not flat in z: the facets of one cylinder.
struct Radii {
  double nearest = 1e9, farthest = 0;
  int facets = 0;
};

Radii radii(const TriangleMesh& mesh, double x_mm, double from, double to) {
  Radii out;
  const auto planar = [&](const Vec3& p) { return Eigen::Vector2d(p.x() - 1e-3 * x_mm, p.y()); };
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (std::abs((b - a).cross(c - a).normalized().z()) > 0.5) continue;
    bool within = true;
    for (const Vec3& p : {a, b, c}) within = within && planar(p).norm() > 1e-3 * from && planar(p).norm() < 1e-3 * to;
    if (!within) continue;
    ++out.facets;
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const Eigen::Vector2d u = planar(p), d = planar(q) - u;
      const double s = d.squaredNorm() > 0 ? std::clamp(-u.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
      out.nearest = std::min(out.nearest, (u + s * d).norm());
      out.farthest = std::max({out.farthest, u.norm(), planar(q).norm()});
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a STEP assembly keeps names, tree, instances, places and colors in every unit and schema", "[step]") {
  const TempFolder folder;
  const std::pair<const char*, const char*> kinds[] = {
      {"MM", "AP203"}, {"MM", "AP214IS"}, {"MM", "AP242DIS"}, {"M", "AP214IS"}, {"INCH", "AP242DIS"}};
  for (const auto& [unit, schema] : kinds) {
    INFO(unit << " " << schema);
    write_step_assembly(folder / "a.step", {}, unit, schema);
    const Assembly a = read_assembly(folder / "a.step");
    CHECK(a.unit == "mm");
    REQUIRE(a.parts.size() == 7);
    CHECK(a.shapes.size() == 5);
    std::vector<std::string> names;
    for (const AssemblyPart& p : a.parts) names.push_back(p.name);
    CHECK(names == std::vector<std::string>{"Grundplatte", "Buchse links", "Buchse rechts", "Blech", "Stift", "Stift_2",
                                            "Welle"});
    CHECK(part(a, "Buchse links").path == std::vector<std::string>{"Baugruppe", "Träger"});
    CHECK(part(a, "Stift_2").path == std::vector<std::string>{"Baugruppe", "Deckel"});
    CHECK(part(a, "Welle").path == std::vector<std::string>{"Baugruppe"});
    CHECK(part(a, "Buchse links").shape == part(a, "Buchse rechts").shape);
    CHECK(part(a, "Stift").shape == part(a, "Stift_2").shape);
    // All is turned by 90 degrees about x (y to z, z to -y) and then moved by (100, 200, 300) mm.
    const auto is_at = [&](const char* name, double x, double y, double z) {
      INFO(name);
      const Pose& X = part(a, name).pose;
      CHECK((X.p - 1e-3 * Vec3(100 + x, 200 - z, 300 + y)).norm() < 1e-12);
      CHECK((X.q * Vec3(0, 0, 1) - Vec3(0, -1, 0)).norm() < 1e-12);
    };
    is_at("Grundplatte", 0, 0, 0);
    is_at("Buchse links", -20, 0, -15);
    is_at("Buchse rechts", 20, 0, -15);
    is_at("Stift_2", 42, 0, -9);
    is_at("Welle", -20, 0, -30);
    const auto is_colored = [&](const char* name, double r, double g, double b) {
      INFO(name);
      REQUIRE(part(a, name).color);
      const Color& c = *part(a, name).color;
      CHECK(c[0] == Approx(r).margin(1e-6));
      CHECK(c[1] == Approx(g).margin(1e-6));
      CHECK(c[2] == Approx(b).margin(1e-6));
      CHECK(c[3] == 1);
    };
    is_colored("Grundplatte", 0.1, 0.2, 0.9);
    is_colored("Buchse rechts", 0.8, 0.1, 0.1);
    is_colored("Blech", 0.2, 0.7, 0.3);
    CHECK(!part(a, "Welle").color);
    // 5 um of sagitta on a radius of 10 mm is 0.05 % of the radius; the area of the ring lost is two thirds of it.
    const double box = 110 * 60 * 1e-9;
    CHECK(volume(mesh_of(a, "Welle")) == Approx(disc(19.993, 60)).epsilon(1e-3));
    CHECK(volume(mesh_of(a, "Grundplatte")) == Approx(15 * box - 2 * disc(26, 15) - 2 * disc(6, 15)).epsilon(1e-3));
    CHECK(volume(mesh_of(a, "Blech")) == Approx(5 * box - 2 * disc(31, 5) - 2 * disc(6, 5)).epsilon(2e-3));
    CHECK(volume(mesh_of(a, "Buchse links")) == Approx(disc(25.98, 15) - disc(20, 15)).epsilon(2e-3));
    for (const auto& shape : a.shapes) {
      const MeshReport r = report(*shape);
      CHECK(r.closed);
      CHECK(r.components == 1);
      CHECK(r.degenerate_faces == 0);
    }
  }
}

TEST_CASE("tessellation never closes a nominal clearance, also after rounding to a file", "[step]") {
  const TempFolder folder;
  const StepSizes sizes;
  write_step_assembly(folder / "a.step", sizes, "MM", "AP214IS");
  for (const double chord : {5e-6, 40e-6}) {
    AssemblyOptions options;
    options.chord = chord;
    const Assembly a = read_assembly(folder / "a.step", options);
    for (const std::string& note : a.notes) UNSCOPED_INFO(note);
    CHECK(a.notes.empty());
    const auto from_file = [&](const std::string& name) {
      write_ply(mesh_of(a, name), folder / "shape.ply", 1e-3);
      const TriangleMesh mesh = load_mesh(folder / "shape.ply", 1e-3);
      CHECK(report(mesh).boundary_edges == 0);
      CHECK(report(mesh).closed);
      return mesh;
    };
    struct Case {
      const char* name;
      double x, radius;  // mm
      bool hole;
    };
    const Case cases[] = {{"Grundplatte", -20, 13, true}, {"Grundplatte", 20, 13, true},
                          {"Grundplatte", 42, 3, true},   {"Blech", -42, 3, true},
                          {"Buchse links", 0, 10, true},  {"Buchse links", 0, 12.99, false},
                          {"Welle", 0, 9.9965, false},    {"Stift", 0, 2.998, false}};
    for (const Case& c : cases) {
      INFO(c.name << " " << c.radius << " chord " << chord);
      const TriangleMesh mesh = from_file(c.name);
      const Radii r = radii(mesh, c.x, c.radius - 0.1, c.radius + 0.1);
      CHECK(r.facets >= 12);
      // Double arithmetic of this test, far under the rounding of the file (2 nm).
      constexpr double noise = 1e-15;
      if (c.hole) {
        CHECK(r.nearest >= 1e-3 * c.radius - noise);
        CHECK(r.farthest <= 1e-3 * c.radius + chord + 1e-8);
      } else {
        CHECK(r.farthest <= 1e-3 * c.radius + noise);
        CHECK(r.nearest >= 1e-3 * c.radius - chord - 1e-8);
      }
    }
  }
}

TEST_CASE("faces that mate are tessellated finer than others", "[step]") {
  const TempFolder folder;
  write_step_assembly(folder / "a.step", {}, "MM", "AP214IS");
  const Assembly a = read_assembly(folder / "a.step");
  // The windows of the cover (31 mm) have no counterpart.
  const Radii window = radii(mesh_of(a, "Blech"), 20, 15, 16);
  CHECK(window.farthest - window.nearest > 10e-6);
  CHECK(window.nearest >= 15.5e-3 - 1e-15);
  AssemblyOptions fine;
  fine.coarse_chord = 5e-6;
  const Assembly b = read_assembly(folder / "a.step", fine);
  const Radii finer = radii(mesh_of(b, "Blech"), 20, 15, 16);
  CHECK(finer.facets > 2 * window.facets);
}

TEST_CASE("facets of a part alone in its file follow its size", "[step]") {
  const TempFolder folder;
  // mm: edge, and how far the facets of its cavity, a sphere, may be from it: edge sqrt(3) / 4000, 5 to 50 um.
  for (const auto& [size, chord] : {std::pair(5.0, 5e-3), std::pair(60.0, 26e-3), std::pair(400.0, 50e-3)}) {
    INFO(size);
    write_step_housing(folder / "housing.step", size);
    const Assembly a = read_assembly(folder / "housing.step");
    REQUIRE(a.shapes.size() == 1);
    const TriangleMesh& mesh = *a.shapes[0];
    CHECK(report(mesh).closed);
    const double radius = 0.4 * size;
    double deepest = 0;  // of a facet's middle inside the sphere, mm
    for (const auto& t : mesh.triangles) {
      const Vec3 p[] = {1e3 * mesh.vertices[t[0]], 1e3 * mesh.vertices[t[1]], 1e3 * mesh.vertices[t[2]]};
      if (std::any_of(std::begin(p), std::end(p), [&](const Vec3& q) { return std::abs(q.norm() - radius) > 1e-3; }))
        continue;
      deepest = std::max(deepest, radius - ((p[0] + p[1] + p[2]) / 3).norm());
    }
    CHECK(deepest <= 1.1 * chord);
    if (size > 50) CHECK(deepest > 0.3 * chord);  // the facets of a small one are bound by their angle
    const Radii hole = radii(mesh, 0, 49 * size / 1000, 51 * size / 1000);
    CHECK(hole.nearest >= 0.05e-3 * size - 1e-15);
    // A tenth of the sphere's chord, from 5 um on.
    const double fine = std::max(5e-6, 1e-3 * size * std::sqrt(3) / 40000);
    CHECK(hole.farthest <= 0.05e-3 * size + fine + 1e-8);
    // The sphere's area by that of an equilateral facet whose middle is `chord` deep, threefold.
    const double facet = 3 * std::sqrt(3) / 4 * 2 * radius * chord;
    CHECK(static_cast<double>(mesh.triangles.size()) < 3 * 4 * M_PI * radius * radius / facet + 2000);
  }
}

TEST_CASE("cylinders and cones of a large part alone in its file have no more facets than those of a small one",
          "[step]") {
  const TempFolder folder;
  const auto read = [&](double size, double coarse_chord) {
    write_step_beam(folder / "beam.step", size);
    AssemblyOptions options;
    options.coarse_chord = coarse_chord;
    const Assembly a = read_assembly(folder / "beam.step", options);
    REQUIRE(a.shapes.size() == 1);
    CHECK(a.notes.empty());
    CHECK(report(*a.shapes[0]).closed);
    return a.shapes[0];
  };
  // Farthest corner of the first bore (hole) and nearest facet of the first boss (shaft), m from their walls.
  const auto errors = [](const TriangleMesh& mesh, double size) {
    const double bore = 7.5e-3 * size, boss = 15e-3 * size;
    const Radii in = radii(mesh, 25e-3 * size, 0.98 * bore, 1.02 * bore);
    const Radii out = radii(mesh, 75e-3 * size, 0.98 * boss, 1.02 * boss);
    CHECK(in.nearest >= 1e-3 * bore - 1e-15);
    CHECK(out.farthest <= 1e-3 * boss + 1e-15);
    return std::pair(in.farthest - 1e-3 * bore, 1e-3 * boss - out.nearest);
  };
  // Diagonals: 199.7 mm, the largest that has 5 um; 1004 mm, for which 25.1 um are as much.
  const auto small = read(199, 50e-6), large = read(1000, 50e-6), fine = read(1000, 5e-6);
  const double noise = 2e-8;
  const auto [small_bore, small_boss] = errors(*small, 199);
  CHECK(std::max(small_bore, small_boss) <= 5e-6 + noise);
  const auto [large_bore, large_boss] = errors(*large, 1000);
  CHECK(std::max(large_bore, large_boss) <= 25.1e-6 + noise);
  CHECK(std::min(large_bore, large_boss) > 10e-6);
  const auto [fine_bore, fine_boss] = errors(*fine, 1000);
  CHECK(std::max(fine_bore, fine_boss) <= 5e-6 + noise);
  CHECK(static_cast<double>(large->triangles.size()) < 1.05 * static_cast<double>(small->triangles.size()));
  CHECK(fine->triangles.size() > 2 * large->triangles.size());
}

TEST_CASE("a solid of a STEP file that is not closed is told with the face", "[step]") {
  const TempFolder folder;
  write_step_open_solid(folder / "open.step");
  const Assembly a = read_assembly(folder / "open.step");
  REQUIRE(a.notes.size() == 1);
  INFO(a.notes[0]);
  CHECK(a.notes[0].find("\" at face #") != std::string::npos);
  CHECK(a.notes[0].find("(a plane around (") != std::string::npos);
  CHECK(a.notes[0].find(" and 3 more: not closed") != std::string::npos);  // the four sides, not the bottom
  // The number is that of an entity of the file which is a face.
  const std::string number = a.notes[0].substr(a.notes[0].find('#'), a.notes[0].find(" (a") - a.notes[0].find('#'));
  const std::string text = read_text(folder / "open.step");
  const std::size_t at = text.find("\n" + number + " = ADVANCED_FACE");
  CHECK(at != std::string::npos);
}

TEST_CASE("a plane face of many round holes takes time in proportion to its holes", "[step]") {
  const TempFolder folder;
  const auto seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };  // of this process's threads
  AssemblyOptions options;
  options.coarse_chord = options.chord;
  double begin = 0;  // OpenCASCADE's reading before takes its time too
  options.progress = [&](const char* what, std::size_t, std::size_t) {
    if (std::string(what).rfind("tessellating \"", 0) == 0) begin = seconds();
  };
  std::vector<double> took;
  for (const int rows : {8, 24}) {
    write_step_perforated(folder / "p.step", rows);
    const Assembly a = read_assembly(folder / "p.step", options);
    REQUIRE(begin > 0);
    took.push_back(seconds() - begin);
    for (const std::string& note : a.notes) UNSCOPED_INFO(note);
    CHECK(a.notes.empty());
    REQUIRE(a.shapes.size() == 1);
    const TriangleMesh& mesh = *a.shapes[0];
    const MeshReport r = report(mesh);
    CHECK(r.closed);
    CHECK(r.components == 1);
    CHECK(r.degenerate_faces == 0);
    // Facets lie outside of the holes' circles by at most the chord error: of 2.5 mm these are 2/1000.
    const int holes = rows * rows;
    CHECK(volume(mesh) == Approx(1e-9 * 2 * holes * (100 - M_PI * 2.5 * 2.5)).epsilon(2e-3));
    // A surface of genus `holes`.
    CHECK(mesh.vertices.size() == mesh.triangles.size() / 2 + 2 - 2 * static_cast<std::size_t>(holes));
    CHECK(mesh.vertices.size() > static_cast<std::size_t>(2 * 20 * holes));
  }
  // Nine times the holes. The default algorithm takes 38 times as long, the one for large planes 16 times.
  CHECK(took[1] < 25 * took[0]);
}

TEST_CASE("STEP files that cannot be read are refused in one line", "[step]") {
  const TempFolder folder;
  write_step_assembly(folder / "a.step", {}, "MM", "AP214IS");
  const std::string whole = read_text(folder / "a.step");
  const auto refused = [&](const std::string& text, const std::string& why) {
    folder.write("bad.step", text);
    const std::string error = refusal(folder / "bad.step");
    INFO(error);
    CHECK(error.find("bad.step: ") != std::string::npos);
    CHECK(error.find(why) != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
  };
  refused("", "empty");
  for (int i = 0; i < 40; ++i) refused(whole.substr(0, whole.size() * static_cast<std::size_t>(i) / 40), "");
  refused(whole.substr(0, whole.size() - 4), "truncated");
  std::string future = whole;
  const auto at = future.find("AUTOMOTIVE_DESIGN");
  REQUIRE(at != std::string::npos);
  future.replace(at, 17, "AP999_EVERYTHING_");
  refused(future, "AP999_EVERYTHING_");
  // A whole frame around data cut in the middle of an instance.
  refused(whole.substr(0, whole.find("DATA;") + 5) + "\nENDSEC;\nEND-ISO-10303-21;\n", "");
  CHECK(refusal(folder / "none.step").find("none.step") != std::string::npos);
}

TEST_CASE("a file that was read leaves nothing behind", "[step]") {
  const TempFolder folder;
  const std::string path = folder / "a.step";
  write_step_assembly(path, {}, "MM", "AP214IS");
  const auto in_use = [&](int reads) {
    for (int i = 0; i < reads; ++i) read_assembly(path);
    return static_cast<double>(mallinfo2().uordblks);
  };
  const double before = in_use(3);
  // A document of it takes half a megabyte.
  CHECK(in_use(10) - before < 500e3);
}
