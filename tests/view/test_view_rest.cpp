// A scene in which nothing is held: looked at without a run, which begins when the page takes a part, and ends when it
// puts it down.
#include <cmath>
#include <cstring>

#include "bodies.hpp"
#include "catch.hpp"
#include "spawn.hpp"
#include "tegotae/import/write.hpp"
#include "view/watcher.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;

namespace {

enum Number { floor_, block, anvil };  // of the parts, in the scene file's order

/// A block 2 mm over a floor, and an anvil that no hand carries.
std::string write_scene(const TempFolder& folder, const std::string& more = "") {
  const auto part = [&](const std::string& name, const Vec3& size, double x, double z, const char* rest = "") {
    write_ply(box(size), folder / (name + ".ply"), 1);
    return "[[part]]\nname = \"" + name + "\"\nmesh = \"" + name + ".ply\"\nposition = [" + std::to_string(x) +
           ", 0, " + std::to_string(z) + "]\n" + rest;
  };
  folder.write("scene.toml", more + "weight = true\n" + part("floor", Vec3(0.3, 0.2, 0.01), 0, -0.005) +
                                 part("block", Vec3(0.02, 0.02, 0.02), 0, 0.012) +
                                 part("anvil", Vec3(0.02, 0.02, 0.02), 0.05, 0.012, "mass = 1e9\n"));
  return folder / "scene.toml";
}

json act(const char* what, int part) {
  return {{"do", what}, {"part", part}};
}

/// A program that serves a page, and what the page asks of it.
struct Page {
  explicit Page(const std::string& scene) : served({"tegotae", "view", scene}) {}

  json parts() const {
    std::string answer;
    REQUIRE(ask(served.port, get(served, "/parts"), &answer) == 200);
    return json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  }
  int tell(const json& what, std::string* answer = nullptr) const {
    return ask(served.port, command(served, what.dump()), answer);
  }
  /// Number of the part that is held; -1: none.
  int held() const {
    const json all = parts().at("parts");
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].at("held") == true) return static_cast<int>(i);
    return -1;
  }
  double height(int part) const { return parts().at("parts")[static_cast<std::size_t>(part)].at("pose")[2]; }
  /// What ends a run is obeyed when its thread gets there.
  bool comes_to_hold(int part) const {
    for (int i = 0; i < 500 && held() != part; ++i) ::usleep(20'000);
    return held() == part;
  }
  /// The row of a frame of the parts as they are now.
  std::vector<float> frame(Watcher& watcher) const {
    const auto generation = parts().at("generation").get<int>();
    do REQUIRE(watcher.next() >= 0);
    while (static_cast<int>(watcher.row()[32]) != generation);
    return watcher.row();
  }

  Served served;
};

}  // namespace

