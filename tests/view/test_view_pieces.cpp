// Addresses, who may ask, meshes for the eye, and the hand that a page leads.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "view/address.hpp"
#include "view/bundle.hpp"
#include "view/display_mesh.hpp"
#include "view/frame_maker.hpp"
#include "view/page_parts.hpp"
#include "view/request_guard.hpp"
#include "view/wire.hpp"

using namespace tegotae;
using namespace tegotae::view;

TEST_CASE("addresses") {
  CHECK(parse_address("127.0.0.1").text() == "127.0.0.1:0");
  CHECK(parse_address("127.0.0.1:8080").text() == "127.0.0.1:8080");
  CHECK(parse_address("[::1]:80").text() == "[::1]:80");
  CHECK(parse_address("0.0.0.0").wildcard());
  CHECK_FALSE(parse_address("10.0.0.1:1").wildcard());
  for (const char* bad : {"", "localhost", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000", "127.0.0.1:-1", "::1",
                          "1.2.3", "[::1", "127.0.0.1:80s", "8080"}) {
    INFO(bad);
    CHECK_THROWS_AS(parse_address(bad), Error);
  }
  // Debian's CivetWeb has no IPv6, and says of such an address only that it failed.
  CHECK(why_not_listening(parse_address("[::1]:0"), false).find("no IPv6") != std::string::npos);
  CHECK(why_not_listening(parse_address("127.0.0.1"), false).empty());
}

TEST_CASE("who may ask") {
  const RequestGuard guard(parse_address("127.0.0.1:4000"));
  const std::string token = guard.token();
  CHECK(token.size() == 32);
  CHECK(RequestGuard(parse_address("127.0.0.1:4000")).token() != token);
  const auto passes = [&](const RequestOrigin& r) { return guard.refusal(r).empty(); };
  CHECK(passes({"127.0.0.1:4000", "", "", token}));
  CHECK(passes({"localhost:4000", "http://localhost:4000", "same-origin", token}));
  CHECK(passes({"127.0.0.1:4000", "", "none", token}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "", "", ""}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "", "", token.substr(1)}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "", "", "0" + token.substr(1) + "0"}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "http://evil.example", "", token}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "http://127.0.0.1:4001", "", token}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "null", "", token}));
  CHECK_FALSE(passes({"127.0.0.1:4000", "", "cross-site", token}));
  CHECK_FALSE(passes({"evil.example:4000", "", "", token}));
  CHECK_FALSE(passes({"127.0.0.1", "", "", token}));
  CHECK_FALSE(passes({"", "", "", token}));

  const RequestGuard everywhere(parse_address("0.0.0.0:4000"));
  CHECK(everywhere.refusal({"192.168.7.9:4000", "", "", everywhere.token()}).empty());
  CHECK_FALSE(everywhere.refusal({"rebound.example:4000", "", "", everywhere.token()}).empty());
}

TEST_CASE("a token for one request") {
  RequestGuard guard(parse_address("127.0.0.1:4000"));
  CHECK_FALSE(guard.take_once({"127.0.0.1:4000", "", "", ""}));
  const std::string first = guard.make_once(), once = guard.make_once();
  CHECK(once.size() == 32);
  CHECK(once != guard.token());
  CHECK_FALSE(guard.take_once({"127.0.0.1:4000", "", "", first}));
  CHECK_FALSE(guard.take_once({"evil.example:4000", "", "", once}));
  CHECK_FALSE(guard.take_once({"127.0.0.1:4000", "", "cross-site", once}));
  CHECK_FALSE(guard.refusal({"127.0.0.1:4000", "", "none", once}).empty());
  CHECK(guard.take_once({"127.0.0.1:4000", "", "none", once}));
  CHECK_FALSE(guard.take_once({"127.0.0.1:4000", "", "none", once}));
}

