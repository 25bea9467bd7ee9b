// SPDX-License-Identifier: MIT
/// Items that are drawn over the finished image, as plain data.
///   points   lengths and text sizes are in points; the shorter side of an image has kImagePoints of them, so that images of 640 x 480 and
///            3840 x 2880 look alike; x to the right, y down
///   text     UTF-8, '\n' ends a line; without a color it is white or black, whichever is readable on the background
/// A packet whose overlay is empty has no overlay pass. Positions in the scene are in world units. Plain data, any thread.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/color.h"
#include "engine/base/vec.h"

namespace catena::render {

/// Position or offset in the image: x to the right, y down.
using Vec2 = glm::dvec2;

inline constexpr double kImagePoints = 576;  ///< Length of the shorter side of an image, points.

/// Anchor point of a box: of the image or of a block of text.
enum class Anchor { top_left, top, top_right, left, center, right, bottom_left, bottom, bottom_right };

/// Text at a position in the image: the anchor point of the text's box lies at the anchor point of the image, moved by `offset_pt`.
struct TextItem {
  std::string text;                  ///< UTF-8
  Anchor anchor = Anchor::top_left;  ///< anchor point of both the image and the text's box
  Vec2 offset_pt{0.0};               ///< offset, points
  double size_pt = 12;               ///< font size, points
  bool bold = false;                 ///< bold font
  std::optional<Color> color{};      ///< nullopt: white or black, readable on the background
};

/// Text at a world position: the anchor point of the text's box lies at the projection of `position`, moved by `offset_pt`. Not drawn where
/// `position` is behind the camera.
struct LabelItem {
  Vec3 position{0.0};             ///< world units
  std::string text;               ///< UTF-8
  Anchor anchor = Anchor::left;   ///< anchor point of the text's box
  Vec2 offset_pt{4.0, 0.0};       ///< offset, points
  double size_pt = 12;            ///< font size, points
  std::optional<Color> color{};   ///< nullopt: white or black, readable on the background
  bool show_dot = false;          ///< small dot at the position itself
  bool hide_if_occluded = false;  ///< not drawn where an opaque surface lies in front of `position`
};

/// Side of the image.
enum class Side { right, left, bottom, top };

/// Tick of a scalar bar.
struct BarTick {
  double value = 0;  ///< value, in the field's unit
  std::string text;  ///< text beside the tick
};

/// Scalar bar: the colors of a color map over its values, with ticks and a title. Bars on the same side are placed side by side.
struct ScalarBarItem {
  std::vector<std::array<double, 4>> colors;  ///< value, r, g, b: piecewise linear, values rising; a single row: one color
  std::vector<BarTick> ticks;                 ///< values rising
  std::string title;                          ///< title, usually the field's name
  std::string factor;                         ///< factor of the tick values, for instance "x 10^-5"
  double linear_below = 0;  ///< linear threshold of the symlog scale along the bar (engine/base/symlog_scale.h); 0: linear
  Side side = Side::right;  ///< side of the image
  int band_count = 0;  ///< > 0: vertical legend of labels with this many bands of one color; values count the bands from below. 0: a bar
  std::string overflow_text;  ///< text below a legend, for instance "and 96 more"
};

/// Orientation marker: the world axes as seen by the camera, as arrows in red, green and blue with their letters.
struct OrientationMarkerItem {
  Anchor anchor = Anchor::bottom_left;              ///< corner of the image
  double size_pt = 84;                              ///< side of the square that contains the marker
  std::array<std::string, 3> names{"X", "Y", "Z"};  ///< labels at the tips of the arrows
};

/// Haptic status: the force as a number and as a bar of its fraction of the maximum, and one line for every link.
struct StatusItem {
  /// Line for one link.
  struct Row {
    std::string name, status_text;  ///< for instance "curve" and "OK"
    bool is_active = true;          ///< the link is active
  };
  double force_n = 0, max_force_n = 0;  ///< newtons; no bar if the maximum is 0
  std::vector<Row> rows;                ///< in the order of the chain
  Anchor anchor = Anchor::top_left;     ///< corner of the image
};

/// Position of the packet's image within the larger image of which it is a tile, pixels. Width 0: not a tile.
struct OverlayFrame {
  double x = 0, y = 0, width = 0, height = 0;  ///< upper left corner of this tile; size of the larger image
};

/// All items that are drawn over an image.
struct Overlay {
  std::vector<TextItem> texts;                              ///< texts at image positions
  std::vector<LabelItem> labels;                            ///< texts at world positions
  std::vector<LabelItem> axis_labels;                       ///< labels of the axes, which depend on the view
  std::vector<ScalarBarItem> scalar_bars;                   ///< scalar bars and legends
  std::optional<OrientationMarkerItem> orientation_marker;  ///< nullopt: none
  std::optional<StatusItem> status;                         ///< nullopt: none
  std::string font = "DejaVu Sans";                         ///< font family; if it is not installed, the nearest match is used
  double scale = 1;                                         ///< factor that scales all sizes
  std::optional<Color> color{};  ///< color of all texts without a color of their own; nullopt: readable on the background
  OverlayFrame frame{};          ///< position of this image if it is a tile

  /// Returns whether there are no items.
  bool empty() const {
    return texts.empty() && labels.empty() && axis_labels.empty() && scalar_bars.empty() && !orientation_marker && !status;
  }
};

/// User interface over a window's image, in pixels of the window: textured triangles as generated by an immediate-mode user interface
/// library. Plain data; the rendered image itself does not change.
struct UiVertex {
  float x = 0, y = 0;      ///< pixels from the window's upper left corner
  float u = 0, v = 0;      ///< 0..1
  std::uint32_t rgba = 0;  ///< 8 bits each, r lowest; straight alpha, display values
};

/// Texture, identified by its address: the same object is uploaded once.
struct UiTexture {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgba;       ///< straight alpha, rows from the top
};

/// One draw call of the user interface.
struct UiDraw {
  std::shared_ptr<const UiTexture> texture;                          ///< texture of the triangles; null: plain white
  std::array<float, 4> clip{};                                       ///< clip rectangle x0, y0, x1, y1, pixels
  std::uint32_t first_index = 0, index_count = 0, first_vertex = 0;  ///< range in UiItems::indices; vertex to which index 0 refers
};

/// User interface of one frame.
struct UiItems {
  std::vector<UiVertex> vertices;      ///< vertices of all draws
  std::vector<std::uint16_t> indices;  ///< three per triangle, relative to UiDraw::first_vertex
  std::vector<UiDraw> draws;           ///< in drawing order
  /// Area of the window that shows the image (x0, y0, x1, y1, pixels), black around it; nullopt, or an area that does not overlap the
  /// window: the whole window.
  std::optional<std::array<std::uint32_t, 4>> image_area{};
};

}  // namespace catena::render
