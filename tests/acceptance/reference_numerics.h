// SPDX-License-Identifier: MIT
/// References of the acceptance tests, independent of the product's numerics: long double vectors, Runge-Kutta integration,
/// Dormand-Prince 5(4) with step control, and closed forms.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/base/vec.h"

namespace catena::acceptance {

using Real = long double;

struct Real3 {
  Real x = 0, y = 0, z = 0;
  Real3() = default;
  Real3(Real a, Real b, Real c) : x(a), y(b), z(c) {}
  explicit Real3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  Vec3 rounded() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};
inline Real3 operator+(const Real3& a, const Real3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Real3 operator-(const Real3& a, const Real3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Real3 operator*(Real s, const Real3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Real dot(const Real3& a, const Real3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Real length(const Real3& a) { return std::sqrt(dot(a, a)); }
inline Real3 unit_direction(const Real3& a) { return (1 / length(a)) * a; }

/// The classical Runge-Kutta method with rate `v` over time t in `steps` steps.
template <class Rate>
Real3 integrate_rk4(const Rate& v, Real3 p, Real t, int steps) {
  const Real h = t / steps;
  for (int i = 0; i < steps; ++i) {
    const Real3 a = v(p), b = v(p + (h / 2) * a), c = v(p + (h / 2) * b), d = v(p + h * c);
    p = p + (h / 6) * (a + 2 * b + 2 * c + d);
  }
  return p;
}

/// Dormand-Prince 5(4) from p over the signed length s of the unit rate u(p, last direction), with an error of at most `tolerance` per
/// step. Returns the end; `last` is the direction there.
template <class Rate>
Real3 dormand_prince(const Rate& u, Real3 p, Real s, Real tolerance, Real3& last, Real& h) {
  const Real sign = s < 0 ? -1 : 1;
  Real left = std::fabs(s);
  Real3 k1 = u(p, last);
  last = k1;
  if (!(h > 0)) h = left;
  while (left > 0) {
    const Real step = std::min(h, left), d = sign * step;
    const auto at = [&](const Real3& q) { return u(q, last); };
    const Real3 k2 = at(p + d * (0.2L * k1));
    const Real3 k3 = at(p + d * (3 / 40.0L * k1 + 9 / 40.0L * k2));
    const Real3 k4 = at(p + d * (44 / 45.0L * k1 - 56 / 15.0L * k2 + 32 / 9.0L * k3));
    const Real3 k5 = at(p + d * (19372 / 6561.0L * k1 - 25360 / 2187.0L * k2 + 64448 / 6561.0L * k3 - 212 / 729.0L * k4));
    const Real3 k6 = at(p + d * (9017 / 3168.0L * k1 - 355 / 33.0L * k2 + 46732 / 5247.0L * k3 + 49 / 176.0L * k4 - 5103 / 18656.0L * k5));
    const Real3 next = p + d * (35 / 384.0L * k1 + 500 / 1113.0L * k3 + 125 / 192.0L * k4 - 2187 / 6784.0L * k5 + 11 / 84.0L * k6);
    const Real3 k7 = at(next);
    const Real3 e =
        d * (71 / 57600.0L * k1 - 71 / 16695.0L * k3 + 71 / 1920.0L * k4 - 17253 / 339200.0L * k5 + 22 / 525.0L * k6 - 1 / 40.0L * k7);
    const Real error = length(e);
    const Real factor = error > 0 ? 0.9L * std::sqrt(std::sqrt(tolerance / error)) : 4;
    if (error > tolerance && step > 1e-17L) {
      h = step * std::max<Real>(0.1L, std::min<Real>(0.8L, factor));
      continue;
    }
    p = next;
    k1 = k7;
    last = k7;
    left = step < left ? left - step : 0;
    if (step == h || factor < 1) h = step * std::min<Real>(4, std::max<Real>(0.5L, factor));
  }
  return p;
}
inline Real3 operator-(const Real3& a) { return {-a.x, -a.y, -a.z}; }

inline Real3 abc_flow(const Real3& p) {
  const Real a = std::sqrt(3.0L), b = std::sqrt(2.0L), c = 1;
  return {a * std::sin(p.z) + c * std::cos(p.y), b * std::sin(p.x) + a * std::cos(p.z), c * std::sin(p.y) + b * std::cos(p.x)};
}

/// Distance of p from the closed streamline of Hill's vortex through (r0, 0, 0), within the plane y = 0 and perpendicular to it, by the
/// level set of the stream function r^2 (1 - r^2 - z^2).
inline double hill_streamline_distance(const Vec3& at, Real r0) {
  const Real3 p(at);
  const auto psi = [](Real r, Real z) { return r * r * (1 - r * r - z * z); };
  const Real goal = psi(r0, 0), r_at = std::sqrt(p.x * p.x + p.y * p.y);
  Real r = r_at, z = p.z;
  for (int i = 0; i < 4; ++i) {
    const Real gr = 2 * r * (1 - r * r - z * z) - 2 * r * r * r, gz = -2 * r * r * z, w = (psi(r, z) - goal) / (gr * gr + gz * gz);
    r -= w * gr;
    z -= w * gz;
  }
  return static_cast<double>(std::sqrt((r - r_at) * (r - r_at) + (z - p.z) * (z - p.z) + p.y * p.y));
}

/// Prints a measured figure and records it as a property of the test.
inline void record_result(const std::string& what, double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  std::printf("    %-72s %s\n", what.c_str(), text);
  std::string key;
  for (const char c : what) key += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  testing::Test::RecordProperty(key, text);
}

/// Records a figure, and expects that it is at most `bound`.
inline void expect_at_most(const std::string& what, double value, double bound) {
  record_result(what, value);
  EXPECT_LE(value, bound) << what;
}

/// Records figures whose names begin with `who`.
inline void record_results(const std::string& who, std::initializer_list<std::pair<const char*, double>> figures) {
  for (const auto& [what, value] : figures) record_result(who + what, value);
}

}  // namespace catena::acceptance
