#include "engine/flow/flow.h"

namespace catena::flow {

namespace {
constexpr const char* kWords[] = {"linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54"};
}

std::optional<Method> method_from_word(std::string_view word) {
  for (int i = 0; i < 7; ++i)
    if (word == kWords[i]) return static_cast<Method>(i);
  return std::nullopt;
}

const char* method_word(Method method) { return kWords[static_cast<int>(method)]; }

// every evaluation comes here: what it calls is part of it, however the files are grouped
[[gnu::flatten]] Stop direction_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& u) noexcept {
  if (flow.line) {
    const field::LineSample sample = flow.field->sample_line(p, cursor);
    return sample.inside ? axis_direction(sample, flow.min_speed, reference, u) : Stop::outside;
  }
  const field::VectorSample sample = flow.field->sample(p, cursor);
  return sample.inside ? unit_direction(sample.value, flow.min_speed, u) : Stop::outside;
}

}  // namespace catena::flow
