// What a recording says, on recordings whose answers are known in closed form.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "bodies.hpp"
#include "catch.hpp"
#include "review/clearance_band.hpp"
#include "review/findings.hpp"
#include "review/path_scan.hpp"
#include "review/spans.hpp"
#include "review/verdict.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::review;
using namespace tegotae::test;

namespace {

/// A block of 10 mm over a floor (top at z = 0) beside a wall (its side at x = 20 mm).
Scene blocks() {
  Scene scene;
  scene.parts.push_back({"floor", shared(box({0.2, 0.2, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"wall", shared(box({0.02, 0.2, 0.1})), {Quat::Identity(), {0.03, 0, 0.06}}, false});
  scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {0, 0, 0.01}}, true});
  return scene;
}

SceneFile file_of(const Scene& scene, const Pose& goal) {
  const Pose start = scene.parts.back().pose;
  return {"blocks.toml", scene, {}, StylusScript({{0, start}, {1, goal}})};
}

RecordFrame row(int ms, double x, double z, double pen_z, double force) {
  RecordFrame r;
  r.tick = static_cast<std::uint64_t>(ms);
  r.t = 1e-3 * ms;
  r.x.p = {x, 0, z};
  r.y.p = {x, 0, pen_z};
  r.wrench.force = {0, 0, force};
  r.wrench.torque = {0.001 * force, 0, 0};
  r.contacts = force > 0 ? 4 : 0;
  return r;
}

/// Down from 5 mm to 2 µm over the floor in half a second, a second of rest there with 2 N, up again, to the wall.
std::vector<RecordFrame> down_and_up() {
  std::vector<RecordFrame> rows;
  const double low = 0.005 + 2e-6;
  for (int i = 0; i <= 500; ++i)
    rows.push_back(row(i, 0, 0.01 + (low - 0.01) * i / 500, 0.01 + (low - 0.01) * i / 500, 0));
  for (int i = 501; i <= 1500; ++i) rows.push_back(row(i, 0, low, low - 2.5e-3, 2));
  for (int i = 1501; i <= 2000; ++i) rows.push_back(row(i, 0, low + 1e-5 * (i - 1500), low + 1e-5 * (i - 1500), 0));
  const double beside = 0.02 - 0.005 - 3e-6;
  for (int i = 2001; i <= 2500; ++i)
    rows.push_back(row(i, beside * (i - 2000) / 500, low + 5e-3, low + 5e-3, i == 2500 ? 0.5 : 0));
  return rows;
}

}  // namespace

TEST_CASE("contacts, stalls, loads and clearances of a block that presses on a floor and goes to a wall") {
  const Scene scene = blocks();
  const std::vector<RecordFrame> rows = down_and_up();
  const Vec3 center = Vec3::Zero();
  const SceneFile file = file_of(scene, rows.back().x);
  const Scan scan = scan_path(scene, "test", rows, {});
  CHECK(scan.astray == 0);
  CHECK(scan.every == 1);
  CHECK((scan.center - center).norm() < 1e-12);
  const Findings f = find(file, rows, scan, center);

  CHECK(f.seconds == Approx(2.5));
  CHECK(f.start.intersecting == 0);
  CHECK(f.way == Approx(0.005 - 2e-6 + 0.005 + 0.015 - 3e-6).epsilon(1e-9));
  REQUIRE(f.clearances.size() == 2);
  CHECK(f.clearances[0].part == 0);
  CHECK(f.clearances[0].distance == Approx(2e-6).epsilon(1e-6));
  CHECK(f.clearances[0].place_W.z() == Approx(1e-6).epsilon(1e-6));
  CHECK(f.clearances[1].part == 1);
  CHECK(f.clearances[1].distance == Approx(3e-6).epsilon(1e-6));
  CHECK(f.clearances[1].t == Approx(2.5));

  REQUIRE(f.contacts.size() == 2);
  CHECK(f.contacts[0].part == 0);
  const double gap = scan.rows[1000].contact_gap;  // some micrometers: 10 µm a millisecond are passed on the way
  CHECK(gap > 2e-6);
  CHECK(f.contacts[0].span.begin == Approx(0.5).margin(1e-3 + 0.5 * gap / 0.01));
  CHECK(f.contacts[0].span.end == Approx(1.5).margin(1e-3 + gap / 0.01));
  CHECK(f.contacts[0].force == 2);
  CHECK(std::abs(f.contacts[0].place_W.z()) < 1e-12);
  CHECK(f.contacts[1].part == 1);
  CHECK(f.contacts[1].force == 0.5);
  CHECK(f.contacts[1].place_W.x() == Approx(0.02));

  CHECK(f.two_sided.empty());
  REQUIRE(f.stalls.size() == 1);
  // The window of 50 ms comes to rest after the part does.
  CHECK(f.stalls[0].span.begin == Approx(0.53).margin(0.03));
  CHECK(f.stalls[0].span.end == Approx(1.5).margin(2e-3));
  CHECK(f.stalls[0].parts == std::vector<std::size_t>{0});
  CHECK(f.stalls[0].ahead == Approx(2.5e-3));

  CHECK(f.loads.force == 2);
  CHECK(f.loads.torque == Approx(0.002));
  CHECK(f.loads.asked_force == Approx(800 * 2.5e-3));
  // 2 N for a second and 0.5 N for a millisecond, over 30 s.
  CHECK(f.loads.running_rms == Approx(std::sqrt((4.0 + 0.25e-3) / 30)).epsilon(1e-3));
  CHECK(f.loads.limit_force == 8.5);
  CHECK(f.loads.continuous == 1.4);

  REQUIRE(f.goal);
  CHECK(f.goal->reached);
  CHECK(f.goal->missing == Approx(0).margin(1e-12));
  const Verdict v = judge(f, scene, true, scan, "");
  CHECK(v.outcome == review::Outcome::goes);
  CHECK(v.headline == "It goes in");
}

