/// Navigation say what mouse and keys do, apart from any window: plain input goes in, a new view and a new place of the hand come out.
///   orbit: left drag     pan: middle drag, or shift and left drag     zoom: wheel
///   hand:  right drag, or control held: motion on the plane through the probe parallel to the picture, wheel for depth
///   hand mode (H): the hand is under the pointer, as deep as what is seen there, and the wheel pushes it in from there (Navigation::push);
///          the left button (anywhere the space bar) is the device's button 1, and while it is down the depth stays
///   In hand mode the mouse pushes harder the harder it is held back: the wheel against the force moves the hand less (yielding).
///   fly (V): left drag looks about, wheel changes the pace; the keys are camera_paths.h's
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/input/keys.h"
#include "render/frame/camera.h"

namespace catena::app {

enum class Action : std::uint8_t;  // commands.h

/// A piece of input: what begins it, a stroke or a button, and the motion until the next such thing. Coordinates of the window, or of the
/// picture's area in it (y down); differences since the last piece.
struct Input {
  double width = 1, height = 1;  ///< of the window, or the area
  double x = 0, y = 0;           ///< of the pointer where the piece begins
  double dx = 0, dy = 0, wheel = 0;
  bool left = false, middle = false, right = false;  ///< held
  bool shift = false, control = false, space = false;
  std::optional<KeyEvent> key_event;         ///< with which the piece begins
  bool needs_redraw = false;                 ///< the window system lost the picture
  std::vector<std::string> dropped_files{};  ///< files
};

struct Navigation {
  render::View view, home;  ///< home: what R goes back to
  Bounds bounds;            ///< of all that is drawn; empty: nothing can be fitted
  Vec3 probe{0.0};          ///< world units
  std::uint32_t buttons = 0;
  bool probe_mode = false;
  Vec3 force_n{0.0};       ///< on the hand, world axes
  double max_force_n = 0;  ///< 0: the mouse yields to nothing
  // A mouse says nothing of depth. In hand mode it is that of what lies under the pointer; where the chain holds the hand elsewhere in
  // depth, or nothing is there, it goes over to the held place's, by the share (pixels moved) / kDepthBlendPixels; else it stays.
  std::optional<Vec3> pointer_hit{};  ///< the place that is seen under the pointer at the end of the motion
  std::optional<Vec3> last_proxy{};   ///< where the chain holds the hand
  double wheel_depth = 0;             ///< of the wheel, along the view, beyond that depth; world units
  static constexpr double kDepthBlendPixels = 60;
  bool fly = false;
  double fly_speed = 1;    ///< times kFlyDiagonalsPerS
  bool turntable = false;  ///< the eye turns by itself
};

/// What an input changed.
struct NavigationChanges {
  bool view = false, probe = false;
  bool any() const { return view || probe; }
};

NavigationChanges apply(Navigation& controls, const Input& input);
/// Hand mode begins: the hand goes onto what is under the pointer, if that is known.
void begin_probe_mode(Navigation& controls);
/// What a command of the eye makes of the view, in a picture of that width / height; true: the view is another. Those of all other
/// commands, and those that need something to look at where there is nothing, change nothing.
bool apply(Navigation& controls, Action action, double aspect);
/// Whoever takes hold of the view ends the turntable.
bool stops_turntable(const Input& input);
bool stops_turntable(Action action);

/// What is left of a motion of the hand in hand mode: the part against the force counts less, down to a quarter at the greatest force. Out
/// of the thing that pushes, and along it, the hand goes with the mouse.
Vec3 compliant_motion(const Vec3& motion, const Vec3& force_n, double max_force_n);

/// Turns the eye about the target: `yaw` about the view's up, `pitch` (radians, upwards) short of the poles.
void orbit(render::View& view, double yaw, double pitch);
/// The eye's distance (orthographic: the picture's height) times `factor`.
void zoom(render::View& view, double factor);

/// Between perspective and orthographic, with the same size of things in the target's plane.
void toggle_projection(render::View& view);

}  // namespace catena::app
