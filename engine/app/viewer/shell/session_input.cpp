// What the person does: to the interface, to the eye, to the hand, to the program.

#include "engine/app/viewer/shell/session.h"

namespace catena::app {

namespace {
constexpr int kSettling = 3;
}

/// What the interface holds is not the scene's: a drag belongs to where it began.
Input Session::routed(Input input) {
  const bool pressed = input.left || input.middle || input.right;
  const bool here = gui_->holds(input.x, input.y);
  if (!pressed) interface_holds_pointer_ = false;
  if (pressed && !state_.pointer_pressed) interface_holds_pointer_ = here;
  state_.pointer_pressed = pressed;
  state_.pointer_x = input.x + input.dx;
  state_.pointer_y = input.y + input.dy;
  if (input.dx != 0 || input.dy != 0) state_.pointer_seen = true;
  state_.pointer_on_picture = !interface_holds_pointer_ && state_.area.contains(state_.pointer_x, state_.pointer_y) &&
                              !gui_->holds(state_.pointer_x, state_.pointer_y);
  if (interface_holds_pointer_ || (!pressed && here)) {
    input.dx = input.dy = input.wheel = 0;
    input.left = input.middle = input.right = false;
  }
  // from now on the picture is all there is
  input.x -= state_.area.x;
  input.y -= state_.area.y;
  input.width = state_.area.width;
  input.height = state_.area.height;
  return input;
}

/// What is open above all goes first; the program stays.
void Session::escape() {
  if (gui_->close_popup()) return;
  bool* const open[] = {&state_.help, &state_.fly, &state_.turntable, &controls_.hand_mode, &state_.full_screen};
  for (bool* what : open)
    if (std::exchange(*what, false)) return;
}

void Session::obey(Command command) {
  const auto said = [&](const Outcome& done) {
    if (!done) state_.say(done.error().message, true);
  };
  switch (command) {
    case Command::undo:
      return said(scene_->undo());
    case Command::redo:
      return said(scene_->redo());
    case Command::open:
      state_.ask_open = true;
      return;
    case Command::save:
      state_.save.emplace();
      return;
    case Command::save_as:
      state_.ask_save = true;
      return;
    case Command::quit:
      state_.quit = true;
      return;
    case Command::screenshot:
    case Command::window_screenshot:
      state_.screenshot.emplace();
      state_.screenshot_of_window = command == Command::window_screenshot;
      return;
    case Command::full_screen:
      state_.full_screen = !state_.full_screen;
      return;
    case Command::toggle_panels:
      state_.panels = !state_.panels;
      return;
    case Command::turntable:
      state_.turntable = !state_.turntable;
      return;
    case Command::fly:
      state_.fly = !state_.fly;
      return;
  }
}

/// True: the picture is another.
bool Session::obey_once(const Input& input) {
  damaged_ = damaged_ || input.damaged;
  if (input.toggle_pulses) pulses_run_ = !pulses_run_;
  if (input.next_stereo) {
    auto& mode = scene_->scene().stereo.mode;
    mode = static_cast<scene::StereoMode>((static_cast<int>(mode) + 1) % scene::kStereoModes);
  }
  if (input.toggle_forces) hand_.set_forces(!hand_.forces());
  if (input.help) state_.help = !state_.help;
  for (const Command command : input.commands) obey(command);
  if (input.escape) escape();
  stop_turning(input);
  if (input.dropped.size() > 1) state_.say("several files were dropped: the last one counts");
  if (!input.dropped.empty()) drop(input.dropped.back());
  return input.next_stereo;
}

/// The last proxy that something holds away from the hand.
static std::optional<Vec3> held_place(const exchange::HapticState& felt) {
  std::optional<Vec3> place;
  for (int i = 0; i < felt.link_count; ++i) {
    const exchange::LinkReport& link = felt.links[static_cast<std::size_t>(i)];
    if (link.active && link.gap > 0) place = link.proxy;
  }
  return place;
}

Gui::Frame Session::interface_frame() {
  return {[this] {
            PanelContext panels = context();
            draw_interface(panels);
          },
          [this] { fulfil_wishes(); }};
}

/// The interface first: it says whether a stroke is text for it or a command.
Changed Session::take_piece(Input piece) {
  gui_->tell(piece, interface_frame());
  if (piece.key && !gui_->wants_keys()) interpret(*piece.key, state_.fly, piece);
  if (!piece.commands.empty()) gui_->expect_change();
  const Changed changed = apply(controls_, routed(piece));
  return obey_once(piece) ? Changed{true, changed.hand} : changed;
}

Changed Session::take_input(double wait_s) {
  Changed changed;
  for (const Input& piece : window_->poll(wait_s)) {
    const Changed by_piece = take_piece(piece);
    changed.view = changed.view || by_piece.view;
    changed.hand = changed.hand || by_piece.hand;
  }
  if (window_->closing()) {
    window_->keep_open();
    state_.quit = true;
  }
  leaves_ = leaves_ || (interrupt_ && interrupt_->asked());
  if (window_->happened()) {
    picked_stale_ = true;
    unsettled_ = kSettling;
  }
  // what is held back while the mouse is the hand
  controls_.fly = state_.fly;
  controls_.force_n = hand_.is_mouse() ? hand_.felt().force_n : Vec3(0.0);
  controls_.max_force_n = scene_->scene().coupling.max_force_n;
  controls_.held = hand_.is_mouse() ? held_place(hand_.felt()) : std::nullopt;
  if (changed.hand) hand_.move_mouse(scene_->scene(), controls_.hand, controls_.buttons);
  if (changed.view) pin_camera();
  return changed;
}

/// What panels and keys asked for, after the frame in which they did.
void Session::fulfil_wishes() {
  Input moves = std::exchange(state_.moves, Input());
  if (moves.reset_view || moves.fit || moves.axis || moves.toggle_projection) {
    moves.width = state_.area.width;
    moves.height = state_.area.height;
    stop_turning(moves);
    if (apply(controls_, moves).view) {
      pin_camera();
      moved_by_menu_ = true;
    }
  }
  fulfil_wishes_for_files();
  if (const auto quality = std::exchange(state_.quality, std::nullopt)) pacing_ = Pacing(*quality);
  fulfil_wishes_for_the_hand();
}

void Session::fulfil_wishes_for_the_hand() {
  if (const auto device = std::exchange(state_.device, std::nullopt)) {
    const Outcome done = hand_.switch_device(scene_->scene(), *device, scene_->bounds);
    if (done && !hand_.is_mouse() && !interrupt_) interrupt_.emplace();
    controls_.hand = hand_.felt().tick > 0 ? hand_.felt().probe : hand_.first_probe();
    state_.say(done ? hand_.hand().device->capabilities().name + " holds the probe" : done.error().message, !done);
  }
  if (const auto path = std::exchange(state_.record, std::nullopt)) {
    const std::string before = hand_.recording().path();
    const Outcome done = path->empty() ? hand_.stop_recording() : hand_.record(*path, recorded());
    state_.say(!done ? done.error().message : path->empty() ? "recorded " + before : "recording to " + *path, !done);
  }
}

}  // namespace catena::app
