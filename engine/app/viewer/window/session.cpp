// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

constexpr int kNewTableFrames = 3;  // the table, its scrollbar, and columns of its final width
constexpr double kEstimateS = 0.6;  // seconds without a change after which the image error is estimated
constexpr double kTitleS = 0.25;
constexpr double kLiveS = 0.1;     // seconds between GUI frames that only show the haptic state
constexpr double kMirrorS = 0.03;  // seconds between mirror frames of the headset in the window, whose display may be the slower one

double s_since(std::int64_t ns) { return 1e-3 * ms_since(ns); }

}  // namespace

Session::Session(const ViewOptions& options, SceneModel& scene, HapticSession& hand, Window& window, std::optional<ShaderReload> reload,
                 std::unique_ptr<TrackedHead> head, std::optional<InterruptHandler>& interrupt)
    : gui_(window),
      context_{options, scene, hand, window, gui_},
      camera_(context_.navigation, scene, hand),
      head_(std::move(head)),
      viewport_(context_, std::move(reload)),
      files_(context_, camera_, viewport_),
      step_watcher_(options.follow_time_steps),
      interrupt_(interrupt) {}

Session::~Session() { context_.haptic_session.stop(); }

PanelContext Session::panel_context() {
  return {context_.scene,  context_.haptic_session, viewport_.presenter(), context_.navigation, context_.scheduler,
          context_.tuning, context_.frame_times,    context_.state,        context_.commands};
}

std::optional<Failure> Session::open() {
  const ViewOptions& options = context_.options;
  HapticSession& hand = context_.haptic_session;
  ViewState& state = context_.state;
  state.show_panels = options.show_panels && options.width >= kMinWidthWithPanels;
  // the image size: the panels' edges are known only after the GUI frame has begun
  gui_.begin();
  const Insets edges = state.show_panels ? interface_insets() : Insets{};
  gui_.end();
  state.image_area = compute_image_area(options.width, options.height, edges);

  std::optional<Failure> not_shown;
  const auto loaded = load_initial_scene(context_.scene, hand, static_cast<std::uint32_t>(state.image_area.width),
                                         static_cast<std::uint32_t>(state.image_area.height),
                                         [&](const LoadWait& is_loaded) { not_shown = viewport_.show_loading(is_loaded); });
  if (not_shown) return not_shown;
  if (!loaded) return to_failure(loaded.error());
  files_.adopt_scene(*loaded);
  find_animated_bands();
  view_without_head_ = context_.navigation.view;
  update_head();
  if (auto failure = viewport_.open()) return failure;
  reset_tracking_observer();
  files_.begin();
  // a device with forces is stopped by its own signal handling on any signal; with a mouse the outputs are finished
  if (hand.is_mouse())
    interrupt_.emplace(std::vector{SIGINT, SIGTERM, SIGHUP});
  else
    interrupt_.emplace();
  if (const Outcome started = hand.start(); !started) return Failure{1, started.error().message};
  if (!hand.open_notice().empty()) state.show_message(hand.open_notice());
  return std::nullopt;
}

/// Rebuilds the haptic program after an edit or a change of the scene. True: the image must be drawn anew, too.
bool Session::process_edits() {
  SceneModel& scene = context_.scene;
  if (!scene.take_changed()) return false;
  context_.state.show_error(apply_scene_target(context_.tuning, scene, context_.scheduler));
  context_.state.show_error(context_.haptic_session.publish(scene.scene(), scene.recording_text()));
  reset_tracking_observer();
  find_animated_bands();
  return true;
}

/// Discards the cost curves: another scene has its own.
void Session::reset_tuning() {
  LiveTuning& live = context_.tuning;
  live = {};
  const scene::Scene& scene = std::as_const(context_.scene).scene();
  live.target = live.scene_target = scene.tuning;
  live.has_fixed_quality = context_.options.has_explicit_quality || is_fixed_quality(scene.quality);
}

/// Measures the cost curves of this scene, independent of its targets: the slider uses them.
std::optional<Failure> Session::measure_costs() {
  LiveTuning& live = context_.tuning;
  set_default_target(live);
  context_.state.show_error(measure_tick_costs(live, context_.scene, context_.haptic_session,
                                               [&](const std::string& line) { context_.state.show_message(line); }));
  if (live.has_fixed_quality) return std::nullopt;
  return viewport_.apply_tuning();
}

/// Resets the measured tracking error, which depends on the settings.
void Session::reset_tracking_observer() {
  LiveTuning& live = context_.tuning;
  live.tracking_error.reset();
  live.observer.reset();
  if (live.tick_tuning && !live.tick_tuning->is_empty()) live.observer.emplace(&*live.tick_tuning, *context_.haptic_session.program());
}

void Session::find_animated_bands() {
  const scene::EntityStore& world = std::as_const(context_.scene).scene().entities;
  has_animated_bands_ = false;
  world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    has_animated_bands_ = has_animated_bands_ || (set.band_length > 0 && !is_hidden(world, e));
  });
  world.each<scene::Slice>([&](scene::Entity e, const scene::Slice& slice) {
    has_animated_bands_ = has_animated_bands_ || (slice.flow_texture && slice.flow_texture->is_animated && !is_hidden(world, e));
  });
}

