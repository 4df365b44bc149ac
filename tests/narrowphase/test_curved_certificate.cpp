// Curved separators against what knows nothing of them: exact triangle tests at poses on the way, and the certificate
// by planes alone.
#include "alloc_guard.hpp"
#include "catch.hpp"
#include "models/helical.hpp"
#include "models/shapes.hpp"
#include "models/threaded.hpp"
#include "narrowphase/axis_pairs.hpp"
#include "narrowphase/patch_front.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

MeshPtr mesh_of(TriangleMesh m) {
  return std::make_shared<const TriangleMesh>(std::move(m));
}

TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh all = a;
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  all.vertices.insert(all.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return all;
}

TriangleMesh placed(TriangleMesh m, const Pose& X) {
  for (Vec3& v : m.vertices) v = X * v;
  return m;
}

/// Two parts, about where they mate, and how much play they have there.
struct Fit {
  const char* name;
  std::shared_ptr<const PatchTree> a, b;
  Pose mated;
  double pitch;  ///< of B, 0 for none
  double play;
  bool mates = true;  ///< parts that do not are paired all the same, with B's rise
  std::vector<AxisPair> axes;
  std::unique_ptr<Oracle> oracle;
};

shapes::Thread thread(double pitch, bool left) {
  return {0.016, pitch, left, 48, 2};
}
TriangleMesh bolt_of(double pitch, bool left = false) {
  shapes::Bolt b;
  b.thread = thread(pitch, left);
  b.length = 0.016;
  return shapes::bolt(b);
}
TriangleMesh nut_of(double pitch, bool left = false, double play = 1e-4) {
  shapes::Nut n;
  n.thread = thread(pitch, left);
  n.height = 0.006;
  n.play = play;
  return shapes::nut(n);
}
TriangleMesh peg_of(double diameter) {
  return shapes::peg({diameter, 0.03, 0.0005, 48, 6});
}
TriangleMesh hole_of() {
  shapes::Block b;
  b.segments = 48;
  b.rings = 6;
  return shapes::block_with_hole(b);
}

/// File frames that are not those of the axes.
const Pose kTurned{rotation(Vec3(0.4, -0.3, 0.9)), Vec3(0.02, 0.05, -0.03)};

