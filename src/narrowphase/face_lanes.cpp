#include "narrowphase/face_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/box_overlap.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

/// Rounding of a gap in single precision, as a share of the sum of all coordinates that it comes from: two dozen
/// operations and numbers that were rounded, of 6e-8 each, along normals that are no axes.
constexpr float kGapError = 5e-6F;

/// Boxes are grown by this share of the coordinates that they come from, in single precision.
constexpr float kBoxError = 1e-6F;

/// Conditions on vectors longer than a register would go number by number.
constexpr std::uint32_t kLane = 8;
typedef float Lane __attribute__((vector_size(kLane * sizeof(float)), may_alias));
typedef EightBits LaneBits;
static_assert(kBlockFaces == 2 * kLane);

typedef std::array<float, 3> Float3;

struct Lanes3 {
  Lane x, y, z;
};

// No lambda gives a lane back: it would be compiled for other registers than its caller, unless it is inlined.

TEGOTAE_INLINE Lane load(const FaceLanes::Field& field, std::uint32_t first) {
  return *reinterpret_cast<const Lane*>(field.data() + first);
}
TEGOTAE_INLINE Lanes3 load3(const std::array<FaceLanes::Field, 3>& f, std::uint32_t first) {
  return {load(f[0], first), load(f[1], first), load(f[2], first)};
}
TEGOTAE_INLINE Lane lesser(Lane a, Lane b) {
  return a < b ? a : b;
}
TEGOTAE_INLINE Lane greater(Lane a, Lane b) {
  return a > b ? a : b;
}
TEGOTAE_INLINE Lane dot(const Lanes3& a, const Float3& b) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}

TEGOTAE_INLINE void store(FaceLanes::Field& field, std::uint32_t first, Lane x) {
  *reinterpret_cast<Lane*>(field.data() + first) = x;
}

TEGOTAE_INLINE void store3(std::array<FaceLanes::Field, 3>& f, std::uint32_t first, const Lanes3& x) {
  store(f[0], first, x.x);
  store(f[1], first, x.y);
  store(f[2], first, x.z);
}

/// One of the faces, as it is asked about.
struct OneFace {
  static constexpr std::size_t kCorners = 6;
  const MovedLanes& of;
  std::uint32_t k;

  TEGOTAE_INLINE float corner(std::size_t c, std::size_t i) const { return of.corner[c][i][k]; }
  TEGOTAE_INLINE float normal(std::size_t i) const { return of.normal[i][k]; }
  TEGOTAE_INLINE float normal_low() const { return of.normal_low[k]; }
  TEGOTAE_INLINE float normal_high() const { return of.normal_high[k]; }
  TEGOTAE_INLINE float low(std::size_t i) const { return of.low[i][k]; }
  TEGOTAE_INLINE float high(std::size_t i) const { return of.high[i][k]; }
};

struct OneBox {
  static constexpr std::size_t kCorners = 16;
  const MovedBox& of;

  TEGOTAE_INLINE float corner(std::size_t c, std::size_t i) const { return of.corner[c][i]; }
  TEGOTAE_INLINE float normal(std::size_t i) const { return of.normal[i]; }
  TEGOTAE_INLINE float normal_low() const { return of.normal_low; }
  TEGOTAE_INLINE float normal_high() const { return of.normal_high; }
  TEGOTAE_INLINE float low(std::size_t i) const { return of.low[i]; }
  TEGOTAE_INLINE float high(std::size_t i) const { return of.high[i]; }
};

/// The greatest of the gaps along the axes between `a` and eight faces of `b`.
template <typename One>
TEGOTAE_INLINE Lane axis_gaps(const One& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  Lane gap = greater(load(b.low[0], first) - (a.high(0) + shift[0]), (a.low(0) + shift[0]) - load(b.high[0], first));
  for (std::size_t i = 1; i < 3; ++i) {
    gap = greater(gap, load(b.low[i], first) - (a.high(i) + shift[i]));
    gap = greater(gap, (a.low(i) + shift[i]) - load(b.high[i], first));
  }
  return gap;
}

