// SPDX-License-Identifier: MIT
#include "engine/widget/handles.h"

#include "engine/widget/widget.h"

namespace catena::widget {

void add_planes(const Spec& spec, State& state, const Vec3& probe, ChainRequest& plan) noexcept {
  const Grip& grip = state.grip;
  state.active_planes = 0;
  for (int i = 0; i < 3; ++i) {
    const auto bit = static_cast<std::uint8_t>(1u << i);
    const Vec3 axis = frame_axis(grip.frame, i);
    const bool within = std::fabs(dot(axis, probe - grip.grab_point)) <= spec.step;
    if ((grip.fixed_axes & bit) == 0 && ((grip.free_axes & bit) != 0 || !within)) continue;
    state.active_planes = static_cast<std::uint8_t>(state.active_planes | bit);
    plan.add_link(i, {LinkShape::Kind::plane, grip.grab_point, axis, 0});
  }
}

Vec3 displacement(const Spec& spec, const State& state, const Vec3& proxy) noexcept {
  Vec3 out(0.0);
  for (int i = 0; i < 3; ++i) {
    if ((state.active_planes & (1u << i)) != 0) continue;
    const double u = dot(frame_axis(state.grip.frame, i), proxy - state.grip.grab_point);
    out[i] = (state.grip.free_axes & (1u << i)) != 0 ? u : deadzone(u, spec.step);
  }
  return out;
}

Vec3 translated(const Vec3& from, const Quat& frame, const Vec3& displacement) noexcept {
  Vec3 to = from;
  for (int i = 0; i < 3; ++i)
    if (displacement[i] != 0) to += frame_axis(frame, i) * displacement[i];
  return to;
}

namespace {

constexpr int kFaces = 6, kMiddle = 2;

bool is_pair(Kind kind) noexcept { return kind == Kind::rake || kind == Kind::ruler; }
bool moves_all_points(Kind kind, int handle) noexcept {
  return (is_pair(kind) && handle == kMiddle) || (kind == Kind::box && handle >= kFaces);
}

bool is_on_links(const Spec& spec, const State& state) noexcept {
  return spec.kind == Kind::ruler && !spec.along_links.empty() && state.handle < kMiddle;
}

// Moves the grabbed face of the box, but not past the opposite face.
void move_face(const Spec& spec, State& state, double displacement) noexcept {
  const int axis = state.handle / 2;
  const Pose& from = state.start_pose;
  const double lo = from.points[0][axis], hi = from.points[1][axis], min_size = std::fmin(spec.step, hi - lo);
  if (state.handle % 2 == 0)
    state.pose.points[0][axis] = std::fmin(lo + displacement, hi - min_size);
  else
    state.pose.points[1][axis] = std::fmax(hi + displacement, lo + min_size);
}

}  // namespace

int handle_count(Kind kind) noexcept {
  switch (kind) {
    case Kind::cutting_plane:
      return 0;
    case Kind::seed:
    case Kind::isolevel:
      return 1;
    case Kind::rake:
    case Kind::ruler:
      return 3;
    case Kind::box:
      return kFaces + 1;
  }
  return 0;
}

Vec3 handle_position(Kind kind, const Pose& pose, int handle) noexcept {
  const Vec3 &a = pose.points[0], &b = pose.points[1];
  if (is_pair(kind) && handle < kMiddle) return pose.points[static_cast<std::size_t>(handle)];
  if (!is_pair(kind) && kind != Kind::box) return a;
  Vec3 at = a * 0.5 + b * 0.5;
  if (kind == Kind::box && handle < kFaces) at[handle / 2] = pose.points[static_cast<std::size_t>(handle % 2)][handle / 2];
  return at;
}

Proximity handle_proximity(const Spec& spec, const State& state, const Vec3& probe) noexcept {
  Proximity out;
  for (int h = 0; h < handle_count(spec.kind); ++h) {
    const double distance = norm(probe - handle_position(spec.kind, state.pose, h));
    if (!(distance <= spec.grab_distance)) continue;
    const bool is_current = state.mode != Mode::idle && state.handle == h;
    if (out.nearest_handle < 0 || is_current || distance < out.distance) {
      out.nearest_handle = static_cast<std::int8_t>(h);
      out.distance = distance;
    }
    if (is_current) break;
  }
  return out;
}

Grip make_grip(const Spec& spec, const State& state, const Vec3& probe) noexcept {
  Grip out{probe, state.pose.orientation, 0, 0};
  if (spec.kind == Kind::cutting_plane) {
    out.fixed_axes = 3;
    out.free_axes = 4;
  } else if (spec.kind == Kind::box) {
    out.frame = kIdentityRotation;
    if (state.handle < kFaces) {
      out.free_axes = static_cast<std::uint8_t>(1u << (state.handle / 2));
      out.fixed_axes = static_cast<std::uint8_t>(7u & ~out.free_axes);
    }
  } else if (spec.kind == Kind::isolevel && spec.field) {
    field::Cursor cursor;
    const Vec3 n = direction(spec.field->sample(state.pose.points[0], cursor).gradient);
    if (max_abs(n) > 0) {
      out.frame = shortest_arc(Vec3(0, 0, 1), n);
      out.fixed_axes = 3;
      out.free_axes = 4;
    }
  }
  return out;
}

ChainRequest plan_handle_chain(const Spec& spec, State& state, const Vec3& probe) noexcept {
  ChainRequest out;
  if (state.mode == Mode::hover) {
    out.add_link(kSphereLink, {LinkShape::Kind::point, handle_position(spec.kind, state.pose, state.handle), Vec3(0.0), 0});
  } else if (state.mode == Mode::drag) {
    out.disables_scene_links = true;
    if (is_on_links(spec, state))
      out.uses_along_links = true;
    else
      add_planes(spec, state, probe, out);
  }
  return out;
}

void update_handle_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept {
  if (is_on_links(spec, state)) {
    state.pose.points[static_cast<std::size_t>(state.handle)] = proxy;
    return;
  }
  const Vec3 offset = displacement(spec, state, proxy);
  if (spec.kind == Kind::box && state.handle < kFaces) return move_face(spec, state, offset[state.handle / 2]);
  const bool all_points = moves_all_points(spec.kind, state.handle);
  for (int k = 0; k < 2; ++k) {
    const auto p = static_cast<std::size_t>(k);
    if (all_points || k == (is_pair(spec.kind) ? state.handle : 0))
      state.pose.points[p] = translated(state.start_pose.points[p], state.grip.frame, offset);
  }
}

void update_level(const Spec& spec, State& state) noexcept {
  if (!spec.field) return;
  field::Cursor cursor;
  const field::ScalarSample sample = spec.field->sample(state.pose.points[0], cursor);
  if (sample.inside && std::isfinite(sample.value)) state.value = sample.value;
}

}  // namespace catena::widget