std::vector<Fit> fits() {
  std::vector<Fit> out;
  const auto add = [&](const char* name, const TriangleMesh& a, const TriangleMesh& b, const Pose& mated, double pitch,
                       double play, bool mates, const std::vector<double>& at = {0}) {
    Fit f;
    f.name = name;
    const MeshPtr ma = mesh_of(placed(a, kTurned)), mb = mesh_of(b);
    f.a = std::make_shared<const PatchTree>(ma);
    f.b = std::make_shared<const PatchTree>(mb);
    f.mated = mated * kTurned.inverse();
    f.pitch = pitch;
    f.play = play;
    f.mates = mates;
    f.oracle = std::make_unique<Oracle>(ma, mb);
    // Known axes: what is proved does not depend on how they are found.
    const double rise = pitch / (2 * kPi);
    for (const double x : at) {
      ScrewAxis of_a, of_b;
      of_a.origin = kTurned * Vec3(x, 0, 0.001);
      of_a.direction = kTurned.q * Vec3::UnitZ();
      of_b.origin = Vec3(x, 0, -0.002);
      for (const double y : at) {
        of_b.origin.x() = y;
        f.axes.push_back({std::make_shared<const ProfileTree>(*f.a, ScrewFrame::of(of_a, rise)),
                          std::make_shared<const ProfileTree>(*f.b, ScrewFrame::of(of_b, rise))});
      }
    }
    out.push_back(std::move(f));
  };
  const Pose on_bolt{Quat::Identity(), Vec3(0, 0, 0.004)}, in_hole{Quat::Identity(), Vec3(0, 0, -0.02)};
  const Pose upside_down{rotation(Vec3(kPi, 0, 0)), Vec3(0, 0, 0.010)};
  add("nut", nut_of(0.002), bolt_of(0.002), on_bolt, 0.002, 1e-4, true);
  add("nut upside down", nut_of(0.002), bolt_of(0.002), upside_down, 0.002, 1e-4, true);
  add("left-hand nut", nut_of(0.002, true), bolt_of(0.002, true), on_bolt, -0.002, 1e-4, true);
  add("fine nut, tight", nut_of(0.001, false, 1e-5), bolt_of(0.001), on_bolt, 0.001, 1e-5, true);
  add("left-hand nut on a right-hand bolt", nut_of(0.002, true), bolt_of(0.002), on_bolt, 0.002, 1e-4, false);
  add("nuts of unlike pitch", nut_of(0.001), bolt_of(0.002), on_bolt, 0.002, 1e-4, false);
  add("nut taken for a ring", nut_of(0.002), bolt_of(0.002), on_bolt, 0, 1e-4, false);
  add("nut with a wrong rise", nut_of(0.002), bolt_of(0.002), on_bolt, 0.0019, 1e-4, false);
  add("peg 0.99", peg_of(0.0198), hole_of(), in_hole, 0, 1e-4, true);
  add("peg 0.999", peg_of(0.01998), hole_of(), in_hole, 0, 1e-5, true);
  std::vector<std::pair<double, double>> outer{{0, -0.02}}, inner{{0.0038, -0.022}};
  line(outer, 0.004, -0.02, 1);
  line(outer, 0.009, 0.005, 10);
  line(outer, 0, 0.005, 1);
  line(inner, 0.0094, 0.006, 10);
  line(inner, 0.02, 0.006, 1);
  line(inner, 0.02, -0.022, 1);
  line(inner, 0.0038, -0.022, 1);
  add("cone in a cone", *revolve(outer, 60), *revolve(inner, 64), Pose{Quat::Identity(), Vec3(0, 0, 0.001)}, 0, 2e-4,
      true);
  const Pose left{Quat::Identity(), Vec3(-0.04, 0, 0)}, right{Quat::Identity(), Vec3(0.04, 0, 0)};
  add("two pegs", together(placed(peg_of(0.0198), left), placed(peg_of(0.0198), right)),
      together(placed(hole_of(), left), placed(hole_of(), right)), in_hole, 0, 1e-4, true, {-0.04, 0.04});
  return out;
}

/// A pose about the mated one and a motion from it: along the common axis, about it, and askew by some plays.
struct Trial {
  Pose X;
  Displacement d;
};

Trial random_trial(std::mt19937& rng, const Fit& fit, const Vec3& center) {
  Trial t;
  const double turn = uniform(rng, -kPi, kPi), askew = fit.play * std::pow(10.0, uniform(rng, -2, 0.6));
  const Vec3 shift = random_in_ball(rng, askew), tilt = random_in_ball(rng, askew / 0.008);
  Pose X = fit.mated;
  X = Pose{rotation(Vec3(0, 0, turn)), Vec3(0, 0, fit.pitch * turn / (2 * kPi))} * X;
  X = Pose{rotation(tilt), shift} * X;
  t.X = X;
  const double size = fit.play * std::pow(10.0, uniform(rng, -2, 1));
  const double spin = rng() % 2 == 0 ? uniform(rng, -0.2, 0.2) : 0;
  const Vec3 way = random_in_ball(rng, size), lean = random_in_ball(rng, size / 0.01);
  const Pose end =
      Pose{rotation(lean), way} * (Pose{rotation(Vec3(0, 0, spin)), Vec3(0, 0, fit.pitch * spin / (2 * kPi))} * X);
  t.d = displacement(X, end, center);
  if (rng() % 4 == 0) t.d = Displacement{};
  return t;
}

using Faces = std::vector<std::uint32_t>;

/// Do triangles of the two patches meet at one of n + 1 poses of either reading of the path?
bool patches_meet(const Fit& f, const Faces& fa, const Faces& fb, const Trial& t, const Vec3& center, int n) {
  const Pose end = displaced(t.X, center, t.d);
  for (int i = 0; i <= n; ++i) {
    const double s = 1.0 * i / n;
    Pose P = displaced(t.X, center, s * t.d);
    for (const bool by_origin : {false, true}) {
      if (by_origin) P.p = t.X.p + s * (end.p - t.X.p);
      for (const std::uint32_t a : fa) {
        const Corners ca{P * f.a->corner(a, 0), P * f.a->corner(a, 1), P * f.a->corner(a, 2)};
        for (const std::uint32_t b : fb)
          if (triangles_meet(ca, {f.b->corner(b, 0), f.b->corner(b, 1), f.b->corner(b, 2)})) return true;
      }
    }
  }
  return false;
}