TEST_CASE("a mesh for the eye keeps its shape within its number of triangles") {
  // A sphere of 160 × 80 patches, radius 10 mm, around (1, 2, 3) m: single precision steps there are 0.2 µm.
  TriangleMesh ball;
  constexpr int kAround = 160, kUp = 80;
  const double pi = std::acos(-1.0);
  const Vec3 center(1, 2, 3);
  for (int i = 0; i <= kUp; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double a = pi * i / kUp, b = 2 * pi * k / kAround;
      ball.vertices.push_back(center + 0.01 * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  for (std::uint32_t i = 0; i < kUp; ++i)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t a = i * kAround + k, b = i * kAround + (k + 1) % kAround;
      ball.triangles.push_back({a, a + kAround, b});
      ball.triangles.push_back({b, a + kAround, b + kAround});
    }
  const DisplayMesh whole = display_mesh(ball, ball.triangles.size());
  CHECK(whole.indices.size() == 3 * ball.triangles.size());
  for (const std::size_t most : {20000u, 5000u, 500u}) {
    const DisplayMesh shown = display_mesh(ball, most);
    INFO(most);
    CHECK(shown.indices.size() <= 3 * most);
    CHECK(shown.indices.size() > most);  // a third of what it may have, at least
    double farthest = 0, nearest = 1;
    for (std::size_t i = 0; i < shown.positions.size(); i += 3) {
      const Vec3 v(shown.positions[i], shown.positions[i + 1], shown.positions[i + 2]);
      farthest = std::max(farthest, (v - center).norm());
      nearest = std::min(nearest, (v - center).norm());
    }
    CHECK(farthest < 0.01 + 1e-6);
    CHECK(nearest > 0.007);
    for (const std::uint32_t i : shown.indices) REQUIRE(3 * i < shown.positions.size());
  }
}

TEST_CASE("a bundle is a description and what it points to") {
  Bundle bundle;
  bundle.add(std::vector<float>{1, 2});
  bundle.about["numbers"] = bundle.add(std::vector<float>{3, 4, 5});
  bundle.about["name"] = "\xff part";  // no UTF-8
  const std::string bytes = bundle.bytes();
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  CHECK(length % 4 == 0);
  REQUIRE(bytes.size() == 4 + length + 5 * 4);
  const nlohmann::json about = nlohmann::json::parse(bytes.substr(4, length));
  CHECK(about.at("numbers") == nlohmann::json({{"at", 2}, {"count", 3}}));
  float value = 0;
  std::memcpy(&value, bytes.data() + 4 + length + 4 * 2, 4);
  CHECK(value == 3);
}

TEST_CASE("a page gets the force of each contact, in the coupling's newtons at its place") {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"floor", test::shared(test::box({0.1, 0.1, 0.01})), {Quat::Identity(), {0, 0, -0.005}}});
  const Vec3 size(0.02, 0.03, 0.01);
  scene.parts.push_back({"block", test::shared(test::box(size)), {Quat::Identity(), {0, 0, 0.0051}}, true});
  HapticLoop loop(scene);
  const FrameMaker maker;
  Frame frame;
  for (const auto& [depth, newtons] : {std::pair(-1e-3, 0.0), {1e-3, 0.8}, {2.5e-3, 2.0}}) {
    CAPTURE(depth);
    const Pose Y{Quat::Identity(), {0.5 * depth, 0, 0.005 - depth}};
    for (int tick = 0; tick < 100; ++tick) loop.step(Y, 1e-3);
    maker.add_loop(loop, frame);
    const std::string bytes = frame_message(frame);
    std::vector<float> row((bytes.size() - 8) / sizeof(float));
    std::memcpy(row.data(), bytes.data() + 8, row.size() * sizeof(float));
    const auto pairs = static_cast<std::size_t>(row[31]), forces = static_cast<std::size_t>(row[33]);
    REQUIRE(row.size() == kFrameFloats + kPairFloats * pairs + kForceFloats * forces);
    CHECK((forces > 0) == (newtons > 0));
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (std::size_t i = 0; i < forces; ++i) {
      const float* at = row.data() + kFrameFloats + kPairFloats * pairs + kForceFloats * i;
      const Vec3 point(at[0], at[1], at[2]), f(at[3], at[4], at[5]);
      CHECK(std::abs(std::abs(point.x() - 0.5 * depth) - 0.5 * size.x()) < 1e-5);
      CHECK(std::abs(std::abs(point.y()) - 0.5 * size.y()) < 1e-5);
      CHECK(point.z() >= 0);
      CHECK(point.z() < 2e-5);
      force += f;
      torque += (point - Vec3(0.5 * depth, 0, 0)).cross(f);
    }
    CHECK((force - Vec3(0, 0, newtons)).norm() < 800 * 2e-5);  // of the gap that contacts keep
    CHECK(torque.norm() < 1e-4);
  }
}

TEST_CASE("a page gets the friction of each contact, and whether it slides") {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.friction.mu = 0.25;
  scene.parts.push_back({"floor", test::shared(test::box({0.1, 0.1, 0.01})), {Quat::Identity(), {0, 0, -0.005}}});
  scene.parts.push_back(
      {"block", test::shared(test::box({0.02, 0.03, 0.01})), {Quat::Identity(), {0, 0, 0.0051}}, true});
  HapticLoop loop(scene);
  const FrameMaker maker;
  Frame frame;
  Pose Y{Quat::Identity(), {0, 0, 0.004}};
  for (int tick = 0; tick < 200; ++tick) {
    if (tick >= 100) Y.p.x() += 2e-5;
    loop.step(Y, 1e-3);
    if (tick != 99 && tick != 199) continue;
    maker.add_loop(loop, frame);
    std::vector<float> forces;
    append_forces(frame, forces);
    REQUIRE(frame.force_count > 0);
    REQUIRE(forces.size() == kForceFloats * frame.force_count);
    double normal = 0, friction = 0;
    for (std::size_t i = 0; i < frame.force_count; ++i) {
      const float* at = forces.data() + kForceFloats * i;
      normal += at[5];
      friction += at[6];
      CHECK(at[9] == 0.25F);
      CHECK(at[10] == (tick == 199 ? 1 : 0));
    }
    CHECK(friction == Approx(tick == 199 ? -0.25 * normal : 0).margin(1e-6));
  }
}

