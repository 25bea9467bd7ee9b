/// What a scene writes and draws over its picture: plain data, read by read_annotations.cpp, laid out by the eye.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// Where a scalar bar stands.
enum class ImageSide { right, left, bottom, top };
/// Where the orientation marker stands.
enum class ImageCorner { bottom_left, bottom_right, top_left, top_right };

/// The colours of a volume or of a coloured streamline set, with their values.
struct ScalarBar {
  Entity target;                      ///< owns a Volume, a StreamlineSet with colours, ...
  json::Node where;                   ///< its place in the scene file, for messages
  std::optional<std::string> title;   ///< none: the name of what is shown
  ImageSide side = ImageSide::right;  ///< where it stands
  int ticks = 5;                      ///< about so many
  std::string format;                 ///< of the values, "%.2f"; empty: as few digits as the ticks need
};

/// Text at a place of the world.
struct Label {
  Vec3 position{0.0};               ///< world units
  std::string text;                 ///< UTF-8; '\n' ends a line
  std::optional<Color> color;       ///< none: readable over the background
  double size_pt = 12;              ///< points of a picture (kImagePoints, render/frame/overlay_items.h)
  bool show_dot = true;             ///< a small dot at the place
  bool hide_when_occluded = false;  ///< left out where an opaque surface stands before it
};

/// The world's axes as the camera sees them, in a corner.
struct OrientationMarker {
  ImageCorner corner = ImageCorner::bottom_left;    ///< which corner
  double size_pt = 84;                              ///< edge of its square, points
  std::array<std::string, 3> names{"X", "Y", "Z"};  ///< at the ends of the arrows
};

/// All that is written over the picture.
struct Annotations {
  std::vector<ScalarBar> scalar_bars;                   ///< bars of colours
  std::vector<Label> labels;                            ///< texts at places
  std::string title;                                    ///< at the top of the picture; empty: none
  std::optional<OrientationMarker> orientation_marker;  ///< none: not drawn
  bool show_status = false;                             ///< what is felt, in words
  // of all text
  std::string font = "DejaVu Sans";  ///< a family; the nearest that is installed is taken
  double scale = 1;                  ///< of all text
  std::optional<Color> color;        ///< of text that has none of its own
};

/// A bar for the first thing in the scene that has colours; nothing where there is none.
std::optional<ScalarBar> first_scalar_bar(const EntityStore& world);

}  // namespace catena::scene
