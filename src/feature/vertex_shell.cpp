#include "feature/vertex_shell.hpp"

namespace tegotae {

VertexShell::VertexShell(std::shared_ptr<const SignedDistance> A, std::shared_ptr<const SignedDistance> B)
    : A_(std::move(A)), B_(std::move(B)), of_a_(vertices(A_->surface())), of_b_(vertices(B_->surface())) {}

std::vector<VertexShell::Vertex> VertexShell::vertices(const Surface& s) {
  std::vector<Vertex> out;
  for (std::uint32_t v = 0; v < s.mesh->vertices.size(); ++v)
    if (s.topology.vertex_face_begin[v] < s.topology.vertex_face_begin[v + 1]) out.push_back({s.mesh->vertices[v], v});
  return out;
}

bool VertexShell::collect(const Pose& X_BA, double reach, std::vector<ShellPoint>& out) noexcept {
  const Pose X_AB = X_BA.inverse();
  for (const bool a : {true, false}) {
    const SignedDistance& other = a ? *B_ : *A_;
    for (Vertex& v : a ? of_a_ : of_b_) {
      if (v.clear - traveled_ > reach) continue;
      const Vec3 p = (a ? X_BA : X_AB) * v.p;
      const SurfacePoint at = other.at(p, v.face);
      v.face = at.face;
      v.clear = at.distance + traveled_;
      if (at.distance >= reach) continue;
      if (out.size() == out.capacity()) return false;
      const Feature vertex{FeatureKind::vertex, v.index}, face{FeatureKind::face, at.face};
      out.push_back(a ? ShellPoint{at.distance, v.p, X_AB.q * at.normal, vertex, face}
                      : ShellPoint{at.distance, at.point, -at.normal, face, vertex});
    }
  }
  return true;
}

}  // namespace tegotae
