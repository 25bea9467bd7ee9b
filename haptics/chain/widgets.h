/// Widgets in the tick (paper, section 6.2; engine/widget/state_machine.h): before the chain they say which of their links run, after it
/// they follow its last proxy. The links x, y, z and sphere are shared by all widgets; what each of them is on stands in LinkState::shape.
///   explore, rotate, hover   the scene's links, then the widget's
///   translate, turn, drag    the widget's alone
/// A link that is put on another shape starts anew, its weight from 0; the force has no step (ramp.h).
/// A tick without a probe holds everything; machine.h says how a grab goes on afterwards. Haptic thread: no allocation, lock, throw.
#pragma once
#include "engine/widget/state_machine.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// What the widgets remember.
struct WidgetsState {
  std::array<widget::State, kMaxWidgets> widgets{};                  ///< by widget
  std::array<std::uint8_t, widget::kSharedLinks> shape_revisions{};  ///< counts the shapes of a link
  Vec3 last_probe{0.0};                                              ///< of the last tick that had one
  std::uint32_t last_buttons = 0;                                    ///< of the last tick that had a probe
  std::int8_t engaged = -1;                                          ///< the engaged widget; -1: none
  bool has_probe = false;                                            ///< there was a probe
  bool probe_lost = false;                                           ///< the last tick had none
};

/// What the widgets get of a tick.
struct WidgetsInput {
  Vec3 probe{0.0};            ///< the hand, world units
  std::uint32_t buttons = 0;  ///< bit n - 1: button n is held
};

/// The order of this tick: `scene`'s links and the widgets'. Puts shapes on links.
LinkOrder engage_widgets(const HapticProgram& program, const WidgetsInput& input, const LinkOrder& scene, const SwitchState& switches,
                         std::array<LinkState, kMaxLinks>& links, WidgetsState& state) noexcept;
/// After the chain, whose last proxy this is.
void move_widgets(const HapticProgram& program, const Vec3& last_proxy, WidgetsState& state) noexcept;
/// A tick without a probe.
void pause_widgets(WidgetsState& state) noexcept;
/// Fills in the reports of all widgets.
void report_widgets(const HapticProgram& program, const WidgetsState& state, HapticState& out) noexcept;

/// Another program takes over: a widget of the same name and kind keeps what the hand has made of it, unless its pose was set since
/// (a higher Spec::revision); the others begin as their Spec says.
void rebind_widgets(const HapticProgram& from, const HapticProgram& to, WidgetsState& state) noexcept;

}  // namespace catena::haptics
