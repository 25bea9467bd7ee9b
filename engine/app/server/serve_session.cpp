// SPDX-License-Identifier: MIT
#include "engine/app/server/serve_session.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "engine/app/server/server_messages.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

constexpr double kNobodyWaitS = 0.1, kLookWaitS = 0.004;  // intervals between checks of the servo state
constexpr double kStateMs = 50, kSceneMs = 500;

}  // namespace

ServeSession::ServeSession(const ServeOptions& options, const LoadedScene& loaded, SceneModel& scene, HapticSession& hand,
                           http::Server& server, FrameEncoder& maker, const InterruptHandler& interrupt)
    : options_(options),
      scene_(scene),
      haptics_(hand),
      server_(server),
      encoder_(maker),
      interrupt_(interrupt),
      scheduler_(options.quality),
      frame_builder_(scene, controls_, scheduler_),
      camera_(controls_, scene, hand),
      step_follower_(options.follow),
      width_(options.width),
      height_(options.height) {
  scene_.bounds = loaded.bounds;
  camera_.adopt_scene(loaded);
  scene_.set_validator(SceneModel::make_validator(hand));
  scene_.take_changed();
  tuning_.has_fixed_quality = options.has_fixed_quality;
}

namespace {

/// Returns whether standard input has ended, which means that the parent process is gone; its content is ignored.
bool stdin_has_ended() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  std::array<char, 4096> ignored{};
  while (poll(&in, 1, 0) > 0) {
    const ssize_t count = read(STDIN_FILENO, ignored.data(), ignored.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return true;
  }
  return false;
}

}  // namespace

bool ServeSession::is_running() const {
  if (options_.exit_with_stdin && stdin_has_ended()) return false;
  return !interrupt_.is_requested() && (options_.seconds <= 0 || 1e-3 * ms_since(start_ns_) < options_.seconds);
}

Outcome ServeSession::run() {
  CATENA_CHECK(apply_stated_targets());
  start_ns_ = now_ns();
  bool busy = true;
  while (is_running()) {
    for (const http::ViewerEvent& event : server_.wait_for_events(viewers_.empty() ? kNobodyWaitS : busy ? 0 : kLookWaitS))
      on_message(event);
    for (const WidgetEdits::FinishedMove& ended : widget_edits_.take_finished(scene_.scene()))
      send_note_on_error(scene_.apply(ended.edits, ended.undo_label));
    if (const auto more = step_follower_.poll(scene_, playback_); !more) send_note(more.error().message);
    if (!viewers_.empty()) send_note_on_error(playback_.advance(scene_));
    if (!viewers_.empty()) send_note_on_error(playback_.follow_proxy(scene_, haptics_));
    if (recording_.must_end(haptics_)) end_recording();
    if (scene_.take_changed()) {
      send_note_on_error(apply_scene_target(tuning_, scene_, scheduler_));
      send_note_on_error(haptics_.publish(scene_.scene(), scene_.recording_text()));
      has_changed_ = true;
      scene_sent_ = false;
    }
    probe_moved_ = haptics_.pull_state(scene_.scene()) || probe_moved_;
    if (viewers_.empty()) continue;
    has_changed_ = camera_.update({}) || has_changed_;
    const int before = frame_times_.count();
    if (server_.has_ready_viewer()) CATENA_CHECK(show_next_frame());
    busy = frame_times_.count() != before;
    send_state();
  }
  CATENA_CHECK(recording_.end(haptics_));
  const HapticState& haptic_state = haptics_.latest_state();
  fmt::print("{} images for at most {} page{} at a time, {:.1f} ms median, on {}\n", frame_times_.count(), max_viewers_,
             max_viewers_ == 1 ? "" : "s", 1e-3 * frame_times_.draw_times().p50_us,
             sanitize_for_terminal(encoder_.renderer().stats().device));
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", haptic_state.probe.x, haptic_state.probe.y,
             haptic_state.probe.z, norm(haptic_state.force_n), haptic_state.tick, haptic_state.missed_deadlines);
  return Done{};
}

// ---- frames ----

Outcome ServeSession::show_next_frame() {
  const bool moved = std::exchange(has_changed_, false) || encoder_.renderer().paging().has_arrived,
             probe_moved = std::exchange(probe_moved_, false);
  if (const auto next = frame_builder_.next_frame(moved, probe_moved, width_, height_)) {
    if (const Outcome drawn = encoder_.draw(frame_builder_, scheduler_, frame_times_, *next, width_, height_); !drawn) {
      if (drawn.error().system_failure) return drawn;
      send_note(drawn.error().message);  // an error caused by an edit: the last image stays
      return Done{};
    }
    if (tuning_.matches(*next) && tuning_.on_rendered(encoder_.render_ms()))
      if (const auto quality = tuning_.quality()) scheduler_ = ProgressiveScheduler(*quality);
    return send_frame(false);
  }
  // idle: the image cannot be refined further, so it is sent once with lossless encoding
  const bool rests = frame_builder_.idle_s() >= kRefineDelayS && 1e-3 * ms_since(last_frame_ns_) >= kRefineDelayS;
  return rests && !sent_lossless_ && encoder_.has_image() ? send_frame(true) : Outcome(Done{});
}