TEST_CASE("a recording that ends against a part tells who is in the way, and where") {
  const Scene scene = blocks();
  std::vector<RecordFrame> rows = down_and_up();
  rows.resize(1400);
  const SceneFile file = file_of(scene, {Quat::Identity(), {0, 0, -0.02}});
  const Scan scan = scan_path(scene, "test", rows, {});
  const Findings f = find(file, rows, scan, Vec3::Zero());
  REQUIRE(f.goal);
  CHECK_FALSE(f.goal->reached);
  CHECK_FALSE(f.goal->passed);
  CHECK(f.goal->depth == Approx(0.005 - 2e-6).epsilon(1e-9));
  CHECK(f.goal->way == Approx(0.03));
  const Verdict v = judge(f, scene, true, scan, "");
  CHECK(v.outcome == review::Outcome::does_not_go);
  CHECK(v.headline.find("It does not go in: blocked by floor at (") == 0);
}

TEST_CASE("poses inside of a part are counted, and are not a way") {
  const Scene scene = blocks();
  std::vector<RecordFrame> rows = down_and_up();
  for (int i = 0; i < 7; ++i) rows.push_back(row(2501 + i, 0.0149, 0.004 - 1e-5 * i, 0.004, 0));
  const SceneFile file = file_of(scene, rows.back().x);
  const Scan scan = scan_path(scene, "test", rows, {});
  const Findings f = find(file, rows, scan, Vec3::Zero());
  CHECK(f.start.intersecting == 7);
  CHECK(f.clearances[0].distance == 0);
  CHECK(judge(f, scene, true, scan, "").outcome == review::Outcome::does_not_go);
}

namespace {

bool tells(const Verdict& v, review::Evidence::Kind kind, const std::vector<std::string>& words) {
  return std::any_of(v.evidence.begin(), v.evidence.end(), [&](const review::Evidence& e) {
    return e.kind == kind && std::all_of(words.begin(), words.end(), [&](const std::string& word) {
             return e.text.find(word) != std::string::npos;
           });
  });
}

/// A block of 10 mm between two boards of 20 mm, each of which it is 3 µm deep in.
Scene pressed_in() {
  Scene scene;
  for (const double side : {-1.0, 1.0})
    scene.parts.push_back({side < 0 ? "left" : "right",
                           shared(box({0.01, 0.02, 0.02})),
                           {Quat::Identity(), {side * (0.01 - 3e-6), 0, 0}}});
  scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), Pose{}, true});
  return scene;
}

