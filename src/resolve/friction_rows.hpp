#pragma once

#include <cstdint>
#include <vector>

#include "resolve/metric.hpp"
#include "tegotae/lp/friction_problem.hpp"

namespace tegotae {

/// What a problem with friction needs of contacts beside the rows of their normals. Allocates only when it is made.
class FrictionRows {
 public:
  /// `mu_of_part`: the coefficient against each part, by its PartId (empty: 0 against all); for at most
  /// `capacity` contacts.
  FrictionRows(std::vector<double> mu_of_part, int capacity);

  /// Takes the contacts, in their order; whether one of them has friction. `metric` is always the same one, oriented as
  /// the held part is. Rows of contacts that are where they were the last time are kept: those of the end of a tick are
  /// those of the next one's beginning.
  bool fill(const std::vector<Contact>& contacts, const Metric& metric) noexcept;
  FrictionProblem problem(const LowRankMatrix& normals, const double* bounds, const Vec6& wanted,
                          std::int64_t deadline_ns) const noexcept {
    return {normals, bounds, tangents_.data(), mu_.data(), wanted, deadline_ns};
  }
  /// Of contact `i`.
  double mu(std::size_t i) const noexcept { return mu_[i]; }

 private:
  std::vector<double> mu_of_part_;
  std::vector<double> mu_;
  std::vector<TangentRows> tangents_;
  /// Of the contact that a row was made for.
  struct Place {
    Vec3 n = Vec3::Zero(), r = Vec3::Zero();
  };
  std::vector<Place> places_;
  std::size_t made_ = 0;      ///< rows, the first ones
  Mat3 axes_ = Mat3::Zero();  ///< of the metric that they were made with
  bool any_;
};

}  // namespace tegotae
