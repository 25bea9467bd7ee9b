#include "haptics/constraints/isosurface/piece.h"

#include "haptics/constraints/isosurface/analytic.h"

namespace catena::haptics {

PieceFrame::PieceFrame(const field::Mapping& mapping, unsigned held_axes) noexcept {
  // nothing held: the span is all of space
  if (held_axes == 0) {
    count = 3;
    return;
  }
  // Gram-Schmidt
  for (int a = 0; a < 3; ++a) {
    held[static_cast<std::size_t>(a)] = (held_axes >> a & 1u) != 0;
    if (held[static_cast<std::size_t>(a)]) continue;
    Vec3 v = direction(mapping.world_from_index_linear[a]);
    for (int pass = 0; pass < 2; ++pass)
      for (int k = 0; k < count; ++k) v -= q[static_cast<std::size_t>(k)] * dot(q[static_cast<std::size_t>(k)], v);
    q[static_cast<std::size_t>(count++)] = direction(v);
  }
}

Vec3 Piece::hessian_times(const Vec3& f, const Vec3& v) const noexcept {
  const Vec3 h = cell_.mixed_second(f);
  const Vec3 d = mapping_.index_from_world_linear * v;
  return mapping_.world_gradient({h.z * d.y + h.y * d.z, h.z * d.x + h.x * d.z, h.y * d.x + h.x * d.y});
}

Vec3 Piece::newton(const Vec3& f, const Vec3& probe, const PieceSample& s, const Vec3& t) const noexcept {
  const double delta = dot(s.n, probe - world(f));
  const double size = norm(t);
  if (!(size > 0)) return Vec3(0.0);
  const Vec3 t1 = t * (1 / size);
  const Vec3 b1 = hessian_times(f, t1) * (1 / s.slope);
  if (frame_.count == 2) return t * (1 / std::max(std::fabs(1 + delta * dot(t1, b1)), 0.1));
  const Vec3 t2 = cross(s.n, t1);
  const Vec3 b2 = hessian_times(f, t2) * (1 / s.slope);
  double u1, u2;
  solve_tangent(1 + delta * dot(t1, b1), delta * dot(t1, b2), 1 + delta * dot(t2, b2), size, 0, 0.1, u1, u2);
  return t1 * u1 + t2 * u2;
}

bool Piece::retract(const Vec3& f, const Vec3& step, const PieceSample& s, Vec3& out, double& along) const noexcept {
  const Vec3 d = frame_.index_step(mapping_, step), n = frame_.index_step(mapping_, s.n);
  const Vec3 start = f + d;
  // Newton on the cubic along n
  double w = along, best = 0, least = -1;
  for (int i = 0; i < 20; ++i) {
    double value;
    Vec3 g;
    ++steps_;
    cell_.value_and_gradient(start + n * w, value, g);
    const double sigma = value - level_, slope = dot(g, n);
    if (!std::isfinite(sigma)) return false;
    if (least >= 0 && std::fabs(sigma) >= least) break;
    least = std::fabs(sigma);
    best = w;
    if (sigma == 0) break;
    if (!(slope > 0.05 * s.slope)) return false;
    w -= sigma / slope;
  }
  out = start + n * best;
  along = best;
  // as well as the cell's values allow
  double largest = std::fabs(level_);
  for (const double c : cell_.corner) largest = std::max(largest, std::fabs(c));
  return least <= 1e-14 * largest || least <= 1e-12 * s.slope * mapping_.smallest_edge();
}

double Piece::outside(const Vec3& f, int& axis) const noexcept {
  double worst = -1;
  axis = -1;
  for (int a = 0; a < 3; ++a) {
    if (frame_.held[static_cast<std::size_t>(a)]) continue;
    const double v = std::max(-f[a], f[a] - 1);
    if (axis < 0 || v > worst) worst = v, axis = a;
  }
  return worst;
}

}  // namespace catena::haptics
