// Stylus scripts: read_script, and the poses and velocities of what it accepts.
#include <cmath>

#include "fuzz/fuzz.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae {

std::vector<Seed> seeds() {
  const std::string header = "t,px,py,pz,qw,qx,qy,qz\n";
  return {{"two_keys", header + "0,0,0,0.1,1,0,0,0\n2,0,0.01,0.05,0.7071,0.7071,0,0\n"},
          {"comments", "# c\n\n" + header + "\n-1.5e0, 1e-3 ,0,0,-1,0,0,0\r\n"},
          {"other_order", "qz,qy,qx,qw,pz,py,px,t\n0,0,0,1,0,0,0,0\n0,0,1,0,0,0,0,1\n0,0,0,1,0,0,0,1.000001\n"},
          {"not_finite", header + "0,nan,0,0,1,0,0,0\n"},
          {"zero_quaternion", header + "0,0,0,0,0,0,0,0\n"},
          {"far", header + "0,1e5,0,0,1,0,0,0\n1e-9,-1e5,0,0,0,1,0,0\n1e9,0,0,0,0,0,1,0\n"},
          {"too_fast", header + "0,0,0,0,1,0,0,0\n1e-320,1,0,0,1,0,0,0\n"},
          {"long_quaternion", header + "0,0,0,0,1e200,0,0,0\n"},
          {"too_far", header + "0,1e308,0,0,1,0,0,0\n1,-1e308,0,0,1,0,0,0\n"},
          {"time_back", header + "1,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n"},
          {"short_row", header + "0,0,0\n"},
          {"header_only", header}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = write_input("input.csv", data, size);
  try {
    const StylusScript script = read_script(path);
    const double begin = script.begin(), end = script.end();
    require(std::isfinite(begin) && begin <= end, "times are in order");
    for (const double t : {begin - 1, begin, 0.5 * (begin + end), 0.25 * begin + 0.75 * end, end, end + 1}) {
      const Pose X = script.pose(t);
      require(X.p.allFinite() && std::abs(X.q.norm() - 1) < 1e-6, "the pose is one");
      const Twist v = script.velocity(t);
      require(v.v.allFinite() && v.w.allFinite(), "the velocity is finite");
    }
  } catch (const Error& e) {
    require_error_of(path + ":", e.what());
  }
  return 0;
}

}  // namespace tegotae
