#include "engine/flow/direction.h"

namespace catena::flow {

Stop direction_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& u) noexcept {
  if (flow.line) {
    const field::LineSample sample = flow.field->sample_line(p, cursor);
    return sample.inside ? axis_direction(sample, flow.min_speed, reference, u) : Stop::outside;
  }
  const field::VectorSample sample = flow.field->sample(p, cursor);
  return sample.inside ? unit_direction(sample.value, flow.min_speed, u) : Stop::outside;
}

}  // namespace catena::flow
