// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/level_set_field.h"

#include <bit>

#include "engine/field/grid/grid.h"

namespace catena::haptics {

LevelPoint LevelSetField::at(const Vec3& world) noexcept {
  LevelPoint out;
  out.p = clamped(held_axes_ != 0 ? project_to_wall(world) : world);
  if (out_of_budget()) return out;
  count_fetch();
  field::ScalarSample sample = grid_ ? grid_->sample(out.p, cursor_) : field_.sample(out.p, cursor_);
  if (held_axes_ != 0) sample.gradient = wall_component(sample.gradient);
  out.finite = std::isfinite(sample.value) && is_finite(sample.gradient);
  out.valid = out.finite && (sample.inside || grid_ == nullptr);
  if (!out.finite) return out;
  const double slope = norm(sample.gradient);
  out.slope = slope;
  out.sigma = sample.value - level_;
  out.n = direction(sample.gradient);
  out.distance = out.sigma / slope;
  out.round_off = 4e-16 * (std::fabs(sample.value) + std::fabs(level_)) / slope + 4e-16 * max_abs(out.p);
  out.plateau = !(slope > 0) || !std::isfinite(out.distance) || !std::isfinite(out.round_off);
  if (out.plateau) out.distance = out.round_off = 0, out.n = Vec3(0.0);
  return out;
}

Vec3 LevelSetField::nearest(const Vec3& index) const noexcept {
  const field::Box& box = field_.index_box();
  const Vec3 inside{std::min(std::max(index.x, box.lo.x), box.hi.x), std::min(std::max(index.y, box.lo.y), box.hi.y),
                    std::min(std::max(index.z, box.lo.z), box.hi.z)};
  return field_.mapping().world_from_index(inside);
}

void LevelSetField::constrain_to_wall(unsigned axes, const Vec3& index) noexcept {
  held_axes_ = axes;
  wall_ = index;
  const field::Mapping& mapping = field_.mapping();
  const auto is_held = [axes](int a) { return (axes >> a & 1) != 0; };
  wall_direction_ = Vec3(0.0);
  if (std::popcount(axes) == 1) {
    for (int a = 0; a < 3; ++a)
      if (is_held(a)) wall_direction_ = direction(mapping.world_from_index_gradient(Vec3(a == 0, a == 1, a == 2)));
  } else if (std::popcount(axes) == 2) {
    for (int a = 0; a < 3; ++a)
      if (!is_held(a)) wall_direction_ = direction(mapping.world_from_index_linear[a]);
  }
}

Vec3 LevelSetField::project_to_wall(const Vec3& world) const noexcept {
  if (held_axes_ == 0) return world;
  const field::Mapping& mapping = field_.mapping();
  Vec3 off = wall_ - mapping.index_from_world(world);
  for (int a = 0; a < 3; ++a)
    if ((held_axes_ >> a & 1) == 0) off[a] = 0;
  // along the wall's normal, or perpendicular to the edge: the nearest point, not the point along an oblique axis
  const Vec3 there = world + mapping.world_from_index_linear * off;
  return there + wall_component(world - there);
}

/// Returns the component of a vector along the held axes.
Vec3 LevelSetField::wall_component(const Vec3& v) const noexcept {
  if (std::popcount(held_axes_) == 1) return v - wall_direction_ * dot(wall_direction_, v);
  return std::popcount(held_axes_) == 2 ? wall_direction_ * dot(wall_direction_, v) : Vec3(0.0);
}

double LevelSetField::march_step() const noexcept {
  return grid_ ? 0.5 * field_.mapping().min_voxel_edge() : field_.domain_length() * (1.0 / 256);
}

void make_tangent_basis(const Vec3& n, Vec3& a, Vec3& b) noexcept {
  const Vec3 m{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  const Vec3 axis = m.x <= m.y && m.x <= m.z ? Vec3(1.0, 0.0, 0.0) : m.y <= m.z ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
  a = direction(cross(n, axis));
  b = cross(n, a);
}

}  // namespace catena::haptics
