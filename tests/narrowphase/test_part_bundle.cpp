// Many fixed parts as one: against sampled poses of all of them together.
#include "catch.hpp"
#include "narrowphase/part_bundle.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kClearance = 1.1e-6, kPitch = 0.012;
constexpr int kRow = 7;

/// Posts of three shapes that stand in rows under a sheet, each a little higher or lower and turned.
struct Posts {
  std::vector<MeshPtr> mesh;
  std::vector<Pose> pose;

  Posts() {
    std::mt19937 rng(5);
    const std::array<MeshPtr, 3> shapes = {box({0.004, 0.003, 0.005}), peg(0.004, 0.01, 60),
                                           box({0.005, 0.005, 0.004})};
    for (int i = 0; i < kRow * kRow; ++i) {
      mesh.push_back(shapes[static_cast<std::size_t>(i % 3)]);
      pose.push_back({rotation(random_in_ball(rng, 0.3)),
                      Vec3(kPitch * (i % kRow - 3), kPitch * (i / kRow - 3), -0.008 - uniform(rng, 0, 5e-4))});
    }
  }
  std::size_t size() const { return mesh.size(); }
  std::vector<std::uint32_t> all() const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < size(); ++i) out.push_back(i);
    return out;
  }
  /// Without the last `but` of them.
  MeshPtr together(std::size_t but = 0) const {
    auto out = std::make_shared<TriangleMesh>();
    out->name = "posts";
    for (std::size_t i = 0; i + but < size(); ++i)
      for (const auto& t : mesh[i]->triangles) {
        const auto first = static_cast<std::uint32_t>(out->vertices.size());
        for (const std::uint32_t v : t) out->vertices.push_back(pose[i] * mesh[i]->vertices[v]);
        out->triangles.push_back({first, first + 1, first + 2});
      }
    return out;
  }
};

MeshPtr face_of(const TriangleMesh& mesh, std::uint32_t face, const Pose& X) {
  auto out = std::make_shared<TriangleMesh>();
  out->name = "face";
  for (const std::uint32_t v : mesh.triangles[face]) out->vertices.push_back(X * mesh.vertices[v]);
  out->triangles = {{0, 1, 2}};
  return out;
}

}  // namespace

TEST_CASE("faces of a bundle are those of its parts", "[patch]") {
  const Posts posts;
  const std::vector<std::uint32_t> members = {3, 7, 8, 20, 48};
  const PartBundle bundle(posts.mesh, posts.pose, members);
  std::vector<std::uint32_t> faces(posts.size(), 0);
  const PatchTree& tree = *bundle.tree();
  for (std::uint32_t f = 0; f < tree.mesh().triangles.size(); ++f) {
    const FacePair pair = bundle.of_part({99, 11, f});
    REQUIRE(std::count(members.begin(), members.end(), pair.part) == 1);
    REQUIRE(pair.a == 11);
    const TriangleMesh& mesh = *posts.mesh[pair.part];
    REQUIRE(pair.b < mesh.triangles.size());
    ++faces[pair.part];
    for (int k = 0; k < 3; ++k)
      REQUIRE((posts.pose[pair.part] * mesh.vertices[mesh.triangles[pair.b][static_cast<std::size_t>(k)]] -
               tree.corner(f, k))
                  .norm() < 1e-15);
  }
  for (std::uint32_t part = 0; part < posts.size(); ++part) {
    const bool member = std::count(members.begin(), members.end(), part) == 1;
    CHECK(bundle.has(part) == member);
    CHECK(faces[part] == (member ? posts.mesh[part]->triangles.size() : 0));
  }
}

