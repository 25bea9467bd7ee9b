// SPDX-License-Identifier: MIT
/// Text and marks over the scene's image: plain data, read by read_annotations.cpp and laid out by render/extract.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/json.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// Side of the image on which a scalar bar is placed.
enum class ImageSide { right, left, bottom, top };
/// Corner of the image in which the orientation marker is placed.
enum class ImageCorner { bottom_left, bottom_right, top_left, top_right };

/// Color legend of one colored object, with its values.
struct ScalarBar {
  Entity target;                      ///< Entity whose colors are shown: the owner of a Volume, a StreamlineSet with color_by, ...
  json::Node where;                   ///< Node in the scene file
  std::optional<std::string> title;   ///< Empty: name of the quantity shown
  ImageSide side = ImageSide::right;  ///< Side of the image
  int ticks = 5;                      ///< Approximate number of ticks
  std::string format;                 ///< Printf format of the values, such as "%.2f"; empty: as few digits as the ticks need
};

/// Text at a point in the world.
struct Label {
  Vec3 position{0.0};               ///< Anchor point, world units
  std::string text;                 ///< UTF-8; '\n' ends a line
  std::optional<Color> color;       ///< Text color; empty: readable over the background
  double size_pt = 12;              ///< Text size in points of the image (kImagePoints, render/frame/overlay_items.h)
  bool show_dot = true;             ///< Draws a small dot at the anchor point
  bool hide_when_occluded = false;  ///< Omits the label if an opaque surface occludes the anchor point
};

/// The world's axes in the camera's orientation, in a corner of the image.
struct OrientationMarker {
  ImageCorner corner = ImageCorner::bottom_left;    ///< Corner of the image
  double size_pt = 84;                              ///< Edge of the marker's square, points of the image
  std::array<std::string, 3> names{"X", "Y", "Z"};  ///< Labels at the tips of the arrows
};

/// Text and marks that are drawn over the image.
struct Annotations {
  std::vector<ScalarBar> scalar_bars;                   ///< Color legends
  std::vector<Label> labels;                            ///< Texts at points in the world
  std::string title;                                    ///< Title at the top of the image; empty: none
  std::optional<OrientationMarker> orientation_marker;  ///< Empty: no marker
  bool show_status = false;                             ///< Writes the force and the status of every link
  // Members that apply to all text:
  std::string font = "DejaVu Sans";  ///< Font family; the nearest installed family is used
  double scale = 1;                  ///< Factor on all text sizes
  std::optional<Color> color;        ///< Color of text without its own color; empty: readable over the background
};

/// Returns a scalar bar for the first colored object of the scene; nullopt if there is none.
CATENA_EXPORT std::optional<ScalarBar> first_scalar_bar(const EntityStore& world);

}  // namespace catena::scene