template <typename One>
TEGOTAE_INLINE Lane along_corner(const Lanes3& n, const One& a, std::size_t c) {
  return n.x * a.corner(c, 0) + n.y * a.corner(c, 1) + n.z * a.corner(c, 2);
}

/// The same along the normals of both.
template <typename One>
TEGOTAE_INLINE Lane plane_gaps(const One& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  const Float3 along = {a.normal(0), a.normal(1), a.normal(2)};
  const float up = along[0] * shift[0] + along[1] * shift[1] + along[2] * shift[2];
  const Lane p = dot(load3(b.corner[0], first), along), q = dot(load3(b.corner[1], first), along),
             r = dot(load3(b.corner[2], first), along);
  const Lane gap =
      greater((a.normal_low() + up) - greater(greater(p, q), r), lesser(lesser(p, q), r) - (a.normal_high() + up));
  const Lanes3 n = load3(b.normal, first);
  Lane low = along_corner(n, a, 0), high = low;
  for (std::size_t c = 1; c < One::kCorners; ++c) {
    const Lane x = along_corner(n, a, c);
    low = lesser(low, x);
    high = greater(high, x);
  }
  const Lane moved = dot(n, shift);
  return greater(gap, greater(low + moved - load(b.normal_high, first), load(b.normal_low, first) - (high + moved)));
}

/// A direction that may keep a face apart from others, and where the face is along it.
struct Along {
  Float3 n;
  float low, high;
};

template <typename One>
TEGOTAE_INLINE Along along(const Float3& n, const One& a) {
  Along out{n, 0, 0};
  for (std::size_t c = 0; c < One::kCorners; ++c) {
    const float x = n[0] * a.corner(c, 0) + n[1] * a.corner(c, 1) + n[2] * a.corner(c, 2);
    out.low = c == 0 ? x : std::min(out.low, x);
    out.high = c == 0 ? x : std::max(out.high, x);
  }
  return out;
}

/// The gap along it to eight faces of `b`.
TEGOTAE_INLINE Lane gaps_along(const Along& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  const float up = a.n[0] * shift[0] + a.n[1] * shift[1] + a.n[2] * shift[2];
  const Lane p = dot(load3(b.corner[0], first), a.n), q = dot(load3(b.corner[1], first), a.n),
             r = dot(load3(b.corner[2], first), a.n);
  return greater((a.low + up) - greater(greater(p, q), r), lesser(lesser(p, q), r) - (a.high + up));
}

/// A bit for each face of `b` that has less than `floor`. Both halves go together: one by one, as many branches would
/// be guessed wrongly again.
template <typename One>
TEGOTAE_INLINE std::uint32_t gaps_below(const One& a, const Along& guess, const FaceLanes& b, const Float3& shift,
                                        float floor) {
  LaneBits one = (LaneBits)(axis_gaps(a, b, 0, shift) < floor),
           other = (LaneBits)(axis_gaps(a, b, kLane, shift) < floor);
  if (together(one | other) == 0) return 0;
  one &= (LaneBits)(plane_gaps(a, b, 0, shift) < floor);
  other &= (LaneBits)(plane_gaps(a, b, kLane, shift) < floor);
  if (together(one | other) == 0) return 0;
  one &= (LaneBits)(gaps_along(guess, b, 0, shift) < floor);
  other &= (LaneBits)(gaps_along(guess, b, kLane, shift) < floor);
  constexpr LaneBits kOf = {1, 2, 4, 8, 16, 32, 64, 128};
  return together((one & kOf) | (other & (kOf << kLane)));
}

TEGOTAE_WIDE std::uint32_t below(const OneFace& a, const FaceLanes& b, const Float3& shift, float floor) {
  return gaps_below(a, Along{}, b, shift, floor);
}

TEGOTAE_WIDE std::uint32_t below(const OneBox& a, const FaceLanes& b, const Float3& shift, float floor) {
  return gaps_below(a, Along{}, b, shift, floor);
}

