// SPDX-License-Identifier: MIT
#include "render/passes/overlay/canvas.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/frame.h"

namespace catena::render {
namespace {

constexpr double kHairlinePt = 0.75;
constexpr double kHaloShare = 0.09, kMinHaloPx = 1;  // halo width: share of the text's size, minimum in pixels
constexpr double kHaloAlpha = 0.75;
constexpr double kDarkGray = 0.08;

double luminance(const Color& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; }
Color grey(double v) { return {float(v), float(v), float(v)}; }
glm::vec2 narrow(const Vec2& v) { return glm::vec2(v); }
double length(const Vec2& v) { return std::hypot(v.x, v.y); }

}  // namespace

Vec2 anchor_fraction(Anchor anchor) {
  const int i = static_cast<int>(anchor);
  return {0.5 * (i % 3), 0.5 * (i / 3)};
}

Canvas::Canvas(const FramePacket& packet, Typesetter& typesetter) : typesetter_(typesetter), text_color_(packet.overlay.color) {
  const OverlayFrame& frame = packet.overlay.frame;
  size_ = frame.width > 0 ? Vec2(frame.width, frame.height) : Vec2(packet.width, packet.height);
  if (frame.width > 0) corner_ = {frame.x, frame.y};
  scale_ = packet.overlay.scale * std::min(size_.x, size_.y) / kImagePoints;
  // images with a transparent background are usually placed on white paper
  const auto& b = packet.background;
  const bool light = b[3] < 0.5f || luminance({b[0], b[1], b[2]}) > 0.5;
  foreground_ = grey(light ? kDarkGray : 1);
  contrast_color_ = grey(light ? 1 : 0);
  typesetter_.set_family(packet.overlay.font);
}

Color Canvas::outline_color(const Color& text) { return luminance(text) > 0.5 ? grey(0) : grey(1); }

double Canvas::hairline_width() const { return std::max(1.0, std::round(px(kHairlinePt))); }

TextExtent Canvas::measure(std::string_view text, const CanvasTextStyle& style) const {
  TextExtent extent = typesetter_.measure(text, {px(style.size_pt), style.bold, 0});
  if (style.rotated) std::swap(extent.width, extent.height);
  return extent;
}

shared::OverlayShape& Canvas::add(std::uint32_t kind, const Vec2& origin, const Vec2& axis, const Paint& paint) {
  shared::OverlayShape shape{};
  shape.kind = kind;
  shape.origin = narrow(origin - corner_);
  shape.axis_x = narrow(axis);
  shape.axis_y = narrow({-axis.y, axis.x});
  shape.color = {paint.color.r, paint.color.g, paint.color.b, float(paint.alpha)};
  shape.occlusion_depth = NO_DEPTH;
  if (occlusion_test_) {
    shape.anchor = narrow(occlusion_test_->position - corner_);
    shape.occlusion_depth = float(occlusion_test_->depth);
  }
  return shapes_.emplace_back(shape);
}

void Canvas::box(const Rect& rect, const Paint& paint, double radius, double stroke) {
  const Vec2 half(0.5 * rect.width, 0.5 * rect.height);
  shared::OverlayShape& s = add(OVERLAY_BOX, Vec2(rect.x, rect.y) + half, {1.0, 0.0}, paint);
  s.hi = narrow(half);
  s.lo = -s.hi;
  s.size = {s.hi, float(radius), float(stroke)};
}

void Canvas::line(const Vec2& from, const Vec2& to, double width, const Paint& paint) {
  const double l = length(to - from);
  shared::OverlayShape& s = add(OVERLAY_BOX, 0.5 * (from + to), l > 0 ? (to - from) / l : Vec2(1.0, 0.0), paint);
  s.hi = narrow({0.5 * l, 0.5 * width});
  s.lo = -s.hi;
  s.size = {s.hi, 0.0f, 0.0f};
}

void Canvas::ramp(const Rect& rect, bool upright, std::span<const shared::OverlayStop> stops) {
  const Vec2 half(0.5 * rect.width, 0.5 * rect.height);
  shared::OverlayShape& s = add(OVERLAY_RAMP, Vec2(rect.x, rect.y) + half, upright ? Vec2(0.0, -1.0) : Vec2(1.0, 0.0), {});
  s.hi = narrow(upright ? Vec2(half.y, half.x) : half);
  s.lo = -s.hi;
  s.size = {s.hi, 0.0f, 0.0f};
  s.first_stop = std::uint32_t(stops_.size());
  stops_.insert(stops_.end(), stops.begin(), stops.end());
  s.last_stop = std::uint32_t(stops_.size() - 1);
}

void Canvas::tube(const Vec2& from, const Vec2& to, double radius, const Color& color) {
  line(from, to, 2 * radius, {color});
  shapes_.back().kind = OVERLAY_TUBE;
}

void Canvas::cone(const Vec2& base, const Vec2& tip, double radius, const Color& color) {
  const double l = length(tip - base);
  if (!(l > 0)) return;
  shared::OverlayShape& s = add(OVERLAY_CONE, base, (tip - base) / l, {color});
  s.lo = narrow({0.0, -radius});
  s.hi = narrow({l, radius});
  s.size = {float(l), float(radius), 0.0f, 0.0f};
}

void Canvas::ellipse(const Vec2& centre, const Vec2& axis, double along, double across, const Color& color, bool ball) {
  shared::OverlayShape& s = add(OVERLAY_ELLIPSE, centre, axis, {color});
  s.hi = narrow({along, across});
  s.lo = -s.hi;
  s.size = {s.hi, ball ? 1.0f : 0.0f, 0.0f};
}

void Canvas::text(std::string_view text, const Vec2& at, Anchor anchor, const CanvasTextStyle& style) {
  const Vec2 share = anchor_fraction(anchor);
  // unit vectors along the text and across it, downwards
  const Vec2 axis = style.rotated ? Vec2(0.0, -1.0) : Vec2(1.0, 0.0), down(-axis.y, axis.x);
  const Vec2 text_share = style.rotated ? Vec2(1 - share.y, share.x) : share;
  const double size_px = px(style.size_pt);
  const TextLayout set = typesetter_.layout(text, {size_px, style.bold, text_share.x});
  if (set.glyphs.empty()) return;

  // text origins are rounded to whole pixels across the line and to quarter pixels along it
  const Vec2 origin(std::floor(at.x), std::floor(at.y)), rest = at - origin;
  const Vec2 corner(rest.x * axis.x + rest.y * axis.y - text_share.x * set.extent.width,
                    rest.x * down.x + rest.y * down.y - text_share.y * set.extent.height);
  const Color color = text_color(style.color);
  const double halo_px = std::max(kMinHaloPx, kHaloShare * size_px);
  for (const bool halo : {true, false})
    for (const PlacedGlyph& g : set.glyphs) {
      const double along = std::round(4 * (corner.x + g.x)) / 4;
      add(OVERLAY_GLYPH, origin, axis, halo ? Paint{outline_color(color), kHaloAlpha} : Paint{color});
      pending_glyphs_.push_back({shapes_.size() - 1, typesetter_.font(style.bold), g.glyph, size_px, halo ? halo_px : 0,
                                 int(std::floor(along)), int(std::lround(corner.y + g.y)), int(4 * (along - std::floor(along)))});
    }
}

void Canvas::place_glyphs() {
  for (const PendingGlyph& pen : pending_glyphs_) {
    shared::OverlayShape& s = shapes_[pen.shape];
    const GlyphAtlas::Entry* entry = typesetter_.atlas().get(*pen.font, pen.glyph, pen.size_px, pen.subpixel_quarter, pen.halo_px);
    if (entry == nullptr) continue;  // not rasterized: an empty quad
    s.lo = {float(pen.x + entry->left), float(pen.y - entry->top)};
    s.hi = s.lo + glm::vec2(float(entry->width), float(entry->height));
    s.texel = {float(entry->x), float(entry->y)};
  }
}

const std::vector<shared::OverlayShape>& Canvas::finish() {
  const std::uint64_t generation = typesetter_.atlas().generation();
  place_glyphs();
  // the atlas was full and was cleared: glyphs placed before have moved
  if (typesetter_.atlas().generation() != generation) place_glyphs();
  return shapes_;
}

}  // namespace catena::render
