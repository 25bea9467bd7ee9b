/// The machine of the widgets (paper, section 6.2): one tick in two phases around the chain, pure functions of (specs, states, input).
///   before   step_modes: transitions of all widgets, by `next_mode` alone;  plan: links, order and shapes of the one that is engaged
///   after    finish: its pose, from the chain's last proxy
/// One widget is engaged at a time; the others are away. Who is: the one that is grabbed or grabs now; else by what the probe is near:
/// a handle before a sphere before a cutting plane, the engaged one before others, then the nearest, then the first.
/// A probe that was not there for a while (`back`): a press does not count; a grab goes on only where its button is down, with the pose
/// as it was (it is taken anew at the new place); a ruler's end on links is let go.
/// World units. Haptic thread: no allocation, lock, throw.
#pragma once
#include <span>

#include "engine/widget/widget.h"

namespace catena::widget {

/// What a transition looks at.
struct TransitionInput {
  bool near_handle = false;        ///< the probe is within `near` of a handle
  bool near_sphere = false;        ///< ... of the sphere
  bool near_plane = false;         ///< within `snap` of the cutting plane; where it explores: within `release`
  bool button_pressed = false;     ///< the button went down in this tick
  bool button_down = false;        ///< the button is down
  bool rotate_on_contact = false;  ///< Spec::touch
  bool is_gripped = false;         ///< the mode was entered, or kept, by a press
};

/// All transitions of all widgets.
Mode next_mode(Kind kind, Mode mode, const TransitionInput& facts) noexcept;

/// Whether the hand has taken hold of the widget.
constexpr bool is_grabbed(Mode mode) noexcept { return mode == Mode::translate || mode == Mode::turn || mode == Mode::drag; }

/// What the machine gets of a tick.
struct TickInput {
  Vec3 probe{0.0};                 ///< finite
  Vec3 last_probe{0.0};            ///< of the last tick that had one
  std::uint32_t buttons = 0;       ///< bit n - 1: button n
  std::uint32_t last_buttons = 0;  ///< of the tick before
  bool probe_returned = false;     ///< the ticks before had no probe
};

/// The pose as the Spec says, away.
void reset_state(const Spec& spec, State& state) noexcept;
/// The engaged widget; -1: none.
int step_modes(std::span<const Spec> specs, std::span<State> states, const TickInput& input) noexcept;
/// The chain that the engaged widget asks for in this tick.
ChainRequest plan_chain(const Spec& spec, State& state, const Vec3& probe) noexcept;
/// `proxy`: the last one of the chain that `plan` asked for.
void update_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept;

/// What the frame is told of it.
Report make_report(const State& state) noexcept;

/// Is this a state that the machine can leave, as far as it indexes with it? For states that come from a file; off the tick.
bool is_valid_state(const Spec& spec, const State& state) noexcept;

}  // namespace catena::widget