TEST_CASE("nothing is held: one looks, changes parts, takes one, puts it down, takes another one") {
  const TempFolder folder;
  Page page(write_scene(folder));
  REQUIRE(page.held() == -1);

  // Parts are moved and removed without a run, and nobody asks whether they overlap.
  CHECK(page.tell({{"do", "move"}, {"part", block}, {"by", {0, 0, 0.01}}, {"turn", {0, 0, 0}}}) == 200);
  CHECK(page.height(block) == Approx(0.022).margin(1e-12));
  CHECK(page.tell(act("remove", anvil)) == 200);
  CHECK(page.tell(act("add", anvil)) == 200);
  std::string answer;
  CHECK(page.tell({{"do", "put_down"}}, &answer) == 400);
  CHECK_THAT(answer, Contains("nothing is held"));
  const Request review = {"POST",
                          "/review",
                          page.served.token,
                          page.served.host(),
                          "http://" + page.served.host(),
                          "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n",
                          ""};
  CHECK(ask(page.served.port, review, &answer) == 400);
  CHECK_THAT(answer, Contains("nothing is held"));

  // What the loop cannot hold is refused, and one goes on looking.
  CHECK(page.tell(act("hold", anvil), &answer) == 400);
  CHECK_THAT(answer, Contains("It cannot be held") && Contains("the mass must be"));
  CHECK(page.held() == -1);

  CHECK(page.tell(act("hold", block)) == 200);
  CHECK(page.held() == block);
  {
    Watcher watcher(page.served);
    CHECK(page.frame(watcher)[6] == Approx(0.022).margin(2e-4));
    // The hand brings it down onto the floor, by a run like any other. (It carries its weight, 80 mN: 0.1 mm.)
    CHECK(page.tell({{"do", "lead"}, {"pose", {0, 0, 0.005, 1, 0, 0, 0}}}) == 200);
    for (int i = 0; i < 200 && watcher.row()[6] > 0.0101; ++i) REQUIRE(watcher.next() >= 0);
    CHECK(watcher.row()[6] == Approx(0.01).margin(5e-5));
    CHECK(watcher.row()[6] > 0.01);
  }

  // Put down, it stays where it was, and moves no more.
  CHECK(page.tell({{"do", "put_down"}}) == 200);
  REQUIRE(page.comes_to_hold(-1));
  CHECK(page.height(block) == Approx(0.01).margin(5e-5));
  CHECK(page.tell({{"do", "lead"}, {"pose", {0, 0, 0.05, 1, 0, 0, 0}}}) == 200);
  CHECK(page.tell({{"do", "move"}, {"part", block}, {"by", {0, 0, 0.1}}, {"turn", {0, 0, 0}}}) == 200);
  CHECK(page.height(block) == Approx(0.11).margin(5e-5));

  // Another one, of a scene from which a part is gone: its frames are of the part's number on the page.
  CHECK(page.tell(act("remove", block)) == 200);
  CHECK(page.tell(act("hold", floor_)) == 200);
  CHECK(page.held() == floor_);
  {
    Watcher watcher(page.served);
    CHECK(page.frame(watcher)[6] == Approx(-0.005).margin(2e-3));
  }
  // Anew: all parts as they were, nothing held.
  CHECK(page.tell({{"do", "restart"}}) == 200);
  REQUIRE(page.comes_to_hold(-1));
  CHECK(page.height(block) == Approx(0.012).margin(1e-12));
  CHECK(page.parts().at("parts")[block].at("removed") == false);

  page.served.interrupt();
  CHECK(page.served.wait() == 0);
  CHECK_THAT(page.served.out(), Contains("Nothing is held: pick a part in the page and press Hold"));
  CHECK_THAT(page.served.out(), Contains("intersecting") && Contains("0 of"));
}

TEST_CASE("who only looks gets no report of a run") {
  const TempFolder folder;
  Page page(write_scene(folder));
  CHECK(page.held() == -1);
  page.served.interrupt();
  CHECK(page.served.wait() == 0);
  CHECK_THAT(page.served.out(), !Contains("intersecting"));
}

TEST_CASE("a scene that holds a part cannot put it down, and the axis that is up is the file's") {
  const TempFolder folder;
  write_scene(folder, "up = \"y\"\n");
  Served s({"tegotae", "view", folder / "scene.toml", "--hold", "block"});
  std::string answer;
  CHECK(ask(s.port, command(s, "{\"do\":\"put_down\"}"), &answer) == 400);
  CHECK_THAT(answer, Contains("hold another one instead"));
  REQUIRE(ask(s.port, get(s, "/scene"), &answer) == 200);
  CHECK_THAT(answer, Contains("\"up\":\"y\"") && Contains("\"loose\":false"));
  s.interrupt();
  CHECK(s.wait() == 0);
}

TEST_CASE("a guide is shown as the way of the center of mass, and wants a part that is held") {
  const TempFolder folder;
  const std::string scene = write_scene(folder);
  folder.write("way.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.012,1,0,0,0\n1,0,0,0.042,1,0,0,0\n2,0.03,0,0.042,1,0,0,0\n");
  Program without(
      {"/bin/sh", "-c", TEGOTAE_BIN_DIR "/tegotae view '" + scene + "' --guide '" + (folder / "way.csv") + "' 2>&1"});
  CHECK_THAT(without.rest(), Contains("--hold NAME"));
  CHECK(without.wait() == 2);

  Served s({"tegotae", "view", scene, "--hold", "block", "--guide", folder / "way.csv"});
  std::string answer;
  REQUIRE(ask(s.port, get(s, "/scene"), &answer) == 200);
  const std::string body = answer.substr(answer.find("\r\n\r\n") + 4);
  std::uint32_t length = 0;
  std::memcpy(&length, body.data(), 4);
  const json guide = json::parse(body.substr(4, length)).at("guide");
  REQUIRE(guide.at("count") == 9);
  float points[9];
  std::memcpy(points, body.data() + 4 + length + 4 * guide.at("at").get<std::size_t>(), sizeof points);
  // The block's center of mass is its origin.
  const double expected[9] = {0, 0, 0.012, 0, 0, 0.042, 0.03, 0, 0.042};
  for (int i = 0; i < 9; ++i) CHECK(std::abs(points[i] - expected[i]) < 1e-7);
  s.interrupt();
  CHECK(s.wait() == 0);
}
