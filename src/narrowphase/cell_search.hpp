#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/free_cell.hpp"
#include "narrowphase/near_hulls.hpp"
#include "narrowphase/patch_batches.hpp"

namespace tegotae {

/// Looks for free cells between pieces of A and subtrees of B.
class CellSearch {
 public:
  enum class Outcome : std::uint8_t {
    found,    ///< for the whole motion
    passing,  ///< the motion is free, but no cell says so: to be searched again for the next one
    divide,   ///< not as a whole: the piece of A or the subtree of B is to be taken apart
    blocked   ///< triangles of B, listed, stop the piece, which is a triangle
  };
  struct Query {
    const PatchTree* tree = nullptr;        ///< of B
    const PatchBatches* batches = nullptr;  ///< of `tree`
    std::uint32_t node = 0;                 ///< of `tree`, or face
    bool is_face = false;
    double wanted = 0;                 ///< what is farther from the piece (m) needs no plane
    const CellItems* known = nullptr;  ///< of an earlier search for the piece or for one that it is of; null: none
    bool cells_only = false;           ///< the search ends where something only passes
    double moved = 0;  ///< how far the piece gets at most from where that search looked, by the end of the motion, m
  };

  CellSearch();

  /// Looks for a cell of `a` (`face_of_a`: its corners, A's axes from the center of mass, when it is a triangle)
  /// against the subtree. `cell` is set when found; its margin at the start is margin(), its pieces of B items().
  Outcome find(const MovingHull& a, const std::array<Vec3, 3>* face_of_a, const Query& query, const Sweep& sweep,
               FreeCell& cell) noexcept;

  /// Whether what is under no plane of a cell is `enough` (m) from all that its piece covers between the start and the
  /// end of the motion, by a new look at what may be nearer: pieces of B of `items`, which the search for the cell
  /// listed. `moved` as in a query. If so the distances of `items` are set, and `clear` is how far the rest is.
  bool renew(const MovingHull& a, const PatchTree& tree, double moved, double enough, CellItems& items,
             double& clear) noexcept;

  /// Of the last find(): least distance of the piece at the start from B that was proved, m.
  double margin() const { return std::min(margin_, clear_); }
  /// The same of what its planes stand for, at the nearer end of the motion, m.
  double least() const { return least_; }
  /// Of the last find() that found a cell: at the start.
  CellGaps gaps() const;
  /// Of the last find() that found a cell or says to divide: where to begin the next one.
  const CellItems& items() const { return items_; }
  /// Of the last find(): faces of B that stop the triangle.
  const std::vector<std::uint32_t>& blocking() const { return blocking_; }
  /// Nodes and faces of B measured by all calls.
  std::int64_t visits() const { return visits_; }

 private:
  /// Pieces of B that one search has to do with at most: those that it measures, and those that were listed for it.
  static constexpr std::size_t kMaxVisits = 160, kMaxPieces = kMaxVisits + kMeasured + kCellItems;

  /// One of the normals of a Nearness.
  struct Side {
    float gap, normal;
  };
  /// A piece of B, as in CellItems, and how far it is from the piece of A at the start.
  struct Entry {
    std::uint32_t item;
    float distance;     ///< lower bound, m
    Side any, upright;  ///< see Nearness
    bool is_face() const { return (item & CellItems::kFace) != 0; }
    std::uint32_t place() const { return item & ~CellItems::kFace; }
  };
  /// Pieces of B with a lower bound of their distance (m) each.
  struct List {
    std::size_t count = 0;
    alignas(64) std::array<float, kMaxPieces + kMeasured> distance;
    std::array<std::uint32_t, kMaxPieces + kMeasured> item;
    void add(std::uint32_t which, float far) {
      item[count] = which;
      distance[count++] = far;
    }
  };

  void begin(const Query& query);
  bool has_next();
  void set_frame(const MovingHull& a);
  Outcome settle(const Entry& e);
  Outcome settle_face(const Entry& e, const Hull& b);
  void open(std::uint32_t node);
  /// Measures pieces and puts those within reach on the stack, the nearest last.
  void push(const std::uint32_t* items, int count);
  /// Puts measured pieces within reach on the stack, the nearest last; the others are left out.
  void sort_out(const std::uint32_t* items, int count);
  /// Measures pieces.
  void measure(const std::uint32_t* items, int count);
  /// What was measured of a piece, and at which place.
  const Nearness& nearness(std::uint32_t item) const {
    return (item & CellItems::kFace) != 0 ? near_faces_ : near_boxes_;
  }
  void add_entry(std::uint32_t item, std::size_t lane, std::size_t first);
  Vec3 normal(const Entry& e, const Hull& b, const Side& side) const;
  void leave_out(std::uint32_t item, float far);
  void take_known(const CellItems& known, double moved);
  Hull hull_of(std::uint32_t item) const;
  bool under_known_plane(const Hull& b, double good);
  bool keeps_off(const Hull& b, const Vec3& n, double at_least);
  bool passes(const Hull& b) const;
  bool best_of_all_axes(const Hull& b, Vec3& n) const;
  bool stays_above(const Vec3& n, double low_start, double low_end, double top) const;
  void report_items(bool found);
  void write(FreeCell& cell) const;

  const MovingHull* a_ = nullptr;
  const std::array<Vec3, 3>* face_of_a_ = nullptr;
  const Sweep* sweep_ = nullptr;
  Query query_;
  HullFrame frame_;
  NearHulls boxes_, faces_;
  PatchBatch batch_;  ///< scratch
  Nearness near_boxes_, near_faces_;
  std::array<std::size_t, kMeasured> lane_;  ///< of each piece that was measured, among the boxes or the faces
  KnownPlanes known_;
  std::array<double, kCellPlanes> tops_;
  int planes_ = 0;
  double most_bulge_ = 0;          ///< along any normal, m
  double margin_ = 0, least_ = 0;  ///< of the planes: at the start, and at the nearer end, m
  double clear_ = 0;
  float list_end_ = 0;  ///< what is farther away is in no list, m
  double beyond_ = 0;   ///< what is in no list is at least so far, m
  CellItems items_;
  List near_, far_;       ///< pieces of B that were settled, or are farther away than is wanted
  bool passing_ = false;  ///< there is no cell, but what was looked at passes
  MovingPlane passed_{Vec3::Zero(), Vec3::Zero()};  ///< while passing_: of the last face of B
  bool full_ = false;                               ///< a plane more was needed than a cell has
  std::array<Entry, kMaxPieces> stack_;             ///< the nearest of those that were measured together last
  std::size_t stacked_ = 0;
  List waiting_;  ///< pieces that an earlier search listed and this one has not come to, the nearest last
  std::vector<std::uint32_t> blocking_;
  std::int64_t visits_ = 0;
};

}  // namespace tegotae
