// The ways in which OBJ and OFF files are written, and what STL and PLY files have around their facets: tests for rows
// of docs/formats.md.
#include <array>

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "tegotae/import/load.hpp"
#include "text.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

// A tetrahedron of the corners 0, 2x, y, z.
const std::string kObjCorners = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string kObjFaces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const std::string kOffCorners = "0 0 0\n2 0 0\n0 1 0\n0 0 1\n";
const std::string kOffFaces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

TriangleMesh check_tetrahedron(const std::string& name, const std::string& bytes) {
  INFO(name);
  const TempFolder folder;
  folder.write(name, bytes);
  TriangleMesh mesh;
  REQUIRE_NOTHROW(mesh = load_mesh(folder / name));
  const MeshReport r = report(mesh);
  CHECK(r.triangles == 4);
  CHECK(r.vertices == 4);
  CHECK(r.closed);
  CHECK(r.inverted_shells == 0);
  CHECK(r.box_min.norm() == 0);
  CHECK((r.box_max - Vec3(2, 1, 1)).norm() == 0);
  return mesh;
}

std::string refused(const std::string& name, const std::string& bytes) {
  const TempFolder folder;
  folder.write(name, bytes);
  return test::refusal([&] { load_mesh(folder / name); });
}

/// The tetrahedron with `x` for its 2.
std::string stl_of(const std::string& x) {
  const std::string corners[4] = {"0 0 0", x + " 0 0", "0 1 0", "0 0 1"};
  std::string s = "solid t\n";
  for (const auto& face : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
    s += "facet normal 0 0 0\nouter loop\n";
    for (const int i : face) s += "vertex " + corners[i] + '\n';
    s += "endloop\nendfacet\n";
  }
  return s + "endsolid t\n";
}

/// A prism over a regular polygon, height 1, radius 1.
std::string off_prism(int n) {
  std::string text = "OFF\n" + std::to_string(2 * n) + ' ' + std::to_string(n + 2) + " 0\n", bottom, top, sides;
  for (int z = 0; z < 2; ++z)
    for (int i = 0; i < n; ++i)
      text += std::to_string(std::cos(2 * M_PI * i / n)) + ' ' + std::to_string(std::sin(2 * M_PI * i / n)) + ' ' +
              std::to_string(z) + '\n';
  for (int i = 0; i < n; ++i) {
    bottom += ' ' + std::to_string(n - 1 - i);
    top += ' ' + std::to_string(n + i);
    const int next = (i + 1) % n;
    sides += "4 " + std::to_string(i) + ' ' + std::to_string(next) + ' ' + std::to_string(n + next) + ' ' +
             std::to_string(n + i) + '\n';
  }
  return text + std::to_string(n) + bottom + '\n' + std::to_string(n) + top + '\n' + sides;
}

}  // namespace

TEST_CASE("OBJ: lines, blanks, marks and comments", "[flat]") {
  const std::string all = kObjCorners + kObjFaces;
  check_tetrahedron("mark.obj", "\xef\xbb\xbf" + all);
  check_tetrahedron("indent.obj", "  " + replaced_all(all, "\n", "\n \t "));
  check_tetrahedron("return.obj", replaced_all(all, "\n", "\r"));
  check_tetrahedron("crlf.obj", replaced_all(all, "\n", "\r\n"));
  check_tetrahedron("aside.obj", replaced_all(all, "\n", " # 1 2 3\n"));
  check_tetrahedron("continued.obj", replaced_all(replaced_all(all, "f 1 ", "f 1 \\\n"), "v 2", "v \\\r\n2"));
  // The folder's last sign does not go on with the next line.
  check_tetrahedron("folder.obj", "# made in C:\\parts\\\n" + all);
  check_tetrahedron("library.obj", "mtllib C:\\parts\\\\a.mtl\ng left\\side\n" + all);
  check_tetrahedron("long.obj", "# " + std::string(10000, 'x') + "\ng " + std::string(10000, 'x') + '\n' + all);
}

