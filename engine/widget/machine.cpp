#include "engine/widget/machine.h"

#include <cstring>

#include "engine/widget/cutting_plane.h"
#include "engine/widget/handles.h"

namespace catena::widget {

namespace {

// Where a cutting plane goes that is not held by the hand.
Mode at_rest(const Facts& f) noexcept { return f.sphere ? (f.touch ? Mode::turn : Mode::rotate) : f.plane ? Mode::explore : Mode::away; }

Mode next_of_cutting_plane(Mode mode, const Facts& f) noexcept {
  switch (mode) {
    case Mode::explore:
      return f.pressed ? Mode::translate : at_rest(f);
    case Mode::translate:
      return f.down ? Mode::translate : at_rest(f);
    case Mode::rotate:
      return f.pressed ? Mode::turn : at_rest(f);
    case Mode::turn:
      if (f.pressed || (f.gripped && f.down)) return Mode::turn;
      return at_rest(f);
    default:
      return at_rest(f);
  }
}

Mode next_of_handles(Mode mode, const Facts& f) noexcept {
  if (mode == Mode::hover && f.pressed) return Mode::drag;
  if (mode == Mode::drag && f.down) return Mode::drag;
  return f.handle ? Mode::hover : Mode::away;
}

// What the probe is near: how much it comes first, and how far it is.
struct Near {
  Reach reach;
  int rank = 0;  // 0 nothing, 1 a cutting plane, 2 its sphere, 3 a handle
};

Near near_of(const Spec& spec, const State& state, const Vec3& probe) noexcept {
  Near out;
  out.reach = spec.kind == Kind::cutting_plane ? reach_of_plane(spec, state, probe) : reach_of_handles(spec, state, probe);
  out.rank = out.reach.handle >= 0 ? 3 : out.reach.sphere ? 2 : out.reach.plane ? 1 : 0;
  return out;
}

Facts facts_of(const Spec& spec, const State& state, const Reach& reach, const Input& input) noexcept {
  const std::uint32_t bit = 1u << ((spec.button - 1) & 31);
  const bool down = (input.buttons & bit) != 0;
  return {.handle = reach.handle >= 0,
          .sphere = reach.sphere,
          .plane = reach.plane,
          .pressed = down && (input.last_buttons & bit) == 0 && !input.back,
          .down = down,
          .touch = spec.touch,
          .gripped = state.gripped};
}

bool drags_along(const Spec& spec, const State& state) noexcept {
  return spec.kind == Kind::ruler && !spec.along.empty() && state.mode == Mode::drag && state.handle < 2;
}

void enter(const Spec& spec, State& state, Mode mode, const Facts& facts, const Reach& reach, const Vec3& probe) noexcept {
  state.gripped = is_grabbed(mode) && (facts.pressed || (state.gripped && facts.down));
  if (mode != Mode::drag) state.handle = mode == Mode::hover ? reach.handle : static_cast<std::int8_t>(-1);
  if (mode == state.mode) return;
  state.mode = mode;
  state.held = 0;
  state.axis = -1;
  if (!is_grabbed(mode)) return;
  state.start = state.pose;
  if (mode == Mode::turn)
    begin_turn(spec, state, probe);
  else if (mode == Mode::translate)
    state.grip = {probe, state.pose.orientation, 0, 0};
  else
    state.grip = grip_of(spec, state, probe);
}

// After a while without a probe a grab goes on as it was, from where the probe is now.
void take_anew(State& state, const Input& input) noexcept {
  const Vec3 grab = state.grip.grab + (input.probe - input.last_probe);
  state.grip.grab = is_finite(grab) ? grab : input.probe;
  state.start.orientation = state.pose.orientation;
  state.rebase = true;
}

}  // namespace

Mode next_mode(Kind kind, Mode mode, const Facts& facts) noexcept {
  return kind == Kind::cutting_plane ? next_of_cutting_plane(mode, facts) : next_of_handles(mode, facts);
}

void begin(const Spec& spec, State& state) noexcept {
  state = State{};
  state.known = true;
  state.revision = spec.revision;
  state.pose = spec.pose;
  state.value = spec.value;
  const Quat& q = spec.pose.orientation;
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!(std::fabs(square - 1) <= 1e-14)) state.pose.orientation = normalised(q);
  if (spec.kind == Kind::isolevel) read_level(spec, state);
}