/// It slides out along y, 20 µm a millisecond and `x` beside the middle on the way: it leaves the boards at 15 mm,
/// after 750 ms.
std::vector<RecordFrame> sliding_out(double x) {
  std::vector<RecordFrame> rows;
  for (int i = 0; i <= 1000; ++i) {
    rows.push_back(row(i, i < 100 || i > 200 ? 0 : x, 0, 0, 0));
    rows.back().x.p.y() = rows.back().y.p.y() = 2e-5 * i;
  }
  return rows;
}

}  // namespace

TEST_CASE("parts that begin pressed together are relieved until they are apart, and no pose may reach deeper") {
  const Scene scene = pressed_in();
  // What a copy lies deeper by: the depth, the 1.1 µm that motions leave and 0.2 µm.
  const double relief = 3e-6 + 1.3e-6;
  const auto look = [&](const std::vector<RecordFrame>& rows, Findings& f) {
    const SceneFile file = file_of(scene, rows.back().x);
    const Scan scan = scan_path(scene, "test", rows, {});
    CHECK(scan.astray <= 5);  // the led loop stays out where the part goes back in
    f = find(file, rows, scan, Vec3::Zero());
    REQUIRE(f.start.pairs.size() == 2);
    for (const StartFinding& s : f.start.pairs) {
      CHECK(s.pair.state == InitialContactState::shrunk);
      CHECK(s.pair.clash.depth.value() == Approx(3e-6).epsilon(1e-6));
      CHECK(s.pair.inward_offset == Approx(relief).epsilon(1e-6));
    }
    return judge(f, scene, false, scan, "");
  };
  Findings f;
  // Pressed aside it is 4 µm deep in a board, 0.3 µm less than that.
  const Verdict good = look(sliding_out(1e-6), f);
  CHECK(good.headline == "It comes out");
  CHECK(f.start.intersecting == 0);
  for (const StartFinding& s : f.start.pairs) {
    CHECK(s.deeper == 0);
    CHECK(s.until == Approx(0.75).margin(3.5e-3));  // one pair a tick is asked about
  }
  CHECK(tells(good, review::Evidence::Kind::plain,
              {"left; until 0.75 s contact is felt 4.30 um inside its surface; no pose reached deeper"}));
  CHECK(tells(good, review::Evidence::Kind::good, {"No pose intersects another part that was free of it"}));

  const Verdict deep = look(sliding_out(2e-6), f);
  CHECK(deep.outcome == review::Outcome::does_not_go);
  CHECK(f.start.intersecting == 0);
  CHECK(f.start.pairs[0].deeper + f.start.pairs[1].deeper == 101);
  CHECK(tells(deep, review::Evidence::Kind::bad, {"101 poses reached deeper"}));

  // Once it came out it may not be in there again.
  std::vector<RecordFrame> again = sliding_out(0);
  for (int i = 0; i < 5; ++i) {
    again.push_back(again[static_cast<std::size_t>(i)]);
    again.back().tick = 1001 + static_cast<std::uint64_t>(i);
    again.back().t = 1e-3 * static_cast<double>(again.back().tick);
  }
  const Verdict back = look(again, f);
  CHECK(back.outcome == review::Outcome::does_not_go);
  CHECK(f.start.intersecting == 5);
  CHECK(f.start.pairs[0].deeper == 0);
}

namespace {

/// A block of 10 mm between two boards of 20 mm, 20 µm from each, at y.
Scene between(double y) {
  Scene scene = pressed_in();
  for (Part& part : scene.parts)
    if (!part.held) part.pose.p.x() *= 1 + (23e-6 / 0.01);
  scene.parts.back().pose.p.y() = y;
  return scene;
}

/// Along y from place to place, 20 µm a millisecond, with half a second of rest.
std::vector<RecordFrame> along_y(const std::vector<double>& places) {
  std::vector<RecordFrame> rows;
  const auto add = [&](double y) {
    rows.push_back(row(static_cast<int>(rows.size()), 0, 0, 0, 0));
    rows.back().x.p.y() = rows.back().y.p.y() = y;
  };
  add(places.front());
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double from = places[i - 1], way = places[i] - from;
    const int n = static_cast<int>(std::lround(std::abs(way) / 2e-5));
    for (int k = 1; k <= n; ++k) add(from + way * k / n);
  }
  for (int k = 0; k < 500; ++k) add(places.back());
  return rows;
}

