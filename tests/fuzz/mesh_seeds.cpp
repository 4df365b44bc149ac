#include "fuzz/mesh_seeds.hpp"

#include <minizip/zip.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "fuzz/gltf_seeds.hpp"

namespace tegotae {
namespace {

// One tetrahedron in every format.
constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr unsigned kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

template <class T>
void put(std::string& bytes, T value, bool big = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes += big ? std::string(std::make_reverse_iterator(raw + sizeof raw), std::make_reverse_iterator(raw))
               : std::string(raw, sizeof raw);
}

std::string corner_lines(const std::string& before) {
  std::string s;
  for (const auto& c : kCorners) {
    s += before;
    for (const float x : c) s += std::to_string(x) + ' ';
    s += '\n';
  }
  return s;
}

std::string face_lines(const std::string& before, unsigned base) {
  std::string s;
  for (const auto& f : kFaces) {
    s += before;
    for (const unsigned i : f) s += ' ' + std::to_string(i + base);
    s += '\n';
  }
  return s;
}

std::vector<Seed> stl() {
  std::string text = "solid t\n", binary(80, '\0');
  put(binary, std::uint32_t{4});
  for (const auto& f : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) put(binary, 0.0f);
    for (const unsigned i : f) {
      text += "vertex";
      for (const float x : kCorners[i]) {
        text += ' ' + std::to_string(x);
        put(binary, x);
      }
      text += '\n';
    }
    text += "endloop\nendfacet\n";
    put(binary, std::uint16_t{0});
  }
  return {{"odd",
           "\xef\xbb\xbf\n SOLID facet endsolid\nFACET NORMAL -nan(ind) 1.#IND 0\nOUTER LOOP\nVERTEX 0 0 0\n"
           "VERTEX +1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n\x1a"},
          {"padded", binary + "\r\n"},
          {"text", text + "endsolid t\n"},
          {"binary", binary},
          {"empty_solid", "solid Empty\nendsolid Empty"}};
}

std::vector<Seed> obj() {
  const std::string body = corner_lines("v ") + face_lines("f", 1);
  return {{"plain", body},
          {"rich",
           "mtllib t.mtl\no t\ng a b\ns 1\n" + corner_lines("v ") +
               "vt 0 0\nvn 0 0 1\nusemtl m\nf 1/1/1 3/1/1 2/1/1\nf -4//1 -3//1 -1//1\nf 2/1 3/1 4/1 1/1\nl 1 2\np 1\n"},
          {"colors", "v 0 0 0 nan nan nan\nv 1 0 0 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n"},
          {"short_face", "v 0 0 0\nv 1 0 0\nf 1 2\nf 1\nf\n"},
          {"continued", "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 3\n"},
          {"curve", corner_lines("v ") + "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nend\n"}};
}

std::vector<Seed> ply() {
  std::vector<Seed> all;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    std::string s = "ply\nformat " + format +
                    " 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    if (format == "ascii") {
      s += corner_lines("") + face_lines("3", 0);
    } else {
      const bool big = format == "binary_big_endian";
      for (const auto& c : kCorners) {
        for (const float x : c) put(s, x, big);
      }
      for (const auto& f : kFaces) {
        put(s, std::uint8_t{3});
        for (const unsigned i : f) put(s, static_cast<std::int32_t>(i), big);
      }
    }
    all.push_back({format, s});
  }
  all.push_back({"more_elements",
                 "ply\nformat ascii 1.0\nobj_info x\nelement vertex 3\nproperty double x\nproperty double y\n"
                 "property double z\nproperty uchar red\nelement face 1\nproperty list uchar uint vertex_index\n"
                 "property list uchar float texcoord\nelement edge 1\nproperty int a\nproperty int b\nend_header\n"
                 "0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2 6 0 0 1 0 0 1\n0 1\n"});
  all.push_back({"strips",
                 "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                 "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                     corner_lines("") + "6 0 1 2 -1 1 3\n"});
  return all;
}

std::vector<Seed> off() {
  return {{"plain", "OFF\n# c\n4 4 6\n" + corner_lines("") + face_lines("3", 0)},
          {"normals", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"},
          {"colors", "COFF 3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2 255 0 0\n"},
          {"four", "4OFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"},
          {"any_dimension", "nOFF\n2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2\n"}};
}

std::string corner_bytes() {
  std::string s;
  for (const auto& c : kCorners) {
    for (const float x : c) put(s, x);
  }
  for (const auto& f : kFaces) {
    for (const unsigned i : f) put(s, static_cast<std::uint16_t>(i));
  }
  return s;
}

std::string gltf_json(const std::string& buffer, const std::string& accessor_more) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"scale":[2,2,2]},)"
         R"({"mesh":0,"matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,0,9,0,1]}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1])" +
         accessor_more +
         R"(},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
         R"("buffers":[{)" +
         buffer + R"("byteLength":72}]})";
}

