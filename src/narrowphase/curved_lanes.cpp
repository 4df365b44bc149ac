#include "narrowphase/curved_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/numbers.hpp"
#include "curve/curved_gap.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

using curve::Lane;
using curve::LaneInMemory;
using curve::Piece;

/// Wider arcs count as whole circles (half of the arc, rad): the bound over an arc needs less than a quarter turn.
constexpr double kWidestArc = 1.5;

std::array<double, kCurvedFields> fields_of(const ProfileBox& a) {
  const double r_lo = a.r_lo, r_hi = a.r_hi, r = 0.5 * (r_lo + r_hi), half = a.half, azimuth = a.azimuth;
  std::array<double, kCurvedFields> f;
  f[kCurvedZLow] = a.z_lo;
  f[kCurvedZHigh] = a.z_hi;
  f[kCurvedR] = r;
  f[kCurvedRHalf] = std::max(r_hi - r, r - r_lo);
  f[kCurvedRLow] = r_lo;
  f[kCurvedRHigh] = r_hi;
  f[kCurvedInverse] = 1 / r;
  f[kCurvedInverseLow] = 1 / r_lo;
  f[kCurvedCos] = std::cos(azimuth);
  f[kCurvedSin] = std::sin(azimuth);
  f[kCurvedCosHalf] = half < kWidestArc ? std::cos(half) : -1;
  f[kCurvedSinHalf] = std::sin(std::min(half, kWidestArc));
  return f;
}

Piece<double> piece_of(const std::array<double, kCurvedFields>& f) {
  return {f[kCurvedZLow], f[kCurvedZHigh], f[kCurvedR],       f[kCurvedRHalf],
          f[kCurvedRLow], f[kCurvedRHigh], f[kCurvedInverse], f[kCurvedInverseLow],
          f[kCurvedCos],  f[kCurvedSin],   f[kCurvedCosHalf], f[kCurvedSinHalf]};
}

std::array<double, kSideFields> side_of(const ProfileBox& a, const ProfileBox& b, double rise,
                                        const CurvedChoice& choice, int i) {
  const CurvedChoice::Side& side = choice.side[i];
  const int k = side.direction;
  const ProfileDirections& d = profile_directions();
  std::array<double, kSideFields> f;
  f[kSideAlpha] = side.sign * d.c[k];
  f[kSideBeta] = side.sign * d.s[k];
  f[kSideBase] = side.sign > 0 ? static_cast<double>(a.lo[k]) - b.hi[k] : static_cast<double>(b.lo[k]) - a.hi[k];
  // The copy of B is one pitch on for the side that has A before all later ones.
  if (rise != 0) f[kSideBase] -= f[kSideBeta] * 2 * kPi * std::abs(rise) * (choice.turns + i);
  return f;
}

TEGOTAE_INLINE Piece<Lane> load_piece(const double* block) {
  const auto at = [block](std::size_t k) __attribute__((always_inline)) {
    return *reinterpret_cast<const LaneInMemory*>(block + k * kCurvedLanes);
  };
  return {at(kCurvedZLow), at(kCurvedZHigh), at(kCurvedR),       at(kCurvedRHalf),
          at(kCurvedRLow), at(kCurvedRHigh), at(kCurvedInverse), at(kCurvedInverseLow),
          at(kCurvedCos),  at(kCurvedSin),   at(kCurvedCosHalf), at(kCurvedSinHalf)};
}

/// Margins along all directions of one pair, A beyond B (`plus`) or before it (`minus`), B where it is.
struct Margins {
  static constexpr std::size_t kRows = 16;
  alignas(64) std::array<double, kRows> plus, minus;
};