struct Count {
  long asked = 0, separate = 0, met = 0, wrong = 0;

  void operator+=(const Count& more) {
    asked += more.asked;
    separate += more.separate;
    met += more.met;
    wrong += more.wrong;
  }
};

/// Pairs of patches that a front by planes has near each other, asked by the curved certificate alone.
Count ask_pairs(const Fit& fit, std::mt19937& rng, long wanted) {
  Count count;
  PatchFront flat(FrontCapacity{1u << 16, 32, 0});
  CurvedPairs curved(16, kMaxAxisPairs);
  const Vec3 center = fit.a->origin() + Vec3(0.002, -0.001, 0.003);
  while (count.asked < wanted) {
    const Trial t = random_trial(rng, fit, center);
    flat.attach(*fit.a, center, *fit.b);
    flat.certify(t.X, t.d, {4000, 32});
    curved.attach(&fit.axes);
    const Sweep sweep(t.X, t.d, center, *fit.b, fit.a->radius() + (fit.a->origin() - center).norm(), 0);
    curved.begin(*fit.a, center, *fit.b, sweep);
    std::vector<std::array<std::uint32_t, 2>> pairs;
    flat.for_each_pair([&](std::uint32_t a, bool face_a, std::uint32_t b, bool face_b) {
      if (!face_a && !face_b) pairs.push_back({a, b});
    });
    std::shuffle(pairs.begin(), pairs.end(), rng);
    int of_this = 0;
    for (const auto& [a, b] : pairs) {
      const Faces fa = faces_under(*fit.a, a, false), fb = faces_under(*fit.b, b, false);
      if (fa.size() * fb.size() > 256 || ++of_this > 40) continue;
      ++count.asked;
      if (!curved.separate(a, b, 0)) {
        if (count.asked % 8 == 0) count.met += patches_meet(fit, fa, fb, t, center, 2);
        continue;
      }
      ++count.separate;
      count.wrong += patches_meet(fit, fa, fb, t, center, 4);
    }
    if (pairs.empty()) ++count.asked;
  }
  return count;
}

/// Whole motions, by planes alone and with curves.
struct Compared {
  long asked = 0, both = 0, none = 0, only_flat = 0, only_curved = 0, wrong = 0;
  double flat_pairs = 0, curved_pairs = 0;
};

Compared compare(const Fit& fit, std::mt19937& rng, long wanted, double clearance) {
  Compared c;
  PatchFront flat(FrontCapacity{1u << 17, 32, 0}), curved(FrontCapacity{1u << 17, 32, 1u << 12});
  const Vec3 center = fit.a->origin() + Vec3(0.002, -0.001, 0.003);
  flat.attach(*fit.a, center, *fit.b);
  curved.attach(*fit.a, center, *fit.b, &fit.axes);
  flat.set_clearance(clearance);
  curved.set_clearance(clearance);
  while (c.asked < wanted) {
    const Trial t = random_trial(rng, fit, center);
    if (rng() % 8 == 0) {
      flat.attach(*fit.a, center, *fit.b);
      curved.attach(*fit.a, center, *fit.b, &fit.axes);
    }
    ++c.asked;
    const CertifyReport f = flat.certify(t.X, t.d, {1 << 20, 1}), q = curved.certify(t.X, t.d, {1 << 20, 1});
    const bool by_planes = f.status == CertifyStatus::certified, by_curves = q.status == CertifyStatus::certified;
    c.both += by_planes && by_curves;
    c.none += !by_planes && !by_curves;
    c.only_flat += by_planes && !by_curves;
    c.only_curved += !by_planes && by_curves;
    if (by_planes && by_curves) c.flat_pairs += f.pairs, c.curved_pairs += q.pairs;
    // What both say is asked now and then, what only curves say always, and densely.
    if (by_curves && (!by_planes || c.asked % 4 == 0))
      c.wrong += fit.oracle->hits(t.X, center, t.d, by_planes ? 4 : 64) > 0;
  }
  return c;
}

