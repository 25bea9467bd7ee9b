#include "haptics/constraints/isosurface/level.h"

#include "engine/field/grid.h"

namespace catena::haptics {

LevelPoint LevelField::at(const Vec3& world) noexcept {
  LevelPoint out;
  out.p = clamped(world);
  if (spent()) return out;
  count_fetch();
  const field::ScalarSample sample = grid_ ? grid_->sample(out.p, cursor_) : field_.sample(out.p, cursor_);
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

Vec3 LevelField::nearest(const Vec3& index) const noexcept {
  const field::Box& box = field_.index_box();
  const Vec3 inside{std::min(std::max(index.x, box.lo.x), box.hi.x), std::min(std::max(index.y, box.lo.y), box.hi.y),
                    std::min(std::max(index.z, box.lo.z), box.hi.z)};
  return field_.mapping().world_from_index(inside);
}

double LevelField::march_step() const noexcept { return grid_ ? 0.5 * field_.mapping().smallest_edge() : field_.length() * (1.0 / 256); }

void tangents(const Vec3& n, Vec3& a, Vec3& b) noexcept {
  const Vec3 m{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  const Vec3 axis = m.x <= m.y && m.x <= m.z ? Vec3(1.0, 0.0, 0.0) : m.y <= m.z ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
  a = direction(cross(n, axis));
  b = cross(n, a);
}

}  // namespace catena::haptics
