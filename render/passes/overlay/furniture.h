/// The overlay's items as shapes on a canvas. Places of scalar bars are worked out apart, so that they can be checked.
#pragma once
#include "render/frame/camera.h"
#include "render/passes/overlay/canvas.h"

namespace catena::render {

/// Where one bar lies, in pixels of the whole picture. The colours fill `ramp` (whole pixels); the low value is at its left end, or at
/// its bottom if upright.
struct BarPlace {
  Rect ramp;
  bool upright = true;
  Vec2 title{0.0};
  Anchor title_anchor = Anchor::centre;
};
/// Bars on one side are stacked from the picture's edge inwards; below a title if they lie at the top.
std::vector<BarPlace> place_scalar_bars(const Canvas& canvas, const Overlay& overlay);
/// Where a value lies along a bar: the coordinate across the tick mark, pixels.
double tick_place(const BarPlace& place, const ScalarBarItem& bar, double value);

void draw_scalar_bars(Canvas& canvas, const Overlay& overlay);
void draw_texts(Canvas& canvas, const Overlay& overlay);
void draw_status(Canvas& canvas, const StatusItem& status);
/// `reference_depth`: where the opaque depths are counted from.
void draw_labels(Canvas& canvas, const Overlay& overlay, const Camera& camera, double reference_depth);
void draw_orientation_marker(Canvas& canvas, const OrientationMarkerItem& marker, const Camera& camera);
/// The centre of the marker and the length of its arrows, pixels of the whole picture.
struct MarkerPlace {
  Vec2 centre{0.0};
  double arrow = 0;
};
MarkerPlace place_orientation_marker(const Canvas& canvas, const OrientationMarkerItem& marker);

/// Free space at the picture's edge.
inline constexpr double kMarginPt = 12;

}  // namespace catena::render
