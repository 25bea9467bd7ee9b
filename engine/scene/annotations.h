/// What a scene writes and draws over its picture: plain data, read by read_annotations.cpp, laid out by the eye.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/scene/components.h"

namespace catena::scene {

enum class PictureSide { right, left, bottom, top };
enum class PictureCorner { bottom_left, bottom_right, top_left, top_right };

/// The colours of a volume or of a coloured streamline set, with their values.
struct ScalarBar {
  Entity shown;  ///< owns a Volume, a StreamlineSet with colours, ...
  json::Node where;
  std::optional<std::string> title;  ///< none: the name of what is shown
  PictureSide side = PictureSide::right;
  int ticks = 5;       ///< about so many
  std::string format;  ///< of the values, "%.2f"; empty: as few digits as the ticks need
};

struct Label {
  Vec3 at{0.0};
  std::string text;
  std::optional<Color> color;
  double size_pt = 12;
  bool dot = true;
  bool hidden_behind = false;  ///< left out where an opaque surface stands before it
};

struct OrientationMarker {
  PictureCorner corner = PictureCorner::bottom_left;
  double size_pt = 84;
  std::array<std::string, 3> names{"X", "Y", "Z"};
};

struct Annotations {
  std::vector<ScalarBar> scalar_bars;
  std::vector<Label> labels;
  std::string title;
  std::optional<OrientationMarker> orientation_marker;
  bool status = false;
  // of all text
  std::string font = "DejaVu Sans";
  double scale = 1;
  std::optional<Color> color;
};

/// A bar for the first thing in the scene that has colours; nothing where there is none.
std::optional<ScalarBar> first_scalar_bar(const World& world);

}  // namespace catena::scene
