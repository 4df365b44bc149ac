// Places and units of STEP files that OpenCASCADE reads otherwise than ISO 10303 means them. What is right comes from
// closed forms: where the frame of a part comes to lie on another, corner by corner.
#include <array>
#include <random>

#include "mesh/step_blocks.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

using Frame = Eigen::Isometry3d;

Frame random_frame(std::mt19937& rng) {
  std::uniform_real_distribution<double> place(-50, 50), share(-1, 1);
  Frame X = Frame::Identity();
  const Eigen::Quaterniond q(share(rng), share(rng), share(rng), share(rng));
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() = Vec3(place(rng), place(rng), place(rng));
  return X;
}

/// An AXIS2_PLACEMENT_3D of a frame in mm, told in units of `unit` mm.
int placement(StepText& s, const Frame& X, double unit = 1) {
  const Vec3 p = X.translation() / unit, z = X.linear().col(2), x = X.linear().col(0);
  return s.frame(s.point(p.x(), p.y(), p.z()), s.direction(z.x(), z.y(), z.z()), s.direction(x.x(), x.y(), x.z()));
}

/// Around StepText::block() moved by `X`, m.
Eigen::AlignedBox3d moved_block(const Frame& X) {
  Eigen::AlignedBox3d box;
  for (int i = 0; i < 8; ++i) box.extend(1e-3 * (X * Vec3(i & 1 ? 40 : 0, i & 2 ? 30 : 0, i & 4 ? 10 : 0)));
  return box;
}

void check_placed(const Assembly& a, const Frame& X) {
  REQUIRE(a.parts.size() == 1);
  const Eigen::AlignedBox3d box = moved_block(X);
  check_box(box_of(a, 0), box.min(), box.max(), 1e-6);  // to_string() gives six places
  CHECK(a.notes.empty());
}

/// The block as a product in another, its frame `from` on `to`, which is told in units of `unit` mm.
StepText placed(const Frame& from, const Frame& to, double unit = 1, bool exchanged = false) {
  StepText s;
  const int part = s.product("plate"), own = placement(s, from);
  const int shown = s.shape(part, {own, s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  if (unit != 1) s.set_unit("$");
  const int top = s.product("all"), on = placement(s, to, unit), all = s.shape(top, {s.origin(), on});
  s.instance(part, shown, exchanged ? on : own, top, all, exchanged ? own : on, "plate");
  return s;
}

/// The block in a representation whose frame `from` a mapped item brings to lie on `to`; that once more by another one.
StepText mapped(const std::array<Frame, 2>& from, const std::array<Frame, 2>& to) {
  StepText s;
  const int part = s.product("plate");
  int item = s.block();
  for (std::size_t k = 0; k < 2; ++k) {
    const int source = s.representation({item}, k == 0 ? "FACETED_BREP_SHAPE_REPRESENTATION" : "SHAPE_REPRESENTATION");
    const int map = s.add("REPRESENTATION_MAP(" + r(placement(s, from[k])) + "," + r(source) + ")");
    item = s.add("MAPPED_ITEM(''," + r(map) + "," + r(placement(s, to[k])) + ")");
  }
  s.shape(part, {s.origin(), item});
  return s;
}

/// A unit of length that is `size` of the unit `base`.
int unit_of(StepText& s, double size, int base) {
  const int measure = s.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + std::to_string(size) + ")," + r(base) + ")");
  const int exponents = s.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
  return s.add("(CONVERSION_BASED_UNIT('own'," + r(measure) + ")LENGTH_UNIT()NAMED_UNIT(" + r(exponents) + "))");
}

/// The block, with `unit` in the place of its context's unit of length.
std::string block_in(StepText& s, int unit) {
  s.shape(s.product("plate"), {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  std::string text = s.text();
  const std::string list = "GLOBAL_UNIT_ASSIGNED_CONTEXT((";
  const std::size_t at = text.find(list) + list.size();
  return text.replace(at, text.find(',', at) - at, r(unit));
}

}  // namespace

TEST_CASE("STEP: a frame comes to lie on another, wherever both are", "[step]") {
  std::mt19937 rng(20);
  for (int k = 0; k < 3; ++k) {
    INFO(k);
    const Frame from = random_frame(rng), to = random_frame(rng);
    check_placed(read(placed(from, to)), to * from.inverse());
    check_placed(read(placed(from, to, 1000)), to * from.inverse());     // of two units
    check_placed(read(placed(from, to, 1, true)), to * from.inverse());  // exchanged, as some programs write
    const std::array<Frame, 2> first = {from, random_frame(rng)}, second = {to, random_frame(rng)};
    check_placed(read(mapped(first, second)), second[1] * first[1].inverse() * to * from.inverse());
  }
}

TEST_CASE("STEP: the second axis that a frame leaves out is the standard's", "[step]") {
  // By build_axes of ISO 10303-42: x, or y for a frame along x.
  const std::array<std::pair<Vec3, Vec3>, 4> axes = {{{-Vec3::UnitZ(), Vec3::UnitX()},
                                                      {Vec3::UnitX(), Vec3::UnitY()},
                                                      {-Vec3::UnitX(), Vec3::UnitY()},
                                                      {-Vec3::UnitY(), Vec3::UnitX()}}};
  for (const auto& [z, x] : axes) {
    INFO(z.transpose());
    Frame meant = Frame::Identity();
    meant.linear() << x, z.cross(x), z;
    StepText s;
    const int part = s.product("plate"), own = s.origin();
    const int shown = s.shape(part, {own, s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
    const int on =
        s.add("AXIS2_PLACEMENT_3D(''," + r(s.point(0, 0, 0)) + "," + r(s.direction(z.x(), z.y(), z.z())) + ",$)");
    const int top = s.product("all"), all = s.shape(top, {s.origin(), on});
    s.instance(part, shown, own, top, all, on, "plate");
    check_placed(read(s), meant);
  }
}

TEST_CASE("STEP: a frame among the items of a shape moves nothing", "[step]") {
  std::mt19937 rng(21);
  const Frame beside = random_frame(rng), to = random_frame(rng);
  StepText s;
  const int part = s.product("plate");
  const int source = s.representation({s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int map = s.add("REPRESENTATION_MAP(" + r(s.origin()) + "," + r(source) + ")");
  s.shape(part, {placement(s, beside), s.add("MAPPED_ITEM(''," + r(map) + "," + r(placement(s, to)) + ")")});
  check_placed(read(s), to);
}

TEST_CASE("STEP: a unit may be so many of another that is so many of a third", "[step]") {
  // A thou is a thousandth of an inch, here of 2.54 cm.
  StepText s;
  const int centimeter = s.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.))");
  const int thou = unit_of(s, 0.001, unit_of(s, 2.54, centimeter));
  const Assembly a = read_step_text(block_in(s, thou));
  REQUIRE(a.parts.size() == 1);
  check_box(box_of(a, 0), Vec3::Zero(), 25.4e-6 * Vec3(40, 30, 10));
  CHECK(a.notes.empty());
  // One that is so many of itself is none.
  StepText circle;
  const int first = unit_of(circle, 2, 1000);
  std::string text = block_in(circle, first);
  const std::size_t at = text.find("#1000");
  text.replace(at, 5, r(first));
  const Assembly none = read_step_text(text);
  REQUIRE(none.parts.size() == 1);
  check_block(none, 0);
  CHECK(has_note(none, "no unit of length"));
}
