/// The headset beside the window, for `catena view --xr`: it draws both eyes, the window mirrors the first one. What is lost is said once,
/// the window goes on, and the headset is tried again, at once and then every kRetryIntervalS: its session, or its runtime (which may be
/// gone for a while) with a new graphics device. Nothing here is OpenXR's own (render/xr is); without it, open() is one sentence. Frame
/// thread.
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

class HeadsetSession {
 public:
  static constexpr double kRetryIntervalS = 1;

  static Result<std::unique_ptr<HeadsetSession>> open();
  ~HeadsetSession();
  HeadsetSession(const HeadsetSession&) = delete;
  HeadsetSession& operator=(const HeadsetSession&) = delete;

  /// For the screen's device: made by the headset's runtime while there is one. The screen lives shorter than this.
  void configure(Presenter::Options& options);

  /// What happened: states begin and end, what was lost is tried again. What is to be said goes to `say`.
  /// Errors: the graphics device cannot be made any more.
  Outcome poll(Presenter& screen, std::int64_t now_ns, const std::function<void(const std::string&)>& say);
  /// Frames are made: draw() paces the loop.
  bool is_running() const;
  /// What a frame is made of.
  struct FrameCallbacks {
    std::function<Result<render::FramePacket>()> make_packet;  ///< of the scene as it is now
    /// Just before it is drawn: the hand in it as it is by now (late latching; nothing else moves, both eyes see the same).
    std::function<void(render::FramePacket& packet)> late_latch;
    std::function<void(const render::View& view, render::FramePacket& packet)> apply_view;  ///< what follows from where the eye is
    std::function<render::QualityLevelOptions(const render::FramePacket& packet)>
        classify_rays;  ///< what the rays have to do, once it was drawn
  };
  /// A frame: it is waited for, the hands are looked at, and both eyes are drawn as well as its time allows. True: the screen's picture is
  /// the first eye's. False: nobody sees anything now, or the headset is lost. Errors: what a window's picture would fail with, too.
  Result<bool> draw(Presenter& screen, HapticSession& hand, const FrameCallbacks& content);
  /// The menu button brings the window, panels and all, before the person, and sends it away again. After the window was shown: as it is
  /// now, on that panel.
  void update_panel(Presenter& screen);
  /// The controller as a mouse on the panel, since the last call; pixels of the window. Nothing while it points elsewhere.
  std::optional<xr_interaction::PanelPointer::Mouse> take_panel_mouse();
  /// Asks the runtime to end the session, and gives it a moment for that.
  void request_exit();

  /// "headset focused, 1 unit = 23 cm", for the title.
  std::string status_text() const;
  /// "headset: 880 pictures, 3 late after the first 30, 0 at half rate", for the last words.
  std::string summary_text() const;
  /// A hand has hold of the world, which moves with it.
  bool is_grabbing_world() const;
  /// The metres of what holds the probe, in the world as it stands in the room: of the controller, or of a device that is registered.
  std::optional<scene::Workspace> probe_workspace(const HapticSession& hand) const;
  /// The registration of a device on the desk; null where there is no headset.
  DeviceRegistration* device_registration();

 private:
  struct Impl;
  explicit HeadsetSession(std::unique_ptr<Impl> parts);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::app