TEST_CASE("OBJ: what vertices and corners have besides", "[flat]") {
  for (const char* more : {" 2.0", " 0", " 0.1 0.2 0.3", " 0.1 0.2 0.3 1", " 255 0", " 1 255 0 0 255"}) {
    INFO(more);
    check_tetrahedron("more.obj", replaced_all(kObjCorners, "\n", std::string(more) + "\n") + kObjFaces);
  }
  check_tetrahedron("texture.obj", kObjCorners + "vt 0\nvn nan nan nan\n" + replaced_all(kObjFaces, " 4", " 4/1/1"));
  check_tetrahedron("missing.obj", kObjCorners + replaced_all(kObjFaces, " 4", " 4/7/9"));
  check_tetrahedron("first.obj", kObjFaces + kObjCorners);
  check_tetrahedron("comma.obj", replaced_all(kObjCorners, "2 ", "2,0 ") + kObjFaces);
  check_tetrahedron("plus.obj", replaced_all(kObjCorners, "2 ", "+2.0E0 ") + kObjFaces);
  check_tetrahedron("relative.obj",
                    "v 9 9 9\n" + kObjCorners + "o a\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\nf -2 -4 -1\n");
}

TEST_CASE("OBJ: free-form surfaces are told", "[flat]") {
  const TriangleMesh mesh =
      check_tetrahedron("surface.obj", kObjCorners + "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n" + kObjFaces);
  REQUIRE(mesh.notes.size() == 1);
  CHECK_THAT(mesh.notes[0], Catch::Contains("line 7") && Catch::Contains("not read"));
  const TempFolder folder;
  folder.write("a.obj", kObjCorners + "surf 0 1 0 1 1 2 3 4\n" + kObjFaces);
  CHECK(has_note(read_assembly(folder / "a.obj"), "free-form"));
}

TEST_CASE("coordinates may have the decimal comma of a country", "[flat]") {
  for (const char* two : {"2,0", "2,", "+2,0E0", "20,0e-1"}) {
    INFO(two);
    const std::string corners = replaced_all(kOffCorners, "2 0 0", std::string(two) + " 0,0 0");
    check_tetrahedron("comma.stl", stl_of(two));
    check_tetrahedron("comma.off", "OFF\n4 4 6\n" + corners + kOffFaces);
    check_tetrahedron("comma.ply",
                      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
                          corners + kOffFaces);
  }
  for (const char* none : {"2,0,0", "2.0,0", ",", "2,x"}) {
    INFO(none);
    CHECK_THAT(refused("comma.stl", stl_of(none)), Catch::Contains("without three numbers"));
    CHECK_THAT(refused("comma.off",
                       "OFF\n4 4 6\n" + replaced_all(kOffCorners, "2 0 0", std::string(none) + " 0 0") + kOffFaces),
               Catch::Contains("damaged at vertex 1"));
  }
}

TEST_CASE("numbers without a digit before the point are numbers; those of many digits are as large as they say") {
  for (const char* two : {"2.", "+2.", "0002.", ".2e1", "+.02E+002", "0.00000000000000000000000000002e29", "20000e-4",
                          "200000000000000000000000000000e-29", "0000000000000000000000000000002"}) {
    INFO(two);
    check_tetrahedron("number.obj", replaced_all(kObjCorners, "v 2", std::string("v ") + two) + kObjFaces);
    check_tetrahedron("number.off",
                      "OFF\n4 4 6\n" + replaced_all(kOffCorners, "2 0 0", std::string(two) + " 0 0") + kOffFaces);
    check_tetrahedron("number.stl", stl_of(two));
  }
  for (const char* half : {".5", "-.5", "+.5", "5.e-1", ".5E+0"}) {
    INFO(half);
    const TempFolder folder;
    folder.write("a.obj", replaced_all(kObjCorners, "v 2", std::string("v ") + half) + kObjFaces);
    const MeshReport r = report(load_mesh(folder / "a.obj"));
    CHECK(r.vertices == 4);
    CHECK(r.box_max.x() - r.box_min.x() == 0.5);
  }
  const std::string huge(30, '1');
  CHECK_THAT(refused("huge.obj", replaced_all(kObjCorners, "v 2", "v " + huge) + kObjFaces),
             Catch::Contains("beyond 1000 km"));
  CHECK_THAT(refused("huge.stl", stl_of(huge)), Catch::Contains("beyond 1000 km"));
}

