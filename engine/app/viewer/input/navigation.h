// SPDX-License-Identifier: MIT
/// Navigation with mouse and keys, independent of the window: plain input is converted to a new view and a new probe position.
///   orbit: left drag     pan: middle drag, or shift and left drag     zoom: wheel
///   probe: right drag, or control held: motion in the plane through the probe parallel to the image, wheel for depth
///   probe mode (H): the probe is under the pointer, at the depth of the pointer hit, and the wheel pushes it further in
///          (Navigation::wheel_depth); the left button (in any mode the space bar) is the device's button 1, and while it is down the
///          depth stays. The wheel moves the probe less against the force (compliant_motion)
///   fly (V): left drag looks around, wheel changes the speed; the keys are FlyKeys (camera_motion.h)
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/input/keys.h"
#include "render/extract/plane_views.h"
#include "render/frame/camera.h"

namespace catena::app {

enum class Action : std::uint8_t;  // commands.h

/// An input segment: the key or button event it begins with, and the motion until the next such event. Coordinates of the window, or of the
/// image area in it (y down); differences since the last segment.
struct Input {
  double width = 1, height = 1;  ///< Size of the window, or of the area.
  double x = 0, y = 0;           ///< Position of the pointer at the beginning of the segment.
  double dx = 0, dy = 0, wheel = 0;
  bool left = false, middle = false, right = false;  ///< Buttons held down.
  bool shift = false, control = false, space = false;
  std::optional<KeyEvent> key_event;         ///< The event that begins the segment.
  bool needs_redraw = false;                 ///< The window system has lost the image.
  std::vector<std::string> dropped_files{};  ///< Paths.
};

/// Orthogonal views beside the 3D view.
struct OrthoViews : scene::OrthogonalViews {
  bool is_on = false;  ///< Requested by the user; shown if the scene has a scalar field, without stereo.
};

/// State of view and probe.
struct Navigation {
  render::View view, home;  ///< Current view, and the view that reset_view returns to.
  Bounds bounds;            ///< Bounds of everything visible, world units; empty: nothing can be fitted.
  Vec3 probe{0.0};          ///< World units.
  /// Buttons of the device, bit by bit.
  std::uint32_t buttons = 0;
  bool probe_mode = false;
  Vec3 force_n{0.0};       ///< Force on the user, world axes.
  double max_force_n = 0;  ///< Maximum force; 0: no resistance.
  // A mouse has no depth. In probe mode the depth is that of the pointer hit; where the chain holds the probe at another depth, or there is
  // no hit, it changes to that of the last proxy by the fraction (pixels moved) / kDepthBlendPixels; otherwise it stays.
  std::optional<Vec3> pointer_hit{};  ///< Point visible under the pointer at the end of the motion.
  std::optional<Vec3> last_proxy{};   ///< Proxy at which the chain holds the probe; nothing if it is not in contact.
  double wheel_depth = 0;             ///< Depth added by the wheel, along the view; world units.
  static constexpr double kDepthBlendPixels = 60;
  bool fly = false;
  double fly_speed = 1;    ///< Factor on kFlyDiagonalsPerS.
  bool turntable = false;  ///< The camera rotates by itself.
  OrthoViews ortho{};
};

/// The changes made by an input.
struct NavigationChanges {
  bool view = false, probe = false;
  bool any() const { return view || probe; }
};

/// Returns the camera of a view in an area of a window, in whose pixels its positions are. The area may be as small as it likes.
render::Camera make_area_camera(const render::View& view, double width, double height);
/// Applies an input segment and returns what changed.
NavigationChanges apply(Navigation& controls, const Input& input);
/// Starts probe mode: moves the probe to the pointer hit, if there is one.
void begin_probe_mode(Navigation& controls);
/// Applies a camera command for an image of width / height `aspect`; returns true if it changes the view. Other commands, and those that
/// need bounds when there are none, change nothing.
bool apply(Navigation& controls, Action action, double aspect);
/// Return whether an input or command stops the turntable.
bool stops_turntable(const Input& input);
bool stops_turntable(Action action);

/// Returns a motion of the probe reduced by the force: the part against the force is scaled down, to a quarter at the maximum force. Motion
/// along the surface and out of it is not reduced.
Vec3 compliant_motion(const Vec3& motion, const Vec3& force_n, double max_force_n);

/// Rotates the camera about the target: `yaw` about the view's up, `pitch` upwards, radians; stops short of the poles.
void orbit(render::View& view, double yaw, double pitch);
/// Scales the camera's distance (orthographic: the image height) by `factor`.
void zoom(render::View& view, double factor);

/// Toggles between perspective and orthographic, keeping the size of objects in the target's plane.
void toggle_projection(render::View& view);

}  // namespace catena::app
