// SPDX-License-Identifier: MIT
/// The headset session of `catena view --xr`: renders both eyes, while the window mirrors the first one. When the headset is lost, this is
/// reported once, the window continues, and the session is retried immediately and then every kRetryIntervalS: the session, or the runtime
/// (which may be gone for a while) with a new graphics device. Independent of OpenXR types (render/xr has those). Frame thread.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/window/presenter.h"
#include "engine/app/viewer/xr/device_registration.h"
#include "engine/app/viewer/xr/panel.h"
#include "render/quality/xr_frame_pacing.h"
#include "render/stereo/xr_views.h"

namespace catena::app {

/// Owns the connection to the headset, its controllers and panel.
class HeadsetSession {
 public:
  static constexpr double kRetryIntervalS = 1;

  /// Connects to the headset. An Error if there is none, or if the program was built without OpenXR.
  static Result<std::unique_ptr<HeadsetSession>> open();
  ~HeadsetSession();
  HeadsetSession(const HeadsetSession&) = delete;
  HeadsetSession& operator=(const HeadsetSession&) = delete;

  /// Sets the options so that the presenter's device is created by the headset's runtime while there is one. The presenter must be
  /// destroyed before this session.
  void configure(Presenter::Options& options);

  /// Call once per turn of the loop: handles session state changes and retries a lost headset. `report_message` receives the messages for
  /// the user. An Error if the graphics device cannot be recreated.
  Outcome poll(Presenter& screen, std::int64_t now_ns, const std::function<void(const std::string&)>& report_message);
  /// Returns whether the headset displays frames; then draw() paces the loop.
  bool is_running() const;
  /// Functions that supply the content of a frame.
  struct FrameCallbacks {
    std::function<Result<render::FramePacket>()> make_packet;  ///< Makes the packet of the scene in its current state.
    /// Updates the probe in the packet just before rendering (late latching); nothing else changes, and both eyes see the same.
    std::function<void(render::FramePacket& packet)> late_latch;
    std::function<void(const render::View& view, render::FramePacket& packet)> apply_view;  ///< Updates what depends on the view.
    /// Returns the ray casting methods the packet needs, once rendered.
    std::function<render::QualityLevelOptions(const render::FramePacket& packet)> classify_rays;
  };
  /// Waits for the next frame, processes the controllers, and renders both eyes at the quality that the time allows. Returns true if the
  /// presenter's image is then the first eye's; false if nothing is displayed or the headset is lost. An Error if a frame in the window
  /// would fail for the same reason.
  Result<bool> draw(Presenter& screen, HapticSession& hand, const FrameCallbacks& content);
  /// Updates the XR panel, which shows the window with its GUI; the menu button brings it in front of the user and dismisses it. Call after
  /// the window was shown.
  void update_panel(Presenter& screen);
  /// Returns the controller as a mouse on the panel since the last call, in pixels of the window; nothing if it points elsewhere.
  std::optional<xr_interaction::PanelPointer::Mouse> take_panel_mouse();
  /// Asks the runtime to end the session and waits briefly for it.
  void request_exit();

  /// Returns "headset focused, 1 unit = 23 cm", for the window title.
  std::string status_text() const;
  /// Returns "headset: 880 images, 3 late after the first 30, 0 at half rate", for the summary.
  std::string summary_text() const;
  /// Returns whether a controller is grabbing the world.
  bool is_grabbing_world() const;
  /// Returns the workspace that maps meters of the controller or the registered device to the world; nothing if it is not known.
  std::optional<scene::Workspace> probe_workspace(const HapticSession& hand) const;
  /// Returns the registration of a device on the desk; null in a build without OpenXR.
  DeviceRegistration* device_registration();

 private:
  struct Impl;
  explicit HeadsetSession(std::unique_ptr<Impl> parts);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::app
