#include "engine/widget/cutting_plane.h"

#include "engine/widget/handles.h"
#include "engine/widget/widget.h"

namespace catena::widget {

namespace {

const Vec3& center_of(const State& state) noexcept { return state.pose.points[0]; }

double height(const State& state, int axis, const Vec3& probe) noexcept {
  return std::fabs(dot(axis_of(state.pose.orientation, axis), probe - center_of(state)));
}

Shape plane_through_center(const State& state, const Quat& frame, int axis) noexcept {
  return {Shape::Kind::plane, center_of(state), axis_of(frame, axis), 0};
}

void hold(State& state, int axis) noexcept { state.held = static_cast<std::uint8_t>(state.held | 1u << axis); }

void turn(State& state, const Vec3& proxy) noexcept {
  const bool about = state.axis >= 0;
  const Vec3 e = about ? axis_of(state.grip.frame, state.axis) : Vec3(0.0);
  const Vec3 arm = about ? direction_across(proxy - center_of(state), e) : direction(proxy - center_of(state));
  if (!(max_abs(arm) > 0)) return;
  if (state.rebase || !(max_abs(state.arm) > 0)) {
    state.arm = arm;
    state.rebase = false;
    return;
  }
  if (about) {
    state.pose.orientation = normalised(turn_about(e, state.arm, arm) * state.start.orientation);
  } else {
    state.pose.orientation = normalised(shortest_arc(state.arm, arm) * state.pose.orientation);
    state.arm = arm;
  }
}

}  // namespace

Reach reach_of_plane(const Spec& spec, const State& state, const Vec3& probe) noexcept {
  Reach out;
  const double to_sphere = std::fabs(norm(probe - center_of(state)) - spec.radius), to_plane = height(state, 2, probe);
  out.sphere = to_sphere <= spec.near;
  out.plane = to_plane <= (state.mode == Mode::explore ? spec.release : spec.snap);
  out.distance = out.sphere ? to_sphere : to_plane;
  return out;
}

void begin_turn(const Spec& spec, State& state, const Vec3& probe) noexcept {
  // the nearest great circle, if it is near enough
  state.grip = {probe, state.pose.orientation, 0, 0};
  state.axis = -1;
  state.rebase = true;
  if (spec.turning == Turning::free) return;
  std::int8_t nearest = 0;
  for (std::int8_t i = 1; i < 3; ++i)
    if (height(state, i, probe) < height(state, nearest, probe)) nearest = i;
  if (spec.turning == Turning::axis || height(state, nearest, probe) <= spec.near) state.axis = nearest;
}

Plan plan_of_plane(const Spec& spec, State& state, const Vec3& probe) noexcept {
  Plan out;
  const Shape sphere{Shape::Kind::sphere, center_of(state), Vec3(0.0), spec.radius};
  switch (state.mode) {
    case Mode::explore:
      hold(state, 2);
      out.add(2, plane_through_center(state, state.pose.orientation, 2));
      break;
    case Mode::translate:
      out.alone = true;
      add_planes(spec, state, probe, out);
      break;
    case Mode::rotate:
      for (int i = 0; i < 3 && spec.turning != Turning::free; ++i) {
        if (height(state, i, probe) > spec.near) continue;
        hold(state, i);
        out.add(i, plane_through_center(state, state.pose.orientation, i));
      }
      out.add(kSphereSlot, sphere);
      break;
    case Mode::turn:
      out.alone = true;
      if (state.axis >= 0 && spec.turning == Turning::any &&
          !(std::fabs(dot(axis_of(state.grip.frame, state.axis), probe - center_of(state))) <= spec.step)) {
        state.axis = -1;
        state.rebase = true;
      }
      if (state.axis >= 0) {
        hold(state, state.axis);
        out.add(state.axis, plane_through_center(state, state.grip.frame, state.axis));
      }
      out.add(kSphereSlot, sphere);
      break;
    default:
      break;
  }
  return out;
}

void finish_plane(const Spec& spec, State& state, const Vec3& proxy) noexcept {
  if (state.mode == Mode::translate)
    state.pose.points[0] = moved(state.start.points[0], state.grip.frame, displacement(spec, state, proxy));
  else
    turn(state, proxy);
}

}  // namespace catena::widget