/// What is said of it with the goal at `goal`.
Verdict verdict_of(const std::vector<double>& places, double goal, bool inwards, const GoalRule& rule = {}) {
  const Scene scene = between(places.front());
  const std::vector<RecordFrame> rows = along_y(places);
  const SceneFile file = file_of(scene, {Quat::Identity(), {0, goal, 0}});
  const Scan scan = scan_path(scene, "test", rows, {});
  return judge(find(file, rows, scan, Vec3::Zero(), rule), scene, inwards, scan, "");
}

}  // namespace

TEST_CASE("a part comes out when it is beside all others, and what is said otherwise is so") {
  using review::Outcome;
  const GoalRule by_end{std::nullopt, 0.1};
  const std::string nothing = ": nothing blocked it at the end; the hand did not bring it there";
  const auto check = [](const Verdict& v, Outcome outcome, const std::string& headline) {
    CHECK(v.headline == headline);
    CHECK((v.outcome == outcome));
  };
  // The boards end at 10 mm; the block is beside them by a twentieth of its radius (8.66 mm) from 15.43 mm on.
  check(verdict_of({0, 0.002}, 0.002, false), Outcome::goes,
        "It gets to its goal, 2 mm on the way out; still inside left and right");
  check(verdict_of({0, 0.0153}, 0.0153, false), Outcome::goes,
        "It gets to its goal, 15.3 mm on the way out; still inside left and right");
  check(verdict_of({0, 0.0155}, 0.0155, false), Outcome::goes, "It comes out");
  check(verdict_of({0.02, 0}, 0, true), Outcome::goes, "It goes in");
  check(verdict_of({0.005, 0}, 0, true), Outcome::goes, "It goes in");
  check(verdict_of({0.02, 0.04}, 0.04, false), Outcome::goes,
        "It gets to its goal; it was out of the other parts where it began");
  // There, and away again: for a run and for who asks whether it ever was there.
  check(verdict_of({0, 0.02, 0.01}, 0.02, false, by_end), Outcome::does_not_go, "It does not come out" + nothing);
  const Verdict left = verdict_of({0, 0.02, 0.01}, 0.02, false);
  CHECK(left.headline.find("It comes out, and leaves again: it was there after ") == 0);
  CHECK(left.outcome == Outcome::goes);
  CHECK(verdict_of({0, 0.002, 0.006}, 0.002, false).headline.find("It gets to its goal, 1.6") ==
        0);  // within the tolerance of 0.34 mm
  // Elsewhere.
  check(verdict_of({0, 0.018}, 0.04, false, by_end), Outcome::does_not_go,
        "It does not get to its goal, though it is out of the other parts" + nothing);
  check(verdict_of({0, 0.001}, 0.005, false, by_end), Outcome::does_not_go, "It does not get to its goal" + nothing);
  check(verdict_of({0.02, 0.01}, 0, true, by_end), Outcome::does_not_go, "It does not go in" + nothing);
  // Before the script's end nothing is judged; and where the goal is where it began nothing can be.
  check(verdict_of({0, 0.002}, 0.02, false, {std::nullopt, 5.0}), Outcome::open,
        "It ends before its script does, 2 mm of 20 mm on the way");
  check(verdict_of({0, 0.02, 0}, 1e-4, false, by_end), Outcome::open,
        "Its goal is where it began, within 0.305 mm: there is nothing to say about its way");
  check(verdict_of({0, 0.02}, 1e-4, false), Outcome::does_not_go,
        "It does not get back to its goal, where it began, within 0.305 mm" + nothing);
  // The recorded tolerance holds.
  CHECK(verdict_of({0, 0.019}, 0.02, false, {0.9e-3, 0.1}).outcome == Outcome::does_not_go);
  CHECK(verdict_of({0, 0.019}, 0.02, false, {1.1e-3, 0.1}).outcome == Outcome::goes);
}

