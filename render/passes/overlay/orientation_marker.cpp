// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "render/passes/overlay/canvas.h"

namespace catena::render {
namespace {

constexpr double kArrowShare = 0.37;    // arrow length / side of the square
constexpr double kRadiusShare = 0.045;  // radius of the shaft / arrow length
constexpr double kConeStart = 0.70, kConeRadius = 0.15;
constexpr double kLetterGapPt = 8;
constexpr double kEndOnShare = 0.3;  // arrows with a shorter projection than this share are drawn end-on
constexpr float kShade = 0.62f;      // brightness of a cone's base

const Color kAxisColors[3] = {{0.90f, 0.20f, 0.18f}, {0.25f, 0.75f, 0.25f}, {0.25f, 0.45f, 0.95f}};

Color darker(const Color& c, float by) { return {by * c.r, by * c.g, by * c.b}; }

}  // namespace

MarkerLayout layout_orientation_marker(const Canvas& canvas, const OrientationMarkerItem& marker) {
  const double side = canvas.px(marker.size_pt), margin = canvas.px(0.5 * kMarginPt);
  const Vec2 room = canvas.size() - Vec2(side + 2 * margin);
  return {Vec2(margin + 0.5 * side) + anchor_fraction(marker.anchor) * room, kArrowShare * side};
}

void draw_orientation_marker(Canvas& canvas, const OrientationMarkerItem& marker, const Camera& camera) {
  const MarkerLayout layout = layout_orientation_marker(canvas, marker);
  const double radius = kRadiusShare * layout.arrow_length, wide = kConeRadius * layout.arrow_length;

  struct Arrow {
    int axis;
    Vec2 along;      // in the image, y down, of length sqrt(1 - towards^2)
    double towards;  // component towards the camera
  };
  Arrow arrows[3];
  for (int i = 0; i < 3; ++i) arrows[i] = {i, {camera.right[i], -camera.up[i]}, camera.back[i]};
  std::sort(std::begin(arrows), std::end(arrows), [](const Arrow& a, const Arrow& b) { return a.towards < b.towards; });

  bool ball = false;
  for (const Arrow& arrow : arrows) {
    if (!ball && arrow.towards >= 0) {
      canvas.ellipse(layout.center, {1.0, 0.0}, 1.7 * radius, 1.7 * radius, {0.75f, 0.75f, 0.75f}, true);
      ball = true;
    }
    const Color& color = kAxisColors[arrow.axis];
    const double projected = std::hypot(arrow.along.x, arrow.along.y);
    const Vec2 unit = projected > 1e-9 ? arrow.along / projected : Vec2(1.0, 0.0);
    const Vec2 base = layout.center + kConeStart * layout.arrow_length * arrow.along,
               tip = layout.center + layout.arrow_length * arrow.along;
    const double squeezed = std::max(0.05, std::fabs(arrow.towards)) * wide;
    // the part nearer to the camera is drawn last: the base of a cone that points away, else the cone over the shaft
    if (arrow.towards < 0) {
      canvas.cone(base, tip, wide, color);
      canvas.ellipse(base, unit, squeezed, wide, darker(color, kShade), false);
      canvas.tube(layout.center, base, radius, color);
    } else {
      canvas.tube(layout.center, base, radius, color);
      canvas.ellipse(base, unit, squeezed, wide, color, true);
      canvas.cone(base, tip, wide, color);
    }
  }
  if (!ball) canvas.ellipse(layout.center, {1.0, 0.0}, 1.7 * radius, 1.7 * radius, {0.75f, 0.75f, 0.75f}, true);

  // letters over all arrows; the letter of an axis along the view is placed opposite to the others
  for (const Arrow& arrow : arrows) {
    Vec2 offset = arrow.along;
    if (std::hypot(offset.x, offset.y) < kEndOnShare) {
      offset = arrow.along - arrows[0].along - arrows[1].along - arrows[2].along;
      if (!(std::hypot(offset.x, offset.y) > 1e-3)) offset = {0.0, 1.0};
    }
    offset /= std::hypot(offset.x, offset.y);
    canvas.text(marker.names[std::size_t(arrow.axis)], layout.center + layout.arrow_length * arrow.along + canvas.px(kLetterGapPt) * offset,
                Anchor::center, {12, true, false, {}});
  }
}

}  // namespace catena::render
