// The ways in which STL and PLY files are written: a test for each row of docs/formats.md.
#include <cstring>

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "tegotae/import/load.hpp"
#include "text.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

// Corners 0, x, y, z of a tetrahedron.
const int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
const float kCorners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// `sliver`: what stands for the normal of a facet without an area, among the others.
std::string text_stl(const std::string& name = "t", const std::string& sliver = "") {
  std::string s = "solid " + name + "\n";
  for (int f = 0; f < 4; ++f) {
    s += " facet normal 0 0 0\n  outer loop\n";
    for (const int i : kFaces[f])
      s += "   vertex " + std::to_string(kCorners[i][0]) + " " + std::to_string(kCorners[i][1]) + " " +
           std::to_string(kCorners[i][2]) + "\n";
    s += "  endloop\n endfacet\n";
    if (f == 1 && !sliver.empty())
      s += " facet normal " + sliver +
           "\n  outer loop\n   vertex 0 0 0\n   vertex 0 0 0\n   vertex 2 0 0\n  endloop\n endfacet\n";
  }
  return s + "endsolid " + name + "\n";
}

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

std::string binary_stl(std::string header, std::uint16_t attribute = 0) {
  header.resize(80, '\0');
  put(header, std::uint32_t{4});
  for (const auto& f : kFaces) {
    for (int k = 0; k < 3; ++k) put(header, 0.0f);
    for (const int i : f)
      for (const float x : kCorners[i]) put(header, x);
    put(header, attribute);
  }
  return header;
}

void check_tetrahedron(const TempFolder& folder, const std::string& name, const std::string& bytes) {
  INFO(name);
  folder.write(name, bytes);
  MeshReport r;
  REQUIRE_NOTHROW(r = report(load_mesh(folder / name)));
  CHECK(r.triangles - r.degenerate_faces == 4);
  CHECK(r.vertices == 4);
  CHECK(r.inverted_shells == 0);
  CHECK(r.closed);
  CHECK((r.box_max - Vec3(2, 1, 1)).norm() == 0);
  CHECK(r.box_min.norm() == 0);
}

std::string refusal(const TempFolder& folder, const std::string& name, const std::string& bytes) {
  folder.write(name, bytes);
  return test::refusal([&] { load_mesh(folder / name); });
}

const char* const kVertices = "0 0 0\n2 0 0\n0 1 0\n0 0 1\n";
const char* const kTriangles = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
const char* const kVertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const char* const kFace = "element face 4\nproperty list uchar int vertex_indices\n";
const char* const kCamera = "element camera 2\nproperty float fx\nproperty list uchar short more\n";

std::string ply(const std::string& head, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + head + "end_header\n" + body;
}

}  // namespace

TEST_CASE("STL: normals that are not numbers belong to slivers, and nobody needs them", "[flat]") {
  const TempFolder folder;
  for (const char* normal : {"NaN NaN NaN", "-nan -nan -nan", "-nan(ind) -nan(ind) -nan(ind)",
                             "-1.#IND -1.#IND -1.#IND", "1.#QNAN 0 0", "0 0", "", "1e999 0 0"}) {
    INFO(normal);
    folder.write("n.stl", text_stl("t", std::string(normal) + " "));
    const TriangleMesh mesh = load_mesh(folder / "n.stl");
    CHECK(mesh.vertices.size() == 4);
    CHECK(report(mesh).degenerate_faces == 1);
  }
}

TEST_CASE("STL: letters, marks, blanks and names around the facets", "[flat]") {
  const TempFolder folder;
  std::string upper = text_stl();
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  check_tetrahedron(folder, "upper.stl", upper);
  check_tetrahedron(folder, "mark.stl", "\xef\xbb\xbf" + text_stl());
  check_tetrahedron(folder, "blank.stl", "\n \t\r\n" + text_stl());
  check_tetrahedron(folder, "crlf.stl", replaced_all(text_stl(), "\n", "\r\n"));
  check_tetrahedron(folder, "name.stl", text_stl("facet cover endsolid"));
  check_tetrahedron(folder, "none.stl", text_stl(""));
  check_tetrahedron(folder, "line.stl", replaced_all(text_stl(), "\n", " ") + "\n");
  check_tetrahedron(folder, "plus.stl", replaced_all(text_stl(), "vertex 2", "vertex +2"));
  check_tetrahedron(folder, "end.stl", text_stl() + "\x1a");
}

TEST_CASE("STL: binary files may say solid, have attributes, and be padded", "[flat]") {
  const TempFolder folder;
  check_tetrahedron(folder, "solid.stl", binary_stl("solid part"));
  check_tetrahedron(folder, "color.stl", binary_stl("COLOR=\xff", 0x801f));
  for (const std::size_t pad : {1u, 2u, 49u}) {
    check_tetrahedron(folder, "pad.stl", binary_stl("exporter") + std::string(pad, '\0'));
    check_tetrahedron(folder, "solid_pad.stl", binary_stl("solid part") + std::string(pad, '\n'));
  }
  for (const std::size_t pad : {50u, 312u, 4096u})
    for (const char c : {'\0', ' ', '\n', '\x1a', '\xff'}) {
      check_tetrahedron(folder, "block.stl", binary_stl("exporter") + std::string(pad, c));
      check_tetrahedron(folder, "solid_block.stl", binary_stl("solid part") + std::string(pad, c));
    }
  // A facet, of which the count does not know, is not padding.
  const std::string facet = binary_stl("x").substr(84, 50);
  CHECK_THAT(refusal(folder, "more.stl", binary_stl("x") + facet),
             Catch::Contains("damaged: its header states 4 triangles, the file has bytes for 5"));
  CHECK_THAT(refusal(folder, "mixed.stl", binary_stl("x") + std::string(50, '\0') + facet),
             Catch::Contains("the file has bytes for 6"));
}

