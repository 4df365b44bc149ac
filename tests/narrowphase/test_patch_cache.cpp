// Hierarchies kept in a folder: the same tree comes back, and nothing but it.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "apps/run_program.hpp"
#include "cache_folder.hpp"
#include "catch.hpp"
#include "mesh/cache_entry.hpp"
#include "models/shapes.hpp"
#include "narrowphase/axis_cache.hpp"
#include "narrowphase/patch_cache.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

using namespace tegotae;
using namespace tegotae::test;
namespace fs = std::filesystem;

namespace {

bool same(const PatchTree& a, const PatchTree& b) {
  return a.nodes().size() == b.nodes().size() &&
         std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size() * sizeof(PatchNode)) == 0 &&
         a.order() == b.order() && a.origin() == b.origin() && a.radius() == b.radius();
}

}  // namespace

TEST_CASE("a kept hierarchy is the one that was built", "[patch_cache]") {
  const TempFolder folder;
  const UseCache use(folder / "cache");
  const auto mesh = std::make_shared<const TriangleMesh>(shapes::sphere(0.05, 200, 60));
  REQUIRE(mesh->triangles.size() >= kMinCached);
  const PatchTree built(mesh);
  CHECK(same(*cached_patch_tree(mesh), built));
  REQUIRE(entries(folder / "cache").size() == 1);
  const fs::path file = entries(folder / "cache")[0];
  const std::string bytes = read_text(file);
  // Read, not built and written again: that would put a new file in place of the one with two names.
  fs::create_hard_link(file, folder / "second_name");
  CHECK(same(*cached_patch_tree(mesh), built));
  CHECK(fs::hard_link_count(file) == 2);

  SECTION("small meshes are not kept") {
    cached_patch_tree(std::make_shared<const TriangleMesh>(shapes::box({1, 1, 1})));
    CHECK(entries(folder / "cache").size() == 1);
  }
  SECTION("another mesh gets another file") {
    auto moved = std::make_shared<TriangleMesh>(*mesh);
    moved->vertices[7].x() += 1e-15;
    cached_patch_tree(moved);
    CHECK(entries(folder / "cache").size() == 2);
  }
  SECTION("a damaged file is built anew and replaced") {
    for (const std::size_t at : {0ul, 9ul, 30ul, 60ul, 70ul, 84ul, 100ul, bytes.size() / 2, bytes.size() - 3}) {
      INFO(at);
      std::string bad = bytes;
      bad[at] = static_cast<char>(bad[at] ^ 0x10);
      std::ofstream(file, std::ios::binary) << bad;
      CHECK(same(*cached_patch_tree(mesh), built));
      CHECK(read_text(file) == bytes);
    }
    for (const std::size_t n : {0ul, 50ul, 88ul, 5000ul, bytes.size() - 1}) {
      INFO("cut to " << n);
      std::ofstream(file, std::ios::binary) << bytes.substr(0, n);
      CHECK(same(*cached_patch_tree(mesh), built));
      CHECK(read_text(file) == bytes);
    }
    std::ofstream(file, std::ios::binary) << bytes << "x";
    CHECK(same(*cached_patch_tree(mesh), built));
    CHECK(read_text(file) == bytes);
  }
  SECTION("a folder that cannot be written is not an error") {
    folder.write("plain", "");
    set_hierarchy_cache(folder / "plain/cache");
    CHECK(same(*cached_patch_tree(mesh), built));
  }
}

TEST_CASE("axes and profiles that are kept are those that were found", "[patch_cache]") {
  const TempFolder folder;
  const auto mesh = std::make_shared<const TriangleMesh>(shapes::cylinder(0.01, 0.03, 250, 50));
  REQUIRE(mesh->triangles.size() >= kMinCached);
  const PatchTree tree(mesh);
  const std::vector<ScrewAxis> axes = find_axes(*mesh);
  REQUIRE(axes.size() == 1);
  const ScrewFrame frame = ScrewFrame::of(axes[0], 0.001);
  const ProfileTree built(tree, frame);
  CHECK(built.boxes() > 1000);
  const auto check = [&] {
    const std::vector<ScrewAxis> kept = cached_axes(*mesh);
    REQUIRE(kept.size() == 1);
    CHECK(std::memcmp(kept.data(), axes.data(), sizeof(ScrewAxis)) == 0);
    const ProfileTree profile = cached_profile(tree, frame);
    CHECK(profile.places() == built.places());
    REQUIRE(profile.boxes() == built.boxes());
    CHECK(std::memcmp(profile.all_boxes().data(), built.all_boxes().data(), built.boxes() * sizeof(ProfileBox)) == 0);
    CHECK(profile.r_max() == built.r_max());
    CHECK(profile.z_min() == built.z_min());
    CHECK(profile.z_max() == built.z_max());
  };
  const UseCache use(folder / "cache");
  check();
  REQUIRE(entries(folder / "cache").size() == 2);
  check();
  for (const fs::path& file : entries(folder / "cache")) {
    const std::string bytes = read_text(file);
    for (const std::size_t at :
         {std::size_t{17}, std::size_t{50}, std::size_t{60}, bytes.size() / 2, bytes.size() - 1}) {
      INFO(file << " at " << at);
      std::string bad = bytes;
      bad[at] = static_cast<char>(bad[at] ^ 4);
      std::ofstream(file, std::ios::binary) << bad;
      check();
      CHECK(read_text(file) == bytes);
    }
  }
  // Another frame of the same axis is another profile.
  cached_profile(tree, ScrewFrame::of(axes[0], 0.002));
  CHECK(entries(folder / "cache").size() == 3);
}

TEST_CASE("without a folder nothing is kept", "[patch_cache]") {
  const TempFolder folder;
  cached_patch_tree(std::make_shared<const TriangleMesh>(shapes::sphere(0.05, 200, 60)));
  CHECK(entries(folder / "cache").empty());
}
