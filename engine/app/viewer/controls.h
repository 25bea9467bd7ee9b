/// What mouse and keys do, apart from any window: plain input in, a new view and a new place of the hand out.
///   orbit: left drag     pan: middle drag, or shift and left drag     zoom: wheel
///   hand:  right drag, or control held, or hand mode (H): motion on the plane through the probe parallel to the picture,
///          wheel for depth; in hand mode the left button (anywhere the space bar) is the device's button 1
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/frame/camera.h"

namespace catena::app {

/// What a key asks of the program as a whole.
enum class Command { undo, redo, open, save, save_as, quit, screenshot, window_screenshot, full_screen, toggle_panels, turntable, fly };

/// A piece of input under one set of held buttons. Window coordinates (y down); differences since the last piece.
struct Input {
  double width = 1, height = 1;  ///< of the window
  double x = 0, y = 0;           ///< of the pointer where the piece begins
  double dx = 0, dy = 0, wheel = 0;
  bool left = false, middle = false, right = false;  ///< held
  bool shift = false, control = false, space = false;
  bool toggle_hand = false, toggle_forces = false, reset_view = false, next_stereo = false, help = false,
       quit = false;  ///< pressed in this piece
  bool fit = false, toggle_projection = false, toggle_pulses = false;
  std::optional<int> axis;  ///< 0, 1, 2: look along x, y, z; with shift the other way
  bool damaged = false;     ///< the window system lost the picture
  std::vector<Command> commands{};
  std::vector<std::string> dropped{};  ///< files
};

struct Controls {
  render::View view, home;  ///< home: what R goes back to
  render::Bounds bounds;    ///< of all that is drawn; empty: nothing can be fitted
  Vec3 hand{0.0};           ///< world units
  std::uint32_t buttons = 0;
  bool hand_mode = false;
};

/// What an input changed.
struct Changed {
  bool view = false, hand = false;
  bool any() const { return view || hand; }
};

Changed apply(Controls& controls, const Input& input);

/// Turns the eye about the target: `yaw` about the view's up, `pitch` (radians, upwards) short of the poles.
void orbit(render::View& view, double yaw, double pitch);
/// The eye's distance (orthographic: the picture's height) times `factor`.
void zoom(render::View& view, double factor);

/// Between perspective and orthographic, with the same size of things in the target's plane.
void toggle_projection(render::View& view);

/// The keys, for the terminal.
std::string_view key_help();

}  // namespace catena::app
