// SPDX-License-Identifier: MIT
/// State machine of the widgets (paper, section 6.2): one tick in two phases, before and after the chain runs. Pure functions of specs,
/// states and input.
///   before   step_modes: transitions of all widgets, by `next_mode` alone;  plan_chain: links, order and shapes of the engaged widget
///   after    update_pose: its pose, from the last proxy of the chain
/// One widget at a time is engaged; the others are idle. It is the widget that is grabbed or being grabbed; else it is chosen by what the
/// probe is near: a handle or an arrow before a sphere before a cutting plane, then the engaged widget before others, then the nearest,
/// then the first. When the probe returns after ticks without one (`probe_returned`), a button press is ignored; a grab continues only if
/// its button is down, with the pose unchanged and the grip moved to the new probe position; a ruler's end on links is released. World
/// units. Haptic thread: no allocation, lock, throw.
#pragma once
#include <span>

#include "engine/base/export.h"
#include "engine/widget/widget.h"

namespace catena::widget {

/// Input of a mode transition.
struct TransitionInput {
  bool near_handle = false;        ///< The probe is within grab_distance of a handle or an arrow
  bool near_sphere = false;        ///< The probe is within grab_distance of the sphere
  bool near_plane = false;         ///< The probe is within `snap` of the cutting plane; in mode explore: within `release`
  bool button_pressed = false;     ///< The button went down in this tick
  bool button_down = false;        ///< The button is down
  bool rotate_on_contact = false;  ///< Spec::rotate_on_contact
  bool is_gripped = false;         ///< The mode was entered, or continued, by a press that still holds
};

/// Returns the next mode of a widget; all transitions are here.
CATENA_EXPORT Mode next_mode(Kind kind, Mode mode, const TransitionInput& facts) noexcept;

/// Returns whether the widget is grabbed.
constexpr bool is_grabbed(Mode mode) noexcept { return mode == Mode::translate || mode == Mode::turn || mode == Mode::drag; }

/// Input of one tick.
struct TickInput {
  Vec3 probe{0.0};                 ///< Probe position, finite
  Vec3 last_probe{0.0};            ///< Probe position of the last tick that had one
  std::uint32_t buttons = 0;       ///< Bit n - 1: button n is down
  std::uint32_t last_buttons = 0;  ///< Buttons of the tick before
  bool probe_returned = false;     ///< True if the ticks before had no probe
};

/// Resets the state to the pose of the spec, in mode idle.
CATENA_EXPORT void reset_state(const Spec& spec, State& state) noexcept;
/// Steps the modes of all widgets. Returns the index of the engaged widget; -1: none.
CATENA_EXPORT int step_modes(std::span<const Spec> specs, std::span<State> states, const TickInput& input) noexcept;
/// Returns the chain that the engaged widget requests for this tick.
CATENA_EXPORT ChainRequest plan_chain(const Spec& spec, State& state, const Vec3& probe) noexcept;
/// Updates the pose of the engaged widget. `proxy`: last proxy of the chain that plan_chain requested.
CATENA_EXPORT void update_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept;

/// Returns the report of a widget for the frame thread.
CATENA_EXPORT Report make_report(const State& state) noexcept;

/// Returns whether the state is valid, so that the state machine can index with it. For states read from a file; off the tick.
CATENA_EXPORT bool is_valid_state(const Spec& spec, const State& state) noexcept;

}  // namespace catena::widget
