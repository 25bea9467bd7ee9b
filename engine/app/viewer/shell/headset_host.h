/// The headset beside the window, for `catena view --xr`: it draws both eyes, the window mirrors the first one. What is lost is said once,
/// the window goes on, and the headset is tried again: its session after kRetryS, its runtime (which may be gone for a while) with a new
/// graphics device. Nothing here is OpenXR's own (render/xr is); without it, open() is one sentence. Frame thread.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/app/viewer/shell/screen.h"
#include "render/stereo/placement.h"

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
  /// Changes the packet for a view: what follows from where the eye is.
  using Aim = std::function<void(const render::View& view, render::FramePacket& packet)>;
  /// A frame, of `share` of the pixels each way. True: the screen's picture is the first eye's. False: nobody sees anything now, or the
  /// headset is lost. Errors: what a window's picture would fail with, too.
  Result<bool> draw(Screen& screen, render::FramePacket& packet, const render::RenderSettings& settings, double share, const Aim& aim);
  /// Asks the runtime to end the session, and gives it a moment for that.
  void leave();

  /// "headset focused, 1 unit = 0.23 m", for the title.
  std::string words() const;
  /// Where the world stands; none: not placed yet.
  std::optional<render::Placement> placement;

 private:
  struct Parts;
  explicit HeadsetHost(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace catena::app
