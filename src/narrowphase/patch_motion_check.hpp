#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "narrowphase/axis_pairs.hpp"
#include "narrowphase/backing.hpp"
#include "narrowphase/cell_front.hpp"
#include "narrowphase/facing.hpp"
#include "narrowphase/headway.hpp"
#include "narrowphase/leaving.hpp"
#include "narrowphase/motion_check.hpp"
#include "narrowphase/offered_motions.hpp"
#include "narrowphase/part_bundle.hpp"
#include "narrowphase/patch_front.hpp"
#include "narrowphase/proved_way.hpp"
#include "narrowphase/surface_sweep.hpp"

namespace tegotae {

/// How much is done to prove motions.
enum class ProofEffort : std::uint8_t {
  /// No common axes of the parts are looked for, which takes up to a second for large meshes, and what is not proved in
  /// one round of work by fronts is not proved: enough for motions that stay clear of contact.
  quick,
  full
};

/// The path certificate over the near fixed parts: a motion is free only when its whole path is. A part that meets A in
/// few places has a PatchFront of its own, kept from tick to tick as long as the part stays near; where the pairs of a
/// front would be too many, as between surfaces that lie on each other, and for parts beyond the number of fronts, the
/// CellFront takes over. Where no deadline bounds a check, what a new PatchMotionCheck proves is proved whatever was
/// asked before.
class PatchMotionCheck final : public MotionCheck {
 public:
  /// `fixed` and `poses` by part number; hierarchies are built once for each distinct mesh. `radius` of A about its
  /// center of mass `center` (m, file frame). Parts in `left_out` may be left out of begin() although they are near. So
  /// many `helpers` look at motions as a whole besides (see SurfaceSweep).
  PatchMotionCheck(const std::shared_ptr<const TriangleMesh>& held, const Vec3& center, double radius,
                   const std::vector<std::shared_ptr<const TriangleMesh>>& fixed, std::vector<Pose> poses,
                   const std::vector<std::uint32_t>& left_out, ProofEffort effort = ProofEffort::full, int helpers = 0);

  void begin(const std::vector<std::uint32_t>& near, std::int64_t deadline_ns, OtherParts others) noexcept override;
  void trust_start() noexcept override { trusted_ = true; }
  void jumped() noexcept override;
  void heads(const Heading& heading) noexcept override;
  MotionAnswer check(const Pose& X, const Displacement& d, double clearance,
                     std::vector<FacePair>& blocking) noexcept override;
  void prepare(const Pose& X, const Displacement& next, std::int64_t deadline_ns) noexcept override;
  std::optional<Displacement> instead() const override { return instead_; }
  bool prefers_long() const override { return behind_for_ >= kTicksBehind && (!heading_.touches || stands_still()); }
  bool goes_on() const override { return sweeping_; }
  double progress() const override { return sweeping_ ? sweep_->progress() : 0; }
  double free_share() const override { return share_; }
  MotionAnswer stands(const Pose& X, std::uint32_t part, double clearance, std::int64_t deadline_ns) noexcept override;
  Pose near_contact(const Pose& X, const Displacement&, const std::vector<FacePair>&) noexcept override { return X; }
  double longest_motion() const override;
  bool overflow() const override { return overflow_; }

 private:
  static constexpr std::uint32_t kNobody = 0xffffffffu;
  /// Searches for planes in one check of a front, and of the cells, which bound the work where no deadline does.
  static constexpr int kFrontSearches = 1 << 13, kCellSearches = 1 << 17;
  /// Where cells or fronts were behind in so many ticks in a row, motions through the air are looked at as a whole.
  static constexpr int kTicksBehind = 2;
  /// What has not moved for so many ticks meanwhile has to be looked at as a whole.
  static constexpr int kTicksStill = 8;

  /// What is looked at as a whole goes on for as far as the pen comes in so many ticks, and for this share of the
  /// part's radius at most.
  static constexpr double kSweptTicks = 50, kLongestSweep = 0.5;
  /// A look from beside the pen's way is taken to last for so many ticks at most.
  static constexpr std::uint64_t kMostSoon = 10;
  /// What has come less far stands, and motions of the pen in a tick that are none, m.
  static constexpr double kStill = 1e-6, kStands = 1e-7;

  /// What a near part is certified by.
  enum class Certificate : std::uint8_t {
    front,          ///< where there is one left for it
    cells,          ///< its front was too small or too slow, or it is better cells
    front_for_good  ///< cells were tried in vain
  };