void check_pairs(long each) {
  std::mt19937 rng(101);
  long separate = 0, met = 0;
  for (const Fit& fit : fits()) {
    Count count = ask_pairs(fit, rng, each);
    // Of a cone in a cone one pair in two thousand is apart about its axis.
    for (int more = 0; fit.mates && count.separate == 0 && more < 9; ++more) count += ask_pairs(fit, rng, each);
    CAPTURE(fit.name, count.asked, count.separate, count.met);
    CHECK(count.wrong == 0);
    if (fit.mates) CHECK(count.separate > 0);
    separate += count.separate;
    met += count.met;
  }
  CHECK(separate > each);
  CHECK(met > 0);
}

void check_motions(long each) {
  std::mt19937 rng(103);
  long both = 0, none = 0, only_flat = 0;
  int fewer = 0;
  for (const Fit& fit : fits()) {
    const Compared c = compare(fit, rng, each, rng() % 2 == 0 ? 0 : 1.1e-6);
    CAPTURE(fit.name, c.asked, c.both, c.none, c.only_flat, c.only_curved);
    CHECK(c.wrong == 0);
    both += c.both;
    none += c.none;
    only_flat += c.only_flat;
    fewer += fit.mates && c.curved_pairs < 0.7 * c.flat_pairs;
  }
  CHECK(fewer >= 4);
  CHECK(10 * both > 3 * each);
  CHECK(10 * none > 3 * each);
  // Boxes and triangles are asked where bands say nothing, so nothing is lost but luck with halved times.
  CHECK(100 * only_flat <= both);
}

/// Poses on either side of the place where a part begins to touch, still and turning, found by planes alone.
void check_boundary(long each) {
  std::mt19937 rng(107);
  long certified = 0, blocked = 0;
  for (const Fit& fit : fits()) {
    PatchFront flat(FrontCapacity{1u << 17, 32, 0}), curved(FrontCapacity{1u << 17, 32, 1u << 12});
    const Vec3 center = fit.a->origin();
    const auto free = [&](PatchFront& front, const Pose& X, const Displacement& d, bool curves) {
      front.attach(*fit.a, center, *fit.b, curves ? &fit.axes : nullptr);
      return front.certify(X, d, {1 << 20, 1}).status == CertifyStatus::certified;
    };
    for (long i = 0; i < each; ++i) {
      const Trial t = random_trial(rng, fit, center);
      const Vec3 way = random_in_ball(rng, 1), lean = random_in_ball(rng, 50);
      const auto at = [&](double s) { return Pose{rotation(s * lean), s * way} * t.X; };
      double lo = 0, hi = 6 * fit.play;
      if (!free(flat, at(lo), {}, false) || free(flat, at(hi), {}, false)) continue;
      for (int k = 0; k < 30; ++k) {
        const double middle = 0.5 * (lo + hi);
        (free(flat, at(middle), {}, false) ? lo : hi) = middle;
      }
      for (const double e : {-1e-6, -1e-7, -1e-8, -1e-9, 0.0, 1e-9, 1e-8, 1e-7, 1e-6}) {
        const double s = (e < 0 ? lo : hi) + e;
        if (s < 0) continue;
        const Pose X = at(s);
        const bool yes = free(curved, X, {}, true);
        (yes ? certified : blocked) += 1;
        if (yes) CHECK(!fit.oracle->meet(X));
        // Into the place, from outside of it.
        const Displacement d = displacement(at(0), X, center);
        if (free(curved, at(0), d, true)) CHECK(fit.oracle->hits(at(0), center, d, 16) == 0);
      }
    }
  }
  CHECK(certified > each);
  CHECK(blocked > each);
}

struct Cost {
  double pairs = 0, searches = 0;
  int moved = 0, blocked = 0;
};

