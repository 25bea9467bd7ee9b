// SPDX-License-Identifier: MIT
#include "engine/widget/state_machine.h"

#include <cstring>

#include "engine/widget/cutting_plane.h"
#include "engine/widget/handles.h"

namespace catena::widget {

namespace {

// Mode of a cutting plane that is not grabbed.
Mode at_rest(const TransitionInput& f) noexcept {
  if (f.near_handle) return Mode::hover;
  return f.near_sphere ? (f.rotate_on_contact ? Mode::turn : Mode::rotate) : f.near_plane ? Mode::explore : Mode::idle;
}

Mode next_of_handle(Mode mode, const TransitionInput& f, Mode otherwise) noexcept {
  if (mode == Mode::hover && f.button_pressed) return Mode::drag;
  return mode == Mode::drag && f.button_down ? Mode::drag : otherwise;
}

Mode next_of_cutting_plane(Mode mode, const TransitionInput& f) noexcept {
  switch (mode) {
    case Mode::explore:
      return f.button_pressed ? Mode::translate : at_rest(f);
    case Mode::translate:
      return f.button_down ? Mode::translate : at_rest(f);
    case Mode::rotate:
      return f.button_pressed ? Mode::turn : at_rest(f);
    case Mode::turn:
      if (f.button_pressed || (f.is_gripped && f.button_down)) return Mode::turn;
      return at_rest(f);
    default:
      return next_of_handle(mode, f, at_rest(f));
  }
}

// The part of a widget that the probe is near: its priority and the probe's distance.
struct Near {
  Proximity reach;
  int rank = 0;  // priority: 0 nothing, 1 a cutting plane, 2 its sphere, 3 a handle or an arrow
};

Near near_of(const Spec& spec, const State& state, const Vec3& probe) noexcept {
  Near out;
  out.reach = spec.kind == Kind::cutting_plane ? plane_proximity(spec, state, probe) : handle_proximity(spec, state, probe);
  out.rank = out.reach.nearest_handle >= 0 ? 3 : out.reach.near_sphere ? 2 : out.reach.near_plane ? 1 : 0;
  return out;
}

TransitionInput transition_input(const Spec& spec, const State& state, const Proximity& proximity, const TickInput& input) noexcept {
  const std::uint32_t bit = 1u << ((spec.button - 1) & 31);
  const bool down = (input.buttons & bit) != 0;
  return {.near_handle = proximity.nearest_handle >= 0,
          .near_sphere = proximity.near_sphere,
          .near_plane = proximity.near_plane,
          .button_pressed = down && (input.last_buttons & bit) == 0 && !input.probe_returned,
          .button_down = down,
          .rotate_on_contact = spec.rotate_on_contact,
          .is_gripped = state.is_gripped};
}

bool drags_on_links(const Spec& spec, const State& state) noexcept {
  return spec.kind == Kind::ruler && !spec.along_links.empty() && state.mode == Mode::drag && state.handle < 2;
}

void enter(const Spec& spec, State& state, Mode mode, const TransitionInput& transition, const Proximity& proximity,
           const Vec3& probe) noexcept {
  state.is_gripped = is_grabbed(mode) && (transition.button_pressed || (state.is_gripped && transition.button_down));
  if (mode != Mode::drag) state.handle = mode == Mode::hover ? proximity.nearest_handle : static_cast<std::int8_t>(-1);
  if (mode == state.mode) return;
  state.mode = mode;
  state.active_planes = 0;
  state.axis = -1;
  if (!is_grabbed(mode)) return;
  state.start_pose = state.pose;
  if (mode == Mode::turn)
    begin_turn(spec, state, probe);
  else if (mode == Mode::translate)
    state.grip = {probe, state.pose.orientation, 0, 0};
  else
    state.grip = make_grip(spec, state, probe);
}

// After an interval without a probe, a grab continues from the probe's present position.
void move_grip(State& state, const TickInput& input) noexcept {
  const Vec3 grab = state.grip.grab_point + (input.probe - input.last_probe);
  state.grip.grab_point = is_finite(grab) ? grab : input.probe;
  state.start_pose.orientation = state.pose.orientation;
  state.rebase_arm = true;
}

}  // namespace

Mode next_mode(Kind kind, Mode mode, const TransitionInput& facts) noexcept {
  if (kind == Kind::cutting_plane) return next_of_cutting_plane(mode, facts);
  return next_of_handle(mode, facts, facts.near_handle ? Mode::hover : Mode::idle);
}

void reset_state(const Spec& spec, State& state) noexcept {
  state = State{};
  state.is_initialized = true;
  state.revision = spec.revision;
  state.pose = spec.pose;
  state.value = spec.value;
  const Quat& q = spec.pose.orientation;
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!(std::fabs(square - 1) <= 1e-14)) state.pose.orientation = normalized(q);
  if (spec.kind == Kind::isolevel) update_level(spec, state);
}

