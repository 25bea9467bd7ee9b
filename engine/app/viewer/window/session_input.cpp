// SPDX-License-Identifier: MIT
// Carries out commands: the only place that does so.
#include <utility>

#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/edit/remove_item.h"
#include "engine/app/viewer/window/session.h"
#include "engine/base/clock.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace

void Session::execute() {
  while (!context_.commands.empty())
    for (const Command& command : std::exchange(context_.commands, {})) execute(command);
}

void Session::execute(const Command& command) {
  SceneModel& scene = context_.scene;
  HapticSession& hand = context_.haptic_session;
  ViewState& state = context_.state;
  const auto choose_device = [&](const SelectDevice& asked) {
    const Outcome done = hand.switch_device(scene.scene(), asked.name, scene.bounds);
    // a device with forces receives every signal, even a repeated one, only as a request to stop
    if (done && !hand.is_mouse() && !(interrupt_ && interrupt_->is_requested())) interrupt_.emplace();
    context_.navigation.probe = hand.latest_state().tick > 0 ? hand.latest_state().probe : hand.initial_probe();
    state.show_message(done ? hand.device().device->capabilities().name + " moves the probe" : done.error().message, !done);
  };
  const auto record = [&](const SetRecording& asked) {
    const std::string before = hand.recording().path();
    const Outcome done = asked.path.empty() ? hand.stop_recording() : hand.record(asked.path, make_recorded_scene(scene, hand));
    state.show_message(!done ? done.error().message : asked.path.empty() ? "recorded " + before : "recording to " + asked.path, !done);
  };
  const auto choose_stereo = [&](const SetStereoMode& asked) {
    scene.scene().stereo.mode = asked.mode;
    content_changed_ = true;
  };
  std::visit(Overloaded{[&](Action action) { perform(action); },
                        [&](const Edit& edit) { state.show_error(scene.apply(edit.edits, edit.undo_label, edit.undo_group)); },
                        [&](const OpenFile& file) { files_.open(file.path); },
                        [&](const DropFile& file) { files_.open_dropped(file.path); },
                        [&](const SaveAs& file) { files_.save_as(file.path); },
                        [&](CancelSave) { files_.cancel_save(); },
                        [&](UnsavedChangesChoice answer) { files_.on_choice(answer); },
                        [&](DroppedFileChoice answer) { files_.on_choice(answer); },
                        [&](FileConflictChoice answer) { files_.on_choice(answer); },
                        [&](RecoveryChoice answer) { files_.on_choice(answer); },
                        [&](const SetQuality& asked) { context_.scheduler = ProgressiveScheduler(asked.quality); },
                        [&](EstimateImageError) { estimate_requested_ = true; },
                        [&](MeasureCosts) { measurement_requested_ = true; },
                        [&](ObserveTrackingError) { report_tracking_error(); },
                        [&](const BindHaptics& asked) { bind_haptics(asked.item, viewport_.find_visible_point(asked.item)); },
                        [&](const RemoveItem& asked) { remove_item(asked.item, asked.undo_label); },
                        choose_stereo,
                        choose_device,
                        [&](ShowTimeStep asked) { show_time_step(asked.step); },
                        record},
             command);
}

/// Reports the measured tracking error at intervals; reference lines are traced as far as the probe has gone.
void Session::report_tracking_error() {
  constexpr double kEveryMs = 2000;
  LiveTuning& live = context_.tuning;
  if (!live.observer || ms_since(last_tracking_report_ns_) < kEveryMs) return;
  live.tracking_error = live.observer->max_error(context_.scene.scene());
  last_tracking_report_ns_ = now_ns();
}

