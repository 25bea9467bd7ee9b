// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/crossing.h"

#include "engine/field/grid/grid.h"
#include "haptics/constraints/isosurface/cell_walk.h"

namespace catena::haptics {
namespace {

constexpr int kMaxCells = 160, kSegmentSteps = 64, kDipTrials = 12, kRootHalvings = 60;
constexpr int kForTheRest = 48;  // field samples reserved for the work after a crossing

bool other_side(double a, double b) { return (a < 0) != (b < 0); }

/// Cubic through the values g at 0, 1/3, 2/3 and 1.
struct Cubic {
  double c0, c1, c2, c3;

  explicit Cubic(const std::array<double, 4>& g)
      : c0(g[0]),
        c1(-5.5 * g[0] + 9 * g[1] - 4.5 * g[2] + g[3]),
        c2(9 * g[0] - 22.5 * g[1] + 18 * g[2] - 4.5 * g[3]),
        c3(-4.5 * g[0] + 13.5 * g[1] - 13.5 * g[2] + 4.5 * g[3]) {}
  double at(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }

  /// Returns the first point in 0..1 where the sign differs from that of `side`; a value above 1 if there is none.
  double leaves(double side) const {
    // the extrema in ascending order, and the end
    std::array<double, 3> stops{2, 2, 1};
    const double root = c2 * c2 - 3 * c1 * c3;
    if (root > 0) {
      const double q = -(c2 + (c2 < 0 ? -std::sqrt(root) : std::sqrt(root)));
      const double a = q != 0 ? c1 / q : 2, b = c3 != 0 ? q / (3 * c3) : 2;
      stops[0] = std::min(a, b);
      stops[1] = std::max(a, b);
    }
    double before = 0;
    for (const double stop : stops) {
      if (!(stop > before && stop <= 1)) continue;
      if (other_side(at(stop), side)) return halve(before, stop, side);
      before = stop;
    }
    return 2;
  }

 private:
  double halve(double low, double high, double side) const {
    for (int i = 0; i < kRootHalvings; ++i) {
      const double mid = 0.5 * (low + high);
      if (!(mid > low && mid < high)) break;
      (other_side(at(mid), side) ? high : low) = mid;
    }
    return high;
  }
};

/// Part of a + t d, 0 <= t <= 1, inside the box of a grid.
struct Part {
  double first = 0, last = 1;

  Part(const field::Box& box, const Vec3& a, const Vec3& d) {
    for (int k = 0; k < 3; ++k) {
      if (is_flat(box, k)) continue;
      if (d[k] == 0) {
        if (a[k] < box.lo[k] || a[k] > box.hi[k]) last = -1;
        continue;
      }
      const double s = (box.lo[k] - a[k]) / d[k], t = (box.hi[k] - a[k]) / d[k];
      first = std::max(first, std::min(s, t));
      last = std::min(last, std::max(s, t));
    }
  }
};

/// Returns the next t at which a + t d crosses a cell face; 2: none.
double next_face(const Vec3& a, const Vec3& d, double t) {
  double next = 2;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) continue;
    const double here = a[k] + t * d[k];
    const double face = d[k] > 0 ? std::floor(here + kFaceTolerance) + 1 : std::ceil(here - kFaceTolerance) - 1;
    next = std::min(next, (face - a[k]) / d[k]);
  }
  return next;
}

