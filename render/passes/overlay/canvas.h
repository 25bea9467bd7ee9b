// SPDX-License-Identifier: MIT
/// Drawing list of the overlay pass: shapes and glyphs in pixels of the whole image, in painter's order. Positions are continuous: the
/// center of pixel (i, j) is at (i + 0.5, j + 0.5), y down. Rebuilt for every frame. Frame thread.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"
#include "render/text/typesetter.h"
#include "shaders/shared/overlay.h"

namespace catena::render {

/// Color and opacity of a shape.
struct Paint {
  Color color;
  double alpha = 1;
};

/// Axis-aligned rectangle: upper left corner and size, pixels.
struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
};

/// Style of a text on the canvas.
struct CanvasTextStyle {
  double size_pt = 12;
  bool bold = false;
  bool rotated = false;  ///< runs from bottom to top
  /// nullopt: Overlay::color, else the foreground color.
  std::optional<Color> color{};
};

/// Returns the position of an anchor in a box, as fractions of its width and height (0 to 1, y down).
Vec2 anchor_fraction(Anchor anchor);

/// List of overlay shapes in drawing order, with the packet's scale, font and colors.
class Canvas {
 public:
  Canvas(const FramePacket& packet, Typesetter& typesetter);

  Vec2 size() const { return size_; }                         ///< size of the whole image, pixels
  double px(double points) const { return scale_ * points; }  ///< converts points to pixels
  double hairline_width() const;                              ///< width of a thin line, pixels: whole pixels, at least one
  Color foreground() const { return foreground_; }            ///< dark or white, whichever is readable on the background
  Color contrast_color() const { return contrast_color_; }    ///< white or black, the opposite of foreground()

  /// Returns the color of a text: its own, else the overlay's text color, else foreground().
  Color text_color(const std::optional<Color>& own) const { return own ? *own : text_color_ ? *text_color_ : foreground_; }
  static Color outline_color(const Color& text);  ///< black or white, whichever contrasts with the text color

  /// Returns width and height of a text, pixels; for a rotated text, of its rotated box.
  TextExtent measure(std::string_view text, const CanvasTextStyle& style) const;

  /// Adds a box. `radius`: corner radius; `stroke`: line width of an outline, 0: filled; pixels.
  void box(const Rect& rect, const Paint& paint, double radius = 0, double stroke = 0);
  /// Adds a line; `width` in pixels.
  void line(const Vec2& from, const Vec2& to, double width, const Paint& paint);
  /// Adds a color ramp along the rectangle's length, from the low end (left, or bottom if `upright`) to the high end.
  void ramp(const Rect& rect, bool upright, std::span<const shared::OverlayStop> stops);
  /// Adds a shaded cylinder, seen from the side.
  void tube(const Vec2& from, const Vec2& to, double radius, const Color& color);
  /// Adds a shaded cone, seen from the side; nothing if base and tip coincide.
  void cone(const Vec2& base, const Vec2& tip, double radius, const Color& color);
  /// Adds an ellipse with half axis `along` in the direction `axis` (unit vector) and half axis `across` perpendicular to it, pixels.
  /// `ball`: shaded as a sphere.
  void ellipse(const Vec2& centre, const Vec2& axis, double along, double across, const Color& color, bool ball);
  /// Adds a text whose anchor point lies at `at`.
  void text(std::string_view text, const Vec2& at, Anchor anchor, const CanvasTextStyle& style);

  /// Occlusion test of a shape: hidden where an opaque surface lies in front of `depth` (view depth minus the reference depth, world units)
  /// at the pixel of `position`.
  struct OcclusionTest {
    Vec2 position{0.0};
    double depth = 0;
  };
  /// Sets the occlusion test for all shapes added from here on; nullopt: always visible.
  void set_occlusion_test(const std::optional<OcclusionTest>& hiding) { occlusion_test_ = hiding; }

  /// Rasterizes the glyphs that are not in the atlas yet, and returns the shapes in pixels of the packet's image.
  const std::vector<shared::OverlayShape>& finish();
  /// Returns the color stops of the ramps.
  const std::vector<shared::OverlayStop>& stops() const { return stops_; }

 private:
  /// Glyph whose position in the atlas is set by finish().
  struct PendingGlyph {
    std::size_t shape;
    const Font* font;
    std::uint32_t glyph;
    double size_px, halo_px;
    int x, y, subpixel_quarter;
  };
  shared::OverlayShape& add(std::uint32_t kind, const Vec2& origin, const Vec2& axis, const Paint& paint);
  void place_glyphs();

  Typesetter& typesetter_;
  Vec2 size_{0.0}, corner_{0.0};
  double scale_ = 1;
  Color foreground_, contrast_color_;
  std::optional<Color> text_color_;
  std::optional<OcclusionTest> occlusion_test_;
  std::vector<shared::OverlayShape> shapes_;
  std::vector<shared::OverlayStop> stops_;
  std::vector<PendingGlyph> pending_glyphs_;
};

// Overlay items as shapes on a canvas. Layouts are computed separately, so that they can be tested.

/// Layout of one scalar bar, pixels of the whole image. The colors fill `ramp` (whole pixels); the low value is at its left end, or at its
/// bottom if upright.
struct BarLayout {
  Rect ramp;
  bool upright = true;
  Vec2 title{0.0};
  Anchor title_anchor = Anchor::center;
};
/// Returns the layouts of the bars. Bars on one side are stacked from the edge of the image inwards, and below a title at the top.
std::vector<BarLayout> layout_scalar_bars(const Canvas& canvas, const Overlay& overlay);
/// Returns the position of a value along the bar: the pixel coordinate along its length at which the tick mark lies.
double tick_position(const BarLayout& layout, const ScalarBarItem& bar, double value);

/// Adds the scalar bars and legends to the canvas.
void draw_scalar_bars(Canvas& canvas, const Overlay& overlay);
/// Adds the texts at image positions.
void draw_texts(Canvas& canvas, const Overlay& overlay);
/// Adds the haptic status panel.
void draw_status(Canvas& canvas, const StatusItem& status);
/// Adds the labels at world positions. `reference_depth`: view depth from which the opaque depths are counted, world units.
void draw_labels(Canvas& canvas, const Overlay& overlay, const Camera& camera, double reference_depth);
/// Adds the orientation marker.
void draw_orientation_marker(Canvas& canvas, const OrientationMarkerItem& marker, const Camera& camera);
/// Layout of the orientation marker: center and arrow length, pixels of the whole image.
struct MarkerLayout {
  Vec2 center{0.0};
  double arrow_length = 0;
};
/// Returns the layout of the orientation marker.
MarkerLayout layout_orientation_marker(const Canvas& canvas, const OrientationMarkerItem& marker);

/// Margin at the edge of the image.
inline constexpr double kMarginPt = 12;

}  // namespace catena::render