/// What a front costs whose held part a hand pushes one way for a while, by `size` times 40 µm and 2 mrad, and
/// trembles: it jams, slides and comes free.
Cost cost_of_pushing(const PatchTree& a, const PatchTree& b, const std::vector<AxisPair>* axes, Pose X, int steps,
                     double size = 1) {
  const Vec3 center = a.origin();
  PatchFront front(FrontCapacity{1u << 15, 32, axes == nullptr ? 0 : 1u << 12});
  front.attach(a, center, b, axes);
  front.set_clearance(3e-6);
  std::mt19937 rng(3);
  Cost sum;
  Vec3 way = Vec3::Zero(), turn = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    if (i % 200 == 0) way = random_in_ball(rng, size * 4e-5), turn = random_in_ball(rng, size * 2e-3);
    Displacement d{way + random_in_ball(rng, size * 8e-5), turn + random_in_ball(rng, size * 4e-3)};
    for (int k = 0; k < 4; ++k) {
      const CertifyReport r = front.certify(X, d, {1 << 20, 8});
      sum.pairs += r.pairs;
      sum.searches += r.searches;
      if (r.status == CertifyStatus::certified) {
        X = displaced(X, center, d);
        ++sum.moved;
        break;
      }
      ++sum.blocked;
      d = 0.5 * d;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("patches that curves keep apart do not meet on the way", "[curved]") {
  check_pairs(1000);
}
TEST_CASE("motions that are certified with curves have no intersecting pose", "[curved]") {
  check_motions(30);
}
TEST_CASE("at the boundary of contact curves say nothing wrong", "[curved]") {
  check_boundary(3);
}
TEST_CASE("patches that curves keep apart, at length", "[.long]") {
  check_pairs(100000);
}
TEST_CASE("motions certified with curves, at length", "[.long]") {
  check_motions(3000);
}
TEST_CASE("the boundary of contact, at length", "[.long]") {
  check_boundary(100);
}

TEST_CASE("a front with curves covers everything, answers alike and allocates nothing", "[curved]") {
  const auto all = fits();
  const Fit& fit = all[0];
  const Vec3 center = fit.a->origin();
  const auto run = [&] {
    PatchFront front(FrontCapacity{1u << 14, 32, 64});  // full now and then
    front.attach(*fit.a, center, *fit.b, &fit.axes);
    std::mt19937 rng(11);
    std::vector<int> log;
    std::uint64_t allocations = 0;
    int most = 0;
    for (int i = 0; i < 60; ++i) {
      const Trial t = random_trial(rng, fit, center);
      // Turned over now and then: what was written for the other sense must not be used.
      const Pose X = i % 15 == 14 ? Pose{rotation(Vec3(kPi, 0, 0)), Vec3(0, 0, 0.014)} * t.X : t.X;
      CertifyReport r;
      {
        const AllocGuard guard;
        r = front.certify(X, t.d, {300 + 20 * i, 8});
        allocations += guard.count();
      }
      most = std::max(most, front.curved_pairs());
      log.insert(log.end(),
                 {static_cast<int>(r.status), r.pairs, r.searches, r.splits, r.merges, front.curved_pairs()});
    }
    CHECK(allocations == 0);
    CHECK(most == 64);  // full
    CHECK(covers_once(*fit.a, *fit.b, [&](auto f) { front.for_each_pair(f); }));
    return log;
  };
  CHECK(run() == run());
}

TEST_CASE("threads, pegs and bores are paired about their axes, what does not mate is not", "[curved]") {
  const auto tree = [](const TriangleMesh& m) { return std::make_shared<const PatchTree>(mesh_of(m)); };
  const auto bolt = tree(shapes::bolt({})), nut = tree(shapes::nut({}));
  shapes::Bolt left;
  left.thread.left_hand = true;
  shapes::Bolt fine;
  fine.thread.pitch = 0.001;
  AxisPairing pairing(nut);
  const auto* pairs = pairing.with(bolt);
  REQUIRE(!pairs->empty());
  CHECK(pairs == pairing.with(bolt));
  CHECK(pairs->at(0).a->frame().rise == pairs->at(0).b->frame().rise);
  CHECK(2 * kPi * pairs->at(0).b->frame().rise == Approx(0.002).epsilon(1e-3));
  const auto threads = [](const std::vector<AxisPair>& all) {
    return std::count_if(all.begin(), all.end(), [](const AxisPair& p) { return p.a->frame().rise != 0; });
  };
  CHECK(threads(*pairs) == 1);
  CHECK(threads(*pairing.with(tree(shapes::bolt(left)))) == 0);
  CHECK(threads(*pairing.with(tree(shapes::bolt(fine)))) == 0);
  CHECK(pairing.with(tree(shapes::box({0.04, 0.03, 0.02}, {4, 4, 4})))->empty());
  AxisPairing pegs(tree(peg_of(0.0198)));
  CHECK(pegs.with(tree(hole_of()))->size() == 1);
}

TEST_CASE("a front is in a thread where a nut is on its bolt, not beyond its end, nor in bores", "[curved]") {
  for (const Fit& fit : fits()) {
    if (!fit.mates) continue;
    CAPTURE(fit.name);
    PatchFront front(FrontCapacity{1u << 14, 32, 1u << 12});
    front.attach(*fit.a, fit.a->origin(), *fit.b, &fit.axes);
    CHECK_FALSE(front.in_thread());
    REQUIRE(front.certify(fit.mated, {}, {1 << 20, 8}).status == CertifyStatus::certified);
    CHECK(front.in_thread() == (fit.pitch != 0));
    // All parts are shorter than this.
    const Pose above = Pose{Quat::Identity(), Vec3(0, 0, 0.06)} * fit.mated;
    front.attach(*fit.a, fit.a->origin(), *fit.b, &fit.axes);
    REQUIRE(front.certify(above, {}, {1 << 20, 8}).status == CertifyStatus::certified);
    CHECK_FALSE(front.in_thread());
  }
}

TEST_CASE("a peg that is pressed against its hole costs no more with curves than by planes", "[curved]") {
  const auto tree = [](const TriangleMesh& m) { return std::make_shared<const PatchTree>(mesh_of(m)); };
  const auto peg = tree(peg_of(0.0198)), hole = tree(hole_of());
  AxisPairing pairing(peg);
  const auto cost = [&](const std::vector<AxisPair>* axes) {
    return cost_of_pushing(*peg, *hole, axes, Pose{Quat::Identity(), Vec3(0, 0, -0.01)}, 4000);
  };
  const Cost flat = cost(nullptr), curved = cost(pairing.with(hole));
  CAPTURE(flat.pairs, curved.pairs, flat.searches, curved.searches, flat.moved, curved.moved, flat.blocked,
          curved.blocked);
  CHECK(flat.moved > 1000);
  CHECK(flat.blocked > 1000);
  CHECK(curved.pairs < flat.pairs);
  CHECK(curved.searches < flat.searches);
}

TEST_CASE("a nut turns on its bolt with fewer pairs than their turns have faces", "[curved]") {
  struct Size {
    double pitch, play;
    int segments, rows, starts;
    double chamfer;
  };
  for (const Size& size : {Size{0.002, 1e-4, 96, 4, 1, 0.001}, Size{0.002, 1e-4, 36, 3, 1, 0.001},
                           Size{0.001, 5e-5, 144, 2, 1, 0.0005}, Size{0.002, 1e-4, 72, 6, 2, 0}}) {
    shapes::Bolt bolt;
    bolt.thread.pitch = size.pitch;
    bolt.thread.segments = size.segments;
    bolt.thread.rows = size.rows;
    bolt.thread.starts = size.starts;
    bolt.chamfer = size.chamfer;
    shapes::Nut nut;
    nut.thread = bolt.thread;
    nut.play = size.play;
    nut.chamfer = size.chamfer;
    const auto a = std::make_shared<const PatchTree>(mesh_of(shapes::nut(nut)));
    const auto b = std::make_shared<const PatchTree>(mesh_of(shapes::bolt(bolt)));
    // A turn has a crest, a root and two flanks: were each of them one patch, and each pair asked.
    const double pairs = 4 * nut.height / size.pitch * 4 * bolt.length / size.pitch;
    AxisPairing pairing(a);
    PatchFront front(FrontCapacity{1u << 15, 32, 1u << 12});
    front.attach(*a, a->origin(), *b, pairing.with(b));
    const double lead = size.pitch * size.starts;
    const auto at = [&](double turns) {
      return Pose{rotation(Vec3(0, 0, 2 * kPi * turns)), Vec3(0, 0, 0.012 + lead * turns)};
    };
    for (int i = 0; i < 100; ++i) {
      const Pose X = at(-5e-4 * i);
      const CertifyReport r = front.certify(X, displacement(X, at(-5e-4 * (i + 1)), a->origin()), {1 << 20, 8});
      CAPTURE(size.pitch, size.segments, i, r.pairs, pairs);
      REQUIRE(r.status == CertifyStatus::certified);
      REQUIRE(r.pairs < pairs);
    }
  }
}

TEST_CASE("a nut that is pushed about on its bolt has few of the pairs that planes need", "[curved]") {
  const auto tree = [](const TriangleMesh& m) { return std::make_shared<const PatchTree>(mesh_of(m)); };
  const auto nut = tree(nut_of(0.002)), bolt = tree(bolt_of(0.002));
  AxisPairing pairing(nut);
  const auto cost = [&](const std::vector<AxisPair>* axes) {
    return cost_of_pushing(*nut, *bolt, axes, Pose{Quat::Identity(), Vec3(0, 0, 0.004)}, 1000, 0.2);
  };
  const Cost flat = cost(nullptr), curved = cost(pairing.with(bolt));
  CAPTURE(flat.pairs, curved.pairs, flat.searches, curved.searches, flat.moved, curved.moved, flat.blocked,
          curved.blocked);
  CHECK(flat.moved > 200);
  CHECK(flat.blocked > 200);
  CHECK(curved.pairs < 0.4 * flat.pairs);
  CHECK(curved.searches < flat.searches);
}

TEST_CASE("bursts of a thread whose facets fall into step are spread over the motions before them", "[curved]") {
  shapes::WavyThread outer;
  outer.radius = 0.0046;
  outer.depth = 0.0008;
  outer.pitch = 0.0015;
  outer.segments = 36;
  outer.low = -0.0135;
  shapes::WavyThread inner = outer;
  inner.radius += 1.2e-4;
  inner.low = -0.0045;
  const MeshPtr nut = mesh_of(shapes::nut(inner, 0.008)), screw = mesh_of(shapes::screw(outer));
  const auto a = std::make_shared<const PatchTree>(nut), b = std::make_shared<const PatchTree>(screw);
  AxisPairing pairing(a);
  PatchFront front(FrontCapacity{1u << 15, 32, 1u << 12});
  front.attach(*a, a->origin(), *b, pairing.with(b));
  const Oracle oracle(nut, screw);
  front.set_clearance(3e-6);
  // 42 motions from one facet to the next, with a hand's tremor; down until the flanks stop it.
  std::mt19937 rng(5);
  double down = 5e-5;
  Pose X;
  std::vector<int> all;
  for (int i = 0; i < 500; ++i) {
    const double turn = 2 * kPi * i / (36 * 42);
    const Quat q = rotation(Vec3(0, 0, turn) + random_in_ball(rng, 1e-5));
    const Vec3 helix(0, 0, -0.003 + 0.0015 * turn / (2 * kPi));
    int searches = 0;
    CertifyReport r;
    for (const double more : {4e-6, 0.0, -4e-6, -2e-5}) {
      const Pose next{q, helix - Vec3(0, 0, down + more)};
      if (i == 0) X = next;
      const Displacement d = displacement(X, next, a->origin());
      r = front.certify(X, d, {1 << 20, 8});
      searches += r.searches;
      if (r.status != CertifyStatus::certified) continue;
      if (i % 16 == 0) CHECK(oracle.hits(X, a->origin(), d, 4) == 0);
      X = next;
      down += more;
      break;
    }
    REQUIRE(r.status == CertifyStatus::certified);
    if (i >= 100) all.push_back(searches);
  }
  CHECK(covers_once(*a, *b, [&](auto f) { front.for_each_pair(f); }));
  // Half as many again when nothing is looked at ahead.
  std::sort(all.begin(), all.end());
  const int median = all[all.size() / 2], burst = all[all.size() * 98 / 100];
  CAPTURE(median, burst, all.back());
  CHECK(median > 200);
  CHECK(burst < 5 * median);
}