TEST_CASE("OBJ: statements that the format has not are told, and damaged ones refused", "[flat]") {
  const TriangleMesh mesh = check_tetrahedron("call.obj", kObjCorners + "vx 1\ncall other.obj\n" + kObjFaces);
  REQUIRE(mesh.notes.size() == 1);
  CHECK_THAT(mesh.notes[0], Catch::Contains("line 5 \"vx 1\" is not a known statement"));
  for (const char* beside : {"vp 1 2", "mg 1 0.1", "lod 3", "usemap off", "con 1 0 1 1 2 0 1 1", "shadow_obj s.obj"})
    CHECK(check_tetrahedron("beside.obj", kObjCorners + beside + '\n' + kObjFaces).notes.empty());
  // Were they left out, the corners of the faces would be others.
  for (const std::string& damage : {std::string("\xc2\xa0"), std::string("\xe2\x80\x8b"), std::string("\xef\xbb\xbf"),
                                    std::string(1, '\0'), std::string("\x01")}) {
    const std::string more = "v 5 5 5\n" + replaced_all(kObjCorners, "v 2", "v" + damage + "2");
    CHECK_THAT(refused("blank.obj", more + kObjFaces), Catch::Contains("line 3"));
    CHECK_THAT(refused("front.obj", "#\n" + damage + more + kObjFaces), Catch::Contains("line 2"));
  }
}

TEST_CASE("OBJ: faces of fewer than three corners are reported, and files without faces have no triangles", "[flat]") {
  const TriangleMesh mesh = check_tetrahedron("edges.obj", kObjCorners + "f 1 2\n" + kObjFaces + "f 3\n");
  REQUIRE(mesh.notes.size() == 1);
  CHECK_THAT(mesh.notes[0], Catch::Contains("fewer than three corners") && Catch::Contains("line 5"));
  CHECK_THAT(refused("none.obj", "v 0 0 0\n"), Catch::Contains("no triangles"));
  CHECK_THAT(refused("case.obj", replaced_all(kObjCorners, "v", "V") + replaced_all(kObjFaces, "f", "F")),
             Catch::Contains("no triangles; line 1 \"V 0 0 0\" is not a known statement"));
  CHECK_THAT(refused("index.obj", replaced_all(kObjCorners, "v 2", "/v 2") + kObjFaces),
             Catch::Contains("index out of range") && Catch::Contains("line 2 \"/v 2 0 0\" is not a known statement"));
}