  /// Cells that run out of time again and again.
  struct Vain {
    int cells = 0;                ///< when it began
    std::uint32_t exhausted = 0;  ///< ticks in which they did since
    std::uint64_t last = 0;       ///< the begin() of the last of them
  };

  /// What leaving motions need to know of A and of each part: which way it faces, if it bounds a solid, and a point of
  /// each of its pieces (of A in its file frame, of the others in that of the assembly, m).
  struct Body {
    std::shared_ptr<const Facing> facing;
    std::vector<Vec3> points;
  };
  /// Which of A and a part is outside the other, where the other bounds a solid; the same until A jumps.
  struct Sides {
    bool known = false;
    bool a_outside = false, b_outside = false;
  };

  /// Who brings A on where something touches and the cells are behind: they or looks at all of it, and what both have
  /// brought, m a tick.
  struct Turn {
    bool of_cells = true;
    int ticks = 0, in_a_row = 0;
    double moved = 0, cells_pace = 0, sweeps_pace = 0;
    Pose X;                   ///< of A
    std::uint64_t since = 0;  ///< the begin() of the last tick
  };

  /// How far ahead a front has been asked at rest.
  struct Ahead {
    Pose X;                                                    ///< where
    double proved = 0;                                         ///< all of B is at least so far away, m
    double ceiling = std::numeric_limits<double>::infinity();  ///< and something of it no farther than this, m
    int proved_with_many = 0;  ///< motions that were proved with so many pairs that A could lie on B
  };

