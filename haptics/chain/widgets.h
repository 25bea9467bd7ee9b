// SPDX-License-Identifier: MIT
/// Widgets in the tick (paper, section 6.2; engine/widget/state_machine.h): before the chain runs they select which of their links run;
/// after it they follow its last proxy. The links x, y, z and sphere are shared by all widgets; the present shape of each is in
/// LinkState::shape.
///   explore, rotate, hover   the scene's links, then the widget's
///   translate, turn, drag    the widget's links alone
/// A link that is given another shape is re-initialized and its weight rises from 0; the force makes no step (ramp.h).
/// A tick without a probe changes no widget; state_machine.h describes how a grab continues afterwards. Haptic thread: no allocation, lock,
/// throw.
#pragma once
#include "engine/base/export.h"
#include "engine/widget/state_machine.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// State of all widgets between ticks.
struct WidgetsState {
  std::array<widget::State, kMaxWidgets> widgets{};                  ///< state of each widget
  std::array<std::uint8_t, widget::kSharedLinks> shape_revisions{};  ///< number of shapes that each shared link has been given
  Vec3 last_probe{0.0};                                              ///< probe of the last tick that had one, world units
  std::uint32_t last_buttons = 0;                                    ///< buttons of the last tick that had a probe
  std::int8_t engaged = -1;                                          ///< index of the engaged widget; -1: none
  bool has_probe = false;                                            ///< at least one tick had a probe
  bool probe_lost = false;                                           ///< the last tick had no probe, an earlier one had
};

/// Input of the widgets in one tick.
struct WidgetsInput {
  Vec3 probe{0.0};            ///< position of the probe, world units
  std::uint32_t buttons = 0;  ///< bit n - 1: button n is down
};

/// Steps the modes of all widgets, before the chain; sets the shapes of their links. Returns the link order of this tick: the links of
/// `scene` and of the engaged widget.
CATENA_EXPORT LinkOrder engage_widgets(const HapticProgram& program, const WidgetsInput& input, const LinkOrder& scene,
                                       const SwitchState& switches, std::array<LinkState, kMaxLinks>& links, WidgetsState& state) noexcept;
/// Updates the pose of the engaged widget, after the chain. `last_proxy`: last proxy of the chain, world units.
CATENA_EXPORT void move_widgets(const HapticProgram& program, const Vec3& last_proxy, WidgetsState& state) noexcept;
/// Marks a tick without a probe.
CATENA_EXPORT void pause_widgets(WidgetsState& state) noexcept;
/// Sets the reports of all widgets in `out`.
CATENA_EXPORT void report_widgets(const HapticProgram& program, const WidgetsState& state, HapticState& out) noexcept;

/// Adapts the state to a new program: a widget of the same name and kind keeps its state, unless its pose was set from outside (a higher
/// Spec::revision); the others start with the pose in their Spec.
CATENA_EXPORT void rebind_widgets(const HapticProgram& from, const HapticProgram& to, WidgetsState& state) noexcept;

}  // namespace catena::haptics
