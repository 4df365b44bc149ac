#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/script.hpp"

using namespace tegotae;

namespace {

struct ScriptFile {
  std::string path = (std::filesystem::temp_directory_path() / "tegotae_script_XXXXXX").string();
  explicit ScriptFile(const std::string& text) {
    close(mkstemp(path.data()));
    std::ofstream(path, std::ios::binary) << text;
  }
  ~ScriptFile() { std::filesystem::remove(path); }
};

const std::string kHeader = "t,px,py,pz,qw,qx,qy,qz\n";

std::string error_of(const std::string& text) {
  const ScriptFile file(text);
  try {
    read_script(file.path);
  } catch (const Error& error) {
    const std::string message = error.what();
    REQUIRE(message.rfind(file.path, 0) == 0);
    return message.substr(file.path.size());
  }
  return "no error";
}

}  // namespace

TEST_CASE("a script is read and sampled between its keys", "[device]") {
  const ScriptFile file("# a quarter turn about z\r\n" + kHeader +
                        "\n1.0, 0, 0, 0.1, 1, 0, 0, 0\r\n# pause\n3.0,0.2,-0.4,0.1,2,0,0,2\n");
  const StylusScript script = read_script(file.path);
  CHECK(script.begin() == 1);
  CHECK(script.end() == 3);
  const Pose quarter = script.pose(1.5);
  CHECK((quarter.p - Vec3(0.05, -0.1, 0.1)).norm() < 1e-15);
  const double eighth = M_PI / 8;
  CHECK((quarter.q * Vec3(1, 0, 0) - Vec3(std::cos(eighth), std::sin(eighth), 0)).norm() < 1e-15);
  CHECK(std::abs(quarter.q.norm() - 1) < 1e-15);
  const Twist rate = script.velocity(2);
  CHECK((rate.v - Vec3(0.1, -0.2, 0)).norm() < 1e-15);
  CHECK((rate.w - Vec3(0, 0, M_PI / 4)).norm() < 1e-15);
  // Clamped at both ends.
  CHECK(script.pose(-5).p == Vec3(0, 0, 0.1));
  CHECK(script.pose(0.5).q.w() == 1);
  CHECK((script.pose(100).p - Vec3(0.2, -0.4, 0.1)).norm() < 1e-15);
  CHECK(script.velocity(0.5).v.norm() == 0);
  CHECK(script.velocity(3).w.norm() == 0);
}

TEST_CASE("rotations between keys go the shorter way, as Eigen's slerp does", "[device]") {
  const Quat a(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));
  const Quat b(Eigen::AngleAxisd(2.1, Vec3(-1, 1, 0.5).normalized()));
  const Quat negated(-b.w(), -b.x(), -b.y(), -b.z());
  const StylusScript script({{0, {a, Vec3::Zero()}}, {2, {negated, Vec3::Zero()}}});
  for (double t : {0.0, 0.3, 1.0, 1.9, 2.0})
    CHECK(script.pose(t).q.angularDistance(a.slerp(t / 2, b)) < 1e-7);  // acos near 1 keeps half the digits
}

TEST_CASE("columns may come in another order", "[device]") {
  const ScriptFile file("qw,qx,qy,qz,t,pz,py,px\n1,0,0,0,0.5,3,2,1\n");
  const StylusScript script = read_script(file.path);
  CHECK(script.begin() == 0.5);
  CHECK(script.pose(0).p == Vec3(1, 2, 3));
}

TEST_CASE("a script may have a byte order mark, and numbers a plus", "[device]") {
  const ScriptFile file("\xef\xbb\xbf" + kHeader + "+0.5,+1,-2,+3e-1,+1,0,0,0\r\n");
  const StylusScript script = read_script(file.path);
  CHECK(script.begin() == 0.5);
  CHECK(script.pose(0).p == Vec3(1, -2, 0.3));
  CHECK_THAT(error_of(kHeader + "+-1,0,0,0,1,0,0,0\n"), Catch::Contains(":2: t is not a number"));
  CHECK_THAT(error_of(kHeader + "0,++1,0,0,1,0,0,0\n"), Catch::Contains(":2: px is not a number"));
  CHECK_THAT(error_of(kHeader + "0,+,0,0,1,0,0,0\n"), Catch::Contains(":2: px is not a number"));
}

