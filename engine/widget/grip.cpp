#include "engine/widget/grip.h"

#include "engine/widget/geometry.h"

namespace catena::widget {

void add_planes(const Spec& spec, State& state, const Vec3& probe, Plan& plan) noexcept {
  const Grip& grip = state.grip;
  state.held = 0;
  for (int i = 0; i < 3; ++i) {
    const auto bit = static_cast<std::uint8_t>(1u << i);
    const Vec3 axis = axis_of(grip.frame, i);
    const bool within = std::fabs(dot(axis, probe - grip.grab)) <= spec.step;
    if ((grip.fixed & bit) == 0 && ((grip.loose & bit) != 0 || !within)) continue;
    state.held = static_cast<std::uint8_t>(state.held | bit);
    plan.add(i, {Shape::Kind::plane, grip.grab, axis, 0});
  }
}

Vec3 displacement(const Spec& spec, const State& state, const Vec3& proxy) noexcept {
  Vec3 out(0.0);
  for (int i = 0; i < 3; ++i) {
    if ((state.held & (1u << i)) != 0) continue;
    const double u = dot(axis_of(state.grip.frame, i), proxy - state.grip.grab);
    out[i] = (state.grip.loose & (1u << i)) != 0 ? u : deadzone(u, spec.step);
  }
  return out;
}

Vec3 moved(const Vec3& from, const Quat& frame, const Vec3& displacement) noexcept {
  Vec3 to = from;
  for (int i = 0; i < 3; ++i)
    if (displacement[i] != 0) to += axis_of(frame, i) * displacement[i];
  return to;
}

}  // namespace catena::widget
