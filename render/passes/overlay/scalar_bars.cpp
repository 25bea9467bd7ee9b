// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/base/result.h"
#include "engine/base/symlog_scale.h"
#include "render/passes/overlay/canvas.h"

namespace catena::render {
namespace {

constexpr double kUprightShare = 0.6, kLyingShare = 0.5;  // of the picture: a bar's length
constexpr double kThicknessPt = 14, kTickPt = 4, kGapPt = 3, kTitleGapPt = 7, kBetweenPt = 22;
constexpr double kBorderAlpha = 0.85;
constexpr double kStepPt = 17;  // most: of a legend's band

const CanvasTextStyle kValueLook{10.5, false, false, {}};
const CanvasTextStyle kTitleLook{12, false, false, {}};

CanvasTextStyle title_look(bool upright) {
  CanvasTextStyle look = kTitleLook;
  look.rotated = upright;
  return look;
}

/// The largest extent of the values' texts.
TextExtent values_extent(const Canvas& canvas, const ScalarBarItem& bar) {
  TextExtent most;
  for (const BarTick& tick : bar.ticks) {
    const TextExtent one = canvas.measure(tick.text, kValueLook);
    most.width = std::max(most.width, one.width);
    most.height = std::max(most.height, one.height);
    most.descent = std::max(most.descent, one.descent);
  }
  return most;
}

/// Low and high end of the values; a map of one colour has one value in its middle.
std::pair<double, double> range(const ScalarBarItem& bar) {
  CATENA_ASSERT(!bar.colors.empty());
  return {bar.colors.front()[0], bar.colors.back()[0]};
}

/// Where a value lies on the way from the low to the high end.
double share_of(const ScalarBarItem& bar, double value) {
  const auto [lo, hi] = range(bar);
  const auto place = [&](double v) { return symlog(v, bar.linear_below); };
  return hi > lo ? (place(value) - place(lo)) / (place(hi) - place(lo)) : 0.5;
}

double title_thickness(const Canvas& canvas, const ScalarBarItem& bar, bool upright) {
  if (bar.title.empty()) return 0;
  const TextExtent title = canvas.measure(bar.title, title_look(upright));
  return (upright ? title.width : title.height) + title.descent + canvas.px(kTitleGapPt);
}

}  // namespace

std::vector<BarLayout> layout_scalar_bars(const Canvas& canvas, const Overlay& overlay) {
  std::vector<BarLayout> places;
  const Vec2 size = canvas.size();
  const double thickness = std::round(canvas.px(kThicknessPt)), tick = canvas.px(kTickPt + kGapPt);
  // what is taken already at each edge
  double taken[4];
  std::fill(std::begin(taken), std::end(taken), canvas.px(kMarginPt));
  for (const TextItem& text : overlay.texts)
    if (text.anchor == Anchor::top || text.anchor == Anchor::bottom) {
      const Side side = text.anchor == Anchor::top ? Side::top : Side::bottom;
      const TextExtent extent = canvas.measure(text.text, {text.size_pt, text.bold, false, {}});
      const double height = extent.height + extent.descent + std::fabs(canvas.px(text.offset_pt.y));
      taken[int(side)] = std::max(taken[int(side)], height + canvas.px(kTitleGapPt));
    }

  for (const ScalarBarItem& bar : overlay.scalar_bars) {
    double& edge = taken[int(bar.side)];
    BarLayout place;
    place.upright = bar.side == Side::right || bar.side == Side::left;
    const TextExtent values = values_extent(canvas, bar);
    const double title = title_thickness(canvas, bar, place.upright);
    double length = std::round(place.upright ? kUprightShare * size.y : kLyingShare * size.x);
    if (bar.band_count > 0) length = std::min(length, std::round(canvas.px(kStepPt)) * bar.band_count);
    const double middle = std::round(0.5 * ((place.upright ? size.y : size.x) - length));
    const double mark = tick + (place.upright ? values.width : values.height + values.descent);
    switch (bar.side) {
      case Side::right: {  // colours, values, title
        const double x = std::floor(size.x - edge - title - mark - thickness);
        place.ramp = {x, middle, thickness, length};
        place.title = {x + thickness + mark + canvas.px(kTitleGapPt), middle + 0.5 * length};
        place.title_anchor = Anchor::left;
        break;
      }
      case Side::left: {  // title, colours, values
        place.ramp = {std::ceil(edge + title), middle, thickness, length};
        place.title = {edge, middle + 0.5 * length};
        place.title_anchor = Anchor::left;
        break;
      }
      case Side::bottom: {  // colours, values, title
        const double y = std::floor(size.y - edge - title - mark - thickness);
        place.ramp = {middle, y, length, thickness};
        place.title = {middle + 0.5 * length, y + thickness + mark + canvas.px(kTitleGapPt)};
        place.title_anchor = Anchor::top;
        break;
      }
      case Side::top: {  // title, colours, values
        place.ramp = {middle, std::ceil(edge + title), length, thickness};
        place.title = {middle + 0.5 * length, edge};
        place.title_anchor = Anchor::top;
        break;
      }
    }
    edge += title + mark + thickness + canvas.px(kBetweenPt);
    places.push_back(place);
  }
  return places;
}

double tick_position(const BarLayout& place, const ScalarBarItem& bar, double value) {
  const double share = share_of(bar, value);
  return place.upright ? place.ramp.y + (1 - share) * place.ramp.height : place.ramp.x + share * place.ramp.width;
}

void draw_scalar_bars(Canvas& canvas, const Overlay& overlay) {
  const std::vector<BarLayout> places = layout_scalar_bars(canvas, overlay);
  const double hair = canvas.hairline_width(), mark = std::round(canvas.px(kTickPt));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ScalarBarItem& bar = overlay.scalar_bars[i];
    const BarLayout& place = places[i];
    const Rect& r = place.ramp;

    // colours within a border
    std::vector<shared::OverlayStop> stops;
    for (const auto& c : bar.colors) stops.push_back({float(share_of(bar, c[0])), {float(c[1]), float(c[2]), float(c[3])}});
    canvas.box({r.x - hair, r.y - hair, r.width + 2 * hair, r.height + 2 * hair}, {canvas.foreground(), kBorderAlpha}, 0, hair);
    canvas.ramp(r, place.upright, stops);

    // marks and values
    for (const BarTick& tick : bar.ticks) {
      const double at = tick_position(place, bar, tick.value), from = std::round(at - 0.5 * hair);
      if (place.upright) {
        canvas.box({r.x + r.width + hair, from, mark, hair}, {canvas.foreground()});
        canvas.text(tick.text, {r.x + r.width + canvas.px(kTickPt + kGapPt), at}, Anchor::left, kValueLook);
      } else {
        canvas.box({from, r.y + r.height + hair, hair, mark}, {canvas.foreground()});
        canvas.text(tick.text, {at, r.y + r.height + canvas.px(kTickPt + kGapPt)}, Anchor::top, kValueLook);
      }
    }
    if (!bar.overflow_text.empty())
      canvas.text(bar.overflow_text, {r.x, r.y + r.height + canvas.px(2 * kGapPt)}, Anchor::top_left, kValueLook);
    if (!bar.factor.empty()) {
      if (place.upright)
        canvas.text(bar.factor, {r.x, r.y - canvas.px(2 * kGapPt)}, Anchor::bottom_left, kValueLook);
      else
        canvas.text(bar.factor, {r.x + r.width + canvas.px(2 * kGapPt), r.y + 0.5 * r.height}, Anchor::left, kValueLook);
    }
    if (!bar.title.empty()) canvas.text(bar.title, place.title, place.title_anchor, title_look(place.upright));
  }
}

}  // namespace catena::render