TEST_CASE("STL: facets of other than three corners, and text that is none, are refused", "[flat]") {
  const TempFolder folder;
  CHECK_THAT(refusal(folder, "four.stl", replaced_all(text_stl(), "  endloop", "   vertex 0 0 0\n  endloop")),
             Catch::Contains("without endloop"));
  CHECK_THAT(refusal(folder, "word.stl", replaced_all(text_stl(), "vertex 2.000000", "vertex two")),
             Catch::Contains("without three numbers"));
  CHECK_THAT(refusal(folder, "after.stl", text_stl() + "facet normal 0 0 0"), Catch::Contains("truncated or damaged"));
}

TEST_CASE("STL: solids of a text file give their names to pieces", "[flat]") {
  const TempFolder folder;
  folder.write("two.stl", text_stl("left side") + replaced_all(text_stl("right"), "vertex 0.000000", "vertex -9"));
  AssemblyOptions options;
  options.split = true;
  const Assembly a = read_assembly(folder / "two.stl", options);
  REQUIRE(a.parts.size() == 2);
  CHECK(a.parts[0].name == "left");
  CHECK(a.parts[1].name == "right");
}

TEST_CASE("PLY: elements and properties that are not shape are skipped, in any order", "[flat]") {
  const TempFolder folder;
  const std::string v = kVertex, f = kFace, c = kCamera;
  check_tetrahedron(folder, "last.ply", ply(v + f + c, std::string(kVertices) + kTriangles + "1 2 3 4\n1 0\n"));
  check_tetrahedron(folder, "first.ply", ply(c + v + f, "1 2 3 4\n1 0\n" + std::string(kVertices) + kTriangles));
  check_tetrahedron(folder, "faces_first.ply", ply(f + v, std::string(kTriangles) + kVertices));
  check_tetrahedron(folder, "properties.ply",
                    ply("element vertex 4\nproperty uchar red\nproperty list uchar int seen_by\nproperty double "
                        "z\nproperty float y\nproperty int x\n"
                        "element face 4\nproperty uchar flags\nproperty list uchar uint vertex_index\nproperty list "
                        "uchar float texcoord\n",
                        "9 1 7 0 0 0\n9 0 0 0 2\n9 0 0 1 0\n9 2 7 7 1 0 0\n"
                        "7 3 0 2 1 0\n7 3 0 1 3 2 .5 .5\n7 3 1 2 3 0\n7 3 2 0 3 0\n"));
  std::string binary =
      "ply\r\nformat binary_big_endian 1.0\r\nelement camera 1\r\nproperty short a\r\nproperty list uchar double "
      "b\r\n" +
      replaced_all(v + f, "\n", "\r\n") + "end_header\r\n" + std::string("\1\2\1\0\0\0\0\0\0\0\0", 11);
  const auto big = [&](auto value) {
    std::string raw;
    put(raw, value);
    binary.append(raw.rbegin(), raw.rend());
  };
  for (const auto& corner : kCorners)
    for (const float x : corner) big(x);
  for (const auto& face : kFaces) {
    big(std::uint8_t{3});
    for (const int i : face) big(std::int32_t{i});
  }
  check_tetrahedron(folder, "binary.ply", binary);
}

TEST_CASE("PLY: triangle strips, ended by -1", "[flat]") {
  const TempFolder folder;
  const std::string head = std::string(kVertex) + "element tristrips 1\nproperty list int int vertex_indices\n";
  check_tetrahedron(folder, "one.ply", ply(head, std::string(kVertices) + "6 0 2 1 3 0 2\n"));
  check_tetrahedron(folder, "three.ply", ply(head, std::string(kVertices) + "12 0 2 1 3 -1 2 0 3 -1 0 1 3\n"));
  CHECK_THAT(refusal(folder, "range.ply", ply(head, std::string(kVertices) + "4 0 2 1 -2\n")),
             Catch::Contains("index out of range: tristrips 0"));
}

TEST_CASE("PLY: vertices without a place and faces without corners are refused", "[flat]") {
  const TempFolder folder;
  CHECK_THAT(refusal(folder, "axis.ply",
                     ply(replaced_all(kVertex, "float z", "float w") + kFace, std::string(kVertices) + kTriangles)),
             Catch::Contains("have no z"));
  CHECK_THAT(refusal(folder, "list.ply",
                     ply(std::string(kVertex) + "element face 4\nproperty list uchar int corners\n",
                         std::string(kVertices) + kTriangles)),
             Catch::Contains("no list vertex_indices"));
}