TEST_CASE("a part that is held up at its goal has not come to rest there") {
  const Scene scene = between(0);
  std::vector<RecordFrame> rows = along_y({0, 0.02});
  const SceneFile file = file_of(scene, rows.back().x);
  const Scan scan = scan_path(scene, "test", rows, {});
  const auto reached = [&](double ahead, LagReason reason) {
    rows.back().y.p.y() = 0.02 + ahead;
    rows.back().lag_reason = reason;
    return find(file, rows, scan, Vec3::Zero()).goal->reached;
  };
  CHECK(reached(0, LagReason::none));
  CHECK(reached(0.01, LagReason::contact));
  CHECK_FALSE(reached(0.01, LagReason::capacity));
}

TEST_CASE("a part that begins in another one is told, and the poses in it until it came free") {
  Scene scene = blocks();
  scene.contact.initial_overlap = InitialOverlap::ignore;
  scene.parts.back().pose.p = {0, 0, 0.004505};  // 0.495 mm deep in the floor
  std::vector<RecordFrame> rows;
  for (int i = 0; i <= 200; ++i) rows.push_back(row(i, 0, 0.004505 + 1e-5 * i, 0.004505 + 1e-5 * i, 0));
  const SceneFile file = file_of(scene, rows.back().x);
  Scan scan = scan_path(scene, "test", rows, {});
  Findings f = find(file, rows, scan, Vec3::Zero());
  REQUIRE(f.start.pairs.size() == 1);
  CHECK(f.start.pairs[0].pair.state == InitialContactState::filtered);
  CHECK(f.start.pairs[0].deeper == 50);
  CHECK(f.start.pairs[0].until == Approx(0.051).margin(1e-9));
  CHECK(f.start.intersecting == 0);
  const Verdict v = judge(f, scene, false, scan, "");
  CHECK(v.outcome == review::Outcome::goes);
  CHECK(tells(v, review::Evidence::Kind::bad, {"Suspended until 0.05 s", "floor", "poses intersect it"}));

  // What goes back into it then intersects.
  for (int i = 0; i < 7; ++i) rows.push_back(row(201 + i, 0, 0.004, 0.004, 0));
  scan = scan_path(scene, "test", rows, {});
  f = find(file, rows, scan, Vec3::Zero());
  CHECK(f.start.intersecting == 1);  // a pose that stands counts once
  CHECK(judge(f, scene, false, scan, "").outcome == review::Outcome::does_not_go);
}

TEST_CASE("held from two sides") {
  const double wide = 0.2;
  CHECK_FALSE(holds_from_two_sides({}));
  CHECK_FALSE(holds_from_two_sides({Vec3::UnitZ()}));
  CHECK_FALSE(holds_from_two_sides({Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()}));  // a corner
  CHECK(holds_from_two_sides({Vec3::UnitZ(), -Vec3::UnitZ()}));
  CHECK(holds_from_two_sides({Vec3::UnitX(), Vec3(-0.5, std::sqrt(0.75), 0), Vec3(-0.5, -std::sqrt(0.75), 0)}));
  // Leaning walls: the part comes free upwards when they lean by more than 10 degrees.
  for (const double lean : {0.1, wide})
    CHECK(holds_from_two_sides({Vec3(std::cos(lean), 0, std::sin(lean)), Vec3(-std::cos(lean), 0, std::sin(lean))}) ==
          (lean < wide));
  // Random normals: the best direction to leave, by trying many.
  std::mt19937 rng(5);
  int held = 0, decided = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3> normals(2 + trial % 5);
    for (Vec3& n : normals) n = random_direction(rng);
    double best = -1;
    for (int k = 0; k < 4000; ++k) {
      const double z = 1 - (2 * k + 1) / 4000.0, r = std::sqrt(1 - z * z), a = 2.399963 * k;
      const Vec3 v(r * std::cos(a), r * std::sin(a), z);
      double least = 1;
      for (const Vec3& n : normals) least = std::min(least, n.dot(v));
      best = std::max(best, least);
    }
    if (std::abs(best - 0.1736) < 0.05) continue;
    ++decided;
    held += best < 0.1736;
    CHECK(holds_from_two_sides(normals) == (best < 0.1736));
  }
  CHECK(decided > 100);
  CHECK(held > 10);
}

