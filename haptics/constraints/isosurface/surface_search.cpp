// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/surface_search.h"

#include <array>

#include "haptics/constraints/equations.h"

namespace catena::haptics {
namespace {

constexpr int kRetractions = 6;

/// Moves from a along u and back to the level along a's normal, until |distance| <= slack. Returns false if the level is not found nearby.
bool retract(LevelSetField& field, const LevelPoint& a, const Vec3& u, double first, double slack, LevelPoint& c) noexcept {
  const double size = norm(u), maximum = 2 * size + 2 * std::fabs(a.distance);
  double w = std::min(std::max(first, -maximum), maximum);
  double below = 0, above = 0;  // offsets at which sigma has these signs
  bool has_below = false, has_above = false;
  for (int i = 0; i < kRetractions && !field.out_of_budget(); ++i) {
    c = field.at(a.p + u + a.n * w);
    if (!c.valid || c.plateau) return false;
    if (std::fabs(c.distance) <= std::max(slack, c.round_off)) return dot(a.n, c.n) > 0.2;
    (c.sigma < 0 ? below : above) = w;
    (c.sigma < 0 ? has_below : has_above) = true;
    const double along = dot(a.n, c.n);
    double next = along > 0.05 ? w - c.distance / along : c.sigma > 0 ? w - size : w + size;
    const double lo = std::min(below, above), hi = std::max(below, above);
    if (has_below && has_above && !(next > lo && next < hi)) next = 0.5 * (lo + hi);
    next = std::min(std::max(next, -maximum), maximum);
    if (next == w) return false;
    w = next;
  }
  return false;
}

}  // namespace

ClosestPointResult descend_on_surface(LevelSetField& field, const Vec3& probe, const ClosestPointCriteria& goal, LevelPoint& at,
                                      Curvature& curvature) noexcept {
  const double length = field.length();
  const std::int32_t first = field.evaluations();
  const auto spent = [&] { return field.out_of_budget() || field.evaluations() - first >= goal.max_fetches; };
  double trust = 0.02 * length;
  curvature = measure_curvature(field, at);
  bool measured = true;

  while (true) {
    const LevelPoint a = at;
    const Vec3 e = probe - a.p;
    const double delta = dot(a.n, e);
    const Vec3 t = e - a.n * delta;
    const double tangential = norm(t);
    const double level_goal = std::max(goal.level_tolerance, a.round_off);
    if (tangential <= std::max(goal.tangential_tolerance, 1e-15 * norm(e)) && std::fabs(a.distance) <= level_goal)
      return ClosestPointResult::converged;
    if (spent()) return ClosestPointResult::out_of_budget;

    // the Newton step and its predicted decrease
    Vec3 t1, t2;
    make_tangent_basis(a.n, t1, t2);
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

    // tests whether the step achieves the predicted decrease
    LevelPoint c;
    const double slack = std::max(level_goal, 1e-3 * size);
    bool accepted = false;
    double ratio = 0;
    if (retract(field, a, u, -a.distance - 0.5 * dot(u, curvature.times(u)), slack, c)) {
      const Vec3 e2 = probe - c.p;
      const Vec3 change = (a.p - c.p) + c.n * c.distance - a.n * a.distance;
      const double fall = -0.5 * dot(change, e + e2 + a.n * a.distance + c.n * c.distance);
      const double next = norm(equation::tangential_component(e2, c.n));
      ratio = fall / promised;
      const bool near = convex && tangential <= 1e-2 * length && next <= 0.7 * tangential && size <= 0.01 * length;
      const bool level_only = tangential <= goal.tangential_tolerance && std::fabs(c.distance) <= 0.5 * std::fabs(a.distance);
      if (near && !(fall > 0)) ratio = 1;
      accepted = (tangential > 0 && fall >= 1e-4 * slope && fall > 0) || near || level_only;
    }
    if (accepted) {
      update_curvature(a, c, length, curvature);
      if (ratio > 0.7) trust = std::min(std::max(trust, 3 * size), 0.3 * length);
      if (ratio < 0.2) trust = 0.4 * size;
      measured = false;
      at = c;
      // the decrease is far from the prediction: the curvature has changed
      if (ratio < 0.5 || ratio > 2) curvature = measure_curvature(field, at), measured = true;
      continue;
    }

    // rejected: measure the curvature, then shorten the step
    if (!measured) {
      curvature = measure_curvature(field, a);
      measured = true;
      trust = std::min(trust, size);
      continue;
    }
    trust = 0.3 * size;
    if (trust > 1e-13 * length) continue;
    const bool fine =
        tangential <= std::max(1e-7 * length, goal.tangential_tolerance) && std::fabs(a.distance) <= std::max(4e-12 * length, level_goal);
    return fine ? ClosestPointResult::converged : ClosestPointResult::stuck;
  }
}

namespace {

constexpr int kMarchSteps = 64;
constexpr int kReserve = 32;  // field samples that a scan leaves for later work in the tick

bool opposite(double a, double b) { return (a <= 0 && b >= 0) || (a >= 0 && b <= 0); }

bool on_level(const LevelSetField& field, const LevelPoint& a) {
  return a.sigma == 0 || (!a.plateau && std::fabs(a.distance) <= std::max(1e-13 * field.length(), a.round_off));
}

}  // namespace

LevelSetHit find_root_between(LevelSetField& field, LevelPoint a, LevelPoint b) noexcept {
  if (!a.valid || !b.valid) return {};
  if (on_level(field, a)) return {!a.plateau, a};
  if (on_level(field, b)) return {!b.plateau, b};
  double fa = a.sigma, fb = b.sigma;
  int same_side = 0;
  for (int i = 0; i < 80 && !field.out_of_budget(); ++i) {
    // false position with the Illinois rule; bisection where it is slow on a steep profile
    double w = fa / (fa - fb);
    if (i % 4 == 3) w = 0.5;
    if (!(w > 0 && w < 1)) w = 0.5;
    const LevelPoint c = field.at(a.p + (b.p - a.p) * w);
    if (!c.valid) return {};
    if (on_level(field, c)) return {!c.plateau, c};
    const bool replaces_b = opposite(fa, c.sigma);
    if (replaces_b) {
      b = c;
      fb = c.sigma;
      if (same_side == 1) fa *= 0.5;
      same_side = 1;
    } else {
      a = c;
      fa = c.sigma;
      if (same_side == -1) fb *= 0.5;
      same_side = -1;
    }
    if (norm(b.p - a.p) <= 1e-15 * field.length() + 2.3e-16 * max_abs(a.p)) break;
  }
  const LevelPoint& best = std::fabs(a.sigma) <= std::fabs(b.sigma) ? a : b;
  return {!best.plateau && !field.out_of_budget(), best};
}

LevelSetHit search_along_gradient(LevelSetField& field, const LevelPoint& start, const Vec3& normal, double radius, int reserve) noexcept {
  LevelPoint a = start;
  Vec3 last_normal = normal;
  double longest = field.voxel_edge() > 0 ? std::max(0.02 * field.length(), field.voxel_edge()) : 0.05 * field.length();
  double path = 0;
  int stalls = 0;
  for (int i = 0; i < kMarchSteps && a.valid && !field.out_of_budget(reserve) && path < radius; ++i) {
    if (on_level(field, a)) return {!a.plateau, a};
    if (!a.plateau) last_normal = a.n;
    if (!(max_abs(last_normal) > 0)) return {false, a};
    const double step = std::min(a.plateau ? longest : std::min(std::fabs(a.distance), longest), radius - path);
    const LevelPoint b = field.at(a.p - last_normal * (a.sigma > 0 ? step : -step));
    if (!b.valid) return {false, a};
    if (opposite(a.sigma, b.sigma)) return find_root_between(field, a, b);
    if ((std::fabs(b.sigma) > std::fabs(a.sigma) || dot(a.n, b.n) < 0)) {
      // across a ridge or a valley: shorter steps
      if (++stalls > 8) return {false, a};
      longest = std::max(0.5 * step, field.march_step());
    }
    path += step;
    if (i >= 8) longest = std::min(longest * 1.5, 0.25 * field.length());
    a = b;
  }
  return {a.valid && !a.plateau && on_level(field, a), a};
}

LevelSetHit search_by_scan(LevelSetField& field, const LevelPoint& centre, bool axes_only, SurfaceScan& scan) noexcept {
  constexpr int kDirections = 27;
  constexpr std::array<double, 8> kRadii{1.0 / 64, 1.0 / 35, 1.0 / 20, 1.0 / 11, 1.0 / 6, 0.3, 0.55, 1.0};
  std::array<LevelPoint, kDirections> last;
  std::array<bool, kDirections> known{};
  LevelPoint nearest;
  if (scan.has_nearest) nearest = field.at(scan.nearest);
  for (constexpr int end = kDirections * static_cast<int>(kRadii.size()); scan.next_direction < end; ++scan.next_direction) {
    const int k = scan.next_direction % kDirections, ring = scan.next_direction / kDirections;
    const Vec3 towards(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (k == 13 || (axes_only && dot(towards, towards) > 1)) continue;
    const Vec3 d = direction(towards);
    const auto on_ring = [&](int r) { return centre.p + d * (kRadii[static_cast<std::size_t>(r)] * field.length()); };
    const Vec3 candidate = on_ring(ring);
    if (max_abs(field.clamped(candidate) - candidate) > 0) continue;
    if (field.out_of_budget(kReserve)) break;
    LevelPoint& before = last[static_cast<std::size_t>(k)];
    // if a scan resumes, the previous ring is sampled first
    if (!known[static_cast<std::size_t>(k)]) before = ring == 0 ? centre : field.at(on_ring(ring - 1));
    known[static_cast<std::size_t>(k)] = true;
    const LevelPoint here = field.at(candidate);
    if (here.valid && before.valid && opposite(here.sigma, before.sigma)) {
      const LevelSetHit root = find_root_between(field, before, here);
      if (root.found) return root;
      if (field.out_of_budget()) break;
    }
    before = here;
    if (here.valid && !here.plateau && (!nearest.valid || std::fabs(here.sigma) < std::fabs(nearest.sigma))) nearest = here;
  }
  scan.has_nearest = nearest.valid;
  scan.nearest = nearest.p;
  scan.in_progress = scan.next_direction < kDirections * static_cast<int>(kRadii.size());
  return {false, nearest};
}

}  // namespace catena::haptics