TEST_CASE("a part that meets many others is free of all of them, and what stops it is told by part", "[patch]") {
  const Posts posts;
  const MeshPtr sheet = wave(kRow * kPitch, 5e-4, 0.03, 24);
  const Oracle oracle(sheet, posts.together());
  PatchMotionCheck check(sheet, Vec3::Zero(), kRow * kPitch, posts.mesh, posts.pose, {});
  std::vector<FacePair> blocking;
  blocking.reserve(64);
  std::mt19937 rng(7);
  Pose X{Quat::Identity(), Vec3(0, 0, 0.006)};
  REQUIRE(oracle.distance(X) > 1e-3);
  int free = 0, blocked = 0, near_ones = 0;
  for (int i = 0; i < 300; ++i) {
    // Now and then nothing is known of other parts: each has a certificate of its own.
    std::vector<std::uint32_t> near = posts.all();
    const bool alone = i % 50 >= 40;
    check.begin(near, kNoDeadline, alone ? OtherParts::ignored : OtherParts::far);
    const double size = std::pow(10.0, uniform(rng, -6, -3.3));
    Displacement d{random_in_ball(rng, size), random_in_ball(rng, 10 * size)};
    d.dp.z() -= size;
    blocking.clear();
    const MotionAnswer answer = check.check(X, d, kClearance, blocking);
    REQUIRE(answer != MotionAnswer::unknown);
    const double share = answer == MotionAnswer::free ? 1 : 0.999999 * check.free_share();
    REQUIRE(oracle.hits(X, Vec3::Zero(), share * d, 4) == 0);
    free += answer == MotionAnswer::free;
    for (const FacePair& pair : blocking) {
      REQUIRE(pair.part < posts.size());
      const Oracle two(face_of(*sheet, pair.a, Pose{}), face_of(*posts.mesh[pair.part], pair.b, posts.pose[pair.part]));
      // 32 poses of the way are no farther apart than that.
      REQUIRE(two.path_distance(X, Vec3::Zero(), d, 32) <= kClearance + (2 + 20 * 0.06) * size / 32);
      ++blocked;
    }
    X = displaced(X, Vec3::Zero(), share * d);
    near_ones += oracle.distance(X) < 1e-4;
  }
  INFO(free << " free, " << blocked << " pairs, " << near_ones << " near");
  CHECK(free > 50);
  CHECK(blocked > 20);
  CHECK(near_ones > 100);
}

TEST_CASE("parts that may be left out, or that do not matter, stop nothing", "[patch]") {
  const Posts posts;
  const MeshPtr sheet = wave(kRow * kPitch, 5e-4, 0.03, 24);
  // Lowered until it cuts the last post, which stands alone as high.
  Posts high = posts;
  high.pose.back().p.z() += 0.008;
  const Pose X{Quat::Identity(), Vec3(0, 0, 0.0045)};
  REQUIRE(Oracle(sheet, high.together()).meet(X));
  REQUIRE(Oracle(sheet, high.together(1)).distance(X) > 1e-4);
  std::vector<std::uint32_t> others = high.all();
  const std::uint32_t last = others.back();
  others.pop_back();
  const Displacement d{Vec3(1e-5, 0, -1e-5), Vec3::Zero()};
  std::vector<FacePair> blocking;
  blocking.reserve(64);
  PatchMotionCheck may(sheet, Vec3::Zero(), kRow * kPitch, high.mesh, high.pose, {last});
  may.begin(others, kNoDeadline, OtherParts::far);
  CHECK(may.check(X, d, kClearance, blocking) == MotionAnswer::free);
  may.begin(high.all(), kNoDeadline, OtherParts::far);
  CHECK(may.check(X, d, kClearance, blocking) == MotionAnswer::blocked);
  for (const FacePair& pair : blocking) CHECK(pair.part == last);
  PatchMotionCheck all(sheet, Vec3::Zero(), kRow * kPitch, high.mesh, high.pose, {});
  all.begin(others, kNoDeadline, OtherParts::ignored);
  blocking.clear();
  CHECK(all.check(X, d, kClearance, blocking) == MotionAnswer::free);
  all.begin(high.all(), kNoDeadline, OtherParts::far);
  CHECK(all.check(X, d, kClearance, blocking) == MotionAnswer::blocked);
  for (const FacePair& pair : blocking) CHECK(pair.part == last);
}
