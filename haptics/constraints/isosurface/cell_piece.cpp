// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/cell_piece.h"

#include "haptics/constraints/common/pull_back.h"
#include "haptics/constraints/isosurface/closest_point.h"

namespace catena::haptics {

PieceFrame::PieceFrame(const field::Mapping& mapping, unsigned held_axes) noexcept {
  // no axis held: the span is all of space
  if (held_axes == 0) {
    dimension = 3;
    return;
  }
  // Gram-Schmidt orthogonalization
  for (int a = 0; a < 3; ++a) {
    held[static_cast<std::size_t>(a)] = (held_axes >> a & 1u) != 0;
    if (held[static_cast<std::size_t>(a)]) continue;
    Vec3 v = direction(mapping.world_from_index_linear[a]);
    for (int pass = 0; pass < 2; ++pass)
      for (int k = 0; k < dimension; ++k) v -= basis[static_cast<std::size_t>(k)] * dot(basis[static_cast<std::size_t>(k)], v);
    basis[static_cast<std::size_t>(dimension++)] = direction(v);
  }
}

Vec3 CellPiece::hessian_times(const Vec3& f, const Vec3& v) const noexcept {
  const Vec3 h = cell_.mixed_second_derivatives(f);
  const Vec3 d = mapping_.index_from_world_linear * v;
  return mapping_.world_from_index_gradient({h.z * d.y + h.y * d.z, h.z * d.x + h.x * d.z, h.y * d.x + h.x * d.y});
}

Vec3 CellPiece::newton_step(const Vec3& f, const Vec3& probe, const PieceSample& s, const Vec3& t) const noexcept {
  const double delta = dot(s.n, probe - world(f));
  const double size = norm(t);
  if (!(size > 0)) return Vec3(0.0);
  const Vec3 t1 = t * (1 / size);
  const Vec3 b1 = hessian_times(f, t1) * (1 / s.slope);
  if (frame_.dimension == 2) return t * (1 / std::max(std::fabs(1 + delta * dot(t1, b1)), 0.1));
  const Vec3 t2 = cross(s.n, t1);
  const Vec3 b2 = hessian_times(f, t2) * (1 / s.slope);
  double u1, u2;
  solve_tangent(1 + delta * dot(t1, b1), delta * dot(t1, b2), 1 + delta * dot(t2, b2), size, 0, 0.1, u1, u2);
  return t1 * u1 + t2 * u2;
}

PulledBackForce CellPiece::pull_back(const Vec3& f, const Vec3& probe, const Vec3& force) const noexcept {
  const PieceSample s = sample(f);
  if (!s.usable || frame_.dimension < 2) return {};
  const double delta = dot(s.n, probe - world(f));
  const auto bent = [&](const Vec3& v) { return frame_.project(hessian_times(f, v)) * (1 / s.slope); };
  if (frame_.dimension == 3) return pull_back_on_surface(s.n, delta, bent, force);
  // one direction remains: in the span, perpendicular to n
  const Vec3 other = cross(frame_.basis[0], frame_.basis[1]), t = direction(cross(s.n, other));
  return pull_back_on_curve(t, 1 + delta * dot(t, bent(t)), force);
}

bool CellPiece::retract(const Vec3& f, const Vec3& step, const PieceSample& s, Vec3& out, double& along) const noexcept {
  const Vec3 d = frame_.index_step(mapping_, step), n = frame_.index_step(mapping_, s.n);
  const Vec3 start = f + d;
  // Newton's method on the cubic along n
  double w = along, best = 0, minimum = -1;
  for (int i = 0; i < 20; ++i) {
    double value;
    Vec3 g;
    ++steps_;
    cell_.value_and_gradient(start + n * w, value, g);
    const double sigma = value - level_, slope = dot(g, n);
    if (!std::isfinite(sigma)) return false;
    if (minimum >= 0 && std::fabs(sigma) >= minimum) break;
    minimum = std::fabs(sigma);
    best = w;
    if (sigma == 0) break;
    if (!(slope > 0.05 * s.slope)) return false;
    w -= sigma / slope;
  }
  out = start + n * best;
  along = best;
  // accepts the accuracy that the cell's values allow
  double largest = std::fabs(level_);
  for (const double c : cell_.corner) largest = std::max(largest, std::fabs(c));
  return minimum <= 1e-14 * largest || minimum <= 1e-12 * s.slope * mapping_.min_voxel_edge();
}

double CellPiece::overshoot(const Vec3& f, int& axis) const noexcept {
  double worst = -1;
  axis = -1;
  for (int a = 0; a < 3; ++a) {
    if (frame_.held[static_cast<std::size_t>(a)]) continue;
    const double v = std::max(-f[a], f[a] - 1);
    if (axis < 0 || v > worst) worst = v, axis = a;
  }
  return worst;
}

namespace {

constexpr double kConverged = 1e-10;  // fraction of L; convergence within a piece
constexpr double kNearFace = 1e-10;   // voxels; a step out of the cell that cannot be shortened into it starts on the face
constexpr double kMinSlope = 0.87;    // minimum slope relative to the slope at the last point; a smaller one is a fold
constexpr double kFlat = 0.25;        // voxels; maximum distance from the level at the end of a straight path

}  // namespace

FollowResult follow_piece(const LevelSetField& field, const CellPiece& piece, const Vec3& probe, bool steepest, Vec3& f, PieceSample& s,
                          Vec3& t) noexcept {
  const field::Mapping& mapping = field.trilinear_grid()->mapping();
  const double length = field.length(), voxel = field.voxel_edge();
  for (int i = 0; i < 40 && !field.exhausted(); ++i) {
    if (!s.usable) return FollowResult::blocked;
    const double size = norm(t);
    if (size <= std::max(kConverged * length, 1e-15 * norm(probe - piece.world(f)))) return FollowResult::converged;
    Vec3 u = steepest ? t : piece.newton_step(f, probe, s, t);
    const double wanted = norm(u);
    if (wanted > 2 * voxel) u = u * (2 * voxel / wanted);

    bool accepted = false;
    for (int trial = 0; trial < 30 && !accepted && !field.exhausted(); ++trial, u = u * 0.35) {
      Vec3 g;
      int axis;
      if (!piece.retract(f, u, s, g)) continue;
      if (piece.overshoot(g, axis) <= 0) {
        const double won = piece.gain(probe, f, g);
        accepted = won >= 1e-4 * dot(t, u);
        if (!accepted && size <= 1e-5 * length) {
          const PieceSample next = piece.sample(g);
          accepted = next.usable && norm(piece.tangential_component(g, probe, next)) <= 0.5 * size;
        }
        if (accepted) f = g;
        continue;
      }

      // inner end of the bracket: the first halving that stays in the cell
      double low = 0, high = 1, v_low = 0, v_high = piece.overshoot(g, axis);
      Vec3 outer = g, within = f;
      bool inner = false;
      const bool hurried = field.is_running_long();
      int exit_axis;
      const double first = hurried ? std::min(0.5, piece.fraction_inside(f, piece.frame().index_step(mapping, u), exit_axis)) : 0.5;
      for (double alpha = first; alpha > 1e-14 && !field.exhausted(); alpha *= 0.5) {
        if (!piece.retract(f, u * alpha, s, g)) continue;  // a fold: there is no nearer point
        int worst;
        const double v = piece.overshoot(g, worst);
        if (v <= 0) {
          low = alpha;
          v_low = v;
          within = g;
          inner = true;
          break;
        }
        high = alpha;
        v_high = v;
        axis = worst;
        outer = g;
      }
      if (!inner) {
        // outside of a face only by round-off
        for (int a = axis, k = 0; k < 3; ++k, a = (a + 1) % 3) {
          const double face = f[a] < 0.5 ? 0.0 : 1.0;
          if (piece.frame().held[static_cast<std::size_t>(a)] || f[a] == face || std::fabs(f[a] - face) > kNearFace) continue;
          f[a] = face;
          return FollowResult::landed;
        }
        return FollowResult::blocked;
      }

      // move onto the face: false position on the distance outside, to the last bit; under time pressure with the Illinois rule (an end
      // value is halved only if it is kept twice), which needs a quarter of the steps
      double a = v_low, b = v_high;
      int stays = 0;
      double along = 0;
      for (int k = 0; k < 80 && high - low > 1e-16 * high && v_high > 1e-15 && !(hurried && v_low > -kFaceTolerance) && !field.exhausted();
           ++k) {
        double w = k % 4 == 3 || !(a < 0) ? 0.5 : a / (a - b);
        if (!(w > 0 && w < 1)) w = 0.5;
        const double mid = low + (high - low) * w;
        if (!(mid > low && mid < high) || !piece.retract(f, u * mid, s, g, along)) break;
        if (!hurried) along = 0;
        const double v = piece.overshoot(g, axis);
        const bool replaces_low = v <= 0;
        const double other = hurried && stays != (replaces_low ? 1 : -1) ? 1 : 0.5;
        stays = replaces_low ? 1 : -1;
        if (replaces_low)
          low = mid, within = g, a = v_low = v, b *= other;
        else
          high = mid, b = v_high = v, outer = g, a *= other;
      }
      if (hurried && v_low > -kFaceTolerance) outer = within, v_high = 0;
      if (v_high > 1e-9) {
        // a fold between the ends: goes as far as the cell's level does
        accepted = piece.gain(probe, f, within) >= 1e-4 * low * dot(t, u);
        if (accepted) f = within;
        continue;
      }
      piece.overshoot(outer, axis);
      for (int k = 0; k < 3; ++k) outer[k] = std::min(std::max(outer[k], 0.0), 1.0);
      outer[axis] = outer[axis] < 0.5 ? 0.0 : 1.0;
      if (!(piece.gain(probe, f, outer) > 0)) continue;
      f = outer;
      return FollowResult::landed;
    }
    if (!accepted) return size <= kMinDescent * length ? FollowResult::converged : FollowResult::blocked;
    s = piece.sample(f);
    t = piece.tangential_component(f, probe, s);
  }
  return FollowResult::converged;
}

bool cross_cell(const LevelSetField& field, const PieceFrames& frames, const CellPiece& piece, const field::ScalarCell& cell, unsigned held,
                const Vec3& probe, const PieceSample& s, const Vec3& t, Vec3& f) noexcept {
  const field::Mapping& mapping = field.trilinear_grid()->mapping();
  const Vec3 d = piece.frame().index_step(mapping, t);
  int axis;
  const double part = piece.fraction_inside(f, d, axis);
  if (axis < 0) return false;
  Vec3 exit = f + d * part;
  for (int a = 0; a < 3; ++a) exit[a] = std::min(std::max(exit[a], 0.0), 1.0);
  exit[axis] = d[axis] > 0 ? 1 : 0;

  const CellPiece face(mapping, cell, field.level(), frames.by_held_axes[held | 1u << axis], field.steps());
  const PieceSample there = face.sample(exit);
  Vec3 g;
  int worst;
  if (!there.usable || there.slope < kMinSlope * s.slope || std::fabs(there.distance) > kFlat * field.voxel_edge()) return false;
  if (!face.retract(exit, Vec3(0.0), there, g) || face.overshoot(g, worst) > 0) return false;
  if (!(piece.gain(probe, f, g) > 0)) return false;
  f = g;
  return true;
}

}  // namespace catena::haptics