TEST_CASE("a script may be as a spreadsheet writes it: any line ends, cells in quotes", "[device]") {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string text = "\"t\",\"px\",py,pz,qw,qx,qy,qz#0,1,2,3,1,0,0,0##\"0.5\",4,5,6,1,0,0,0#";
    for (std::size_t at = 0; (at = text.find('#', at)) != std::string::npos;) text.replace(at, 1, end);
    const ScriptFile file(text);
    const StylusScript script = read_script(file.path);
    CHECK(script.end() == 0.5);
    CHECK(script.pose(0).p == Vec3(1, 2, 3));
    CHECK_THAT(error_of(text + "x"), Catch::Contains(":5: 1 values"));
  }
}

TEST_CASE("of a script that is not text of single bytes the reason is named, on one line", "[device]") {
  std::string wide;
  for (const char c : kHeader) (wide += c) += '\0';
  CHECK_THAT(error_of("\xff\xfe" + wide), Catch::Contains("is in UTF-16"));
  CHECK_THAT(error_of(wide), Catch::Contains("is in UTF-16"));
  CHECK_THAT(error_of("t\x01\x7f,px\n"), Catch::Contains(":1: unknown column \"t??\""));
  CHECK_THAT(error_of(kHeader + std::string("0,0,0,0,1,0,\0,0\n", 16)),
             Catch::Contains(":2: qy is not a number: \"?\""));
}

TEST_CASE("a bad script is refused with file, line and reason", "[device]") {
  const std::string row = "0,0,0,0,1,0,0,0\n";
  CHECK_THROWS_WITH(read_script("/nonexistent/s.csv"), Catch::Contains("/nonexistent/s.csv: cannot be opened"));
  CHECK_THROWS_WITH(read_script("/"), Catch::Contains("/: "));
  CHECK_THAT(error_of(""), Catch::Contains(": empty"));
  CHECK_THAT(error_of("# nothing\n"), Catch::Contains(": empty"));
  CHECK_THAT(error_of(kHeader), Catch::Contains(": no row"));
  CHECK_THAT(error_of(row), Catch::Contains(":1: unknown column \"0\""));
  CHECK_THAT(error_of("t,px,py,pz,qw,qx,qy\n"), Catch::Contains(":1: column qz is missing"));
  CHECK_THAT(error_of("t,t,px,py,pz,qw,qx,qy,qz\n"), Catch::Contains(":1: column t comes twice"));
  CHECK_THAT(error_of(kHeader + row + "1,0,0,0,1,0,0\n"), Catch::Contains(":3: 7 values"));
  CHECK_THAT(error_of(kHeader + "0,0,0,0,1,0,0,0,0\n"), Catch::Contains(":2: 9 values"));
  CHECK_THAT(error_of(kHeader + "0,0,x,0,1,0,0,0\n"), Catch::Contains(":2: py is not a number: \"x\""));
  CHECK_THAT(error_of(kHeader + "0,0,,0,1,0,0,0\n"), Catch::Contains(":2: py is not a number: \"\""));
  CHECK_THAT(error_of(kHeader + "0,0,1e999,0,1,0,0,0\n"), Catch::Contains(":2: py is not a number"));
  CHECK_THAT(error_of(kHeader + "0,0,0,nan,1,0,0,0\n"), Catch::Contains(":2: a value is not finite"));
  CHECK_THAT(error_of(kHeader + "inf,0,0,0,1,0,0,0\n"), Catch::Contains(":2: a value is not finite"));
  CHECK_THAT(error_of(kHeader + row + row), Catch::Contains(":3: the time does not increase"));
  CHECK_THAT(error_of(kHeader + row + "#\n\n-1,0,0,0,1,0,0,0\n"), Catch::Contains(":5: the time does not increase"));
  CHECK_THAT(error_of(kHeader + "0,0,0,0,0,0,0,0\n"), Catch::Contains(":2: the quaternion is zero"));
  CHECK_THAT(error_of(kHeader + "0,0,0,0,1e200,0,0,0\n"), Catch::Contains(":2: the quaternion is too long"));
  CHECK_THAT(error_of(kHeader + row + "1e-320,1,0,0,1,0,0,0\n"), Catch::Contains(":3: the way from the key before"));
  CHECK_THAT(error_of(kHeader + "0,0,-10001,0,1,0,0,0\n"), Catch::Contains(":2: the position lies beyond 10 km"));
  CHECK_THAT(error_of(kHeader + row + "2,1e308,0,0,1,0,0,0\n"), Catch::Contains(":3: the position lies beyond 10 km"));
  CHECK_NOTHROW(StylusScript({{0, Pose{Quat::Identity(), Vec3(-1e4, 0, 1e4)}}}));
  CHECK_THROWS_WITH(StylusScript({}), Catch::Contains("no key"));
  CHECK_THROWS_WITH(StylusScript({{0, Pose()}, {0, Pose()}}), Catch::Contains("key 2"));
}
