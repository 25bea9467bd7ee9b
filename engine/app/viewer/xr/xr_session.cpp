// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/xr_session.h"

#include <chrono>
#include <utility>

#include "engine/app/viewer/xr/xr_controllers.h"

#ifdef CATENA_XR
#include <fmt/format.h>

#include "engine/app/viewer/xr/xr_panel.h"
#include "engine/base/clock.h"
#include "render/xr/headset.h"
#endif

namespace catena::app {

#ifdef CATENA_XR

namespace {

constexpr int kFarewellTurns = 200;                  // maximum turns of events and frames while the session ends
constexpr std::chrono::milliseconds kPatience{500};  // wait for a frame before the window continues; after that kTurn
constexpr std::chrono::milliseconds kTurn{10};       // wait per turn of the window's loop, and while the session ends
constexpr double kFovea = 0.36;           // tan 20 degrees off the gaze, or the eye's axis: beyond it full resolution is not worth its cost
constexpr double kAboveHandM = 0.06;      // offset of the scale label above the controllers that grab the world
constexpr double kWordsAt_px = 1.0 / 50;  // label height, as a fraction of the view's
constexpr double kMaxStepS = 0.1;         // maximum time step of world motion: no jump after a pause
constexpr std::int64_t kRepeatNs = 30'000'000'000;  // interval after which the same loss is reported another time
constexpr std::int64_t kSettlesNs = 300'000'000;    // forces are suspended so long after the world was placed: the probe jumps
constexpr int kUnseen = 60;                         // frames without a view before this is reported

/// Placement by the scene's camera, with its view straight ahead of the head: the local space of some runtimes begins elsewhere.
Placement before(const render::xr::XrHeadPose& head, const render::View& view) {
  return xr_interaction::move_world(render::make_initial_placement(view), Vec3(0.0), xr_interaction::heading_rotation(head.orientation), 1,
                                    head.position);
}

XrHand room_hand(const render::xr::ControllerState& state) {
  return {state.is_tracked, state.grip.position, state.grip.orientation, state.select, state.grab, state.stick_x};
}

}  // namespace

struct HeadsetSession::Impl {
  std::mutex queue_lock;  // outlives the device
  std::unique_ptr<render::xr::Headset> headset;
  std::int64_t retry_ns = 0;    ///< earliest time of the next attempt
  std::int64_t started_ns = 0;  ///< start of the session
  std::string reported_loss;    ///< last reported loss
  std::int64_t reported_ns = 0;
  std::string broken;  ///< error in a frame; handled by follow()
  bool waits = false;  ///< waiting for a frame that the runtime delays longer than kPatience
  bool told_waits = false, waits_news = false;
  int unseen = 0;     ///< consecutive frames whose views cannot be rendered
  bool left = false;  ///< the user has ended the session through the runtime
  std::optional<Placement> placement;
  std::int64_t placed_ns = 0;  ///< time of placement, from which the probe position matches the image
  XrControllers hands;
  render::XrFramePacing pace;
  int pictures = 0;            ///< number of frames shown
  XrTime last_time = 0;        ///< time of the last frame; 0: no frame so far
  std::optional<Vec3> gaze;    ///< gaze direction at display time, in tracking space; none: not known
  std::optional<Vec3> held_m;  ///< center of the controllers that grab the world; none: they do not
  DeviceRegistration desk;
  XrPanel panel;
  std::uint64_t starts = 0;  ///< number of sessions started: each has its own local space