TEGOTAE_WIDE void all_margins(const std::array<double, kCurvedFields>& f, const double* c, const double* s,
                              const double* beyond, const double* before, const AxisMotion& m, Margins& out) {
  const Lane one = Lane{} + 1.0;
  const Piece<Lane> a{one * f[kCurvedZLow], one * f[kCurvedZHigh], one * f[kCurvedR],       one * f[kCurvedRHalf],
                      one * f[kCurvedRLow], one * f[kCurvedRHigh], one * f[kCurvedInverse], one * f[kCurvedInverseLow],
                      one * f[kCurvedCos],  one * f[kCurvedSin],   one * f[kCurvedCosHalf], one * f[kCurvedSinHalf]};
  const auto p0 = curve::posed(a, m.start), p1 = curve::posed(a, m.end);
  for (std::size_t k = 0; k < Margins::kRows; k += kCurvedLanes) {
    const Lane alpha = *reinterpret_cast<const LaneInMemory*>(c + k),
               beta = *reinterpret_cast<const LaneInMemory*>(s + k);
    const Lane far = *reinterpret_cast<const LaneInMemory*>(beyond + k),
               near = *reinterpret_cast<const LaneInMemory*>(before + k);
    *reinterpret_cast<LaneInMemory*>(out.plus.data() + k) = curve::margin_of(a, p0, p1, m, alpha, beta, far);
    *reinterpret_cast<LaneInMemory*>(out.minus.data() + k) = curve::margin_of(a, p0, p1, m, -alpha, -beta, near);
  }
}

Margins margins_of(const ProfileBox& a, const ProfileBox& b, const AxisMotion& m) {
  alignas(64) std::array<double, Margins::kRows> c{}, s{}, beyond, before;
  beyond.fill(-1);
  before.fill(-1);
  const ProfileDirections& d = profile_directions();
  for (int k = 0; k < kProfileDirections; ++k) {
    c[k] = d.c[k];
    s[k] = d.s[k];
    beyond[k] = static_cast<double>(a.lo[k]) - b.hi[k];
    before[k] = static_cast<double>(b.lo[k]) - a.hi[k];
  }
  Margins out;
  all_margins(fields_of(a), c.data(), s.data(), beyond.data(), before.data(), m, out);
  return out;
}

/// The best of all directions where B has no copies.
std::optional<CurvedChoice> separate_turned(const Margins& margins, double spare) {
  CurvedChoice::Side side;
  double best = spare;
  bool found = false;
  for (int k = 0; k < kProfileDirections; ++k) {
    for (const int sign : {1, -1}) {
      const double margin = sign > 0 ? margins.plus[k] : margins.minus[k];
      if (!(margin > best)) continue;
      best = margin;
      side = {static_cast<std::int8_t>(k), static_cast<std::int8_t>(sign)};
      found = true;
    }
  }
  if (!found) return std::nullopt;
  return CurvedChoice{{side, side}, 0};
}

/// The best direction that has A beyond the copies up to `turns` and the best that has it before the later ones.
std::optional<CurvedChoice> separate_between(const Margins& margins, double pitch, double turns, double spare) {
  const ProfileDirections& d = profile_directions();
  CurvedChoice choice;
  choice.turns = turns;
  double beyond = spare, before = spare;
  bool is_beyond = false, is_before = false;
  for (int k = 0; k < kProfileDirections; ++k) {
    const double plus = margins.plus[k] - d.s[k] * pitch * turns;
    const double minus = margins.minus[k] + d.s[k] * pitch * (turns + 1);
    if (plus > beyond) beyond = plus, is_beyond = true, choice.side[0] = {static_cast<std::int8_t>(k), 1};
    if (minus > before) before = minus, is_before = true, choice.side[1] = {static_cast<std::int8_t>(k), -1};
  }
  if (!is_beyond || !is_before) return std::nullopt;
  return choice;
}

}  // namespace