TEST_CASE("OFF, PLY: what the counts do not announce is reported; files without faces have no triangles", "[flat]") {
  const std::string head = "OFF\n4 4 6\n", body = kOffCorners + kOffFaces;
  CHECK(check_tetrahedron("blank.off", head + body + " \n# end\n\n").notes.empty());
  const TriangleMesh off = check_tetrahedron("more.off", head + body + "3 0 1 2\n");
  REQUIRE(off.notes.size() == 1);
  CHECK_THAT(off.notes[0], Catch::Contains("behind its last face"));
  CHECK_THAT(refused("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), Catch::Contains("no triangles"));
  CHECK_THAT(refused("nothing.off", "OFF\n0 0 0\n"), Catch::Contains("no triangles"));

  const std::string vertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string list = "property list uchar int vertex_indices\nend_header\n", ply = "ply\nformat ascii 1.0\n";
  for (const std::string& pad : {std::string(), std::string(60, '\0'), std::string("\n \n"), std::string(3, '\x1a')})
    CHECK(check_tetrahedron("pad.ply", ply + vertex + "element face 4\n" + list + body + pad).notes.empty());
  const TriangleMesh more =
      check_tetrahedron("more.ply", ply + vertex + "element face 4\n" + list + body + "3 0 1 2\n");
  REQUIRE(more.notes.size() == 1);
  CHECK_THAT(more.notes[0], Catch::Contains("behind its last element"));
  CHECK_THAT(refused("none.ply", ply + vertex + "element face 0\n" + list + kOffCorners),
             Catch::Contains("no triangles"));
}

TEST_CASE("STL: a damaged facet swallows no other", "[flat]") {
  for (const char* lost : {"outer loop\n", "endloop\n", "endfacet\n", "vertex 0 0 0\n", "loop", "outer"}) {
    std::string text = stl_of("2");
    text.erase(text.find(lost), std::string(lost).size());
    INFO(lost);
    CHECK_THAT(refused("lost.stl", text), Catch::Contains("damaged"));
  }
}

TEST_CASE("STL: a facet begins where outer follows, whatever words a name has", "[flat]") {
  const std::string all = stl_of("2");
  for (const char* name :
       {"facet normal", "my facet normal 0 0 1 part", "facet normal 0 0 1 facet normal", "a facet"}) {
    INFO(name);
    check_tetrahedron("name.stl", replaced_all(all, "solid t\n", std::string("solid ") + name + '\n'));
    // Also all on one line, and with a facet on the line of the name.
    const std::string line = replaced_all(all, "solid t\n", std::string("solid ") + name + ' ');
    check_tetrahedron("line.stl", line);
    check_tetrahedron("one.stl", replaced_all(line, "\n", " "));
  }
}

TEST_CASE("text that only looks right is told by what is wrong with it", "[flat]") {
  std::string zero = stl_of("2");
  zero[zero.find("endloop") - 1] = '\0';  // the end of line 6
  CHECK_THAT(refused("zero.stl", zero), Catch::Contains("zero bytes in the text, the first in line 6"));
  const std::string marks = "\xef\xbb\xbf\xef\xbb\xbf";
  CHECK_THAT(refused("marks.stl", marks + stl_of("2")),
             Catch::Contains("begins with \"solid\", this one with the bytes EF BB BF"));
  CHECK_THAT(refused("space.stl", "\xc2\xa0" + stl_of("2")), Catch::Contains("this one with the bytes C2 A0"));
  for (const char* ends : {" ", "\t"})
    CHECK_THAT(refused("line.off", "OFF\n4 4 0 " + replaced_all(kOffCorners + kOffFaces, "\n", ends) + "\n"),
               Catch::Contains("more than counts on the line of its counts"));
  CHECK_THAT(refused("short.off", "OFF\n4 4 0\n"), Catch::Contains("truncated"));
  // Packed files keep their first name.
  const std::pair<std::string, const char*> packed[] = {{"\x1f\x8b\x08", "gzip"}, {"PK\3\4", "ZIP"},
                                                        {"BZh9", "bzip2"},        {std::string("\3757zXZ\0", 6), "xz"},
                                                        {"(\xb5/\xfd", "zstd"},   {"7z\xbc\xaf'\x1c", "7z"}};
  for (const char* name : {"a.stl", "a.ply", "a.obj", "a.off", "a.gltf", "a.glb"})
    for (const auto& [start, kind] : packed) {
      INFO(name);
      CHECK_THAT(refused(name, start + std::string(200, 'x')), Catch::Contains(std::string("is packed by ") + kind));
    }
  // A binary STL may begin with anything.
  std::string binary("\x1f\x8b");
  binary.resize(80);
  binary += std::string("\1\0\0\0", 4);
  for (const float x : {0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    binary.append(reinterpret_cast<const char*>(&x), sizeof x);
  CHECK(refused("header.stl", binary + std::string(2, '\0')).empty());
}

TEST_CASE("PLY: lines may end with a carriage return alone, as the format began", "[flat]") {
  const std::string vertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string text = "ply\nformat ascii 1.0\ncomment a\n" + vertex + face + kOffCorners + kOffFaces;
  check_tetrahedron("return.ply", replaced_all(text, "\n", "\r"));
  check_tetrahedron("crlf.ply", replaced_all(text, "\n", "\r\n"));
  CHECK_THAT(refused("cut.ply", replaced_all(text, "\n", "\r").substr(0, 100)), Catch::Contains("truncated"));
  CHECK_THAT(refused("lost.ply", replaced_all(replaced_all(text, "3 1 2 3", "3 1 2"), "\n", "\r")),
             Catch::Contains("truncated or damaged at face 2"));
  // Of a binary file only the header has lines; a 13 in its body is a number. Vertex 0 has one, which nobody reads.
  std::string binary =
      replaced_all("ply\nformat binary_little_endian 1.0\n" + vertex + "property uchar more\n" + face, "\n", "\r");
  const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& corner : corners) {
    binary.append(reinterpret_cast<const char*>(corner), sizeof corner);
    binary += '\r';
  }
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (const auto& f : faces) {
    binary += '\3';
    binary.append(reinterpret_cast<const char*>(f), sizeof f);
  }
  check_tetrahedron("binary.ply", binary);
  std::string feed = binary;  // a body that begins with a line feed: the low byte of the first x
  feed[feed.find("end_header\r") + 11] = '\n';
  const TempFolder folder;
  folder.write("feed.ply", feed);
  CHECK(load_mesh(folder / "feed.ply").vertices.size() == 4);
}

TEST_CASE("PLY: faces of any number of corners", "[flat]") {
  // A prism of height 2 over an L of area 3, turned outward: concave, and its sides are quadrangles.
  const float base[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  std::string text, binary;
  const auto face = [&](const std::vector<int>& corners) {
    text += std::to_string(corners.size());
    binary += static_cast<char>(corners.size());
    for (const int i : corners) {
      text += ' ' + std::to_string(i);
      binary.append(reinterpret_cast<const char*>(&i), sizeof i);
    }
    text += '\n';
  };
  for (const float z : {0.f, 2.f})
    for (const auto& p : base) {
      text += std::to_string(p[0]) + ' ' + std::to_string(p[1]) + ' ' + std::to_string(z) + '\n';
      for (const float x : {p[0], p[1], z}) binary.append(reinterpret_cast<const char*>(&x), sizeof x);
    }
  face({5, 4, 3, 2, 1, 0});
  face({6, 7, 8, 9, 10, 11});
  for (int i = 0; i < 6; ++i) face({i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i});
  const std::string head =
      "element vertex 12\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 8\nproperty list uchar int vertex_indices\nend_header\n";
  const TempFolder folder;
  folder.write("text.ply", "ply\nformat ascii 1.0\n" + head + text);
  folder.write("binary.ply", "ply\nformat binary_little_endian 1.0\n" + head + binary);
  for (const char* name : {"text.ply", "binary.ply"}) {
    INFO(name);
    const TriangleMesh mesh = load_mesh(folder / name);
    CHECK(report(mesh).closed);
    CHECK(report(mesh).triangles == 20);  // of n corners n - 2
    CHECK(volume(mesh) == Approx(6));
    CHECK(mesh.notes.empty());
  }
}

TEST_CASE("PLY, OFF: faces of fewer than three corners are counted and left out", "[flat]") {
  const std::string few = "0\n1 2\n2 0 1\n",
                    why = "faces of fewer than three corners are left out, 3 of them; export anew if there is a hole";
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 7\nproperty list uchar int vertex_indices\nend_header\n";
  CHECK(check_tetrahedron("few.ply", head + kOffCorners + few + kOffFaces).notes == std::vector<std::string>{why});
  CHECK(check_tetrahedron("few.off", "OFF\n4 7 0\n" + kOffCorners + few + kOffFaces).notes ==
        std::vector<std::string>{why});
  CHECK_THAT(refused("only.off", "OFF\n4 3 0\n" + kOffCorners + few), Catch::Contains("no triangles"));
}

TEST_CASE("OBJ: padding and marks at the end of a file are not statements", "[flat]") {
  for (const std::string& end : {std::string(40, '\0'), std::string("\x1a"), std::string("\n\x1a\0\0", 4)}) {
    check_tetrahedron("end.obj", kObjCorners + kObjFaces + end);
    check_tetrahedron("line.obj", kObjCorners + kObjFaces.substr(0, kObjFaces.size() - 1) + end);
  }
}

TEST_CASE("text in UTF-16 and UTF-32 is refused as such, whatever the format", "[flat]") {
  const std::string gltf = R"({"asset":{"version":"2.0"}})";
  const std::vector<std::pair<std::string, std::string>> files = {{"w.obj", kObjCorners + kObjFaces},
                                                                  {"w.stl", stl_of("2")},
                                                                  {"w.off", "OFF\n4 4 6\n" + kOffCorners + kOffFaces},
                                                                  {"w.ply", "ply\nformat ascii 1.0\n"},
                                                                  {"w.gltf", gltf}};
  for (const auto& [name, text] : files)
    for (const std::size_t width : {2u, 4u})
      for (const bool big : {false, true})
        for (const bool mark : {false, true}) {
          INFO(name << ' ' << width << big << mark);
          std::string wide;
          const auto put = [&](char high, char low) {
            std::string unit(width, '\0');
            unit[big ? width - 1 : 0] = low;
            unit[big ? width - 2 : 1] = high;
            wide += unit;
          };
          if (mark) put('\xfe', '\xff');
          for (const char c : text) put('\0', c);
          CHECK_THAT(refused(name, wide), Catch::Contains(width == 2 ? "is in UTF-16" : "is in UTF-32"));
        }
}

TEST_CASE("OBJ: what cannot be is refused with its line", "[flat]") {
  CHECK_THAT(refused("two.obj", "\n" + kObjCorners + "v 1 2\n" + kObjFaces), Catch::Contains("line 6 \"v 1 2\""));
  CHECK_THAT(refused("word.obj", kObjCorners + "f 1 2 x\n" + kObjFaces), Catch::Contains("line 5 \"f 1 2 x\""));
  CHECK_THAT(refused("zero.obj", kObjCorners + "f 1 2 0\n"), Catch::Contains("line 5") && Catch::Contains("range"));
  CHECK_THAT(refused("back.obj", kObjCorners + "f 1 2 -5\n"), Catch::Contains("line 5") && Catch::Contains("range"));
  CHECK_THAT(refused("range.obj", kObjCorners + kObjFaces + "f 1 2 5\n"),
             Catch::Contains("line 9 names vertex 5 of 4"));
  CHECK_THAT(refused("huge.obj", replaced_all(kObjCorners, "v 2", "v 1e400") + kObjFaces), Catch::Contains("finite"));
}

TEST_CASE("OFF: headers, comments and blank lines", "[flat]") {
  const std::string body = kOffCorners + kOffFaces;
  check_tetrahedron("one.off", "OFF 4 4 6\n" + body);
  check_tetrahedron("none.off", "4 4 0\n" + body);
  check_tetrahedron("no_edges.off", "OFF\n4 4\n" + body);
  check_tetrahedron("three.off", "OFF\n4\n4 6\n" + body);
  check_tetrahedron("mark.off", "\xef\xbb\xbfOFF\r\n4 4 6\r\n" + replaced_all(body, "\n", "\r\n"));
  check_tetrahedron("comments.off", "# a\nOFF # b\n# c\n4 4 6 # d\n" + replaced_all(body, "\n", " # e\n\n# f\n \n"));
  check_tetrahedron("long.off",
                    "OFF\n4 4 6\n" + replaced_all(body, "2 0 0\n", "2 0 0" + std::string(9000, ' ') + '\n'));
}

TEST_CASE("OFF: what vertices have besides, and other dimensions", "[flat]") {
  const auto with = [](const std::string& more) { return replaced_all(kOffCorners, "\n", more + "\n") + kOffFaces; };
  check_tetrahedron("color3.off", "COFF\n4 4 6\n" + with(" 255 0 0"));
  check_tetrahedron("all.off", "STCNOFF\n4 4 6\n" + with(" nan nan nan 0 0 1 1 0 0"));
  check_tetrahedron("dimension.off", "nOFF\n3\n4 4 6\n" + with(""));
  // Homogeneous: what counts is x / w.
  check_tetrahedron("four.off", "4OFF\n4 4 6\n0 0 0 7\n4 0 0 2\n0 1 0 1\n0 0 0.5 0.5\n" + kOffFaces);
  CHECK_THAT(refused("infinity.off", "4OFF\n4 4 6\n" + with(" 0")), Catch::Contains("infinity"));
  CHECK_THAT(refused("four_dimensions.off", "nOFF\n4\n4 4 6\n" + with(" 0")), Catch::Contains("4 dimensions"));
  CHECK_THAT(refused("word.off", "BOFF\n4 4 6\n" + with("")), Catch::Contains("does not begin with OFF"));
}

TEST_CASE("OFF: faces of any number of corners", "[flat]") {
  const TempFolder folder;
  for (const int n : {3, 9, 10, 40, 300}) {
    INFO(n);
    folder.write("prism.off", off_prism(n));
    const TriangleMesh mesh = load_mesh(folder / "prism.off");
    CHECK(report(mesh).closed);
    CHECK(volume(mesh) == Approx(n * std::sin(2 * M_PI / n) / 2).epsilon(1e-4));
  }
}

TEST_CASE("STL: comments, colors and padding around the facets; names of any length", "[flat]") {
  std::string facets;
  const std::string corners[] = {"vertex 0 0 0\n", "vertex 2 0 0\n", "vertex 0 1 0\n", "vertex 0 0 1\n"};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (const auto& f : faces) {
    facets += "facet normal 0 0 0\nouter loop\n";
    for (const int i : f) facets += corners[i];
    facets += "endloop\nendfacet\n";
  }
  const std::string all = "solid a\n" + facets + "endsolid a\n";
  check_tetrahedron("before.stl", "# made by hand\n ; and more\n" + all);
  check_tetrahedron("between.stl", replaced_all(all, "endfacet\n", "endfacet\n// next\n color 1 0 0\n"));
  check_tetrahedron("padded.stl", all + std::string(30, '\0'));
  check_tetrahedron("long.stl", replaced_all(all, "solid a", "solid " + std::string(5000, 'a')));
  CHECK_THAT(refused("none.stl", facets), Catch::Contains("begins with \"solid\""));
  CHECK_THAT(refused("huge.stl", replaced_all(all, "vertex 2", "vertex 1e400")), Catch::Contains("finite"));
}

TEST_CASE("PLY: byte order marks and blank lines; indices and coordinates that cannot be", "[flat]") {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 4\nproperty list uchar float vertex_indices\nend_header\n";
  check_tetrahedron("mark.ply", "\xef\xbb\xbf" + head + kOffCorners + kOffFaces);
  check_tetrahedron("blank.ply", head + "\n" + kOffCorners + " \n\n" + kOffFaces + "\n\n");
  CHECK_THAT(refused("half.ply", head + kOffCorners + replaced_all(kOffFaces, "3 2 0 3", "3 2 0.5 3")),
             Catch::Contains("face 3 has an index that is not a whole number"));
  CHECK_THAT(refused("huge.ply", head + replaced_all(kOffCorners, "2 0 0", "1e400 0 0") + kOffFaces),
             Catch::Contains("finite"));
  check_tetrahedron("tiny.ply", head + replaced_all(kOffCorners, "0 1 0", "1e-400 1 -0.0e-999") + kOffFaces);
  CHECK_THAT(refused("type.ply", replaced_all(head, "uchar float", "uchar int64")),
             Catch::Contains("\"property list uchar int64 vertex_indices\""));
}