  void make_bundle(const std::vector<std::shared_ptr<const TriangleMesh>>& fixed,
                   const std::vector<std::uint32_t>& left_out);
  void make_bodies(const std::shared_ptr<const TriangleMesh>& held,
                   const std::vector<std::shared_ptr<const TriangleMesh>>& fixed,
                   const std::vector<std::uint32_t>& left_out);
  bool bundles() noexcept;
  void take_up_near() noexcept;
  void begin_anew() noexcept;
  void take_front(std::uint32_t part) noexcept;
  void move_to_cells(std::uint32_t part) noexcept;
  MotionAnswer ask(const Pose& X, const Displacement& d, double clearance, std::vector<FacePair>& blocking) noexcept;
  MotionAnswer answer(std::vector<FacePair>& blocking) noexcept;
  void tell(const std::vector<FacePair>& pairs, std::vector<FacePair>& blocking) const noexcept;
  /// Whether a motion is looked at as a whole that `X` is on, and that leads where `d` does.
  bool sweeps(const Pose& X, const Displacement& d) const noexcept;
  void count_still(const Pose& X) noexcept;
  void count_behind() noexcept;
  void take_turns(const Pose& X) noexcept;
  /// Where something touches, whether the cells bring A on as fast as looks at all of it.
  bool cells_turn() const { return heading_.touches && turn_.of_cells && !stands_still(); }
  bool stands_still() const { return still_for_ >= kTicksStill; }
  bool rests(const Pose& X, const Displacement& d) const noexcept;
  bool may_sweep() const noexcept;
  bool all_on_axes() const noexcept;
  /// So many ticks in a row cells and fronts may be behind until motions are looked at as a whole.
  int ticks_behind() const noexcept;
  bool all_in_threads() const noexcept;
  bool may_go_along() const noexcept;
  bool may_look_ahead() const noexcept;
  /// What was looked at is a way from now on, after those that are known.
  void add_way() noexcept;
  bool at_end_of_way(const Pose& X) const noexcept;
  /// Whether A goes along the way that is proved, which makes most of `d`.
  bool goes_along(const Pose& X, const Displacement& d, std::vector<FacePair>& blocking) noexcept;
  bool slides_along(const Pose& X, const Displacement& d) noexcept;
  void fronts_left() noexcept;
  bool same_way(const Displacement& a, const Displacement& b) const noexcept;
  /// From beside the way: most of `d`, onto it.
  std::optional<Displacement> onto_way(const Pose& X, const Displacement& d) const noexcept;
  /// How far A is from where `d` leads when it has made another motion, m.
  double left_of(const Pose& X, const Displacement& d, const Displacement& made) const noexcept;
  /// How far (m) a motion has to be free for whole blocks of faces to be enough, where so much is wanted of it.
  double worth(const Displacement& wanted, const Displacement& all) const noexcept;
  bool begin_sweep(const Pose& X, const Displacement& d, double clearance) noexcept;
  /// To `swept_`: the parts that a motion from `from`, of A which is at `X`, may come near to, whatever certifies them
  /// else. False where one of them is too large.
  bool find_swept(const Pose& X, const Pose& from, const Displacement& d) noexcept;
  /// The side to which A at `from` may be drawn out for a look at a motion past the parts `swept_`, if there is one.
  std::optional<Backing::Side> drawn_for(const Pose& from, const Displacement& d) const noexcept;
  /// Whether those that a way or a sweep is about are all that are near.
  bool covers_near(const std::vector<std::uint32_t>& parts) const noexcept;
  double product(const Displacement& a, const Displacement& b) const {
    return a.dp.dot(b.dp) + radius_ * radius_ * a.dr.dot(b.dr);
  }
  /// A look took so many ticks.
  void lasted(std::uint64_t ticks) noexcept;
  /// How many ticks a look lasts, about, by the last one.
  double soon() const noexcept;
  /// From `from`, the motion onto the way of the pen, which goes on from `pen`, and on along it. So many ticks of the
  /// pen long where it begins beside that way no farther than what counts as near, else as soon as may be.
  Displacement onto_pen_way(const Pose& from, const Pose& pen, double ticks) const noexcept;
  /// How many ticks a look at all faces takes, about.
  double look_ticks() const;
  /// How far `d` leads beside the pen's way, m.
  double beside_pen(const Displacement& d) const noexcept;
  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }
  MotionAnswer blocked_at_once(const Pose& X, std::vector<FacePair>& blocking) noexcept;
  MotionAnswer ask_sweep(const Pose& X, const Displacement& d, std::vector<FacePair>& blocking) noexcept;
  void look_at(const Pose& X, const Displacement& d, double clearance, double worth) noexcept;
  bool empty_full_front(std::uint32_t part, const CertifyReport& report) noexcept;
  /// Whether time was over; the same of ask_all_cells().
  bool ask_fronts(const Pose& X, const Displacement& d, double clearance, std::vector<FacePair>& blocking) noexcept;
  bool ask_all_cells(const Pose& X, const Displacement& d, double clearance, std::vector<FacePair>& blocking) noexcept;
  /// Sends parts back to fronts, from the next tick on, where cells do not pay.
  void judge_cells(const CertifyReport& report) noexcept;
  CertifyReport ask_front(std::uint32_t part, const Pose& X, const Displacement& d, double clearance,
                          const WorkLimit& limit) noexcept;
  bool many(int pairs) const noexcept;
  bool lies_on(const CertifyReport& report, std::uint32_t part) const noexcept;
  /// Whether the motion only leads away from the parts that are certified by cells: they need not be asked.
  bool only_leaves(const Pose& X, const Displacement& d, double clearance) noexcept;
  const Sides& sides_of(std::uint32_t part, const Pose& X) noexcept;
  /// Cells that are not asked while A leaves are too small where it has come to.
  void forget_small_cells(const Displacement& d) noexcept;
  void prepare_fronts(const Pose& X) noexcept;
  void prepare_cells(const Pose& X, const Displacement& next) noexcept;
  void prepare_way(const Pose& X, const Displacement& next) noexcept;
  std::optional<Pose> place_soon(const Pose& X, const Displacement& next) const noexcept;
  bool begin_ahead(const Pose& X, const Displacement& next) noexcept;
  void finish_way(const Pose& X) noexcept;
  CertifyReport ask_cells(const Pose& X, const Displacement& d, double clearance) noexcept;
  /// Asks for ever more clearance at rest by `ask`, until something is nearer or time is over.
  template <typename Ask>
  void look_ahead(const Pose& X, Ahead& ahead, double at_most, Ask ask) noexcept;
  /// A bound on how near (m) the held part at X is to a part: from above.
  double least_gap_at_most(const Pose& X, std::uint32_t part) const noexcept;

