// What the person does with keys and pointer: for the interface, for a command, for the eye or the hand.
#include <utility>

#include "engine/app/viewer/shell/session.h"

namespace catena::app {

namespace {

constexpr int kSettling = 3;

/// The last proxy that something holds away from the hand.
std::optional<Vec3> held_place(const exchange::HapticState& felt) {
  std::optional<Vec3> place;
  for (int i = 0; i < felt.link_count; ++i) {
    const exchange::LinkReport& link = felt.links[static_cast<std::size_t>(i)];
    if (link.active && link.gap > 0) place = link.proxy;
  }
  return place;
}

}  // namespace

Gui::Frame Session::interface_frame() {
  return {[this] {
            PanelContext panels = context();
            draw_interface(panels);
          },
          [this] {
            carry_out();
            picture_.write_asked();
          }};
}

Changed Session::take_input(double wait_s) {
  Changed changed;
  Window& window = shared_.window;
  for (const Input& piece : window.poll(wait_s)) {
    const Changed by_piece = take_piece(piece);
    changed.view = changed.view || by_piece.view;
    changed.hand = changed.hand || by_piece.hand;
  }
  if (window.closing()) {
    window.keep_open();
    shared_.commands.push_back(Action::quit);
    carry_out();
    unsettled_ = kSettling;
  }
  if (window.happened()) {
    picture_.look_again();
    unsettled_ = kSettling;
  }
  if (bool& full = shared_.state.full_screen; window.is_full_screen() != full) {
    window.set_full_screen(full);
    full = window.is_full_screen();
  }
  // what is held back while the mouse is the hand
  Controls& controls = shared_.controls;
  HandHost& hand = shared_.hand;
  const scene::Scene& scene = shared_.scene.scene();
  controls.force_n = hand.is_mouse() ? hand.felt().force_n : Vec3(0.0);
  controls.max_force_n = scene.coupling.max_force_n;
  controls.held = hand.is_mouse() ? held_place(hand.felt()) : std::nullopt;
  if (changed.hand) hand.move_mouse(scene, controls.hand, controls.buttons);
  if (changed.view) eye_.pin();
  return changed;
}

/// The interface first: it says whether a stroke is text for it or a command. Then the stroke, then the motion after it.
Changed Session::take_piece(Input piece) {
  gui_.tell(piece, interface_frame());
  Commands& commands = shared_.commands;
  if (piece.damaged) picture_.damage();
  if (piece.key && !gui_.wants_keys())
    if (const auto action = action_of(*piece.key, shared_.controls.fly)) {
      commands.push_back(*action);
      gui_.expect_change();
    }
  if (piece.dropped.size() > 1) shared_.state.say("several files were dropped: the last one counts");
  if (!piece.dropped.empty()) commands.push_back(DropFile{piece.dropped.back()});
  carry_out();
  if (takes_hold(piece)) shared_.controls.turntable = false;
  return apply(shared_.controls, routed(piece));
}

/// What the interface holds is not the scene's: a drag belongs to where it began.
Input Session::routed(Input input) {
  ViewState& state = shared_.state;
  const bool pressed = input.left || input.middle || input.right;
  const bool here = gui_.holds(input.x, input.y);
  if (!pressed) interface_holds_pointer_ = false;
  if (pressed && !state.pointer_pressed) interface_holds_pointer_ = here;
  state.pointer_pressed = pressed;
  state.pointer_x = input.x + input.dx;
  state.pointer_y = input.y + input.dy;
  if (input.dx != 0 || input.dy != 0) state.pointer_seen = true;
  state.pointer_on_picture =
      !interface_holds_pointer_ && state.area.contains(state.pointer_x, state.pointer_y) && !gui_.holds(state.pointer_x, state.pointer_y);
  if (interface_holds_pointer_ || (!pressed && here)) {
    input.dx = input.dy = input.wheel = 0;
    input.left = input.middle = input.right = false;
  }
  // from now on the picture is all there is
  input.x -= state.area.x;
  input.y -= state.area.y;
  input.width = state.area.width;
  input.height = state.area.height;
  return input;
}

}  // namespace catena::app