int step_modes(std::span<const Spec> specs, std::span<State> states, const TickInput& input) noexcept {
  const std::size_t count = std::min({specs.size(), states.size(), static_cast<std::size_t>(kMaxWidgets)});
  std::array<Near, kMaxWidgets> near{};
  std::array<TransitionInput, kMaxWidgets> inputs{};
  std::size_t engaged = count;
  for (std::size_t i = 0; i < count; ++i) {
    if (!states[i].is_initialized) reset_state(specs[i], states[i]);
    if (input.probe_returned && drags_on_links(specs[i], states[i])) states[i].mode = Mode::idle;
    near[i] = near_of(specs[i], states[i], input.probe);
    inputs[i] = transition_input(specs[i], states[i], near[i].reach, input);
    // the widget that is grabbed, or becomes grabbed in this tick
    if (states[i].mode != Mode::idle && is_grabbed(next_mode(specs[i].kind, states[i].mode, inputs[i]))) engaged = i;
  }
  if (engaged == count) {
    const auto precedes = [&](std::size_t a, std::size_t b) {
      if (near[a].rank != near[b].rank) return near[a].rank > near[b].rank;
      const bool a_is = states[a].mode != Mode::idle, b_is = states[b].mode != Mode::idle;
      return a_is != b_is ? a_is : near[a].reach.distance < near[b].reach.distance;
    };
    for (std::size_t i = 0; i < count; ++i)
      if (near[i].rank > 0 && (engaged == count || precedes(i, engaged))) engaged = i;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Mode old_mode = states[i].mode;
    const Mode next = i == engaged ? next_mode(specs[i].kind, old_mode, inputs[i]) : Mode::idle;
    enter(specs[i], states[i], next, inputs[i], near[i].reach, input.probe);
    if (input.probe_returned && is_grabbed(old_mode) && states[i].mode == old_mode) move_grip(states[i], input);
  }
  return engaged < count ? static_cast<int>(engaged) : -1;
}

ChainRequest plan_chain(const Spec& spec, State& state, const Vec3& probe) noexcept {
  state.active_planes = 0;
  return spec.kind == Kind::cutting_plane ? plan_plane_chain(spec, state, probe) : plan_handle_chain(spec, state, probe);
}

void update_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept {
  if (!is_grabbed(state.mode) || !is_finite(proxy)) return;
  const Pose old_pose = state.pose;
  if (spec.kind == Kind::cutting_plane)
    update_plane_pose(spec, state, proxy);
  else
    update_handle_pose(spec, state, proxy);
  if (!is_finite(state.pose.points[0]) || !is_finite(state.pose.points[1]) || !is_finite(state.pose.orientation)) state.pose = old_pose;
  if (spec.kind == Kind::isolevel) update_level(spec, state);
}

Report make_report(const State& state) noexcept {
  return {state.pose, state.value, state.revision, state.mode, state.handle, state.active_planes};
}

bool is_valid_state(const Spec& spec, const State& state) noexcept {
  const auto byte = [](const auto& value) {
    unsigned char out;
    std::memcpy(&out, &value, 1);
    return out;
  };
  if (byte(state.is_initialized) > 1 || byte(state.is_gripped) > 1 || byte(state.rebase_arm) > 1) return false;
  if (byte(state.mode) > static_cast<unsigned char>(Mode::drag)) return false;
  const bool on_handle = state.mode == Mode::hover || state.mode == Mode::drag, plane = spec.kind == Kind::cutting_plane;
  if (state.mode != Mode::idle && !plane && !on_handle) return false;
  return state.handle >= (on_handle ? 0 : -1) && state.handle < std::max(handle_count(spec.kind), 1) && state.axis >= -1 && state.axis <= 2;
}

}  // namespace catena::widget
