// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/closest_point.h"

#include "haptics/constraints/equations.h"

namespace catena::haptics {
namespace {

constexpr double kShrink = 0.35;
constexpr int kSlow = 12;  // steps after which convergence counts as slow

}  // namespace

void update_curvature(const LevelPoint& from, const LevelPoint& to, double length, Curvature& b) noexcept {
  const auto on_plane = [&](const Vec3& v) { return equation::tangential_component(v, to.n); };
  const Vec3 sigma = on_plane(to.p - from.p), y = on_plane(to.n - from.n);
  const Vec3 r = on_plane(y - b.times(sigma));
  const double step = norm(sigma), rs = dot(r, sigma);
  if (step < 1e-6 * (length / 4) || std::fabs(rs) <= 1e-8 * norm(r) * step) return;
  b.xx += r.x * r.x / rs;
  b.yy += r.y * r.y / rs;
  b.zz += r.z * r.z / rs;
  b.yz += r.y * r.z / rs;
  b.xz += r.x * r.z / rs;
  b.xy += r.x * r.y / rs;
  const double maximum = std::max(max_abs({b.xx, b.yy, b.zz}), max_abs({b.yz, b.xz, b.xy}));
  if (!(maximum <= 1e4 / length)) b = Curvature{};
}

Curvature measure_curvature(LevelSetField& field, const LevelPoint& at) noexcept {
  const double h = 1e-6 * field.length();
  Vec3 t1, t2;
  make_tangent_basis(at.n, t1, t2);
  const LevelPoint p1 = field.at(at.p + t1 * h), p2 = field.at(at.p + t2 * h);
  if (!p1.valid || !p2.valid || p1.plateau || p2.plateau) return {};
  const Vec3 y1 = (p1.n - at.n) * (1 / h), y2 = (p2.n - at.n) * (1 / h);
  const double b11 = dot(t1, y1), b22 = dot(t2, y2), b12 = 0.5 * (dot(t1, y2) + dot(t2, y1));
  const auto entry = [&](int i, int k) { return b11 * t1[i] * t1[k] + b12 * (t1[i] * t2[k] + t2[i] * t1[k]) + b22 * t2[i] * t2[k]; };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(1, 2), entry(0, 2), entry(0, 1)};
}

void solve_tangent(double m11, double m12, double m22, double t1, double t2, double min_size, double& u1, double& u2) noexcept {
  // eigenvalues of [m11 m12; m12 m22] and the eigenvector (c, s) of the first
  const double mean = 0.5 * (m11 + m22), half = 0.5 * (m11 - m22);
  const double radius = std::sqrt(half * half + m12 * m12);
  const auto safe = [min_size](double v) { return std::max(std::fabs(v), min_size); };
  double c = half + (half >= 0 ? radius : -radius), s = m12;
  const double size = std::sqrt(c * c + s * s);
  if (!(size > 0))
    c = 1, s = 0;
  else
    c /= size, s /= size;
  const double first = safe(half >= 0 ? mean + radius : mean - radius), second = safe(half >= 0 ? mean - radius : mean + radius);
  const double a = (c * t1 + s * t2) / first, b = (c * t2 - s * t1) / second;
  u1 = c * a - s * b;
  u2 = s * a + c * b;
}