std::optional<CurvedChoice> separate_curved(const ProfileBox& a, const ProfileBox& b, const AxisMotion& m,
                                            double spare) {
  const Margins margins = margins_of(a, b, m);
  if (m.rise == 0) return separate_turned(margins, spare);
  // Across the axis all copies are alike.
  for (const int sign : {1, -1}) {
    if (!((sign > 0 ? margins.plus[0] : margins.minus[0]) > spare)) continue;
    const CurvedChoice::Side side{0, static_cast<std::int8_t>(sign)};
    return CurvedChoice{{side, side}, 0};
  }
  const double pitch = 2 * kPi * std::abs(m.rise);
  constexpr int kAlong = kProfileDirections / 2;
  const double between =
      0.5 * (static_cast<double>(a.lo[kAlong]) + a.hi[kAlong] - b.lo[kAlong] - b.hi[kAlong]) + m.end.shift;
  const double first = std::floor(between / pitch);
  for (const double turns : {first, first - 1, first + 1}) {
    // A's middle can be a little outside of the two copies that it is between, no more.
    constexpr double kOutside = 0.25;
    if (std::abs(between / pitch - turns - 0.5) > 0.5 + kOutside) continue;
    if (const auto choice = separate_between(margins, pitch, turns, spare)) return choice;
  }
  return std::nullopt;
}

double curved_margin(const ProfileBox& a, const ProfileBox& b, const AxisMotion& m, const CurvedChoice& choice) {
  const Piece<double> piece = piece_of(fields_of(a));
  const auto p0 = curve::posed(piece, m.start), p1 = curve::posed(piece, m.end);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 2; ++i) {
    const auto f = side_of(a, b, m.rise, choice, i);
    least = std::min(least, curve::margin_of(piece, p0, p1, m, f[kSideAlpha], f[kSideBeta], f[kSideBase]));
  }
  return least;
}

CurvedBlocks::CurvedBlocks(std::size_t capacity) {
  const std::size_t blocks = std::max<std::size_t>(1, (capacity + kCurvedLanes - 1) / kCurvedLanes);
  data_.reset(static_cast<double*>(std::aligned_alloc(64, blocks * kBlock * sizeof(double))));
  if (!data_) throw std::bad_alloc();
  std::fill_n(data_.get(), blocks * kBlock, 1.0);
}

void CurvedBlocks::set(std::size_t slot, const ProfileBox& a, const ProfileBox& b, double rise,
                       const CurvedChoice& choice) {
  const auto f = fields_of(a);
  for (std::size_t k = 0; k < kCurvedFields; ++k) at(slot, k) = f[k];
  for (int i = 0; i < 2; ++i) {
    const auto g = side_of(a, b, rise, choice, i);
    for (std::size_t k = 0; k < kSideFields; ++k)
      at(slot, kCurvedFields + static_cast<std::size_t>(i) * kSideFields + k) = g[k];
  }
}

void CurvedBlocks::move(std::size_t from, std::size_t to) {
  for (std::size_t k = 0; k < kFields; ++k) at(to, k) = at(from, k);
}

void CurvedBlocks::spoil(std::size_t slot) {
  at(slot, static_cast<std::size_t>(kCurvedFields) + static_cast<std::size_t>(kSideBase)) =
      -std::numeric_limits<double>::infinity();
}

TEGOTAE_WIDE std::size_t curved_failures(const CurvedBlocks& pairs, std::size_t end, const AxisMotion& m,
                                         std::uint32_t* failed) {
  std::size_t n = 0;
  for (std::size_t slot = 0; slot < end; slot += kCurvedLanes) {
    const double* block = pairs.block(slot);
    const Piece<Lane> a = load_piece(block);
    const auto p0 = curve::posed(a, m.start), p1 = curve::posed(a, m.end);
    const auto side = [&](std::size_t i) __attribute__((always_inline)) {
      const double* f = block + (kCurvedFields + i * kSideFields) * kCurvedLanes;
      const auto at = [f](std::size_t k) __attribute__((always_inline)) {
        return *reinterpret_cast<const LaneInMemory*>(f + k * kCurvedLanes);
      };
      return curve::margin_of(a, p0, p1, m, at(kSideAlpha), at(kSideBeta), at(kSideBase));
    };
    const Lane margin = curve::lesser(side(0), side(1));
    for (std::size_t i = 0; i < kCurvedLanes && slot + i < end; ++i) {
      failed[n] = static_cast<std::uint32_t>(slot + i);
      n += !(margin[i] > 0);
    }
  }
  return n;
}

}  // namespace tegotae