void Session::perform(Action action) {
  SceneModel& scene = context_.scene;
  ViewState& state = context_.state;
  const auto toggle = [](bool& what) { what = !what; };
  switch (action) {
    case Action::open:
      state.dialogs.show_open = true;
      return;
    case Action::save:
      return files_.save();
    case Action::save_as:
      state.dialogs.show_save_as = true;
      return;
    case Action::save_image:
    case Action::save_window_image:
      return viewport_.request_screenshot(action == Action::save_window_image);
    case Action::quit:
      return files_.quit();
    case Action::undo:
      return state.show_error(scene.undo());
    case Action::redo:
      return state.show_error(scene.redo());
    case Action::toggle_panels:
      return toggle(state.show_panels);
    case Action::toggle_fullscreen:
      return toggle(state.is_fullscreen);
    case Action::toggle_help:
      return toggle(state.show_help);
    case Action::dismiss:
      return dismiss();
    case Action::next_stereo_mode: {
      const int next = (static_cast<int>(scene.scene().stereo.mode) + 1) % scene::kStereoModeCount;
      return execute(SetStereoMode{static_cast<scene::StereoMode>(next)});
    }
    case Action::toggle_band_animation:
      return toggle(bands_animated_);
    case Action::play_time_steps:
      return toggle(state.playback.is_playing);
    case Action::next_time_step:
      return show_time_step(scene.scene().time.step + 1);
    case Action::previous_time_step:
      return show_time_step(scene.scene().time.step - 1);
    case Action::toggle_probe_mode:
      return context_.navigation.probe_mode ? end_probe_mode() : begin_probe_mode();
    case Action::register_device:
      return state.show_error(viewport_.toggle_registration());
    case Action::toggle_forces:
      return context_.haptic_session.set_forces_enabled(!context_.haptic_session.forces_enabled());
    case Action::reset_view:
    case Action::fit_view:
    case Action::view_along_plus_x:
    case Action::view_along_plus_y:
    case Action::view_along_plus_z:
    case Action::view_along_minus_x:
    case Action::view_along_minus_y:
    case Action::view_along_minus_z:
    case Action::toggle_projection:
    case Action::toggle_turntable:
    case Action::toggle_fly:
      content_changed_ = camera_.handle(action, state.image_area.width / state.image_area.height) || content_changed_;
      return;
  }
}

void Session::end_probe_mode() {
  context_.navigation.probe_mode = false;
  if (context_.haptic_session.is_mouse()) context_.state.show_message("the probe stays at its position; H moves it");
}

/// Moves the probe onto the item under the pointer. If the chain is empty, a link on that item is added.
void Session::begin_probe_mode() {
  Navigation& controls = context_.navigation;
  controls.probe_mode = true;
  const auto under = viewport_.pick_under_pointer();
  const std::string item = under ? viewport_.item_label(under->id) : std::string();
  const scene::EntityStore& world = std::as_const(context_.scene).scene().entities;
  if (world.count<scene::Link>() == 0) {
    if (!item.empty())
      bind_haptics(item, under->world);
    else
      context_.state.show_message("the chain is empty: point at an object in the image and press H, or click Feel beside the object");
  }
  if (!context_.haptic_session.is_mouse()) return;
  controls.pointer_hit = under ? std::optional(under->world) : std::nullopt;
  app::begin_probe_mode(controls);
  context_.haptic_session.move_mouse(context_.scene.scene(), controls.probe, controls.buttons);
}

/// Adds a link on the item. `at`: a visible point of the item.
void Session::bind_haptics(const std::string& item, std::optional<Vec3> at) {
  SceneModel& scene = context_.scene;
  ViewState& state = context_.state;
  const double edge = scene.bounds.longest_edge();
  const auto binding = app::make_haptic_binding(scene.scene(), item, at, context_.navigation.view.position, edge > 0 ? edge : 4);
  if (!binding) return state.show_message(binding.error().message, true);
  if (const std::string by = find_bound_link(scene.scene(), *binding); !by.empty())
    return state.show_message(binding->description + " has a link already: " + by);
  const Outcome done = scene.apply(make_binding_edits(scene.scene(), item, *binding), "feel " + binding->description, {});
  if (!done) return state.show_message(done.error().message, true);
  // a mouse-driven probe starts on the item's surface, not inside it
  Navigation& controls = context_.navigation;
  if (context_.haptic_session.is_mouse() && at) {
    controls.probe = *at;
    controls.wheel_depth = 0;
    context_.haptic_session.move_mouse(scene.scene(), controls.probe, controls.buttons);
  }
  const char* how = !context_.haptic_session.is_mouse() ? ""
                    : controls.probe_mode               ? ". The wheel moves the probe in depth; Esc ends probe mode"
                                                        : ". Point at the object and press H to move the probe with the mouse";
  state.show_message("link added: " + binding->description + how);
}

/// Removes the item and the links on it, except links that something else needs.
void Session::remove_item(const std::string& item, const std::string& what) {
  SceneModel& scene = context_.scene;
  const TextEdits removal_edits = make_remove_edits_with_links(scene.scene(), scene.document().text(), item);
  if (scene.apply(removal_edits, what)) return;
  context_.state.show_error(scene.apply(make_remove_edits(scene.document().text(), item), what));
}

