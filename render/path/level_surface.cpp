// SPDX-License-Identifier: MIT
#include "render/path/level_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace catena::render {
namespace {

constexpr double kStartVoxels = 1e-3;  // distance from the surface at which a new ray starts
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Returns the first root of c0 + c1 t + c2 t^2 + c3 t^3 in [0, 1].
std::optional<double> first_root(const std::array<double, 4>& c) {
  const auto value = [&](double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
  // between the extrema the polynomial is monotonic
  std::array<double, 4> ends{0, 1, 1, 1};
  const double a = 3 * c[3], b = 2 * c[2], discriminant = b * b - 4 * a * c[1];
  if (discriminant > 0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double t1 = a != 0 ? q / a : 2, t2 = q != 0 ? c[1] / q : 2;
    if (t1 > t2) std::swap(t1, t2);
    std::size_t count = 1;
    for (const double t : {t1, t2})
      if (t > 0 && t < 1) ends[count++] = t;
  }
  double lo = 0, at_lo = value(0);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double end = ends[i], at_end = value(end);
    if (at_lo == 0) return lo;
    if ((at_lo < 0) != (at_end < 0) || at_end == 0) {
      double hi = end;
      for (int k = 0; k < 60 && hi - lo > 1e-12; ++k) {
        const double middle = 0.5 * (lo + hi);
        ((value(middle) < 0) == (at_lo < 0) ? lo : hi) = middle;
      }
      return hi;
    }
    lo = end, at_lo = at_end;
    if (end >= 1) break;
  }
  return std::nullopt;
}

/// Walk from cell to cell, or from block to block of cells, along a ray in index space.
struct CellWalk {
  CellWalk(const Vec3& start, const Vec3& step, double from, int edge, const std::array<int, 3>& count) : t(from) {
    for (int a = 0; a < 3; ++a) {
      const double p = start[a] + from * step[a];
      at[a] = std::clamp(int(std::floor(p / edge)), 0, count[std::size_t(a)] - 1);
      by[a] = step[a] > 0 ? 1 : -1;
      end[a] = step[a] > 0 ? count[std::size_t(a)] : -1;
      next[a] = step[a] != 0 ? (double(edge) * (at[a] + (step[a] > 0 ? 1 : 0)) - start[a]) / step[a] : kNever;
      delta[a] = step[a] != 0 ? edge / std::fabs(step[a]) : kNever;
    }
  }
  int axis() const { return next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2); }
  double leave() const { return next[axis()]; }
  /// Goes on to the next one; false: outside.
  bool advance() {
    const int a = axis();
    t = std::max(t, next[a]);
    next[a] += delta[a];
    at[a] += by[a];
    return at[a] != end[a];
  }
  int at[3], by[3], end[3];
  double t, next[3], delta[3];
};

}  // namespace

SurfaceHit LevelSurface::intersect(const PathRay& ray, double from, double to) const {
  SurfaceHit hit;
  const Vec3 start = grid_->to_index(ray.origin), step = grid_->to_index_direction(ray.direction);
  const auto& size = grid_->size();
  if (grid_->bricks()[0] == 0) return hit;
  for (int a = 0; a < 3; ++a) {
    const double most = size[std::size_t(a)] - 1;
    if (step[a] == 0 && (start[a] < 0 || start[a] > most)) return hit;
    if (step[a] == 0) continue;
    const double x = -start[a] / step[a], y = (most - start[a]) / step[a];
    from = std::max(from, std::min(x, y));
    to = std::min(to, std::max(x, y));
  }
  if (!(from < to)) return hit;
  const auto level = float(item_->level);
  std::array<float, 8> corner{};
  const std::array<int, 3> cells{size[0] - 1, size[1] - 1, size[2] - 1};
  CellWalk brick(start, step, from, DenseGrid::kBrick, grid_->bricks());
  do {
    const auto [lowest, highest] = grid_->range(brick.at[0], brick.at[1], brick.at[2]);
    const double leave = std::min(brick.leave(), to);
    if (lowest > level || highest < level || leave <= brick.t) continue;
    CellWalk cell(start, step, brick.t, 1, cells);
    do {
      const double begin = cell.t, end = std::min(cell.leave(), to);
      if (!(end > begin) || !grid_->is_valid_cell(cell.at[0], cell.at[1], cell.at[2])) continue;
      grid_->corners(cell.at[0], cell.at[1], cell.at[2], corner);
      const auto [least, most] = std::ranges::minmax(corner);
      if (least > level || most < level) continue;
      // the cubic along the ray, from its values at 0, 1/3, 2/3 and 1
      const auto value = [&](double f) {
        const Vec3 p = start + (begin + f * (end - begin)) * step - Vec3(cell.at[0], cell.at[1], cell.at[2]);
        const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
        const double y0 = mix(mix(corner[0], corner[1], p.x), mix(corner[2], corner[3], p.x), p.y);
        const double y1 = mix(mix(corner[4], corner[5], p.x), mix(corner[6], corner[7], p.x), p.y);
        return mix(y0, y1, p.z) - item_->level;
      };
      const double v0 = value(0), v1 = value(1.0 / 3), v2 = value(2.0 / 3), v3 = value(1);
      const std::array<double, 4> cubic{v0, -5.5 * v0 + 9 * v1 - 4.5 * v2 + v3, 9 * v0 - 22.5 * v1 + 18 * v2 - 4.5 * v3,
                                        -4.5 * v0 + 13.5 * v1 - 13.5 * v2 + 4.5 * v3};
      if (const auto root = first_root(cubic)) {
        hit.t = begin + *root * (end - begin);
        const Vec3 p = start + hit.t * step, f = p - Vec3(cell.at[0], cell.at[1], cell.at[2]);
        std::array<double, 8> exact{};
        std::ranges::copy(corner, exact.begin());
        double unused;
        Vec3 gradient;
        field::trilinear(exact, f, unused, gradient);
        hit.normal = grid_->mapping().world_from_index_gradient(gradient);
        hit.shading_normal = grid_->gradient(glm::vec3(p));
        hit.color = item_->color;
        hit.opacity = item_->opacity;
        hit.epsilon = kStartVoxels * grid_->voxel_edge();
        return hit;
      }
    } while (cell.advance() && cell.t < leave);
  } while (brick.advance() && brick.t < to);
  return hit;
}

}  // namespace catena::render
