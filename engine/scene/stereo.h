// SPDX-License-Identifier: MIT
/// Stereo rendering: modes (values of "stereo": {"mode"} and of `--stereo`), eyes and screens.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::scene {

/// Composition of the eyes' images, in the order of the mode names; a viewer steps through the modes in this order.
enum class StereoMode {
  mono,
  left,
  right,
  side_by_side,
  side_by_side_half,
  cross_eyed,
  top_bottom,
  top_bottom_half,
  anaglyph,
  anaglyph_gray,
  row_interlaced,
  column_interlaced,
  checkerboard
};
inline constexpr int kStereoModeCount = 13;  ///< Number of modes

/// Returns the name of a mode: "side-by-side" and so on.
CATENA_EXPORT std::string_view to_string(StereoMode mode);
/// Returns the mode of that name; nullopt: unknown.
CATENA_EXPORT std::optional<StereoMode> parse_stereo_mode(std::string_view word);
/// Returns all names, for messages: "mono, left, .. or checkerboard".
CATENA_EXPORT std::string stereo_mode_names();
/// Returns whether the mode requires exactly two views.
CATENA_EXPORT bool needs_two_views(StereoMode mode);

/// A flat screen that shows the scene behind it as a window does. World units.
struct DisplayScreen {
  std::string name;                                         ///< Name for the option --screen
  Vec3 lower_left{0.0}, lower_right{0.0}, upper_left{0.0};  ///< Corners, as seen by a viewer in front of the screen
};
inline constexpr std::size_t kMaxScreens = 64;  ///< Maximum number of screens; more are an error

/// Eyes of the image, and the screens through which they can look. Lengths in world units.
struct Stereo {
  StereoMode mode = StereoMode::mono;   ///< Composition of the eyes' images
  std::optional<double> separation;     ///< Distance of neighboring eyes; empty: a 30th of the zero-parallax distance
  std::optional<double> zero_parallax;  ///< Distance from the eyes at which their images agree; empty: that of the camera's target
  int view_count = 2;                   ///< Number of views; other than 2 only for modes that allow it
  bool swap_eyes = false;               ///< Exchanges the images of the left and right eye
  std::vector<DisplayScreen> screens;   ///< Screens that an image can be rendered for
  /// Index into `screens`; the camera's position is then the head between the eyes. Empty: no screen.
  std::optional<std::size_t> screen_index;
};
inline constexpr int kMaxStereoViews = 64;            ///< Maximum number of views; more are an error
inline constexpr double kMaxStereoSeparation = 1e15;  ///< Maximum eye separation, world units

}  // namespace catena::scene
