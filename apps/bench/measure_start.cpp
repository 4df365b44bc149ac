#include "bench/measure_start.hpp"

#include <algorithm>

#include "models/shapes.hpp"
#include "models/write_obj.hpp"
#include "models/write_stl.hpp"
#include "shared/temporary_folder.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/isolated_load.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/import/write.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

namespace tegotae::bench {
namespace {

constexpr int kSegments = 1000, kRings = 499, kQuickRings = 19;
constexpr int kSecondStarts = 3;
// Where the part in hand is, m: beside the shaft, so that the two are looked at but FCL is not asked.
const Vec3 kBeside(0.02, 0, 0);

/// Seconds until a loop has made its first tick.
double start(const std::string& large, const std::string& small) {
  const std::int64_t begin = monotonic_ns();
  Scene scene;
  scene.add_fixed("shaft", load_mesh_isolated(large, 1e-3));
  scene.add_held("pin", load_mesh_isolated(small, 1e-3), {Quat::Identity(), kBeside});
  HapticLoop loop(scene);
  loop.step({Quat::Identity(), kBeside}, 1e-3);
  return 1e-9 * static_cast<double>(monotonic_ns() - begin);
}

}  // namespace

std::vector<StartFigures> measure_starts(bool quick) {
  const apps::TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  const TriangleMesh shaft = shapes::cylinder(0.02, 0.06, kSegments, quick ? kQuickRings : kRings);
  write_stl(shaft, path("shaft.stl"));
  write_ply(shaft, path("shaft.ply"), 1e-3);
  write_obj(shaft, path("shaft.obj"));
  write_obj(shapes::cylinder(0.005, 0.02, 32), path("pin.obj"));
  std::vector<StartFigures> all;
  for (const char* format : {"stl", "ply", "obj"}) {
    set_hierarchy_cache(path(std::string("cache_") + format));
    const std::string file = path(std::string("shaft.") + format);
    StartFigures f{format, shaft.triangles.size(), start(file, path("pin.obj")), 0};
    f.second_s = start(file, path("pin.obj"));
    for (int i = 1; i < kSecondStarts; ++i) f.second_s = std::min(f.second_s, start(file, path("pin.obj")));
    all.push_back(f);
  }
  set_hierarchy_cache(default_cache_folder());
  return all;
}

}  // namespace tegotae::bench