TEGOTAE_WIDE std::uint32_t next_below(const OneFace& a, const Float3& direction, const BoxLanes* boxes,
                                      const BesideFaces::Block* blocks, std::uint32_t count, std::uint32_t& at) {
  const AxisBox box = {{a.low(0), a.low(1), a.low(2)}, {a.high(0), a.high(1), a.high(2)}};
  const Along guess = along(direction, a);
  for (std::uint32_t first = at / BoxLanes::kBoxes * BoxLanes::kBoxes; first < count; first += BoxLanes::kBoxes) {
    const std::uint32_t bits = overlap(boxes[first / BoxLanes::kBoxes], box);
    for (at = std::max(at, first); at < first + BoxLanes::kBoxes; ++at) {
      if ((bits >> (at - first) & 1) == 0) continue;
      const std::uint32_t open = gaps_below(a, guess, *blocks[at].faces, blocks[at].shift, blocks[at].floor);
      if (open != 0) return open;
    }
  }
  return 0;
}

/// A Placement in single precision.
struct Moved {
  std::array<Float3, 3> R;  ///< rows
  Float3 t;
};

Moved in_single(const Placement& at) {
  Moved out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k) out.R[i][k] = static_cast<float>(at.R(row, static_cast<Eigen::Index>(k)));
    out.t[i] = static_cast<float>(at.t[row]);
  }
  return out;
}

TEGOTAE_WIDE void move_lanes(const FaceLanes& faces, const Moved& start, const Moved& end, MovedLanes& out) {
  for (std::uint32_t first = 0; first < kBlockFaces; first += kLane) {
    const Lanes3 n = load3(faces.normal, first);
    const Lanes3 normal = {dot(n, start.R[0]), dot(n, start.R[1]), dot(n, start.R[2])};
    store3(out.normal, first, normal);
    Lanes3 low{}, high{};
    Lane along_low{}, along_high{};
    for (std::size_t c = 0; c < 6; ++c) {
      const Moved& at = c < 3 ? start : end;
      const Lanes3 p = load3(faces.corner[c % 3], first);
      const Lanes3 x = {dot(p, at.R[0]) + at.t[0], dot(p, at.R[1]) + at.t[1], dot(p, at.R[2]) + at.t[2]};
      const Lane along = normal.x * x.x + normal.y * x.y + normal.z * x.z;
      along_low = c == 0 ? along : lesser(along_low, along);
      along_high = c == 0 ? along : greater(along_high, along);
      low = c == 0 ? x : Lanes3{lesser(low.x, x.x), lesser(low.y, x.y), lesser(low.z, x.z)};
      high = c == 0 ? x : Lanes3{greater(high.x, x.x), greater(high.y, x.y), greater(high.z, x.z)};
      store3(out.corner[c], first, x);
    }
    store(out.normal_low, first, along_low);
    store(out.normal_high, first, along_high);
    store3(out.low, first, low);
    store3(out.high, first, high);
  }
}

/// Directions across edges: of each with each, and across those of both faces in their planes; one is there twice.
constexpr std::uint32_t kAcross = 16;
typedef std::array<FaceLanes::Field, 3> Across;
static_assert(kAcross == kBlockFaces);

/// One of eight directions along which there is at least `floor`; none: kAcross.
TEGOTAE_INLINE std::uint32_t one_apart(const Across& left, const Across& right, std::uint32_t first,
                                       const std::array<Float3, 6>& p, const std::array<Float3, 3>& q, float floor2) {
  const Lanes3 l = load3(left, first), r = load3(right, first);
  const Lanes3 n = {l.y * r.z - l.z * r.y, l.z * r.x - l.x * r.z, l.x * r.y - l.y * r.x};
  Lane low = dot(n, p[0]), high = low;
  for (std::size_t k = 1; k < 6; ++k) {
    const Lane x = dot(n, p[k]);
    low = lesser(low, x);
    high = greater(high, x);
  }
  const Lane x = dot(n, q[0]), y = dot(n, q[1]), z = dot(n, q[2]);
  const Lane gap = greater(low - greater(greater(x, y), z), lesser(lesser(x, y), z) - high);
  const Lane positive = greater(gap, Lane{}), square = positive * positive;
  // Squares below are too near to the least numbers of single precision.
  const Lane least = greater((n.x * n.x + n.y * n.y + n.z * n.z) * floor2, Lane{} + 1e-36F);
  const LaneBits apart = square > least;
  if (together(apart) == 0) return kAcross;
  std::uint32_t k = 0;
  while (apart[k] == 0) ++k;
  return first + k;
}