TEST_CASE("a led hand goes to its goal like a hand") {
  const Pose start{Quat::Identity(), Vec3(0.1, 0, 0)};
  SimulatedDeviceSettings settings;
  settings.position_resolution = settings.rotation_resolution = settings.friction = 0;
  const Vec3 center(0, 0, 0.02);
  SimulatedDevice pen(settings, StylusScript({{0, start}}), center);
  InputGuide guide;
  pen.follow(guide);
  pen.start();
  for (int i = 0; i < 100; ++i) pen.advance(1e-3);
  CHECK((pen.true_pose().p - start.p).norm() < 1e-9);  // nobody leads

  const Pose goal{rotation(Vec3(0, 0, 1.2)), Vec3(0.1, 0.2, -0.1)};
  guide.lead(goal);
  double fastest = 0;
  Vec3 last = pen.true_pose() * center;
  for (int i = 0; i < 3000; ++i) {
    pen.advance(1e-3);
    const Vec3 now = pen.true_pose() * center;
    fastest = std::max(fastest, (now - last).norm() / 1e-3);
    last = now;
  }
  CHECK(fastest < 0.5);  // 0.4 m/s of the hand, and what the spring adds
  CHECK(fastest > 0.3);
  CHECK((pen.true_pose().p - goal.p).norm() < 1e-6);
  CHECK(rotation_vector(pen.true_pose().q * goal.q.conjugate()).norm() < 1e-6);
}

TEST_CASE("parts that a page moves, removes, adds back and takes into the hand") {
  using nlohmann::json;
  // A box of 2 x 4 x 6 cm whose middle is 10 cm from its file's origin.
  TriangleMesh mesh = test::box(Vec3(0.02, 0.04, 0.06));
  for (Vec3& v : mesh.vertices) v += Vec3(0.1, 0, 0);
  const auto shape = std::make_shared<const TriangleMesh>(mesh);
  Scene scene;
  scene.parts = {{"a", shape, {Quat::Identity(), Vec3(1, 2, 3)}}, {"b", shape, {}, true}, {"c", shape, {}}};
  PageParts parts(scene);
  const double quarter = std::acos(0.0);

  parts.edit({{"do", "move"}, {"part", 0}, {"by", {0.5, 0, 0}}, {"turn", {0, 0, quarter}}});
  const Pose& X = parts.all()[0].pose;
  // The middle goes by what is asked for; what pointed along x from there points along y.
  CHECK((X * Vec3(0.1, 0, 0) - Vec3(1.6, 2, 3)).norm() < 1e-12);
  CHECK((X * Vec3(0.11, 0, 0) - Vec3(1.6, 2.01, 3)).norm() < 1e-12);
  // First about x, then about y: z goes to -y and stays there.
  parts.edit({{"do", "move"}, {"part", 2}, {"by", {0, 0, 0}}, {"turn", {quarter, quarter, 0}}});
  CHECK((parts.all()[2].pose.q * Vec3::UnitZ() + Vec3::UnitY()).norm() < 1e-12);

  parts.edit({{"do", "remove"}, {"part", 0}});
  CHECK(parts.numbers() == std::vector<std::uint32_t>{1, 2});
  CHECK(parts.in_scene().front().name == "b");
  parts.edit({{"do", "hold"}, {"part", 2}});
  CHECK(parts.held() == 2);
  CHECK_FALSE(parts.all()[1].held);
  std::vector<Part> placed = parts.in_scene();
  placed[0].pose.p = Vec3(7, 8, 9);
  parts.place(placed);
  CHECK(parts.all()[1].pose.p == Vec3(7, 8, 9));
  for (const char* what : {"hold", "remove", "move"})
    CHECK_THROWS_AS(parts.edit({{"do", what}, {"part", 0}, {"by", {0, 0, 0}}, {"turn", {0, 0, 0}}}), Error);
  parts.edit({{"do", "add"}, {"part", 0}});
  CHECK((parts.all()[0].pose * Vec3(0.1, 0, 0) - Vec3(1.6, 2, 3)).norm() < 1e-12);
  CHECK(parts.numbers().size() == 3);
  for (const json& bad : {json{{"do", "add"}, {"part", 0}}, json{{"do", "remove"}, {"part", 2}},
                          json{{"do", "remove"}, {"part", 3}}, json{{"do", "remove"}, {"part", -1}},
                          json{{"do", "move"}, {"part", 0}, {"by", {200, 0, 0}}, {"turn", {0, 0, 0}}}})
    CHECK_THROWS_AS(parts.edit(bad), Error);
}
