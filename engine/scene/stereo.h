/// What a stereo picture is made of: the words of "stereo": {"mode"} and of `--stereo`.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/vec.h"

namespace catena::scene {

/// In the order of the words; a viewer goes through them in this order.
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
inline constexpr int kStereoModeCount = 13;  ///< How many modes there are.

/// "side-by-side" and so on.
std::string_view to_string(StereoMode mode);
/// The mode of that word.
std::optional<StereoMode> parse_stereo_mode(std::string_view word);
/// "mono, left, .. or checkerboard"
std::string stereo_mode_names();
/// Whether the mode takes two eyes and no other number.
bool needs_two_views(StereoMode mode);

/// A flat display that shows what lies behind it as a window does. World units.
struct DisplayScreen {
  std::string name;                                         ///< what --screen calls it
  Vec3 lower_left{0.0}, lower_right{0.0}, upper_left{0.0};  ///< corners, as one sees them who stands before it
};
inline constexpr std::size_t kMaxScreens = 64;  ///< More are refused.

/// The eyes of the picture, and the screens that they may look through. Lengths in world units.
struct Stereo {
  StereoMode mode = StereoMode::mono;   ///< how the eyes' pictures make one
  std::optional<double> separation;     ///< of neighbouring eyes; none: a 30th of the zero-parallax distance
  std::optional<double> zero_parallax;  ///< distance from the eyes to where both see the same; none: to the camera's target
  int view_count = 2;                   ///< for the modes that take any number
  bool swap_eyes = false;               ///< the right eye's picture in the left eye's place
  std::vector<DisplayScreen> screens;   ///< screens that a picture may be of
  std::optional<std::size_t>
      screen_index;  ///< which of them the picture is of: the camera's position is the head, beside which the eyes are
};
inline constexpr int kMaxStereoViews = 64;            ///< More are refused.
inline constexpr double kMaxStereoSeparation = 1e15;  ///< world units

}  // namespace catena::scene