TEGOTAE_WIDE std::uint32_t across_edges(const Across& left, const Across& right, const std::array<Float3, 6>& p,
                                        const std::array<Float3, 3>& q, float floor2) {
  const std::uint32_t one = one_apart(left, right, 0, p, q, floor2);
  return one < kAcross ? one : one_apart(left, right, kLane, p, q, floor2);
}

Float3 difference(const Float3& x, const Float3& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}

/// Across both, of unit length, about; zero where there is no such direction. Any will do that keeps faces apart.
Float3 across(const Float3& x, const Float3& y) {
  const Float3 n = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  if (!(square > std::numeric_limits<float>::min())) return {0, 0, 0};
  const float scale = 1 / std::sqrt(square);
  return {scale * n[0], scale * n[1], scale * n[2]};
}

Float3 normal_of(const Float3& p, const Float3& q, const Float3& r) {
  return across(difference(q, p), difference(r, p));
}

Float3 in_single(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// With room for the rounding of all that is asked about.
float floor_in_single(float size, const FaceLanes& b, const Vec3& shift, double floor) {
  return static_cast<float>(floor) + kGapError * (size + b.size + static_cast<float>(shift.cwiseAbs().maxCoeff()));
}

}  // namespace

FaceLanes::FaceLanes(const PatchTree& tree, const FaceBlocks& blocks, std::uint32_t block) {
  const AxisBox box = blocks.box(0, block);
  for (std::size_t i = 0; i < 3; ++i)
    origin[static_cast<Eigen::Index>(i)] = 0.5 * (double{box.low[i]} + double{box.high[i]});
  for (std::uint32_t k = 0; k < kBlockFaces; ++k) {
    const std::uint32_t face = blocks.face(block, std::min(k, blocks.faces(block) - 1));
    std::array<Float3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 at = tree.corner(face, static_cast<int>(c)) - tree.origin() - origin;
      p[c] = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())};
    }
    const Float3 n = normal_of(p[0], p[1], p[2]);
    Float3 along{};
    for (std::size_t i = 0; i < 3; ++i) {
      normal[i][k] = n[i];
      for (std::size_t c = 0; c < 3; ++c) {
        corner[c][i][k] = p[c][i];
        along[c] += n[i] * p[c][i];
      }
      low[i][k] = std::min({p[0][i], p[1][i], p[2][i]});
      high[i][k] = std::max({p[0][i], p[1][i], p[2][i]});
      size = std::max({size, -low[i][k], high[i][k]});
    }
    normal_low[k] = std::min({along[0], along[1], along[2]});
    normal_high[k] = std::max({along[0], along[1], along[2]});
  }
}

void MovedLanes::set(const FaceLanes& faces, const Placement& start, const Placement& end) noexcept {
  move_lanes(faces, in_single(start), in_single(end), *this);
  size = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < kBlockFaces; ++k) size = std::max({size, -low[i][k], high[i][k]});
  // What they were before counts as well.
  size = std::max(size, faces.size);
}

MovedBox::MovedBox(const std::array<Vec3, 8>& start, const std::array<Vec3, 8>& end) {
  size = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    corner[c] = {static_cast<float>(start[c].x()), static_cast<float>(start[c].y()), static_cast<float>(start[c].z())};
    corner[8 + c] = {static_cast<float>(end[c].x()), static_cast<float>(end[c].y()), static_cast<float>(end[c].z())};
  }
  normal = normal_of(corner[0], corner[1], corner[2]);
  low = high = corner[0];
  for (std::size_t c = 0; c < 16; ++c) {
    const float along = normal[0] * corner[c][0] + normal[1] * corner[c][1] + normal[2] * corner[c][2];
    normal_low = c == 0 ? along : std::min(normal_low, along);
    normal_high = c == 0 ? along : std::max(normal_high, along);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], corner[c][i]);
      high[i] = std::max(high[i], corner[c][i]);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) size = std::max({size, -low[i], high[i]});
}

