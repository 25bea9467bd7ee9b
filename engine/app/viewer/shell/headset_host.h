/// The headset beside the window, for `catena view --xr`: it draws both eyes, the window mirrors the first one. What is lost is said once,
/// the window goes on, and the headset is tried again, at once and then every kRetryS: its session, or its runtime (which may be gone for a
/// while) with a new graphics device. Nothing here is OpenXR's own (render/xr is); without it, open() is one sentence. Frame thread.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/app/viewer/shell/desk_device.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/screen.h"
#include "engine/immersive/panel.h"
#include "render/quality/frame_pace.h"
#include "render/stereo/room_eye.h"

namespace catena::app {

class HeadsetHost {
 public:
  static constexpr double kRetryS = 1;

  static Result<std::unique_ptr<HeadsetHost>> open();
  ~HeadsetHost();
  HeadsetHost(const HeadsetHost&) = delete;
  HeadsetHost& operator=(const HeadsetHost&) = delete;

  /// For the screen's device: made by the headset's runtime while there is one. The screen lives shorter than this.
  void join(Screen::Options& options);

  /// What happened: states begin and end, what was lost is tried again. What is to be said goes to `say`.
  /// Errors: the graphics device cannot be made any more.
  Outcome follow(Screen& screen, std::int64_t now_ns, const std::function<void(const std::string&)>& say);
  /// Frames are made: draw() paces the loop.
  bool running() const;
  /// What a frame is made of.
  struct Content {
    std::function<Result<render::FramePacket>()> make;  ///< of the scene as it is now
    /// Just before it is drawn: the hand in it as it is by now (late latching; nothing else moves, both eyes see the same).
    std::function<void(render::FramePacket& packet)> latch;
    std::function<void(const render::View& view, render::FramePacket& packet)> aim;  ///< what follows from where the eye is
    std::function<render::LadderKind(const render::FramePacket& packet)> kind;       ///< what the rays have to do, once it was drawn
  };
  /// A frame: it is waited for, the hands are looked at, and both eyes are drawn as well as its time allows. True: the screen's picture is
  /// the first eye's. False: nobody sees anything now, or the headset is lost. Errors: what a window's picture would fail with, too.
  Result<bool> draw(Screen& screen, HandHost& hand, const Content& content);
  /// The menu button brings the window, panels and all, before the person, and sends it away again. After the window was shown: as it is
  /// now, on that panel.
  void show_panel(Screen& screen);
  /// The controller as a mouse on the panel, since the last call; pixels of the window. Nothing while it points elsewhere.
  std::optional<immersive::PanelPointer::Mouse> panel_mouse();
  /// Asks the runtime to end the session, and gives it a moment for that.
  void leave();

  /// "headset focused, 1 unit = 23 cm", for the title.
  std::string words() const;
  /// "headset: 880 pictures, 3 late after the first 30, 0 at half rate", for the last words.
  std::string figures() const;
  /// A hand has hold of the world, which moves with it.
  bool holds_world() const;
  /// The metres of what holds the probe, in the world as it stands in the room: of the controller, or of a device that is registered.
  std::optional<scene::Workspace> hand_workspace(const HandHost& hand) const;
  /// The registration of a device on the desk; null where there is no headset.
  DeskDevice* desk();

 private:
  struct Parts;
  explicit HeadsetHost(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace catena::app