ClosestPointResult closest_point(LevelSetField& field, const Vec3& probe, const ClosestPointCriteria& goal, LevelPoint& at,
                                 Curvature& curvature) noexcept {
  const double length = field.length();
  double trust = 0.3 * length;
  bool restarted = false;
  const std::int32_t first = field.evaluations();
  LevelPoint a = at;
  ClosestPointResult answer = ClosestPointResult::out_of_budget;
  double min_size = 0.1;
  for (int step_count = 0;; ++step_count) {
    // slow: the surface is nearly a sphere around the probe, and the step depends on the last digits of the curvature
    if (step_count >= kSlow && (step_count - kSlow) % 6 == 0) {
      curvature = measure_curvature(field, a);
      min_size = std::max(0.1 * min_size, 1e-4);
    }
    const Vec3 e = probe - a.p;
    const double delta = dot(a.n, e);
    const Vec3 t = e - a.n * delta;
    const double tangential = norm(t);
    const double level_goal = std::max(goal.level_tolerance, a.round_off);
    const double tangential_goal = std::max(goal.tangential_tolerance, 1e-15 * norm(e));
    if (tangential <= tangential_goal && std::fabs(a.distance) <= level_goal) {
      answer = ClosestPointResult::converged;
      break;
    }

    // Newton step on the tangent plane
    Vec3 t1, t2;
    make_tangent_basis(a.n, t1, t2);
    const auto newton = [&] {
      if (!(tangential > 0)) return Vec3(0.0);
      const Vec3 b1 = curvature.times(t1), b2 = curvature.times(t2);
      double u1, u2;
      solve_tangent(1 + delta * dot(t1, b1), delta * dot(t1, b2), 1 + delta * dot(t2, b2), dot(t, t1), dot(t, t2), min_size, u1, u2);
      const Vec3 step = t1 * u1 + t2 * u2;
      const double size = norm(step);
      return size > trust ? step * (trust / size) : step;
    };
    Vec3 u = newton();

    // shrinks the step until it is accepted
    bool accepted = false;
    double pull = 1;
    LevelPoint c;
    for (int trial = 0; trial < goal.max_rejections; ++trial) {
      if (field.out_of_budget() || field.evaluations() - first >= goal.max_fetches) {
        at = a;
        return ClosestPointResult::out_of_budget;
      }
      const double w = pull * (-a.distance - 0.5 * dot(u, curvature.times(u)));
      c = field.at(a.p + u + a.n * w);
      const double loosest = std::max(std::fabs(a.distance), 0.5 * norm(u));
      if (c.valid && !c.plateau && dot(a.n, c.n) > 0.3 && std::fabs(c.distance) <= loosest) {
        // change of the merit function, from differences, so that it stays exact near convergence
        const Vec3 e2 = probe - c.p;
        const Vec3 change = (a.p - c.p) + c.n * c.distance - a.n * a.distance;
        const Vec3 sum = e + e2 + a.n * a.distance + c.n * c.distance;
        const double merit = 0.5 * dot(change, sum) + 0.5 * (c.distance - a.distance) * (c.distance + a.distance);
        const double next = norm(equation::tangential_component(e2, c.n));
        const bool level_halved = std::fabs(a.distance) > level_goal && std::fabs(c.distance) <= 0.5 * std::fabs(a.distance) &&
                                  norm(e2) <= norm(e) + 1.1 * std::fabs(a.distance);
        const bool close =
            tangential <= 1e-5 * length && next <= 0.9 * tangential && std::fabs(c.distance) <= std::max(level_goal, 1e-3 * next);
        if ((tangential > 0 && merit <= -1e-4 * dot(t, u)) || level_halved || close) {
          accepted = true;
          break;
        }
      }
      if (trial == 2) {
        curvature = measure_curvature(field, a);
        u = newton();
        continue;
      }
      u = u * kShrink;
      if (trial >= 5) pull *= kShrink;
      if (norm(u) + std::fabs(w) < 1e-14 * length) break;
    }
    if (!accepted) {
      const bool fine =
          tangential <= std::max(1e-7 * length, goal.tangential_tolerance) && std::fabs(a.distance) <= std::max(4e-12 * length, level_goal);
      if (fine || restarted) {
        answer = fine ? ClosestPointResult::converged : ClosestPointResult::stuck;
        break;
      }
      curvature = Curvature{};
      trust = 0.01 * length;
      restarted = true;
      continue;
    }
    const double moved = norm(u);
    update_curvature(a, c, length, curvature);
    trust = std::max(4 * moved, 1e-3 * length);
    a = c;
  }
  at = a;
  return answer;
}

}  // namespace catena::haptics
