/// What is written and drawn over the finished picture, as plain data.
///   points   lengths and text sizes are in points of a picture whose shorter side has kImagePoints of them, so that a picture of
///            640 x 480 and one of 3840 x 2880 look alike; x to the right, y down
///   text     UTF-8, '\n' ends a line; without a colour it is white or black, whichever the background leaves readable
/// A packet whose overlay is empty has no overlay pass. World units elsewhere. Plain data, any thread.
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

/// Two doubles: x to the right, y down.
using Vec2 = glm::dvec2;

inline constexpr double kImagePoints = 576;  ///< Points of a picture's shorter side.

/// A point of a box: of the picture, of a block of text.
enum class Anchor { top_left, top, top_right, left, center, right, bottom_left, bottom, bottom_right };

/// Text at a place of the picture: the text's own anchor point lies on the picture's, moved by `offset_pt`.
struct TextItem {
  std::string text;                  ///< UTF-8
  Anchor anchor = Anchor::top_left;  ///< of the picture and of the text
  Vec2 offset_pt{0.0};               ///< points
  double size_pt = 12;               ///< height of the letters, points
  bool bold = false;                 ///< heavier letters
  std::optional<Color> color{};      ///< none: readable over the background
};

/// Text at a point of the world: the anchor point of the text's box lies where `at` projects to, moved by `offset_pt`. Not drawn
/// where `at` is behind the eye.
struct LabelItem {
  Vec3 position{0.0};             ///< world units
  std::string text;               ///< UTF-8
  Anchor anchor = Anchor::left;   ///< of the text's box
  Vec2 offset_pt{4.0, 0.0};       ///< points
  double size_pt = 12;            ///< height of the letters, points
  std::optional<Color> color{};   ///< none: readable over the background
  bool show_dot = false;          ///< a small dot at the point itself
  bool hide_if_occluded = false;  ///< left out where an opaque surface stands before `at`
};

/// A side of the picture.
enum class Side { right, left, bottom, top };

/// A value on a scalar bar and what is written beside it.
struct BarTick {
  double value = 0;  ///< the field's unit
  std::string text;  ///< what stands beside it
};

/// The colours of a map over its values, with ticks and a title. Bars on one side stand beside each other.
struct ScalarBarItem {
  std::vector<std::array<double, 4>> colors;  ///< value, r, g, b: piecewise linear, values rising; one row: one colour
  std::vector<BarTick> ticks;                 ///< values rising
  std::string title;                          ///< what it shows
  std::string factor;                         ///< beside the values, for instance "x 10^-5"
  double linear_below = 0;                    ///< the scale of the values along it (engine/base/symlog_scale.h)
  Side side = Side::right;                    ///< where it stands
  int band_count = 0;         ///< of a legend of labels, upright: so many bands of one colour; values count them from below. 0: a bar
  std::string overflow_text;  ///< below a legend: "and 96 more"
};

/// The world's axes as the camera sees them: arrows in red, green and blue with their letters.
struct OrientationMarkerItem {
  Anchor anchor = Anchor::bottom_left;              ///< the corner
  double size_pt = 84;                              ///< of the square that holds it
  std::array<std::string, 3> names{"X", "Y", "Z"};  ///< at the ends of the arrows
};

/// What is felt: the force as a number and a bar of its share of the largest, and a line for every link.
struct StatusItem {
  /// A line for a link.
  struct Row {
    std::string name, status_text;  ///< "curve", "OK"
    bool is_active = true;          ///< the link holds
  };
  double force_n = 0, max_force_n = 0;  ///< newtons; no bar if the largest is 0
  std::vector<Row> rows;                ///< in the order of the chain
  Anchor anchor = Anchor::top_left;     ///< the corner
};

/// Where the packet's picture lies within a larger one of which it is a tile, pixels. Width 0: it is the whole picture.
struct OverlayFrame {
  double x = 0, y = 0, width = 0, height = 0;  ///< of this tile's upper left corner; of the larger picture
};

/// All that is written over a picture.
struct Overlay {
  std::vector<TextItem> texts;                              ///< at places of the picture
  std::vector<LabelItem> labels;                            ///< at places of the world
  std::vector<LabelItem> axis_labels;                       ///< of the axes, which follow the view
  std::vector<ScalarBarItem> scalar_bars;                   ///< bars of colours
  std::optional<OrientationMarkerItem> orientation_marker;  ///< none: not drawn
  std::optional<StatusItem> status;                         ///< none: not drawn
  std::string font = "DejaVu Sans";                         ///< a family; the nearest that is installed is taken
  double scale = 1;                                         ///< of everything
  std::optional<Color> color{};                             ///< of all text that has none of its own
  OverlayFrame frame{};                                     ///< where this picture lies in a larger one

  /// Whether there is nothing.
  bool empty() const {
    return texts.empty() && labels.empty() && axis_labels.empty() && scalar_bars.empty() && !orientation_marker && !status;
  }
};

/// What is drawn over a window's picture, at the window's own pixels: triangles with a texture, as an immediate-mode user interface makes
/// them. Plain data; the picture itself does not change.
struct UiVertex {
  float x = 0, y = 0;      ///< pixels from the window's upper left corner
  float u = 0, v = 0;      ///< 0..1
  std::uint32_t rgba = 0;  ///< 8 bits each, r lowest; straight alpha, display values
};

/// A texture by content: the same object is uploaded once.
struct UiTexture {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgba;       ///< straight alpha, rows from the top
};

/// One draw of the user interface.
struct UiDraw {
  std::shared_ptr<const UiTexture> texture;                          ///< what the triangles show
  std::array<float, 4> clip{};                                       ///< x0, y0, x1, y1, pixels
  std::uint32_t first_index = 0, index_count = 0, first_vertex = 0;  ///< of UiItems
};

/// A user interface of one frame.
struct UiItems {
  std::vector<UiVertex> vertices;      ///< corners
  std::vector<std::uint16_t> indices;  ///< three a triangle, from first_vertex on
  std::vector<UiDraw> draws;           ///< in order
  /// Where the window shows the picture (x0, y0, x1, y1, pixels), black beside it; none, or what of it the window holds is empty:
  /// everywhere.
  std::optional<std::array<std::uint32_t, 4>> image_area{};
};

}  // namespace catena::render
