// SPDX-License-Identifier: MIT
#include "engine/widget/cutting_plane.h"

#include "engine/widget/handles.h"
#include "engine/widget/widget.h"

namespace catena::widget {

namespace {

const Vec3& center_of(const State& state) noexcept { return state.pose.points[0]; }

double height(const State& state, int axis, const Vec3& probe) noexcept {
  return std::fabs(dot(frame_axis(state.pose.orientation, axis), probe - center_of(state)));
}

LinkShape plane_through_center(const State& state, const Quat& frame, int axis) noexcept {
  return {LinkShape::Kind::plane, center_of(state), frame_axis(frame, axis), 0};
}

void activate_plane(State& state, int axis) noexcept { state.active_planes = static_cast<std::uint8_t>(state.active_planes | 1u << axis); }

void update_turn(State& state, const Vec3& proxy) noexcept {
  const bool has_axis = state.axis >= 0;
  const Vec3 e = has_axis ? frame_axis(state.grip.frame, state.axis) : Vec3(0.0);
  const Vec3 arm = has_axis ? perpendicular_direction(proxy - center_of(state), e) : direction(proxy - center_of(state));
  if (!(max_abs(arm) > 0)) return;
  if (state.rebase_arm || !(max_abs(state.arm) > 0)) {
    state.arm = arm;
    state.rebase_arm = false;
    return;
  }
  if (has_axis) {
    state.pose.orientation = normalized(rotation_about(e, state.arm, arm) * state.start_pose.orientation);
  } else {
    state.pose.orientation = normalized(shortest_arc(state.arm, arm) * state.pose.orientation);
    state.arm = arm;
  }
}

}  // namespace

Proximity plane_proximity(const Spec& spec, const State& state, const Vec3& probe) noexcept {
  Proximity out;
  const double to_sphere = std::fabs(norm(probe - center_of(state)) - spec.radius), to_plane = height(state, 2, probe);
  out.near_sphere = to_sphere <= spec.grab_distance;
  out.near_plane = to_plane <= (state.mode == Mode::explore ? spec.release : spec.snap);
  out.distance = out.near_sphere ? to_sphere : to_plane;
  if (out.near_sphere || out.near_plane) return out;
  const Vec3 normal = frame_axis(state.pose.orientation, 2);
  const double along = std::fmin(std::fmax(dot(normal, probe - center_of(state)), 0.0), kArrowLength * spec.radius);
  const double to_arrow = norm(probe - center_of(state) - normal * along);
  if (to_arrow <= spec.grab_distance) {
    out.nearest_handle = 0;
    out.distance = to_arrow;
  }
  return out;
}

void begin_turn(const Spec& spec, State& state, const Vec3& probe) noexcept {
  // grab the nearest great circle, if the probe is near enough to it
  state.grip = {probe, state.pose.orientation, 0, 0};
  state.axis = -1;
  state.rebase_arm = true;
  if (spec.rotation == RotationMode::free) return;
  std::int8_t nearest = 0;
  for (std::int8_t i = 1; i < 3; ++i)
    if (height(state, i, probe) < height(state, nearest, probe)) nearest = i;
  if (spec.rotation == RotationMode::axis || height(state, nearest, probe) <= spec.grab_distance) state.axis = nearest;
}

ChainRequest plan_plane_chain(const Spec& spec, State& state, const Vec3& probe) noexcept {
  ChainRequest out;
  const LinkShape sphere{LinkShape::Kind::sphere, center_of(state), Vec3(0.0), spec.radius};
  switch (state.mode) {
    case Mode::explore:
      activate_plane(state, 2);
      out.add_link(2, plane_through_center(state, state.pose.orientation, 2));
      break;
    case Mode::hover:
      for (int i = 0; i < 2; ++i) {
        activate_plane(state, i);
        out.add_link(i, plane_through_center(state, state.pose.orientation, i));
      }
      break;
    case Mode::translate:
    case Mode::drag:
      out.disables_scene_links = true;
      add_planes(spec, state, probe, out);
      break;
    case Mode::rotate:
      for (int i = 0; i < 3 && spec.rotation != RotationMode::free; ++i) {
        if (height(state, i, probe) > spec.grab_distance) continue;
        activate_plane(state, i);
        out.add_link(i, plane_through_center(state, state.pose.orientation, i));
      }
      out.add_link(kSphereLink, sphere);
      break;
    case Mode::turn:
      out.disables_scene_links = true;
      if (state.axis >= 0 && spec.rotation == RotationMode::any &&
          !(std::fabs(dot(frame_axis(state.grip.frame, state.axis), probe - center_of(state))) <= spec.step)) {
        state.axis = -1;
        state.rebase_arm = true;
      }
      if (state.axis >= 0) {
        activate_plane(state, state.axis);
        out.add_link(state.axis, plane_through_center(state, state.grip.frame, state.axis));
      }
      out.add_link(kSphereLink, sphere);
      break;
    default:
      break;
  }
  return out;
}

void update_plane_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept {
  if (state.mode == Mode::translate || state.mode == Mode::drag)
    state.pose.points[0] = translated(state.start_pose.points[0], state.grip.frame, displacement(spec, state, proxy));
  else
    update_turn(state, proxy);
}

}  // namespace catena::widget