/// Writes the poses of widgets that the probe has moved and released into the scene.
void Session::store_widget_edits() {
  for (const WidgetEdits::FinishedMove& ended : widget_edits_.take_finished(context_.scene.scene()))
    context_.state.show_error(context_.scene.apply(ended.edits, ended.undo_label));
}

/// Advances the animated bands. True: they have moved. With a fixed number of frames they stand still, so that frames repeat.
bool Session::animate_bands() {
  const bool running = has_animated_bands_ && bands_animated_ && context_.options.max_frames == 0 && context_.window.has_focus_or_pointer();
  scene::Scene& scene = context_.scene.scene();
  const auto phase = band_clock_.advance(now_ns(), running, scene.animation_phase);
  if (phase) scene.animation_phase = *phase;
  return phase.has_value();
}

/// Sets the camera from the tracked head, regardless of the mouse. True: it has moved.
bool Session::update_head() {
  if (!head_) return false;
  const auto at = head_->position_at(s_since(start_ns_));
  if (head_->take_lost()) context_.state.show_message("the head is not tracked, or is not in front of the screen: the camera stays", true);
  render::View view = view_without_head_;
  view.position = at.value_or(context_.navigation.view.position);
  const bool moved = view.position != std::exchange(context_.navigation.view, view).position;
  camera_.pin_camera();
  return moved;
}

void Session::poll_time_steps() {
  const auto more = step_watcher_.poll(context_.scene, context_.state.playback);
  if (!more)
    context_.state.show_message(more.error().message, true);
  else if (*more)
    context_.state.show_message(fmt::format("the scene has {} time steps", scene::step_count(std::as_const(context_.scene).scene())));
}

void Session::show_time_step(int step) { context_.state.show_error(context_.state.playback.show(context_.scene, step)); }

void Session::update_title() {
  if (last_title_ns_ != 0 && s_since(last_title_ns_) < kTitleS) return;
  const HapticSession& hand = context_.haptic_session;
  const HapticState& haptic_state = hand.latest_state();
  const scene::Document& document = context_.scene.document();
  const std::string name = context_.state.is_untitled ? "untitled" : std::filesystem::path(document.path()).filename().string();
  std::string title = fmt::format("{}{} - Catena", name, document.is_modified() ? " \u2022" : "");
  if (!hand.is_mouse() || context_.navigation.probe_mode) {
    title += fmt::format("  {:.2f} N", norm(haptic_state.force_n));
    const auto links = std::min(static_cast<std::size_t>(haptic_state.link_count), hand.link_names().size());
    for (std::size_t k = 0; k < links; ++k) title += fmt::format("  {} {}", hand.link_names()[k], to_string(haptic_state.links[k].status));
  }
  if (const std::string text = hand.device().device->status_text(); !text.empty()) title += "  " + text;
  if (hand.recording().is_recording()) title += hand.recording().has_failed() ? "  the recording has stopped" : "  [recording]";
  if (!hand.is_mouse()) title += hand.forces_enabled() ? "  [forces on]" : "  [forces off]";
  const scene::StereoMode stereo = context_.scene.scene().stereo.mode;
  if (stereo != scene::StereoMode::mono) title += fmt::format("  [{}]", scene::to_string(stereo));
  if (context_.navigation.probe_mode) title += "  [probe mode]";
  if (const std::string headset = viewport_.headset_status(); !headset.empty()) title += "  [" + headset + "]";
  context_.window.set_title(title);
  last_title_ns_ = now_ns();
}

bool Session::should_continue() const {
  const ViewOptions& options = context_.options;
  const bool asked = interrupt_ && interrupt_->is_requested();
  return !asked && !files_.has_quit() && (options.max_frames == 0 || context_.frame_times.count() < options.max_frames) &&
         (options.max_seconds <= 0 || s_since(start_ns_) < options.max_seconds);
}

std::optional<FrameRequest> Session::next_frame(bool moved, bool probe_moved) {
  const ViewOptions& options = context_.options;
  if (options.max_frames > 0 && context_.frame_times.count() + 1 == options.max_frames) return viewport_.frame_builder().final_frame();
  const auto [width, height] = viewport_.size();
  return viewport_.frame_builder().next_frame(moved, probe_moved, width, height);
}