int step_modes(std::span<const Spec> specs, std::span<State> states, const Input& input) noexcept {
  const std::size_t count = std::min({specs.size(), states.size(), static_cast<std::size_t>(kMaxWidgets)});
  std::array<Near, kMaxWidgets> nears{};
  std::array<Facts, kMaxWidgets> facts{};
  std::size_t chosen = count;
  for (std::size_t i = 0; i < count; ++i) {
    if (!states[i].known) begin(specs[i], states[i]);
    if (input.back && drags_along(specs[i], states[i])) states[i].mode = Mode::away;
    nears[i] = near_of(specs[i], states[i], input.probe);
    facts[i] = facts_of(specs[i], states[i], nears[i].reach, input);
    // what the hand has, or takes now
    if (states[i].mode != Mode::away && is_grabbed(next_mode(specs[i].kind, states[i].mode, facts[i]))) chosen = i;
  }
  if (chosen == count) {
    const auto comes_first = [&](std::size_t a, std::size_t b) {
      if (nears[a].rank != nears[b].rank) return nears[a].rank > nears[b].rank;
      const bool a_is = states[a].mode != Mode::away, b_is = states[b].mode != Mode::away;
      return a_is != b_is ? a_is : nears[a].reach.distance < nears[b].reach.distance;
    };
    for (std::size_t i = 0; i < count; ++i)
      if (nears[i].rank > 0 && (chosen == count || comes_first(i, chosen))) chosen = i;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Mode was = states[i].mode;
    const Mode next = i == chosen ? next_mode(specs[i].kind, was, facts[i]) : Mode::away;
    enter(specs[i], states[i], next, facts[i], nears[i].reach, input.probe);
    if (input.back && is_grabbed(was) && states[i].mode == was) take_anew(states[i], input);
  }
  return chosen < count ? static_cast<int>(chosen) : -1;
}

Plan plan(const Spec& spec, State& state, const Vec3& probe) noexcept {
  state.held = 0;
  return spec.kind == Kind::cutting_plane ? plan_of_plane(spec, state, probe) : plan_of_handles(spec, state, probe);
}

void finish(const Spec& spec, State& state, const Vec3& proxy) noexcept {
  if (!is_grabbed(state.mode) || !is_finite(proxy)) return;
  const Pose before = state.pose;
  if (spec.kind == Kind::cutting_plane)
    finish_plane(spec, state, proxy);
  else
    finish_handles(spec, state, proxy);
  if (!is_finite(state.pose.points[0]) || !is_finite(state.pose.points[1]) || !is_finite(state.pose.orientation)) state.pose = before;
  if (spec.kind == Kind::isolevel) read_level(spec, state);
}

Report report_of(const State& state) noexcept { return {state.pose, state.value, state.revision, state.mode, state.handle, state.held}; }

bool is_sane(const Spec& spec, const State& state) noexcept {
  const auto byte = [](const auto& value) {
    unsigned char out;
    std::memcpy(&out, &value, 1);
    return out;
  };
  if (byte(state.known) > 1 || byte(state.gripped) > 1 || byte(state.rebase) > 1) return false;
  if (byte(state.mode) > static_cast<unsigned char>(Mode::drag)) return false;
  const bool on_handle = state.mode == Mode::hover || state.mode == Mode::drag, plane = spec.kind == Kind::cutting_plane;
  if (state.mode != Mode::away && plane == on_handle) return false;
  return state.handle >= (on_handle ? 0 : -1) && state.handle < std::max(handle_count(spec.kind), 1) && state.axis >= -1 && state.axis <= 2;
}

}  // namespace catena::widget
