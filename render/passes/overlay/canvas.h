/// What the overlay pass draws: shapes and glyphs in pixels of the whole picture, in painter's order. Places are continuous: the centre
/// of pixel (i, j) is at (i + 0.5, j + 0.5), y down. Built anew for every frame. Frame thread.
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

struct Paint {
  Color color;
  double alpha = 1;
};

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
};

struct CanvasTextStyle {
  double size_pt = 12;
  bool bold = false;
  bool rotated = false;  ///< reads upwards
  std::optional<Color> color{};
};

/// The share of a box's width and height at which its anchor lies.
Vec2 anchor_fraction(Anchor anchor);

class Canvas {
 public:
  Canvas(const FramePacket& packet, Typesetter& typesetter);

  Vec2 size() const { return size_; }  ///< of the whole picture
  double px(double points) const { return scale_ * points; }
  double hairline_width() const;                            ///< the width of a thin line: whole pixels, at least one
  Color foreground() const { return foreground_; }          ///< what is readable on the background
  Color contrast_color() const { return contrast_color_; }  ///< and what is not

  Color text_color(const std::optional<Color>& own) const { return own ? *own : text_color_ ? *text_color_ : foreground_; }
  static Color outline_color(const Color& text);  ///< black or white: what sets a text off

  /// Width and height of a text, pixels; of a rotated one as it lies in the picture.
  TextExtent measure(std::string_view text, const CanvasTextStyle& look) const;

  void box(const Rect& rect, const Paint& paint, double radius = 0, double stroke = 0);
  void line(const Vec2& from, const Vec2& to, double width, const Paint& paint);
  /// Colours from the low end of the rectangle's length (left, or bottom if `upright`) to the high one.
  void ramp(const Rect& rect, bool upright, std::span<const shared::OverlayStop> stops);
  void tube(const Vec2& from, const Vec2& to, double radius, const Color& color);
  void cone(const Vec2& base, const Vec2& tip, double radius, const Color& color);
  /// Half axes along `axis` (unit) and across it.
  void ellipse(const Vec2& centre, const Vec2& axis, double along, double across, const Color& color, bool ball);
  /// The text's anchor point lies at `at`.
  void text(std::string_view text, const Vec2& at, Anchor anchor, const CanvasTextStyle& look);

  /// From here on: hidden where an opaque surface lies before `depth` in the pixel of `at`; none: always drawn.
  struct OcclusionTest {
    Vec2 position{0.0};
    double depth = 0;
  };
  void set_occlusion_test(const std::optional<OcclusionTest>& hiding) { occlusion_test_ = hiding; }

  /// Rasterises the glyphs that are new. The shapes in pixels of the packet's picture.
  const std::vector<shared::OverlayShape>& finish();
  const std::vector<shared::OverlayStop>& stops() const { return stops_; }

 private:
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

// ---- the overlay's items as shapes on a canvas; places of scalar bars are worked out apart, so that they can be checked ----

/// Where one bar lies, in pixels of the whole picture. The colours fill `ramp` (whole pixels); the low value is at its left end, or at
/// its bottom if upright.
struct BarLayout {
  Rect ramp;
  bool upright = true;
  Vec2 title{0.0};
  Anchor title_anchor = Anchor::center;
};
/// Bars on one side are stacked from the picture's edge inwards; below a title if they lie at the top.
std::vector<BarLayout> layout_scalar_bars(const Canvas& canvas, const Overlay& overlay);
/// Where a value lies along a bar: the coordinate across the tick mark, pixels.
double tick_position(const BarLayout& place, const ScalarBarItem& bar, double value);

void draw_scalar_bars(Canvas& canvas, const Overlay& overlay);
void draw_texts(Canvas& canvas, const Overlay& overlay);
void draw_status(Canvas& canvas, const StatusItem& status);
/// `reference_depth`: where the opaque depths are counted from.
void draw_labels(Canvas& canvas, const Overlay& overlay, const Camera& camera, double reference_depth);
void draw_orientation_marker(Canvas& canvas, const OrientationMarkerItem& marker, const Camera& camera);
/// The centre of the marker and the length of its arrows, pixels of the whole picture.
struct MarkerLayout {
  Vec2 center{0.0};
  double arrow_length = 0;
};
MarkerLayout layout_orientation_marker(const Canvas& canvas, const OrientationMarkerItem& marker);

/// Free space at the picture's edge.
inline constexpr double kMarginPt = 12;

}  // namespace catena::render
