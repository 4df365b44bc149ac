// Parts whose triangles an application already has: no file is read. A cube of 20 mm comes down on a table of two
// triangles; what a mesh is like can be asked before it is used.
#include <cstdio>
#include <limits>
#include <tegotae/tegotae.hpp>

using namespace tegotae;

TriangleMesh cube(double side) {
  TriangleMesh mesh;
  mesh.name = "cube";
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back(side * Vec3((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh table(double side) {
  const double a = side / 2;
  return {"table", {Vec3(-a, -a, 0), Vec3(a, -a, 0), Vec3(a, a, 0), Vec3(-a, a, 0)}, {{0, 1, 2}, {0, 2, 3}}};
}

int main() {
  // weld() joins vertices that are equal, as drawing buffers often have one for each face; load_mesh does it by itself.
  const TriangleMesh peg = weld(cube(0.02));
  const MeshReport r = report(peg);
  std::printf("cube: %d triangles, %s\n", static_cast<int>(r.triangles), r.closed ? "closed" : "open");

  Scene scene;
  scene.add_fixed("table", weld(table(0.2)));
  scene.add_held("cube", peg, {Quat::Identity(), Vec3(0, 0, 0.02)});
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();  // not bounded by the clock: repeatable
  HapticLoop loop(scene);  // the contact loop alone, for pens that the application reads itself
  for (int ms = 0; ms <= 400; ++ms) {
    const Pose pen{Quat::Identity(), Vec3(0, 0, 0.02 - 4e-5 * ms)};  // m: into the table
    const TickReport& tick = loop.step(pen, 1e-3);
    if (ms % 100 == 0)
      std::printf("%3d ms: pen at %5.1f mm, cube at %6.3f mm, %d contacts\n", ms, 1e3 * pen.p.z(),
                  1e3 * tick.proxy.X.p.z(), tick.contacts);
  }
}
