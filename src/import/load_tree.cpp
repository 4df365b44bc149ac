#include <Eigen/SVD>
#include <map>

#include "import/note_texts.hpp"
#include "import/part_file.hpp"
#include "import/read_parts.hpp"
#include "import/usable.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae {
namespace {

// Entries of two maps that differ by less are equal: they are products of a few matrices of floats.
constexpr double kMapNoise = 2e-6;

/// A map as a pose after a linear map that has no rotation in it: a scale, a shear, a mirroring of x.
struct Placement {
  Pose pose;
  Mat3 rest;
};

Placement placement_of(const Matrix34& X) {
  const Mat3 A = X.leftCols<3>();
  const Vec3 mirror(A.determinant() < 0 ? -1.0 : 1.0, 1, 1);
  const Eigen::JacobiSVD<Mat3> svd(A * mirror.asDiagonal(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 R = svd.matrixU() * svd.matrixV().transpose();
  Placement placement;
  placement.pose.q = Quat(R).normalized();
  placement.pose.p = X.col(3);
  placement.rest = placement.pose.q.toRotationMatrix().transpose() * A;
  if ((placement.rest - Mat3::Identity()).cwiseAbs().maxCoeff() < kMapNoise) placement.rest.setIdentity();
  return placement;
}

/// Makes an assembly of the parts of a file.
class TreeReader {
 public:
  TreeReader(const std::string& path, PartFile file, const AssemblyOptions& options)
      : path_(path), file_(std::move(file)), options_(options), known_(file_.meshes.size()) {}

  Assembly read() {
    if (options_.unit) file_.unit = *options_.unit;
    assembly_.unit = file_.unit;
    assembly_.up = file_.up;
    assembly_.notes = std::move(file_.notes);
    for (const PartFile::Placed& part : file_.parts) add(part);
    notes_.write_to(assembly_.notes);
    return std::move(assembly_);
  }

 private:
  void add(const PartFile::Placed& placed) {
    AssemblyPart part;
    part.name = placed.name;
    part.path = placed.path;
    part.color = placed.color;
    const Placement placement = placement_of(placed.X);
    part.pose = placement.pose;
    part.pose.p *= unit_length(file_.unit);
    if (!find_shape(placed, placement.rest, part.shape)) return;
    assembly_.parts.push_back(std::move(part));
    if (options_.progress) options_.progress("reading parts", ++done_, file_.parts.size());
  }

  /// The shape of the mesh of `placed`, mapped by `map`; false when it has no triangles.
  bool find_shape(const PartFile::Placed& placed, const Mat3& map, std::size_t& shape) {
    for (const Known& known : known_[placed.mesh]) {
      if ((known.map - map).cwiseAbs().maxCoeff() > kMapNoise * map.cwiseAbs().maxCoeff()) continue;
      shape = known.shape;
      return true;
    }
    const TriangleMesh& from = file_.meshes[placed.mesh];
    if (from.triangles.empty()) {
      notes_.add(note_texts::kEmptyMesh, '"' + placed.name + '"');
      return false;
    }
    TriangleMesh mesh;
    Matrix34 X = Matrix34::Zero();
    X.leftCols<3>() = map;
    append(from, X, unit_length(file_.unit), mesh);
    shape = assembly_.shapes.size();
    known_[placed.mesh].push_back({map, shape});
    assembly_.shapes.push_back(std::make_shared<const TriangleMesh>(
        usable(std::move(mesh), path_, from.name.empty() ? placed.name : from.name)));
    return true;
  }

  struct Known {
    Mat3 map;
    std::size_t shape;
  };

  const std::string& path_;
  PartFile file_;
  const AssemblyOptions& options_;
  std::vector<std::vector<Known>> known_;  // of each mesh of the file
  ImportNotes notes_;
  Assembly assembly_;
  std::size_t done_ = 0;
};

}  // namespace

Assembly read_tree(const std::string& path, const AssemblyOptions& options) {
  if (options.progress) options.progress("reading the file", 0, 0);
  return TreeReader(path, read_part_file(path), options).read();
}

}  // namespace tegotae