LevelSetHit cross_cells(LevelSetField& field, const Vec3& from, const LevelPoint& to) noexcept {
  const field::CellField& grid = *field.trilinear_grid();
  const field::Mapping& mapping = grid.mapping();
  const Vec3 a = mapping.index_from_world(from), d = mapping.index_from_world_linear * (to.p - from);
  const Part part(grid.index_box(), a, d);
  CellCache cells(field);
  double side = 0;
  double t = part.first;
  for (int i = 0; i < kMaxCells && t < part.last && !field.out_of_budget(kForTheRest); ++i) {
    const double end = std::min(std::max(next_face(a, d, t), t + 1e-12), part.last);
    const field::ScalarCell* cell = cells.fetch(grid.cell_base(a + d * (0.5 * (t + end))));
    if (cell == nullptr) {
      side = 0;
      t = end;
      continue;
    }
    const auto [minimum, maximum] = std::minmax_element(cell->corner.begin(), cell->corner.end());
    if (!(*minimum - field.level() > 0) && !(*maximum - field.level() < 0)) {
      std::array<double, 4> g;
      const Vec3 base(cell->base.x, cell->base.y, cell->base.z);
      for (int k = 0; k < 4; ++k) g[static_cast<std::size_t>(k)] = cell->value(a + d * (t + (end - t) * k / 3) - base) - field.level();
      ++field.steps();
      if (side == 0) side = g[0] < 0 ? -1 : 1;
      const double s = Cubic(g).leaves(side);
      if (s <= 1) {
        const LevelPoint at = field.at(mapping.world_from_index(a + d * (t + (end - t) * s)));
        return {at.valid && !at.plateau, at};
      }
    } else {
      side = *minimum > field.level() ? 1 : -1;
    }
    t = end;
  }
  return {};
}

/// Finds a dip of the value between two points on the same side that crosses the level, if the tangents allow one.
LevelSetHit cross_dip(LevelSetField& field, LevelPoint a, LevelPoint b) noexcept {
  const double side = a.sigma < 0 ? -1 : 1;
  for (int i = 0; i < kDipTrials && !field.out_of_budget(kForTheRest); ++i) {
    const Vec3 way = b.p - a.p;
    const double va = side * a.sigma, vb = side * b.sigma;
    const double da = side * a.slope * dot(a.n, way), db = side * b.slope * dot(b.n, way);
    if (!(da < 0 && db > 0)) return {};
    const double t = (vb - db - va) / (da - db);
    if (!(t > 0 && t < 1) || va + da * t >= 0) return {};
    const LevelPoint c = field.at(a.p + way * std::min(std::max(t, 0.1), 0.9));
    if (!c.valid) return {};
    if (other_side(c.sigma, side)) return find_root_between(field, a, c);
    if (c.plateau) return {};
    (side * dot(c.n, way) > 0 ? b : a) = c;
  }
  return {};
}

LevelSetHit cross_steps(LevelSetField& field, const Vec3& from, const LevelPoint& to, const LevelPoint* known) noexcept {
  const double length = norm(to.p - from);
  const double count = std::min(std::max(std::ceil(length / field.march_step()), 1.0), static_cast<double>(kSegmentSteps));
  LevelPoint a = known != nullptr ? *known : field.at(from);
  for (double i = 1; i <= count && !field.out_of_budget(kForTheRest); ++i) {
    const LevelPoint b = i == count ? to : field.at(from + (to.p - from) * (i / count));
    if (a.valid && b.valid) {
      const LevelSetHit root = other_side(a.sigma, b.sigma) ? find_root_between(field, a, b) : cross_dip(field, a, b);
      if (root.found) return root;
    }
    a = b;
  }
  return {};
}

}  // namespace

LevelSetHit find_first_crossing(LevelSetField& field, const Vec3& from, const LevelPoint& to, const LevelPoint* known) noexcept {
  const bool in_cells = field.trilinear_grid() != nullptr && norm(to.p - from) <= kMaxCells / 3 * field.voxel_edge();
  return in_cells ? cross_cells(field, from, to) : cross_steps(field, from, to, known);
}

bool stays_on_side(const LevelSetField& field, const LevelPoint& a, const LevelPoint& b) noexcept {
  const Vec3 way = b.p - a.p;
  if (!a.valid || !b.valid || other_side(a.sigma, b.sigma) || norm(way) > field.march_step()) return false;
  const double side = a.sigma < 0 ? -1 : 1;
  return !(side * dot(a.n, way) < 0 && side * dot(b.n, way) > 0);
}

}  // namespace catena::haptics
