// SPDX-License-Identifier: MIT
// Carries out commands: the only place that does so.
#include <utility>

#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/edit/remove_item.h"
#include "engine/app/viewer/edit/window_level.h"
#include "engine/app/viewer/window/session.h"
#include "engine/base/clock.h"
#include "engine/scene/time_steps.h"
#include "render/extract/plane_views.h"

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
                        [&](const OpenFile& file) { files_.open(file.path, file.grid); },
                        [&](const AddFile& file) { files_.add(file.path); },
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
    case Action::add:
      state.dialogs.show_add = true;
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
    case Action::toggle_ortho_views: {
      if (context_.options.use_headset || scene.scene().stereo.mode != scene::StereoMode::mono)
        return state.show_message("orthogonal views are not shown in stereo; F2 selects the stereo mode", true);
      if (!context_.navigation.ortho.is_on)
        if (const auto planes = render::find_ortho_planes(scene.scene()); !planes) return state.show_message(planes.error().message, true);
      toggle(context_.navigation.ortho.is_on);
      content_changed_ = true;
      return;
    }
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
      content_changed_ = camera_.handle(action, viewport_.view_area().width / viewport_.view_area().height) || content_changed_;
      return;
  }
}

void Session::end_probe_mode() {
  Navigation& controls = context_.navigation;
  controls.probe_mode = false;
  if (!context_.haptic_session.is_mouse()) return;
  // nothing holds the mouse: the probe goes back to where the chain holds it, so that no force is left
  controls.buttons = 0;
  controls.probe = controls.last_proxy.value_or(controls.probe);
  context_.haptic_session.move_mouse(context_.scene.scene(), controls.probe, controls.buttons);
  context_.state.show_message("the probe stays at its position; H moves it");
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
  } else if (under) {
    explain_unfelt(item, under->world);
  }
  if (!context_.haptic_session.is_mouse()) return;
  controls.pointer_hit = under ? std::optional(under->world) : std::nullopt;
  app::begin_probe_mode(controls);
  context_.haptic_session.move_mouse(context_.scene.scene(), controls.probe, controls.buttons);
}

/// Says why the item under the pointer is not felt, if no link lies on it.
void Session::explain_unfelt(const std::string& item, const Vec3& at) {
  SceneModel& scene = context_.scene;
  if (item.empty() || item.starts_with("widgets")) return;
  const double edge = scene.bounds.longest_edge();
  const auto binding = app::make_haptic_binding(scene.scene(), item, at,
                                                context_.navigation.view.position / context_.navigation.view.stretch, edge > 0 ? edge : 4);
  if (!binding) return context_.state.show_message("this is not felt: " + binding.error().message);
  if (find_bound_link(scene.scene(), *binding).empty())
    context_.state.show_message("this is not felt: no link of the chain lies on " + binding->description +
                                "; the button Feel in its panel adds one");
}

/// Adds a link on the item. `at`: a visible point of the item.
void Session::bind_haptics(const std::string& item, std::optional<Vec3> at) {
  SceneModel& scene = context_.scene;
  ViewState& state = context_.state;
  const double edge = scene.bounds.longest_edge();
  const auto binding = app::make_haptic_binding(scene.scene(), item, at,
                                                context_.navigation.view.position / context_.navigation.view.stretch, edge > 0 ? edge : 4);
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
  if (const auto changed = process_plane_input(input)) return *changed;
  const Area view = viewport_.view_area();
  input.x -= view.x;
  input.y -= view.y;
  input.width = view.width;
  input.height = view.height;
  if (controls.probe_mode && context_.haptic_session.is_mouse()) {
    // over a panel the probe stays where it is, so that moving the pointer to a panel does not move it
    if (!context_.state.pointer_on_image && !context_.state.pointer_pressed) input.dx = input.dy = input.wheel = 0;
    const auto under = viewport_.pick_under_pointer();
    controls.pointer_hit = under ? std::optional(under->world) : std::nullopt;
  }
  if (drag_window_level(input) ||
      drag_widget(input, make_area_camera(controls.view, input.width, input.height), [&] { return viewport_.widget_at(input.x, input.y); }))
    input.dx = input.dy = 0;
  return apply(controls, input);
}

/// Changes the range of the colors while Ctrl, Shift and the left button are down: to the right a wider range, upwards lower values. One
/// press is one undo step. True: the input belongs to it.
bool Session::drag_window_level(const Input& input) {
  if (!input.left || !input.control || !input.shift) {
    window_level_drag_ = 0;
    return false;
  }
  if (window_level_drag_ == 0) window_level_drag_ = ++context_.state.edit.gesture;
  if (input.dx == 0 && input.dy == 0) return true;
  const scene::Scene& scene = std::as_const(context_.scene).scene();
  const TextEdits edits = make_window_level_edits(scene, 2 * input.dx / input.width, input.dy / input.height);
  if (!edits.empty()) execute(Edit{edits, "window and level", "window and level" + std::to_string(window_level_drag_)});
  return true;
}

/// Moves the widget part that was under the pointer at the press; the moves of one press are one undo step. True: the input belongs to it.
bool Session::drag_widget(const Input& input, const render::Camera& camera, const std::function<std::optional<WidgetPart>()>& find) {
  const bool was_down = std::exchange(left_was_down_, input.left), pressed = input.left && !was_down;
  SceneModel& model = context_.scene;
  if (!input.left) dragged_widget_.reset();
  const bool can = pressed && !input.shift && !input.control;
  if (!dragged_widget_ && !can) return false;
  if (can) {
    const auto part = find();
    if (!part) return false;
    dragged_widget_ = {entity_name(model.scene(), part->widget),
                       WidgetDrag(model.scene().entities.get<scene::Widget>(part->widget), *part, camera)};
    ++context_.state.edit.gesture;
  }
  if (input.dx == 0 && input.dy == 0) return true;
  const std::string& name = dragged_widget_->name;
  const scene::Entity entity = scene::find_widget(std::as_const(model).scene(), name);
  if (!entity) return true;
  const widget::Pose pose = dragged_widget_->drag.pose_at(camera, input.x + input.dx, input.y + input.dy);
  execute(Edit{make_pose_edits(std::as_const(model).scene().entities.get<scene::Widget>(entity), pose), "move " + name,
               "move " + name + std::to_string(context_.state.edit.gesture)});
  return true;
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
  return input;
}

/// Applies input over a plane of a page of orthogonal views; a drag belongs to the view in which it began. Nothing: the input belongs to
/// the 3D view.
std::optional<NavigationChanges> Session::process_plane_input(const Input& input) {
  const bool pressed = input.left || input.middle || input.right;
  if (!pressed || !std::exchange(plane_pressed_, pressed)) plane_ = viewport_.plane_at(input.x, input.y);
  plane_pressed_ = pressed;
  if (!plane_ || gui_captures_pointer_ || (!pressed && gui_.covers(input.x, input.y))) return std::nullopt;
  // the plane may have moved since the press
  if (const auto now = viewport_.plane_at(plane_->area.x + 1, plane_->area.y + 1)) plane_ = now;
  const render::Camera camera = make_area_camera(plane_->plane->view, plane_->area.width, plane_->area.height);
  Input there = input;
  there.x -= plane_->area.x;
  there.y -= plane_->area.y;
  if (drag_widget(there, camera, [&] { return viewport_.widget_in_plane(*plane_, camera, there.x, there.y); })) return NavigationChanges{};
  const NavigationChanges changed = apply_to_plane(context_.navigation, input, *plane_->plane, plane_->area);
  content_changed_ = content_changed_ || changed.view;
  return NavigationChanges{false, changed.probe};
}

}  // namespace catena::app