  Vec3 center_;
  double radius_;
  std::shared_ptr<const PatchTree> held_;
  std::vector<std::shared_ptr<const PatchTree>> fixed_;
  const ProofEffort effort_;
  const int helpers_;
  std::optional<AxisPairing> pairing_;              ///< none: no axes are looked for
  std::vector<const std::vector<AxisPair>*> axes_;  ///< of each part with the held one
  std::vector<Pose> poses_;
  std::vector<std::uint32_t> one_ = {0};  ///< the part of stands()
  std::vector<PatchFront> fronts_;
  std::vector<std::uint32_t> part_of_;    ///< of each front, kNobody while unused
  std::vector<std::uint32_t> front_of_;   ///< of each part, kNobody while it has none
  std::vector<std::uint64_t> used_;       ///< of each front: the begin() that last named its part
  std::vector<std::uint64_t> emptied_;    ///< of each front: the begin() in which it began anew because it was full
  std::vector<std::uint32_t> exhausted_;  ///< of each front: calls in a row that ran out of time or work
  std::vector<Ahead> ahead_;              ///< of each front
  Headway headway_;                       ///< of the cells
  std::vector<std::uint64_t> seen_;       ///< of each part: the begin() that last named it
  std::uint64_t now_ = 0;
  std::unique_ptr<CellFront> cells_;
  std::optional<PartBundle> bundle_;  ///< what the cells know as the part after the last
  bool bundled_ = false;              ///< the near parts of the bundle are certified as one
  Body held_body_;
  std::shared_ptr<const Backing> backing_;       ///< of A; null: none
  std::vector<Body> bodies_;                     ///< of each part; nothing of those that may be left out
  std::shared_ptr<const Facing> bundle_facing_;  ///< where all in the bundle bound solids
  std::vector<Sides> sides_;                     ///< of each part
  int waits_for_sides_ = 0;                      ///< how often, since A jumped, no look began until they are known
  LeavingCheck leaving_;
  bool behind_ = false;                  ///< the cells ran out of time when they were asked last
  std::unique_ptr<SurfaceSweep> sweep_;  ///< what takes their place then
  ProvedWays ways_;                      ///< of it
  OfferedMotions offered_;               ///< the last of them
  ProvedWay line_;                       ///< what is looked at, as if it were proved
  bool line_touches_ = false;            ///< A touched something when that began
  bool near_told_ = false;               ///< of that: what was met near
  std::vector<std::uint32_t> swept_;     ///< parts
  struct {
    Pose X;
    int count = 0;
  } blocked_;                       ///< where a few faces ended looks at once, and how often
  std::vector<bool> outside_;       ///< of each of them: see SurfaceSweep::begin()
  std::vector<bool> left_out_;      ///< of each part: it may be
  double clearance_ = 0;            ///< of the last check, m
  bool looks_ahead_ = false;        ///< it is at a way that A has not come to yet
  bool turns_off_ = false;          ///< that does not begin at the end of the last way, but before
  Displacement pen_then_;           ///< the pen's motion when that look began
  std::uint64_t ahead_since_ = 0;   ///< and the begin()
  Heading heading_;                 ///< see heads()
  bool fronts_busy_ = false;        ///< they took long when they were asked last
  int behind_for_ = 0;              ///< ticks in a row, up to
  std::uint64_t behind_since_ = 0;  ///< the begin() of the last one in which they were asked
  int behind_before_ = 0;           ///< ticks in a row before that
  int still_for_ = 0;               ///< ticks in a row in which A stood at still_X_ and they were behind
  Pose still_X_;
  std::uint64_t still_since_ = 0;  ///< the begin() of the last of them
  Turn turn_;
  std::uint64_t swept_since_ = 0,
                swept_until_ = 0;  ///< the begin() since which A waited for the last sweep, and of its end
  std::uint64_t swept_for_ = 0;    ///< and the ticks that it took
  std::uint64_t slow_until_ = 0;   ///< the begin() until which looks are taken to be slow
  Pose swept_from_;                ///< where it began
  Displacement swept_motion_;      ///< and what it was about
  bool sweeping_ = false;          ///< it was begun, and its answer not yet given
  std::optional<Displacement> instead_;
  std::uint64_t wait_ = 0, retry_leaving_ = 0;  ///< ticks, and the one, until leaving is looked at thoroughly again
  bool trusted_ = false;                        ///< see trust_start()
  double edge_;                                 ///< mean of the held part's, m
  double left_ = 0;  ///< how far A has come by motions that the cells were not asked about, m
  OtherParts others_ = OtherParts::ignored;
  std::vector<Certificate> choice_;  ///< of each part, for as long as it is near
  Vain vain_;
  std::vector<std::uint32_t> near_;         ///< of the last begin()
  std::vector<std::uint32_t> near_fronts_;  ///< near parts that have fronts
  std::vector<std::uint32_t> near_cells_;   ///< the others
  WorkLimit limit_;
  double share_ = 0;
  bool overflow_ = false;
  bool asked_ = false;  ///< since all began
};

}  // namespace tegotae
