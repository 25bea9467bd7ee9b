// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/flow.h"

namespace catena::flow {

namespace {
constexpr const char* kWords[] = {"linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54"};
}

std::optional<Method> parse_method(std::string_view word) {
  for (int i = 0; i < 7; ++i)
    if (word == kWords[i]) return static_cast<Method>(i);
  return std::nullopt;
}

const char* to_string(Method method) { return kWords[static_cast<int>(method)]; }

// flatten inlines all calls: every evaluation passes through here, whatever file a callee is in
[[gnu::flatten]] StopReason direction_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& u) noexcept {
  if (flow.is_line_field) {
    const field::LineSample sample = flow.field->sample_line(p, cursor);
    return sample.inside ? axis_direction(sample, flow.min_speed, reference, u) : StopReason::outside;
  }
  const field::VectorSample sample = flow.field->sample(p, cursor);
  return sample.inside ? unit_direction(sample.value, flow.min_speed, u) : StopReason::outside;
}

}  // namespace catena::flow
