// Scene files: load_scene beside a mesh and a script that are good; what it accepts is held and moved.
#include "fuzz/fuzz.hpp"
#include "fuzz/mesh_seeds.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae {

namespace {

// More parts than this make a run slow, not wrong.
constexpr std::size_t kMaxParts = 8;

const std::string kParts =
    "[[part]]\nname = \"block\"\nmesh = \"tet.obj\"\n"
    "[[part]]\nname = \"peg\"\nmesh = \"tet.obj\"\nheld = true\nposition = [0, 0, 2]\n";
const std::string kDevice = "[device]\nscript = \"pen.csv\"\n";

void write_neighbors() {
  static const bool once = [] {
    const std::string mesh = mesh_seeds("obj").front().bytes;
    write_input("tet.obj", mesh.data(), mesh.size());
    const std::string script = "t,px,py,pz,qw,qx,qy,qz\n0,0,0,2,1,0,0,0\n1,0,0,0,1,0,0,0\n";
    write_input("pen.csv", script.data(), script.size());
    return true;
  }();
  static_cast<void>(once);
}

/// Follows the script's two ends: the scene is held or refused, the part stays where numbers are.
void hold(const SceneFile& file) {
  Scene scene = file.scene;
  scene.contact.tick_budget = 1e-3;
  HapticLoop loop(scene);
  for (const double t : {file.script.begin(), file.script.end(), file.script.end()}) {
    const TickReport& report = loop.step(file.script.pose(t), 1e-3);
    require(report.proxy.X.p.allFinite() && report.proxy.X.q.coeffs().allFinite(), "the part's pose is finite");
  }
}

}  // namespace

std::vector<Seed> seeds() {
  return {{"small", kParts + kDevice},
          {"whole", "unit = \"mm\"\n" + kParts +
                        "[contact]\nl_min = 4e-6\nl_0 = 4e-5\nresolver = \"lp\"\nnarrowphase = \"fcl\"\n"
                        "tick_budget = 0.8e-3\ndensity = 1000\n[coupling]\nstiffness = 800\ndamping = 5\n"
                        "torsional_stiffness = 0.3\ntorsional_damping = 0.004\n" +
                        kDevice +
                        "type = \"simulated\"\nhand = { stiffness = 400, damping = 24, mass = 0.3, inertia = 2e-4 }\n"},
          {"turned",
           "[[part]]\nname = 'a'\nmesh = './tet.obj'\nunit = 'in'\nrpy_deg = [10, 20, 30]\n"
           "[[part]]\nname = 'b'\nmesh = 'tet.obj'\nheld = true\nposition = [3.0, 0, inf]\n"
           "orientation = [0.5, 0.5, -0.5, 0.5]\n" +
               kDevice},
          {"intersecting",
           "[[part]]\nname=\"a\"\nmesh=\"tet.obj\"\nheld=true\n[[part]]\nname=\"b\"\nmesh=\"tet.obj\"\n" + kDevice},
          {"no_held", "[[part]]\nname=\"a\"\nmesh=\"tet.obj\"\n" + kDevice},
          {"unknown_key", "frobnicate = 1979-05-27T07:32:00Z\n" + kParts + kDevice},
          {"wrong_type", "part = 3\n[device]\nscript = [[1], {}]\n"},
          {"odd_paths", "[[part]]\nname=\"a\"\nmesh=\"/dev/zero\"\nheld=true\n[device]\nscript = \"..\"\n"},
          {"not_toml", "[[part\nname = \"\"\"\n"},
          {"empty", "\n"}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  write_neighbors();
  const std::string path = write_input("input.toml", data, size);
  bool read = false;
  try {
    const SceneFile file = load_scene(path);
    read = true;
    if (file.scene.parts.size() <= kMaxParts) hold(file);
  } catch (const Error& e) {
    const std::string what = e.what();
    require(read || what.rfind(path + ":", 0) == 0, "the error begins with the file");
    require(what.find('\n') == std::string::npos, "the error is one line");
  }
  return 0;
}

}  // namespace tegotae
