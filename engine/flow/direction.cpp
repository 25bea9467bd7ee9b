#include "engine/flow/direction.h"

#include "engine/field/grid.h"

namespace catena::flow {

Stop direction_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& u) noexcept {
  const field::VectorSample sample = flow.field->sample(p, cursor, flow.line ? &reference : nullptr);
  if (!sample.inside) return Stop::outside;
  return unit_direction(sample.value, flow.min_speed, u);
}

Stop seed_direction(const Flow& flow, const Vec3& seed, field::Cursor& cursor, Vec3& u) noexcept {
  const field::VectorGrid* grid = flow.line ? flow.field->grid() : nullptr;
  if (!grid) {
    const field::VectorSample sample = flow.field->sample(seed, cursor);
    return sample.inside ? unit_direction(sample.value, flow.min_speed, u) : Stop::outside;
  }
  const Vec3 index = grid->mapping().index_from_world(seed);
  const field::VectorCell cell = grid->cell(grid->base_of(index), cursor);
  const Vec3 f = index - Vec3(cell.base.x, cell.base.y, cell.base.z);
  return direction_at(flow, seed, nearest_side(cell, f), cursor, u);
}

Vec3 nearest_side(const field::VectorCell& cell, const Vec3& f) noexcept {
  Vec3 reference(0.0);
  double nearest = -1;
  for (int c = 0; c < 8; ++c) {
    const double weight = ((c & 1) ? f.x : 1 - f.x) * ((c & 2) ? f.y : 1 - f.y) * ((c & 4) ? f.z : 1 - f.z);
    const Vec3 side = direction(cell.corner[static_cast<std::size_t>(c)]);
    if (weight > nearest && max_abs(side) > 0) {
      nearest = weight;
      reference = side;
    }
  }
  return reference;
}

}  // namespace catena::flow