TEST_CASE("a block between two walls is held from two sides while it touches both") {
  Scene scene;
  scene.parts.push_back({"left", shared(box({0.02, 0.1, 0.1})), {Quat::Identity(), {-0.015 - 2e-6, 0, 0}}, false});
  scene.parts.push_back({"right", shared(box({0.02, 0.1, 0.1})), {Quat::Identity(), {0.015 + 2e-6, 0, 0}}, false});
  scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {0, 0, 0.08}}, true});
  std::vector<RecordFrame> rows;
  for (int i = 0; i <= 400; ++i) rows.push_back(row(i, 0, 0.08 - 2e-4 * i, 0.08 - 2e-4 * i, 1));
  const Scan scan = scan_path(scene, "test", rows, {});
  const Findings f = find(file_of(scene, rows.back().x), rows, scan, Vec3::Zero());
  REQUIRE(f.two_sided.size() == 1);
  // Its lower side comes between them at z = 55 mm, after 125 ms.
  CHECK(f.two_sided[0].span.begin == Approx(0.125).margin(0.02));
  CHECK(f.two_sided[0].span.end == Approx(0.4).margin(2e-3));
  CHECK(f.two_sided[0].parts == std::vector<std::size_t>{0, 1});
}

TEST_CASE("spans join short breaks and leave out what is short") {
  const std::vector<int> on = {1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1};
  const auto time = [](std::size_t i) { return 0.01 * static_cast<double>(i); };
  const auto holds = [&](std::size_t i) { return on[i] == 1; };
  using Spans = std::vector<std::pair<std::size_t, std::size_t>>;
  CHECK(spans(on.size(), time, holds, 0.025, 0) == Spans{{0, 3}, {7, 7}, {12, 13}});
  CHECK(spans(on.size(), time, holds, 0.025, 0.005) == Spans{{0, 3}, {12, 13}});
  CHECK(spans(0, time, holds, 0.025, 0).empty());
}

TEST_CASE("rows that are looked at") {
  CHECK(looked_at(0, 10).empty());
  CHECK(looked_at(3, 10) == std::vector<std::size_t>{0, 1, 2});
  CHECK(looked_at(11, 5) == std::vector<std::size_t>{0, 3, 6, 9, 10});
}

TEST_CASE("a band of clearances over the motion of a block towards a wall and back") {
  // The gap to the wall goes from 10 mm to 1 mm and back, 9 mm/s; the floor is 40 mm away.
  const Scene scene = blocks();
  std::vector<RecordFrame> rows;
  const auto gap = [](int i) { return 0.01 - 9e-6 * (i <= 1000 ? i : 2000 - i); };
  for (int i = 0; i <= 2000; ++i) rows.push_back(row(i, 0.015 - gap(i), 0.045, 0.045, 0));
  const ClearanceBand band{0.002, 0.005};
  const Scan scan = scan_path(scene, "test", rows, {}, band.high);
  CHECK(scan.reach == Approx(band.high));
  const BandFindings found = find_band(band, rows, scan);
  REQUIRE(found.of_row.size() == rows.size());
  for (int i = 0; i <= 2000; ++i)
    if (std::abs(gap(i) - band.low) > 1e-9 && std::abs(gap(i) - band.high) > 1e-9)
      REQUIRE(found.of_row[i] == band.zone(gap(i)));
  // Above for 5 of 9 mm, inside for 3, below for 1; each way.
  const double row_seconds = 2.1e-3, row_way = 2.1 * 9e-6;  // at each end of a stretch a row more or less
  CHECK(found.seconds[0] == Approx(2.0 / 9).margin(row_seconds));
  CHECK(found.seconds[1] == Approx(6.0 / 9).margin(row_seconds));
  CHECK(found.seconds[2] == Approx(10.0 / 9).margin(row_seconds));
  CHECK(found.seconds[0] + found.seconds[1] + found.seconds[2] == Approx(2));
  CHECK(found.way[0] == Approx(0.002).margin(row_way));
  CHECK(found.way[1] == Approx(0.006).margin(row_way));
  CHECK(found.way[2] == Approx(0.010).margin(row_way));
  REQUIRE(found.spans.size() == 5);
  const BandZone zones[] = {BandZone::above, BandZone::inside, BandZone::below, BandZone::inside, BandZone::above};
  const double ends[] = {5.0 / 9, 8.0 / 9, 10.0 / 9, 13.0 / 9, 2}, ways[] = {0.005, 0.008, 0.010, 0.013, 0.018};
  const double tightest[] = {0.005, 0.002, 0.001, 0.002, 0.005};
  for (std::size_t k = 0; k < 5; ++k) {
    const BandSpan& s = found.spans[k];
    CHECK(s.zone == zones[k]);
    CHECK(s.span.begin == (k == 0 ? 0 : found.spans[k - 1].span.end));
    CHECK(s.way_begin == (k == 0 ? 0 : found.spans[k - 1].way_end));
    CHECK(s.span.end == Approx(ends[k]).margin(row_seconds));
    CHECK(s.way_end == Approx(ways[k]).margin(row_way));
    CHECK(s.tightest.part == 1);
    CHECK(s.tightest.distance == Approx(tightest[k]).margin(row_way));
  }
  // The tightest place: at the turn, in the middle of the gap of 1 mm.
  const BandSpan& below = found.spans[2];
  CHECK(below.tightest.distance == Approx(0.001).margin(1e-12));
  CHECK(below.tightest.t == Approx(1));
  CHECK(below.tightest.place_W.x() == Approx(0.0195));
  const Findings f = find(file_of(scene, rows.back().x), rows, scan, scan.center);
  const std::vector<std::string> text = band_text(found, f.clearances, scene);
  CHECK_THAT(text[0], Catch::Contains("clearance of 2 mm to 5 mm: below 0.22 s and 2.0"));
  CHECK_THAT(text[2], Catch::Contains("below the band from 0.8") && Catch::Contains("at least 1 mm to wall"));
  CHECK_THAT(text.back(), Catch::Contains("tightest: 1 mm to wall") && Catch::Contains("below the band"));
  BandFindings rounded = found;  // ways are sums of steps: what rounds to zero has no sign
  for (BandSpan& s : rounded.spans) s.way_begin = s.way_end = -1e-9;
  const std::vector<std::string> zeros = band_text(rounded, f.clearances, scene);
  CHECK_THAT(zeros[2], Catch::Contains(", 0.00 to 0.00 mm on the way"));
}

