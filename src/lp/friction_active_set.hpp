#pragma once

#include <array>
#include <vector>

#include "lp/coulomb_residual.hpp"
#include "lp/pricing.hpp"

namespace tegotae {

/// Exact friction by an active set: contacts in it slide along a direction of their own or stick. Each round solves one
/// system of order six, in which a contact gives by a hair so that many contacts share the load (with the least sum of
/// squares), and takes that hair back by shifting the forces. Then the contacts change: one that pulls leaves, one that
/// would slide backwards sticks, one whose friction is beyond its cone slides, the one that is violated most comes in.
/// Not every problem ends; `solve` says so. Allocates only when it is made.
class FrictionActiveSet {
 public:
  /// For at most `capacity` rows.
  explicit FrictionActiveSet(int capacity);

  /// Starts from the contacts that touch after the motion `from`, each sliding as that has it, or sticking where it
  /// does not slide. False when the rounds or the time ran out or it went in a circle.
  bool solve(const FrictionProblem& problem, const Vec6& from) noexcept;

  /// Starts from an answer that is nearly right: its contacts with force, which slide where `from` or the forces have
  /// them slide.
  bool refine(const FrictionProblem& problem, const Vec6& from, const std::vector<FrictionForce>& forces) noexcept;

  // Of the last solve that ended:
  const Vec6& z() const noexcept { return z_; }
  /// Appends the forces; `out` has room for most_forces().
  void forces(std::vector<FrictionForce>& out) const noexcept;
  int rounds() const noexcept { return rounds_; }
  static constexpr int most_forces() { return kMaxMembers; }

 private:
  static constexpr int kMaxMembers = 96;

  struct Member {
    Vec6 n, t[2];
    Vec6 column;  ///< what a unit of force moves: n, less the friction while it slides
    double bound, mu, length;
    double normal;         ///< ν
    double tangential[2];  ///< τ while it sticks
    double direction[2];   ///< of slip, unit, or 0
    double slip[2];        ///< T z
    double along;          ///< of the slip that its direction was set for, along it; at least slip_
    int row, flips;
    bool slides;
    bool turns;  ///< its direction is an unknown of the last round
  };
  enum class Change { none, some, failed };

  void set_problem(const Vec6& from) noexcept;
  void begin(const Vec6& from) noexcept;
  bool run(bool first) noexcept;
  bool add(int row) noexcept;
  void set_direction(Member& m, double d0, double d1) noexcept;
  void remove(int position) noexcept;
  /// One round: z_, all forces, error_. False when the system has no solution that can be.
  bool step() noexcept;
  /// Takes out contacts that pull: all of them in the first round, then the worst.
  bool drop_pulling(bool first) noexcept;
  Change stick_or_turn() noexcept;
  Change slide() noexcept;
  bool add_most_violated() noexcept;
  void set_outside(int row, bool outside) noexcept {
    outside_[static_cast<std::size_t>(row / kRowLanes)].v[row % kRowLanes] = outside ? 1 : 0;
  }
  /// Adds factor a bᵀ to the system of the round.
  void push_product(double factor, const Vec6& a, const Vec6& b) noexcept;

  const Pricing& pricing_;
  const FrictionProblem* problem_ = nullptr;
  std::array<Member, kMaxMembers> members_;
  int count_ = 0;
  std::array<PaddedVec6, 3 * kMaxMembers> left_{}, right_{};  ///< of each product in the system of the round
  int products_ = 0;
  std::vector<LaneBlock> bounds_;   ///< of the rows
  std::vector<LaneBlock> outside_;  ///< 1 for rows that are not members, or 0
  std::vector<int> touching_;       ///< rows
  Vec6 z_ = Vec6::Zero();
  double scale_ = 0;  ///< |wanted|
  double give_ = 0;   ///< of a contact, m per m
  double slip_ = 0;   ///< less than this (m) is not a slip
  double error_ = 0;  ///< of the rows that hold, m
  double turn_ = 0;   ///< of directions in the last round, rad
  int rounds_ = 0;
};

}  // namespace tegotae
