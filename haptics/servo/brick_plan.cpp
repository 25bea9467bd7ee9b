// SPDX-License-Identifier: MIT
#include "haptics/servo/brick_plan.h"

#include <algorithm>
#include <unordered_set>

namespace catena::haptics {

namespace {

/// Collects bricks in the order in which they are first named.
class Collector {
 public:
  Collector(const field::PagedGrid& grid, std::size_t max_bricks) : grid_(grid), max_bricks_(max_bricks) {}
  bool is_full() const { return plan_.size() >= max_bricks_; }

  /// Adds the bricks that a cube in index space touches, if it touches the grid.
  void add_cube(const Vec3& center, double half_edge) {
    const field::Box& box = grid_.index_box();
    if (!is_finite(center) || !box.contains(center, half_edge)) return;
    const field::Index3 lo = grid_.brick_of(center - Vec3(half_edge)), hi = grid_.brick_of(center + Vec3(half_edge));
    for (int z = lo.z; z <= hi.z; ++z)
      for (int y = lo.y; y <= hi.y; ++y)
        for (int x = lo.x; x <= hi.x && !is_full(); ++x) add({x, y, z});
  }
  std::vector<field::BrickId> take() { return std::move(plan_); }

 private:
  void add(const field::Index3& brick) {
    const field::BrickId id = grid_.brick_id(brick);
    if (known_.insert(id.number).second) plan_.push_back(id);
  }

  const field::PagedGrid& grid_;
  std::size_t max_bricks_;
  std::unordered_set<std::uint64_t> known_;
  std::vector<field::BrickId> plan_;
};

}  // namespace

std::vector<field::BrickId> plan_bricks(const field::PagedGrid& grid, std::span<const WatchedPosition> positions,
                                        const PlanLimits& limits) {
  const field::Mapping& mapping = grid.mapping();
  // in index space; positions beside another one need no plan of their own
  std::vector<WatchedPosition> points;
  for (const WatchedPosition& at : positions) {
    const WatchedPosition point{mapping.index_from_world(at.position), mapping.index_from_world_linear * at.velocity};
    const auto is_beside = [&](const WatchedPosition& other) { return norm(other.position - point.position) < 0.5 * limits.near_voxels; };
    if (std::ranges::none_of(points, is_beside)) points.push_back(point);
  }
  Collector plan(grid, limits.max_bricks);
  double fastest = 0;
  for (const WatchedPosition& at : points) fastest = std::max(fastest, norm(at.velocity));
  const double way = fastest * limits.look_ahead_s;
  const auto add_way = [&](double margin, double step, double max_steps) {
    const int steps = std::isfinite(way) ? static_cast<int>(std::min(max_steps, std::ceil(way / step))) : 0;
    for (int k = 0; k <= steps && !plan.is_full(); ++k)
      for (const WatchedPosition& at : points)
        plan.add_cube(at.position + at.velocity * (steps > 0 ? limits.look_ahead_s * k / steps : 0.0), margin);
  };
  add_way(limits.near_voxels, limits.near_voxels, 512);
  constexpr double kEdge = field::kBrickEdge;
  for (double margin = kEdge / 2; margin <= 2.5 * kEdge && !plan.is_full(); margin += kEdge) add_way(margin, kEdge, 64);
  return plan.take();
}

}  // namespace catena::haptics