/// Closes the topmost open element; never the program.
void Session::dismiss() {
  if (gui_.close_popup()) return;
  ViewState& state = context_.state;
  Navigation& controls = context_.navigation;
  bool* const first[] = {&state.show_help, &controls.fly, &controls.turntable};
  for (bool* what : first)
    if (std::exchange(*what, false)) return;
  if (controls.probe_mode) return end_probe_mode();
  state.is_fullscreen = false;
}

// Keys and pointer input of the user are sent to the GUI, to a command, to the camera or to the probe.

namespace {

constexpr int kPointerSettleFrames = 3;

}  // namespace

Gui::Frame Session::make_gui_frame() {
  return {[this] {
            PanelContext panels = panel_context();
            draw_interface(panels);
          },
          [this] {
            execute();
            viewport_.write_requested_screenshot();
          }};
}

NavigationChanges Session::process_input(double wait_s) {
  NavigationChanges changed;
  Window& window = context_.window;
  for (const Input& piece : window.poll(wait_s)) {
    const NavigationChanges by_piece = process_segment(piece);
    changed.view = changed.view || by_piece.view;
    changed.probe = changed.probe || by_piece.probe;
  }
  if (window.is_closing()) {
    window.cancel_close();
    context_.commands.push_back(Action::quit);
    execute();
    settle_frames_ = kPointerSettleFrames;
  }
  if (window.had_events()) {
    viewport_.invalidate_pick();
    settle_frames_ = kPointerSettleFrames;
  }
  if (bool& full = context_.state.is_fullscreen; window.is_fullscreen() != full) {
    window.set_fullscreen(full);
    full = window.is_fullscreen();
  }
  const scene::Scene& scene = context_.scene.scene();
  context_.haptic_session.update_resistance(scene, context_.navigation);
  if (changed.probe) context_.haptic_session.move_mouse(scene, context_.navigation.probe, context_.navigation.buttons);
  if (changed.view) camera_.pin_camera();
  return changed;
}

/// Processes one input segment. The GUI comes first: it decides whether a key press is text or a command. Then the key press, then motion.
NavigationChanges Session::process_segment(Input piece) {
  gui_.feed_input(piece, make_gui_frame());
  Commands& commands = context_.commands;
  if (piece.needs_redraw) viewport_.request_redraw();
  if (piece.key_event && !gui_.wants_text_input())
    if (const auto action = find_action(*piece.key_event, context_.navigation.fly)) {
      commands.push_back(*action);
      gui_.expect_focus_change();
    }
  if (!piece.dropped_files.empty()) {
    const auto series = scene::make_pattern(piece.dropped_files);
    if (!series) context_.state.show_message("the dropped files are not a series: only the last file is opened");
    commands.push_back(DropFile{series ? *series : piece.dropped_files.back()});
  }
  execute();
  Navigation& controls = context_.navigation;
  if (stops_turntable(piece)) controls.turntable = false;
  Input input = route_to_viewport(piece);
  if (controls.probe_mode && context_.haptic_session.is_mouse()) {
    // over a panel the probe stays where it is, so that moving the pointer to a panel does not move it
    if (!context_.state.pointer_on_image && !context_.state.pointer_pressed) input.dx = input.dy = input.wheel = 0;
    const auto under = viewport_.pick_under_pointer();
    controls.pointer_hit = under ? std::optional(under->world) : std::nullopt;
  }
  return apply(controls, input);
}

/// Removes input that belongs to the GUI: a drag belongs to the area in which it began.
Input Session::route_to_viewport(Input input) {
  ViewState& state = context_.state;
  const bool pressed = input.left || input.middle || input.right;
  const bool here = gui_.covers(input.x, input.y);
  if (!pressed) gui_captures_pointer_ = false;
  if (pressed && !state.pointer_pressed) gui_captures_pointer_ = here;
  state.pointer_pressed = pressed;
  state.pointer_x = input.x + input.dx;
  state.pointer_y = input.y + input.dy;
  if (input.dx != 0 || input.dy != 0) state.pointer_has_moved = true;
  state.pointer_on_image = !gui_captures_pointer_ && state.image_area.contains(state.pointer_x, state.pointer_y) &&
                           !gui_.covers(state.pointer_x, state.pointer_y);
  if (gui_captures_pointer_ || (!pressed && here)) {
    input.dx = input.dy = input.wheel = 0;
    input.left = input.middle = input.right = false;
  }
  // from here on in coordinates of the image area
  input.x -= state.image_area.x;
  input.y -= state.image_area.y;
  input.width = state.image_area.width;
  input.height = state.image_area.height;
  return input;
}

}  // namespace catena::app