void BesideFaces::set(const FaceBlocks& blocks, const std::vector<FaceLanes>& lanes, const std::uint32_t* found,
                      std::uint32_t count, const MovedLanes& a, const Vec3& origin, double floor) noexcept {
  count_ = count;
  const std::uint32_t whole = (count + BoxLanes::kBoxes - 1) / BoxLanes::kBoxes * BoxLanes::kBoxes;
  const Float3 at = in_single(origin);
  for (std::uint32_t i = 0; i < whole; ++i) {
    BoxLanes& out = boxes_[i / BoxLanes::kBoxes];
    const std::uint32_t k = i % BoxLanes::kBoxes;
    const AxisBox box = i < count ? blocks.box(0, found[i]) : AxisBox::empty();
    for (std::size_t c = 0; c < 3; ++c) {
      out.low[c][k] = box.low[c];
      out.high[c][k] = box.high[c];
    }
    if (i >= count) continue;
    const FaceLanes& faces = lanes[found[i]];
    const Vec3 shift = origin - faces.origin;
    blocks_[i] = {&faces, in_single(shift), floor_in_single(a.size, faces, shift, floor)};
    for (std::size_t c = 0; c < 3; ++c) {
      const float slack =
          static_cast<float>(floor) + kBoxError * (std::abs(at[c]) + std::abs(box.low[c]) + std::abs(box.high[c]));
      out.low[c][k] = box.low[c] - at[c] - slack;
      out.high[c][k] = box.high[c] - at[c] + slack;
    }
  }
}

std::uint32_t BesideFaces::next_not_kept_apart(const MovedLanes& a, std::uint32_t k, const Float3& guess,
                                               std::uint32_t& at) const noexcept {
  return next_below(OneFace{a, k}, guess, boxes_.data(), blocks_.data(), count_, at);
}

std::uint32_t not_kept_apart(const MovedLanes& a, std::uint32_t k, const FaceLanes& b, const Vec3& shift,
                             double floor) noexcept {
  return below(OneFace{a, k}, b, in_single(shift), floor_in_single(a.size, b, shift, floor));
}

std::uint32_t not_kept_apart(const MovedBox& a, const FaceLanes& b, const Vec3& shift, double floor) noexcept {
  return below(OneBox{a}, b, in_single(shift), floor_in_single(a.size, b, shift, floor));
}

bool edges_keep_apart(const MovedLanes& a, std::uint32_t k, const FaceLanes& b, std::uint32_t k_b, const Vec3& shift,
                      double floor, Float3& direction) noexcept {
  std::array<Float3, 6> p;
  std::array<Float3, 3> q;
  Float3 normal_a, normal_b;
  for (std::size_t i = 0; i < 3; ++i) {
    normal_a[i] = a.normal[i][k];
    normal_b[i] = b.normal[i][k_b];
    for (std::size_t c = 0; c < 6; ++c)
      p[c][i] = a.corner[c][i][k] + static_cast<float>(shift[static_cast<Eigen::Index>(i)]);
    for (std::size_t c = 0; c < 3; ++c) q[c][i] = b.corner[c][i][k_b];
  }
  alignas(64) Across left, right;
  std::size_t count = 0;
  const auto add = [&](const Float3& x, const Float3& y) {
    for (std::size_t i = 0; i < 3; ++i) {
      left[i][count] = x[i];
      right[i][count] = y[i];
    }
    ++count;
  };
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) add(difference(p[(i + 1) % 3], p[i]), difference(q[(j + 1) % 3], q[j]));
  for (std::size_t i = 0; i < 3; ++i) {
    add(normal_a, difference(p[(i + 1) % 3], p[i]));
    add(normal_b, difference(q[(i + 1) % 3], q[i]));
  }
  add(normal_a, normal_b);
  const float least = floor_in_single(a.size, b, shift, floor);
  const std::uint32_t one = across_edges(left, right, p, q, least * least);
  if (one == kAcross) return false;
  direction = across({left[0][one], left[1][one], left[2][one]}, {right[0][one], right[1][one], right[2][one]});
  return true;
}

}  // namespace tegotae