Outcome ServeSession::send_frame(bool exact) {
  CATENA_TRY(last_frame_, encoder_.encode_message(exact, input_number_));
  sent_lossless_ = exact;
  last_frame_ns_ = now_ns();
  server_.send(http::kAllViewers, http::Slot::frame, last_frame_);
  return Done{};
}

// ---- viewers ----

void ServeSession::on_message(const http::ViewerEvent& event) {
  switch (event.kind) {
    case http::ViewerEvent::Kind::connected:
      return on_connect(event.viewer);
    case http::ViewerEvent::Kind::disconnected:
      return on_disconnect(event.viewer);
    case http::ViewerEvent::Kind::message:
      break;
  }
  const auto request = parse_request(event.text);
  if (!request) return server_.send(event.viewer, http::Slot::note, note_message(request.error().message));
  const bool has_hand = event.viewer == controller_;
  if (const auto* about = std::get_if<ControlRequest>(&*request)) {
    if (*about == ControlRequest::take && controller_ == 0) give_control_to(event.viewer);
    if (*about == ControlRequest::release && has_hand) give_control_to(0);
    return;
  }
  if (!has_hand) return;  // viewers that only watch cannot change anything
  std::visit(
      [this](const auto& asked) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(asked)>, ControlRequest>) handle(asked);
      },
      *request);
}

void ServeSession::on_connect(http::ViewerId viewer) {
  viewers_.push_back(viewer);
  max_viewers_ = std::max(max_viewers_, viewers_.size());
  last_state_.clear();
  server_.send(viewer, http::Slot::scene, scene_message(scene_, field_values_));
  if (!last_frame_.empty()) server_.send(viewer, http::Slot::frame, last_frame_);
  if (controller_ == 0) return give_control_to(viewer);
  send_roles();
}

void ServeSession::on_disconnect(http::ViewerId viewer) {
  std::erase(viewers_, viewer);
  if (viewer == controller_) return give_control_to(0);
  send_roles();
}

void ServeSession::give_control_to(http::ViewerId viewer) {
  stop_haptics();
  controls_.turntable = false;
  controller_ = viewer;
  input_number_ = 0;
  send_roles();
}

void ServeSession::send_roles() {
  for (const http::ViewerId viewer : viewers_)
    server_.send(viewer, http::Slot::role,
                 role_message(viewer == controller_ ? "yours"
                              : controller_ == 0    ? "free"
                                                    : "taken",
                              viewers_.size()));
}

void ServeSession::send_state() {
  if (ms_since(last_state_ns_) < kStateMs) return;
  last_state_ns_ = now_ns();
  std::string state =
      state_message(haptics_, scene_, {controls_.probe_mode, playback_.is_playing, scheduler_.status_text(), tuning_, recording_.name()});
  if (state != last_state_) server_.send(http::kAllViewers, http::Slot::state, state);
  last_state_ = std::move(state);
  // histograms are sent once the values are sorted
  if ((scene_sent_ && !field_values_.is_busy()) || ms_since(last_scene_ns_) < kSceneMs) return;
  last_scene_ns_ = last_state_ns_;
  server_.send(http::kAllViewers, http::Slot::scene, scene_message(scene_, field_values_));
  scene_sent_ = true;
}

void ServeSession::send_note(const std::string& line) {
  if (controller_ != 0) server_.send(controller_, http::Slot::note, note_message(line));
}

void ServeSession::send_note_on_error(const Outcome& outcome) {
  if (!outcome) send_note(outcome.error().message);
}

// ---- tuning ----

/// Applies the tuning targets that the scene states, before the first viewer connects.
Outcome ServeSession::apply_stated_targets() {
  tuning_.target = tuning_.scene_target = scene_.scene().tuning;
  if (tuning_.target.has_haptic_targets()) {
    CATENA_CHECK(measure_tick_costs(tuning_, scene_, haptics_, [](const std::string& line) { print_message(line); }));
    scene_.mark_changed();
  }
  return Done{};
}

Outcome ServeSession::measure_image() {
  CATENA_TRY(const render::FramePacket packet, frame_builder_.make_packet(width_, height_));
  const auto report_message = [this](const std::string& line) { viewers_.empty() ? print_message(line) : send_note(line); };
  return measure_image_costs(tuning_, scheduler_, encoder_.renderer(), packet, scene_, haptics_, report_message);
}

}  // namespace catena::app
