#include "narrowphase/fcl_near_triangles.hpp"

#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

namespace tegotae {
namespace {

// FCL's thresholds are meant for lengths of about 1: it gets them in 0.1 mm.
constexpr double kNearUnit = 1e-4;

class TriangleQuery : public LeafQuery {
 public:
  TriangleQuery(const NearFront& front, const Pose& X_BA, const std::atomic<bool>* stop)
      : front_(front), X_(X_BA), stop_(stop) {}

  double distance(const PatchNode& a, const PatchNode& b, Vec3& /*normal*/, double& bound) override {
    if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) {
      bound = 0;  // nothing more is asked
      return 0;
    }
    const PatchTree &of_a = front_.a(), &of_b = front_.b();
    for (std::uint32_t i = 0; i < a.count; ++i) {
      std::array<Vec3, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = X_ * of_a.corner(of_a.order()[a.first + i], k) / kNearUnit;
      for (std::uint32_t j = 0; j < b.count; ++j) {
        std::array<Vec3, 3> q;
        for (int k = 0; k < 3; ++k) q[k] = of_b.corner(of_b.order()[b.first + j], k) / kNearUnit;
        if (!fcl::detail::Intersect<double>::intersect_Triangle(p[0], p[1], p[2], q[0], q[1], q[2])) continue;
        hit_ = true;
        bound = 0;
        return 0;
      }
    }
    return 0;
  }
  bool hit() const { return hit_; }

 private:
  const NearFront& front_;
  const Pose X_;
  const std::atomic<bool>* stop_;
  bool hit_ = false;
};

}  // namespace

bool FclNearTriangles::intersect(const Pose& X_BA, const std::atomic<bool>* stop) {
  double bound = kNear;
  TriangleQuery query(front_, X_BA, stop);
  front_.query(X_BA, bound, query);
  return query.hit();
}

}  // namespace tegotae
