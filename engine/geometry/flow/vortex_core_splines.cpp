// SPDX-License-Identifier: MIT
#include <algorithm>
#include <glm/matrix.hpp>

#include "engine/base/result.h"
#include "engine/geometry/flow/vortex_cores.h"

namespace catena::flow {
namespace {

constexpr int kSweeps = 60;  // Gauss-Seidel sweeps: each halves the error

/// Returns the derivatives of the interpolating cubic spline at its knots; the parameter grows by h[k] from knot k. The first and the last
/// piece of an open spline are parabolas.
std::vector<Vec3> spline_slopes(const std::vector<Vec3>& p, const std::vector<double>& h, bool closed) {
  const std::size_t n = p.size(), pieces = h.size();
  std::vector<Vec3> m(n);
  for (std::size_t k = 0; k < n; ++k) m[k] = (p[(k + 1) % n] - p[k]) * (k < pieces ? 1 / h[k] : 0);
  if (n == 2 && !closed) {
    m[1] = m[0];
    return m;
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t k = 0; k < n; ++k) {
      if (!closed && k == 0) {
        m[0] = (p[1] - p[0]) * (2 / h[0]) - m[1];
      } else if (!closed && k == n - 1) {
        m[k] = (p[k] - p[k - 1]) * (2 / h[k - 1]) - m[k - 1];
      } else {
        const std::size_t previous = k == 0 ? n - 1 : k - 1, next = (k + 1) % n;
        const double a = 1 / h[previous], b = 1 / h[k];
        const Vec3 right_side = ((p[k] - p[previous]) * (a * a) + (p[next] - p[k]) * (b * b)) * 3.0;
        m[k] = (right_side - m[previous] * a - m[next] * b) * (0.5 / (a + b));
      }
    }
  return m;
}

}  // namespace

std::vector<Vec3> fair_points(const std::vector<Vec3>& points, bool closed, int half_window) {
  const int n = static_cast<int>(points.size());
  std::vector<Vec3> out(points);
  for (int i = 0; i < n; ++i) {
    const int half = closed ? std::min(half_window, (n - 1) / 2) : std::min({half_window, i, n - 1 - i});
    if (half < 2) continue;
    const auto at = [&](int k) -> const Vec3& { return points[static_cast<std::size_t>((i + k + n) % n)]; };
    // least-squares parabola, parametrized by chord length
    Mat3 normal(0.0), right_side(0.0);
    const auto add = [&](double u, const Vec3& p) {
      const Vec3 powers(1, u, u * u);
      for (int r = 0; r < 3; ++r) {
        normal[r] += powers * powers[r];
        right_side[r] += p * powers[r];
      }
    };
    const double unit = norm(at(1) - at(0));
    add(0, Vec3(0.0));
    for (const int direction_sign : {-1, 1}) {
      double u = 0;
      for (int k = 1; k <= half; ++k) {
        u += direction_sign * norm(at(direction_sign * k) - at(direction_sign * (k - 1))) / unit;
        add(u, at(direction_sign * k) - points[static_cast<std::size_t>(i)]);
      }
    }
    const Mat3 inverse = glm::inverse(normal);
    const Vec3 moved = right_side[0] * inverse[0][0] + right_side[1] * inverse[1][0] + right_side[2] * inverse[2][0];
    if (is_finite(moved)) out[static_cast<std::size_t>(i)] += moved;
  }
  return out;
}

CurvePtr spline_through(const std::vector<Vec3>& points, bool closed, const LineEnd& first, const LineEnd& last, double domain_length) {
  const std::size_t n = points.size(), pieces = closed ? n : n - 1;
  std::vector<double> h(pieces);
  for (std::size_t k = 0; k < pieces; ++k) h[k] = norm(points[(k + 1) % n] - points[k]);
  // parametrized by chord length first, then by the arc lengths of the resulting spline
  std::vector<Vec3> slopes = spline_slopes(points, h, closed);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t k = 0; k < pieces; ++k) {
      const std::size_t next = (k + 1) % n;
      h[k] = Hermite(points[k], points[next] - points[k], h[k], slopes[k], slopes[next]).length();
    }
    slopes = spline_slopes(points, h, closed);
  }
  std::vector<Knot> knots;
  double s = 0;
  for (std::size_t k = 0; k <= pieces; ++k) {
    knots.push_back({s, points[k % n], direction(slopes[k % n])});
    if (k < pieces) s += h[k];
  }
  return std::make_shared<const Curve>(std::move(knots), closed, first, last, domain_length);
}

}  // namespace catena::flow