TEST_CASE("a cylinder that rolls along a wall stays in the band that its gap is in") {
  // 720 facets: the gap differs by a sagitta of 0.1 um.
  TriangleMesh rod;
  const int n = 720;
  const double radius = 0.01;
  for (int i = 0; i < n; ++i)
    for (const double z : {-0.02, 0.02})
      rod.vertices.emplace_back(radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n), z);
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::uint32_t>(2 * i), b = static_cast<std::uint32_t>(2 * ((i + 1) % n));
    rod.triangles.push_back({a, b, a + 1});
    rod.triangles.push_back({b, b + 1, a + 1});
  }
  Scene scene;
  scene.parts.push_back({"wall", shared(box({0.02, 0.4, 0.1})), {Quat::Identity(), {0.0102 + radius, 0, 0}}});
  scene.parts.push_back({"rod", shared(rod), Pose{}, true});
  std::vector<RecordFrame> rows;
  for (int i = 0; i <= 1000; ++i) {
    RecordFrame r;
    r.tick = static_cast<std::uint64_t>(i);
    r.t = 1e-3 * i;
    const double y = -0.05 + 1e-4 * i;
    r.x = r.y = {rotation({0, 0, y / radius}), {0, y, 0}};
    rows.push_back(r);
  }
  const Scan scan = scan_path(scene, "test", rows, {});
  const double sagitta = radius * (1 - std::cos(M_PI / n));
  for (const ScannedRow& s : scan.rows) {
    REQUIRE(s.clearances.size() == 1);
    CHECK(s.clearances[0].distance >= 2e-4 - 1e-9);
    CHECK(s.clearances[0].distance <= 2e-4 + sagitta + 1e-9);
  }
  for (const auto& [low, high, zone] : std::initializer_list<std::tuple<double, double, BandZone>>{
           {1.9e-4, 2.1e-4, BandZone::inside}, {1e-5, 1.9e-4, BandZone::above}, {2.1e-4, 1e-3, BandZone::below}}) {
    const BandFindings found = find_band({low, high}, rows, scan);
    REQUIRE(found.spans.size() == 1);
    CHECK(found.spans[0].zone == zone);
    CHECK(found.spans[0].span.end == Approx(1));
    CHECK(found.spans[0].way_end == Approx(0.1));
  }
}
