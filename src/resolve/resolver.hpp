#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lp/low_rank_matrix.hpp"
#include "tegotae/resolve/status.hpp"

namespace tegotae {

/// A resolver's answer, in whitened coordinates.
struct Resolution {
  Vec6 motion = Vec6::Zero();  ///< zero unless solved
  ResolveStatus status = ResolveStatus::stalled;
  int iterations = 0;
};

/// Turns a wanted motion into one that the limits allow.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// A motion z with rows z >= bounds (rows.rows() of them), as near to `wanted` as the method brings it.
  virtual Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept = 0;
  /// Whether the answer is the allowed motion nearest to the wanted one. If not, it may be no motion at all although
  /// some would lead nearer.
  virtual bool projects() const = 0;
};

/// What ContactSettings::resolver knows: "lp" (the paper's linear programme), "qp" (Gauss's least constraint), and two
/// that solve no programme but are loops of their own, "impulse" and "penalty" (see src/sim).
const std::vector<std::string>& resolver_names();
/// "lp" or "qp", for at most `capacity` rows. Throws Error for another name.
std::unique_ptr<Resolver> make_resolver(const std::string& name, int capacity);

}  // namespace tegotae
