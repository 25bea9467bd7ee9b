#include "haptics/constraints/isosurface/descent.h"

#include "haptics/constraints/equations.h"

namespace catena::haptics {
namespace {

constexpr int kRetractions = 6;

/// From a along u and back to the level along a's normal, to |distance| <= slack. False: there is none near by.
bool retract(LevelField& field, const LevelPoint& a, const Vec3& u, double first, double slack, LevelPoint& c) noexcept {
  const double size = norm(u), most = 2 * size + 2 * std::fabs(a.distance);
  double w = std::min(std::max(first, -most), most);
  double below = 0, above = 0;  // where sigma has these signs
  bool has_below = false, has_above = false;
  for (int i = 0; i < kRetractions && !field.spent(); ++i) {
    c = field.at(a.p + u + a.n * w);
    if (!c.valid || c.plateau) return false;
    if (std::fabs(c.distance) <= std::max(slack, c.round_off)) return dot(a.n, c.n) > 0.2;
    (c.sigma < 0 ? below : above) = w;
    (c.sigma < 0 ? has_below : has_above) = true;
    const double along = dot(a.n, c.n);
    double next = along > 0.05 ? w - c.distance / along : c.sigma > 0 ? w - size : w + size;
    const double lo = std::min(below, above), hi = std::max(below, above);
    if (has_below && has_above && !(next > lo && next < hi)) next = 0.5 * (lo + hi);
    next = std::min(std::max(next, -most), most);
    if (next == w) return false;
    w = next;
  }
  return false;
}

}  // namespace

Closest descend(LevelField& field, const Vec3& probe, const ClosestGoal& goal, LevelPoint& at, Curvature& curvature) noexcept {
  const double length = field.length();
  const std::int32_t first = field.evaluations();
  const auto spent = [&] { return field.spent() || field.evaluations() - first >= goal.most; };
  double trust = 0.02 * length;
  curvature = measure_curvature(field, at);
  bool measured = true;

  while (true) {
    const LevelPoint a = at;
    const Vec3 e = probe - a.p;
    const double delta = dot(a.n, e);
    const Vec3 t = e - a.n * delta;
    const double tangential = norm(t);
    const double level_goal = std::max(goal.off_level, a.round_off);
    if (tangential <= std::max(goal.tangential, 1e-15 * norm(e)) && std::fabs(a.distance) <= level_goal) return Closest::converged;
    if (spent()) return Closest::spent;

    // the Newton step, and what it promises
    Vec3 t1, t2;
    tangents(a.n, t1, t2);
    const Vec3 b1 = curvature.times(t1), b2 = curvature.times(t2);
    const double m11 = 1 + delta * dot(t1, b1), m12 = delta * dot(t1, b2), m22 = 1 + delta * dot(t2, b2);
    double u1, u2;
    solve_tangent(m11, m12, m22, dot(t, t1), dot(t, t2), 1e-3, u1, u2);
    Vec3 u = t1 * u1 + t2 * u2;
    if (norm(u) > trust) {
      const double cut = trust / norm(u);
      u = u * cut, u1 *= cut, u2 *= cut;
    }
    const double size = norm(u), slope = dot(t, u);
    const double promised = slope - 0.5 * (m11 * u1 * u1 + 2 * m12 * u1 * u2 + m22 * u2 * u2);
    const bool convex = m11 > 0 && m11 * m22 > m12 * m12;

    // is it kept
    LevelPoint c;
    const double slack = std::max(level_goal, 1e-3 * size);
    bool accepted = false;
    double ratio = 0;
    if (retract(field, a, u, -a.distance - 0.5 * dot(u, curvature.times(u)), slack, c)) {
      const Vec3 e2 = probe - c.p;
      const Vec3 change = (a.p - c.p) + c.n * c.distance - a.n * a.distance;
      const double fall = -0.5 * dot(change, e + e2 + a.n * a.distance + c.n * c.distance);
      const double next = norm(equation::tangential(e2, c.n));
      ratio = fall / promised;
      const bool near = convex && tangential <= 1e-2 * length && next <= 0.7 * tangential && size <= 0.01 * length;
      const bool level_only = tangential <= goal.tangential && std::fabs(c.distance) <= 0.5 * std::fabs(a.distance);
      if (near && !(fall > 0)) ratio = 1;
      accepted = (tangential > 0 && fall >= 1e-4 * slope && fall > 0) || near || level_only;
    }
    if (accepted) {
      learn_curvature(a, c, length, curvature);
      if (ratio > 0.7) trust = std::min(std::max(trust, 3 * size), 0.3 * length);
      if (ratio < 0.2) trust = 0.4 * size;
      measured = false;
      at = c;
      // far from what was promised: the curvature has changed
      if (ratio < 0.5 || ratio > 2) curvature = measure_curvature(field, at), measured = true;
      continue;
    }

    // refused: know the curvature, then shorter
    if (!measured) {
      curvature = measure_curvature(field, a);
      measured = true;
      trust = std::min(trust, size);
      continue;
    }
    trust = 0.3 * size;
    if (trust > 1e-13 * length) continue;
    const bool fine =
        tangential <= std::max(1e-7 * length, goal.tangential) && std::fabs(a.distance) <= std::max(4e-12 * length, level_goal);
    return fine ? Closest::converged : Closest::stuck;
  }
}

}  // namespace catena::haptics