  void lose(std::int64_t now_ns);
  Outcome take_hands(const render::xr::Frame& frame, HapticSession& hand);
  void show_scale(render::FramePacket& packet) const;
  Outcome take_desk(const render::xr::Frame& frame, HapticSession& hand, const std::array<XrHand, 2>& now);
  void stop();
};

/// Stops the session and releases everything that depends on it.
void HeadsetSession::Impl::stop() {
  if (headset && headset->is_started()) headset->session().stop_wait();  // before anything that it uses is destroyed
  panel.release();
  if (headset) headset->stop();
}

HeadsetSession::HeadsetSession(std::unique_ptr<Impl> parts) : impl_(std::move(parts)) {}
HeadsetSession::~HeadsetSession() = default;

Result<std::unique_ptr<HeadsetSession>> HeadsetSession::open() {
  auto parts = std::make_unique<Impl>();
  CATENA_TRY(parts->headset, render::xr::Headset::open());
  return std::unique_ptr<HeadsetSession>(new HeadsetSession(std::move(parts)));
}

void HeadsetSession::configure(Presenter::Options& options) {
  options.vulkan_maker = [this] {
    return impl_->headset ? impl_->headset->vulkan_provider(impl_->queue_lock) : render::vk::VulkanProvider{};
  };
  options.before_device_created = [this] { impl_->stop(); };
}

/// Handles a loss: retries, at once if the session had run for some time; a lost runtime instance is released as well.
void HeadsetSession::Impl::lose(std::int64_t now_ns) {
  const auto wait_ns = std::int64_t(1e9 * kRetryIntervalS);
  last_time = 0;
  pace.pause();
  retry_ns = now_ns - started_ns < wait_ns ? now_ns + wait_ns : now_ns;
  stop();
  if (headset && headset->loss() == render::xr::Loss::instance) headset.reset();
}

Outcome HeadsetSession::poll(Presenter& screen, std::int64_t now_ns, const std::function<void(const std::string&)>& report_message) {
  Impl& p = *impl_;
  if (p.left) return Done{};
  const auto lose = [&](const std::string& why) {
    if (p.reported_loss != why || now_ns - p.reported_ns > kRepeatNs) {
      report_message(why);
      p.reported_loss = why;
      p.reported_ns = now_ns;
    }
    p.lose(now_ns);
  };
  if (!p.broken.empty()) lose(std::exchange(p.broken, {}));
  if (!p.headset) {
    if (now_ns < p.retry_ns) return Done{};
    p.retry_ns = now_ns + std::int64_t(1e9 * kRetryIntervalS);
    auto opened = render::xr::Headset::open();
    if (!opened) return Done{};
    p.headset = std::move(*opened);
    // uses the device created by the new runtime; if that fails, the window creates its own
    if (const Outcome made = screen.recreate(); !made) {
      p.headset.reset();
      CATENA_CHECK(screen.recreate());
      lose("the headset's runtime restarted without a graphics device: " + made.error().message);
      return Done{};
    }
  }
  if (!p.headset->is_started()) {
    if (now_ns < p.retry_ns) return Done{};
    p.started_ns = now_ns;
    if (const Outcome started = p.headset->start(screen.renderer().device()); !started) {
      lose(started.error().message);
      return Done{};
    }
    ++p.starts;
  }
  if (const Outcome polled = p.headset->poll(); !polled) {
    lose(polled.error().message);
    return Done{};
  }
  if (std::exchange(p.waits_news, false)) report_message("the headset's runtime delays its images; the window continues");
  if (p.unseen == kUnseen) {
    ++p.unseen;
    report_message("the headset reports no usable pose or field of view of its eyes; its images are not rendered");
  }
  if (const std::string message = p.pace.take_message(); !message.empty()) report_message(message);
  if (p.headset->session().has_exited()) {
    p.left = true;
    p.stop();
    report_message("the headset's runtime ended the session");
  }
  return Done{};
}

bool HeadsetSession::is_running() const { return impl_->headset && impl_->headset->is_running(); }

void HeadsetSession::update_panel(Presenter& screen) {
  Impl& p = *impl_;
  if (!p.headset || !p.headset->is_started()) return;
  if (const Outcome shown = p.panel.show(*p.headset, screen); !shown) p.broken = shown.error().message;
}

std::optional<xr_interaction::PanelPointer::Mouse> HeadsetSession::take_panel_mouse() { return impl_->panel.take_mouse(); }

/// Updates the registration of a desktop device, if one drives the probe.
Outcome HeadsetSession::Impl::take_desk(const render::xr::Frame& frame, HapticSession& hand, const std::array<XrHand, 2>& now) {
  if (!frame.should_render || hand.is_mouse() || hand.controller()) return Done{};
  render::xr::Session& session = headset->session();
  StageSpace space;
  space.recenter_count = (starts << 32) + session.recenter_count();
  if (const XrSpace stage = session.space(render::xr::SpaceKind::stage)) {
    CATENA_TRY(const std::optional<render::xr::XrPose> found, session.locate(stage, frame.display_time, "locate its room"));
    if (!found) return Done{};
    space = {found->position, found->orientation, true, space.recenter_count};
  }
  desk.step(1e-9 * double(frame.display_time), hand, now, space);
  return Done{};
}

/// Applies the controllers to the world and to the probe, and their haptic output. Recorded poses are those at display time.
Outcome HeadsetSession::Impl::take_hands(const render::xr::Frame& frame, HapticSession& hand) {
  using haptics::log::TrackedPart;
  render::xr::Actions& actions = headset->actions();
  CATENA_CHECK(actions.sync());
  const render::xr::XrHeadPose head = render::xr::head_pose(frame);
  haptics::log::LogPoses poses;
  poses.predicted_ns = frame.display_time;
  if (frame.should_render) poses[TrackedPart::head] = {head.position, head.orientation};
  std::array<render::xr::ControllerState, render::xr::kControllers> states;
  std::array<XrHand, 2> hands_then;
  for (std::size_t k = 0; k < hands_then.size(); ++k) {
    CATENA_TRY(states[k], actions.controller(k, frame.display_time));
    hands_then[k] = room_hand(states[k]);
    if (states[k].is_tracked)
      poses[k == 0 ? TrackedPart::left_hand : TrackedPart::right_hand] = {states[k].grip.position, states[k].grip.orientation};
  }
  panel.update(states, head, desk);
  CATENA_TRY(const auto eyes, actions.gaze(frame.display_time));
  gaze.reset();
  if (eyes) {
    poses[TrackedPart::gaze] = {eyes->position, eyes->orientation};
    gaze = rotate(eyes->orientation, Vec3(0.0, 0.0, -1.0));
  }
  hand.record_poses(poses);
  const double dt_s = last_time == 0 ? 0 : std::clamp(1e-9 * (double(frame.display_time) - double(last_time)), 0.0, kMaxStepS);
  last_time = frame.display_time;
  if (placement) hands.update(hands_then, head.position, dt_s, *placement);
  held_m = hands.grab_center(hands_then);

  CATENA_CHECK(take_desk(frame, hand, hands_then));

  // the probe is at the controller's present position
  haptics::TrackedController* controller = hand.controller();
  if (!controller) return Done{};
  const std::int64_t now = now_ns();
  const auto at = render::xr::to_xr_time(headset->instance(), now);
  XrHand probe = hands_then[XrControllers::kProbeHand];
  if (at) {
    CATENA_TRY(const render::xr::ControllerState state, actions.controller(XrControllers::kProbeHand, *at));
    probe = room_hand(state);
  }
  if (panel.captures_pointer()) probe.select = 0;  // the trigger acts on the panel
  controller->push_pose(hands.make_controller_pose(probe, now));
  const bool settled = placement && now - placed_ns > kSettlesNs;
  const auto call = hands.next_vibration(controller->peaks(), now, settled && headset->session().is_focused(), probe);
  using What = haptics::VibrationSender::Action;
  if (call.action == What::stop) return actions.stop_vibration(XrControllers::kProbeHand);
  if (call.action == What::nothing) return Done{};
  return actions.vibrate(XrControllers::kProbeHand, call.vibration.amplitude, call.vibration.frequency_hz, call.vibration.duration_ns);
}

/// Shows the scale of the world above the controllers that change it.
void HeadsetSession::Impl::show_scale(render::FramePacket& packet) const {
  if (!held_m || !placement) return;
  render::LabelItem label;
  label.position = placement->to_world(*held_m + Vec3(0.0, kAboveHandM, 0.0));
  label.text = xr_interaction::format_scale(placement->meters_per_unit);
  label.anchor = render::Anchor::bottom;
  label.offset_pt = {0.0, 0.0};
  label.size_pt = std::max(12.0, kWordsAt_px * headset->instance().view_sizes().front().height) / packet.overlay.scale;
  packet.overlay.labels.push_back(std::move(label));
}

Result<bool> HeadsetSession::draw(Presenter& screen, HapticSession& hand, const FrameCallbacks& content) {
  Impl& p = *impl_;
  const auto broken = [&](const std::string& why) {
    p.broken = why;  // handled by follow()
    return false;
  };
  // a runtime that delays the frame must not delay the window
  auto begun = p.headset->begin_within(p.waits ? kTurn : kPatience);
  if (!begun) return broken(begun.error().message);
  std::optional<render::xr::Frame>& frame = *begun;
  if (!frame) {
    if (!std::exchange(p.told_waits, true)) p.waits_news = true;
    p.waits = true;
    p.pace.pause();
    return false;
  }
  p.waits = false;
  if (const Outcome taken = p.take_hands(*frame, hand); !taken) {
    (void)p.headset->skip(*frame);
    return broken(taken.error().message);
  }
  p.unseen = frame->is_valid ? 0 : p.unseen + 1;
  if (!frame->should_render) {
    p.pace.pause();
    const Outcome ended = p.headset->skip(*frame);
    return ended ? false : broken(ended.error().message);
  }
  auto packet = content.make_packet();
  if (!packet) {
    (void)p.headset->skip(*frame);
    return packet.error();
  }
  if (!p.placement) {
    p.placement = before(render::xr::head_pose(*frame), packet->view);
    p.placed_ns = now_ns();
  }
  packet->vignette = p.hands.vignette_strength();
  p.show_scale(*packet);
  render::FramePlan plan = p.pace.next(1e-6 * double(frame->display_period_ns), frame->display_time);
  if (plan.settings.fast) plan.settings.fast->fovea_tangent = kFovea;
  const std::int64_t start = now_ns();
  if (content.late_latch) content.late_latch(*packet);
  const Outcome shown =
      p.headset->show(*frame, screen.renderer(), *packet, plan.settings, *p.placement, 1.0 / plan.pixel_scale, content.apply_view, p.gaze);
  if (shown) {
    p.pace.record_render_ms(ms_since(start));
    p.pace.set_level_options(content.classify_rays(*packet));
    screen.mark_rendered();
    ++p.pictures;
    return true;
  }
  if (screen.renderer().device().is_lost()) {
    CATENA_CHECK(screen.recreate());
    return false;
  }
  if (p.headset->loss() == render::xr::Loss::none) return shown.error();
  return broken(shown.error().message);
}

bool HeadsetSession::is_grabbing_world() const { return impl_->hands.is_grabbing_world(); }
DeviceRegistration* HeadsetSession::device_registration() { return &impl_->desk; }

std::optional<scene::Workspace> HeadsetSession::probe_workspace(const HapticSession& hand) const {
  const std::optional<Placement>& placed = impl_->placement;
  if (!placed) return std::nullopt;
  if (!hand.controller()) return impl_->desk.workspace(hand, *placed);
  return scene::Workspace{placed->meters_per_unit, placed->world_origin, placed->world_from_room, true};
}

std::string HeadsetSession::summary_text() const {
  const Impl& p = *impl_;
  return fmt::format("headset: {} images, {} late after the first {}, {} at half rate", p.pictures, p.pace.late_after_warmup(),
                     render::XrFramePacing::kWarmupFrames, p.pace.half_rate_frames());
}

void HeadsetSession::request_exit() {
  Impl& p = *impl_;
  if (is_running()) (void)p.headset->session().request_exit();
  for (int i = 0; i < kFarewellTurns && is_running(); ++i) {
    if (!p.headset->poll() || !is_running()) break;
    const auto frame = p.headset->begin_within(kTurn);
    if (!frame || (*frame && !p.headset->skip(**frame))) break;
  }
  p.stop();  // stop in any state: the device is destroyed next
}

std::string HeadsetSession::status_text() const {
  const Impl& p = *impl_;
  const std::string state = p.headset && p.headset->is_started() ? render::xr::state_name(p.headset->session().state()) : "lost";
  return "headset " + state + (p.placement ? ", " + xr_interaction::format_scale(p.placement->meters_per_unit) : "");
}

#else

struct HeadsetSession::Impl {};
HeadsetSession::HeadsetSession(std::unique_ptr<Impl> parts) : impl_(std::move(parts)) {}
HeadsetSession::~HeadsetSession() = default;
Result<std::unique_ptr<HeadsetSession>> HeadsetSession::open() {
  return Error{"no headset: this program was built without OpenXR; the package libopenxr-dev was expected at build time"};
}
void HeadsetSession::configure(Presenter::Options&) {}
Outcome HeadsetSession::poll(Presenter&, std::int64_t, const std::function<void(const std::string&)>&) { return Done{}; }
bool HeadsetSession::is_running() const { return false; }
Result<bool> HeadsetSession::draw(Presenter&, HapticSession&, const FrameCallbacks&) { return false; }
void HeadsetSession::request_exit() {}
std::string HeadsetSession::status_text() const { return "no headset"; }
std::string HeadsetSession::summary_text() const { return status_text(); }
bool HeadsetSession::is_grabbing_world() const { return false; }
DeviceRegistration* HeadsetSession::device_registration() { return nullptr; }
std::optional<scene::Workspace> HeadsetSession::probe_workspace(const HapticSession&) const { return std::nullopt; }
void HeadsetSession::update_panel(Presenter&) {}
std::optional<xr_interaction::PanelPointer::Mouse> HeadsetSession::take_panel_mouse() { return std::nullopt; }

#endif

}  // namespace catena::app
