// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "render/passes/overlay/canvas.h"

namespace catena::render {
namespace {

constexpr double kArrowShare = 0.37;    // of the square: an arrow's length
constexpr double kRadiusShare = 0.045;  // of the arrow's length: the shaft's radius
constexpr double kConeStart = 0.70, kConeRadius = 0.15;
constexpr double kLetterGapPt = 8;
constexpr double kAlongView = 0.3;  // shorter arrows than that share are seen from their end
constexpr float kShade = 0.62f;     // a cone's base, seen from behind

const Color kAxisColors[3] = {{0.90f, 0.20f, 0.18f}, {0.25f, 0.75f, 0.25f}, {0.25f, 0.45f, 0.95f}};

Color darker(const Color& c, float by) { return {by * c.r, by * c.g, by * c.b}; }

}  // namespace

MarkerLayout layout_orientation_marker(const Canvas& canvas, const OrientationMarkerItem& marker) {
  const double side = canvas.px(marker.size_pt), margin = canvas.px(0.5 * kMarginPt);
  const Vec2 room = canvas.size() - Vec2(side + 2 * margin);
  return {Vec2(margin + 0.5 * side) + anchor_fraction(marker.anchor) * room, kArrowShare * side};
}

void draw_orientation_marker(Canvas& canvas, const OrientationMarkerItem& marker, const Camera& camera) {
  const MarkerLayout place = layout_orientation_marker(canvas, marker);
  const double radius = kRadiusShare * place.arrow_length, wide = kConeRadius * place.arrow_length;

  struct Arrow {
    int axis;
    Vec2 along;      // in the picture, y down, of length sqrt(1 - towards^2)
    double towards;  // the eye
  };
  Arrow arrows[3];
  for (int i = 0; i < 3; ++i) arrows[i] = {i, {camera.right[i], -camera.up[i]}, camera.back[i]};
  std::sort(std::begin(arrows), std::end(arrows), [](const Arrow& a, const Arrow& b) { return a.towards < b.towards; });

  bool ball = false;
  for (const Arrow& arrow : arrows) {
    if (!ball && arrow.towards >= 0) {
      canvas.ellipse(place.center, {1.0, 0.0}, 1.7 * radius, 1.7 * radius, {0.75f, 0.75f, 0.75f}, true);
      ball = true;
    }
    const Color& color = kAxisColors[arrow.axis];
    const double seen = std::hypot(arrow.along.x, arrow.along.y);
    const Vec2 unit = seen > 1e-9 ? arrow.along / seen : Vec2(1.0, 0.0);
    const Vec2 base = place.center + kConeStart * place.arrow_length * arrow.along, tip = place.center + place.arrow_length * arrow.along;
    const double squeezed = std::max(0.05, std::fabs(arrow.towards)) * wide;
    // what is nearer comes later: a cone that points away shows its base, one that points here hides it
    if (arrow.towards < 0) {
      canvas.cone(base, tip, wide, color);
      canvas.ellipse(base, unit, squeezed, wide, darker(color, kShade), false);
      canvas.tube(place.center, base, radius, color);
    } else {
      canvas.tube(place.center, base, radius, color);
      canvas.ellipse(base, unit, squeezed, wide, color, true);
      canvas.cone(base, tip, wide, color);
    }
  }
  if (!ball) canvas.ellipse(place.center, {1.0, 0.0}, 1.7 * radius, 1.7 * radius, {0.75f, 0.75f, 0.75f}, true);

  // letters over all arrows; that of an axis along the view stands where the others are not
  for (const Arrow& arrow : arrows) {
    Vec2 aside = arrow.along;
    if (std::hypot(aside.x, aside.y) < kAlongView) {
      aside = arrow.along - arrows[0].along - arrows[1].along - arrows[2].along;
      if (!(std::hypot(aside.x, aside.y) > 1e-3)) aside = {0.0, 1.0};
    }
    aside /= std::hypot(aside.x, aside.y);
    canvas.text(marker.names[std::size_t(arrow.axis)], place.center + place.arrow_length * arrow.along + canvas.px(kLetterGapPt) * aside,
                Anchor::center, {12, true, false, {}});
  }
}

}  // namespace catena::render