/// A tetrahedron with a skin, a morph target and instances; the bytes are those of corner_bytes() and zeros.
std::string posed_gltf() {
  return R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing"],
    "scenes":[{"nodes":[0,1]}],"nodes":[{"translation":[1,2,3],"children":[2]},{"mesh":0,"skin":0},
    {"mesh":0,"weights":[0.5],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0,"SCALE":0}}}}],
    "skins":[{"joints":[0,2],"inverseBindMatrices":3}],
    "meshes":[{"weights":[1],"primitives":[{"mode":5,"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},
      "targets":[{"POSITION":0}]}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
      {"bufferView":1,"componentType":5121,"count":4,"type":"VEC4"},
      {"bufferView":0,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"},
      {"bufferView":1,"componentType":5126,"count":2,"type":"MAT4"}],
    "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":128}],
    "buffers":[{"byteLength":176,"uri":"data:application/octet-stream;base64,)" +
         std::string(236, 'A') + R"("}]})";
}

/// A bufferView of EXT_meshopt_compression whose stream is none.
std::string packed_gltf() {
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],
    "bufferViews":[{"buffer":1,"byteLength":48,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteLength":30,
      "byteStride":12,"count":4,"mode":"ATTRIBUTES","filter":"EXPONENTIAL"}}}],
    "buffers":[{"byteLength":30,"uri":"data:application/octet-stream;base64,oAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"},
      {"byteLength":48,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}]})";
}

std::vector<Seed> gltf() {
  const std::string uri = R"("uri":"data:application/octet-stream;base64,)" + base64(corner_bytes()) + "\",";
  std::vector<Seed> all = {
      {"data_uri", gltf_json(uri, "")},
      {"no_file", gltf_json(R"("uri":"missing.bin",)", "")},
      {"sparse", gltf_json(uri, R"(,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},)"
                                R"("values":{"bufferView":0}})")},
      {"posed", posed_gltf()},
      {"packed", packed_gltf()},
      {"version_1", R"({"asset":{"version":"1.0"},"scene":"s","scenes":{"s":{"nodes":["n"]}},)"
                    R"("nodes":{"n":{"meshes":[]}}})"}};
  for (Seed& seed : all) seed.grammar = Grammar::json;
  for (Seed& seed : compressed_gltf()) all.push_back(std::move(seed));
  return all;
}

/// An archive of these files, read back from `archive`.
std::string zipped(const std::vector<Seed>& files) {
  const std::string archive = (scratch_folder() / "packed").string();
  zipFile zip = zipOpen(archive.c_str(), APPEND_STATUS_CREATE);
  for (const auto& [name, bytes, grammar] : files) {
    static_cast<void>(grammar);
    zipOpenNewFileInZip(zip, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, 0, 0);  // stored, not packed
    zipWriteInFileInZip(zip, bytes.data(), static_cast<unsigned>(bytes.size()));
    zipCloseFileInZip(zip);
  }
  zipClose(zip, nullptr);
  std::ifstream in(archive, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove(archive);
  return bytes;
}

/// A 3MF file of this model.
std::string threemf_of(const std::string& model) {
  const std::string relations = "<Relationships><Relationship Target='/m' Type='x/3dmodel'/></Relationships>";
  return zipped({{"_rels/.rels", relations}, {"m", model}});
}

std::vector<Seed> threemf() {
  std::string mesh = "<mesh><vertices>";
  for (const auto& c : kCorners)
    mesh +=
        "<vertex x='" + std::to_string(c[0]) + "' y='" + std::to_string(c[1]) + "' z='" + std::to_string(c[2]) + "'/>";
  mesh += "</vertices><triangles>";
  for (const auto& f : kFaces)
    mesh += "<triangle v1='" + std::to_string(f[0]) + "' v2='" + std::to_string(f[1]) + "' v3='" +
            std::to_string(f[2]) + "'/>";
  mesh += "</triangles></mesh>";
  const std::string model =
      "<model unit='inch'><resources><object id='1' pid='5'>" + mesh +
      "</object><object id='2'><components><component objectid='1' transform='0 1 0 -1 0 0 0 0 2 3 4 5'/>"
      "</components></object><basematerials id='5'><base displaycolor='#12345678'/></basematerials>"
      "</resources><build><item objectid='2'/><item objectid='1'/></build></model>";
  return {{"model", model, Grammar::xml},
          {"whole", threemf_of(model)},
          {"empty", zipped({{"_rels/.rels", "<Relationships/>"}})}};
}

std::vector<Seed> glb() {
  std::string json = gltf_json("", "");
  while (json.size() % 4 != 0) json += ' ';
  const std::string body = corner_bytes();
  std::string s = "glTF";
  put(s, std::uint32_t{2});
  put(s, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + body.size()));
  put(s, static_cast<std::uint32_t>(json.size()));
  s += "JSON" + json;
  put(s, static_cast<std::uint32_t>(body.size()));
  s += std::string("BIN\0", 4) + body;
  return {{"plain", s, Grammar::glb}};
}

}  // namespace

std::vector<Seed> mesh_seeds(const std::string& extension) {
  if (extension == "stl") return stl();
  if (extension == "obj") return obj();
  if (extension == "ply") return ply();
  if (extension == "off") return off();
  if (extension == "3mf") return threemf();
  return extension == "glb" ? glb() : gltf();
}

std::string mesh_file(const std::string& extension, const std::string& bytes) {
  return extension == "3mf" && bytes.compare(0, 2, "PK") != 0 ? threemf_of(bytes) : bytes;
}

}  // namespace tegotae