std::optional<Failure> Session::run() {
  const ViewOptions& options = context_.options;
  SceneModel& scene = context_.scene;
  start_ns_ = now_ns();
  if (head_)
    if (const Outcome started = head_->start(s_since(start_ns_)); !started) return Failure{1, started.error().message};
  viewport_.frame_builder().mark_changed();
  std::int64_t last_show_ns = 0;
  bool busy = true, minimised = false, live = false;
  const Gui::Frame frame = make_gui_frame();
  while (should_continue()) {
    const NavigationChanges by_input = process_input(minimised ? kMinimizedWaitS : busy ? 0 : kIdleWaitS);
    if (std::exchange(measurement_requested_, false)) {
      if (auto failure = measure_costs()) return failure;
      content_changed_ = true;
    }
    // collect the changes since the last frame
    poll_time_steps();
    context_.state.show_error(context_.state.playback.advance(scene));
    context_.state.show_error(context_.state.playback.follow_proxy(scene, context_.haptic_session));
    if (context_.state.appearance.measure.labels.collect()) settle_frames_ = kNewTableFrames;
    const bool opened = files_.poll_loaded();
    if (opened) {
      reset_tuning();
      head_.reset();  // its display screen belongs to the closed scene
    }
    const bool edited = process_edits(), late = viewport_.take_late_probe_motion(),
               state_changed = context_.haptic_session.pull_state(scene.scene()) || late;
    if (state_changed && context_.tuning.observer) context_.tuning.observer->add(context_.haptic_session.latest_state());
    live = live || state_changed || files_.is_loading() || context_.haptic_session.recording().is_recording();
    if (state_changed) store_widget_edits();
    const auto followed = viewport_.poll_headset();
    if (!followed) return Failure{1, followed.error().message};
    const bool in_headset = *followed;
    minimised = viewport_.is_minimised();
    if (minimised) {
      viewport_.request_redraw();
      frame.run_commands();  // the window can still be closed
      continue;
    }
    const bool flies = context_.navigation.fly && !gui_.wants_text_input();
    const bool pulsed = animate_bands(), reloaded = viewport_.reload_shaders();
    const bool head_moved = update_head();
    const bool turned = camera_.update(flies ? context_.window.held_fly_keys() : FlyKeys{});
    const render::PagingStats bricks = viewport_.presenter().renderer().paging();
    const bool resized = viewport_.is_stale() || viewport_.update_layout();
    const bool moved = by_input.view || std::exchange(content_changed_, false) || opened || edited || resized || pulsed || reloaded ||
                       turned || head_moved || bricks.has_arrived || context_.frame_times.count() == 0;
    if (in_headset && moved) viewport_.frame_builder().mark_changed();
    auto next = in_headset ? viewport_.frame_builder().interactive_frame() : next_frame(moved, state_changed || by_input.probe);
    if (!next && viewport_.frame_builder().idle_s() >= kEstimateS && std::exchange(estimate_requested_, false))
      if (auto failure = viewport_.estimate_error()) return failure;
    if (!next && (options.max_frames > 0 || options.max_seconds > 0)) next = context_.scheduler.current();
    busy = next.has_value();
    if (next)
      if (auto failure = viewport_.draw(*next)) return failure;

    // the GUI responds to user input at once, and to the haptic state at a lower rate
    const bool due = live && s_since(last_show_ns) >= kLiveS;
    const bool mirrors = in_headset && s_since(last_show_ns) < kMirrorS && !viewport_.needs_redraw();
    if (mirrors) {
      settle_frames_ = 0;
    } else if (next || viewport_.needs_redraw() || due || settle_frames_ > 0 || context_.window.had_events() || gui_.is_busy()) {
      settle_frames_ = std::max(0, settle_frames_ - 1);
      if (auto failure = viewport_.show(frame.draw_panels)) return failure;
      last_show_ns = now_ns();
      live = false;
      frame.run_commands();
    }
    files_.autosave();
    update_title();
  }
  files_.autosave(true);
  return finish();
}

std::optional<Failure> Session::finish() {
  const ViewOptions& options = context_.options;
  if (auto finished = context_.haptic_session.finish(options.servo_stats); !finished) return to_failure(finished.error());
  context_.haptic_session.pull_state(context_.scene.scene());
  if (!options.frame_stats.empty()) {
    auto file = OutputFile::open(options.frame_stats);
    if (!file) return to_failure(file.error());
    file->write(context_.frame_times.to_json());
    if (auto written = file->commit(); !written) return to_failure(written.error());
  }
  if (auto failure = viewport_.write_final_screenshots(make_gui_frame().draw_panels)) return failure;
  print_statistics();
  if (interrupt_)
    if (const Outcome ended = interrupt_->outcome(); !ended) return Failure{1, ended.error().message};
  return std::nullopt;
}

/// Prints the closing statistics to the terminal.
void Session::print_statistics() {
  Presenter& screen = viewport_.presenter();
  const FrameTimes& times = context_.frame_times;
  const HapticState& haptic_state = context_.haptic_session.latest_state();
  fmt::print("{} frames, {:.1f} ms median, on {}\n", times.count(), 1e-3 * times.draw_times().p50_us,
             sanitize_for_terminal(screen.renderer().stats().device));
  if (const std::string headset = viewport_.headset_summary(); !headset.empty()) fmt::print("{}\n", headset);
  if (screen.recovery_count() > 0)
    fmt::print("the graphics device was lost and restarted {} time{}\n", screen.recovery_count(), screen.recovery_count() == 1 ? "" : "s");
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", haptic_state.probe.x, haptic_state.probe.y,
             haptic_state.probe.z, norm(haptic_state.force_n), haptic_state.tick, haptic_state.missed_deadlines);
}

}  // namespace catena::app
