// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/base/result.h"
#include "engine/base/symlog_scale.h"
#include "render/passes/overlay/canvas.h"

namespace catena::render {
namespace {

constexpr double kVerticalShare = 0.6, kHorizontalShare = 0.5;  // bar length / image height or width
constexpr double kThicknessPt = 14, kTickPt = 4, kGapPt = 3, kTitleGapPt = 7, kBetweenPt = 22;
constexpr double kBorderAlpha = 0.85;
constexpr double kStepPt = 17;  // maximum height of a band of a legend

const CanvasTextStyle kValueStyle{10.5, false, false, {}};
const CanvasTextStyle kTitleStyle{12, false, false, {}};

CanvasTextStyle title_look(bool upright) {
  CanvasTextStyle style = kTitleStyle;
  style.rotated = upright;
  return style;
}

/// Returns the maximum extent of the values' texts.
TextExtent values_extent(const Canvas& canvas, const ScalarBarItem& bar) {
  TextExtent max_extent;
  for (const BarTick& tick : bar.ticks) {
    const TextExtent one = canvas.measure(tick.text, kValueStyle);
    max_extent.width = std::max(max_extent.width, one.width);
    max_extent.height = std::max(max_extent.height, one.height);
    max_extent.descent = std::max(max_extent.descent, one.descent);
  }
  return max_extent;
}

/// Returns the low and high end of the values; they are equal for a map of one color, whose value is drawn in the middle.
std::pair<double, double> range(const ScalarBarItem& bar) {
  CATENA_ASSERT(!bar.colors.empty());
  return {bar.colors.front()[0], bar.colors.back()[0]};
}

/// Returns the position of a value between the low (0) and the high (1) end, on the bar's scale.
double share_of(const ScalarBarItem& bar, double value) {
  const auto [lo, hi] = range(bar);
  const auto layout = [&](double v) { return symlog(v, bar.linear_below); };
  return hi > lo ? (layout(value) - layout(lo)) / (layout(hi) - layout(lo)) : 0.5;
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
  // space already taken at each side of the image
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
    BarLayout layout;
    layout.upright = bar.side == Side::right || bar.side == Side::left;
    const TextExtent values = values_extent(canvas, bar);
    const double title = title_thickness(canvas, bar, layout.upright);
    double length = std::round(layout.upright ? kVerticalShare * size.y : kHorizontalShare * size.x);
    if (bar.band_count > 0) length = std::min(length, std::round(canvas.px(kStepPt)) * bar.band_count);
    const double middle = std::round(0.5 * ((layout.upright ? size.y : size.x) - length));
    const double mark = tick + (layout.upright ? values.width : values.height + values.descent);
    // the text below a legend may be wider than the legend
    const double below = layout.upright ? canvas.measure(bar.overflow_text, kValueStyle).width : 0;
    const double wider = std::max(0.0, below - thickness - mark - title);
    switch (bar.side) {
      case Side::right: {  // order: color ramp, values, title
        const double x = std::floor(size.x - edge - title - mark - thickness - wider);
        layout.ramp = {x, middle, thickness, length};
        layout.title = {x + thickness + mark + canvas.px(kTitleGapPt), middle + 0.5 * length};
        layout.title_anchor = Anchor::left;
        break;
      }
      case Side::left: {  // order: title, color ramp, values
        layout.ramp = {std::ceil(edge + title), middle, thickness, length};
        layout.title = {edge, middle + 0.5 * length};
        layout.title_anchor = Anchor::left;
        break;
      }
      case Side::bottom: {  // order: color ramp, values, title
        const double y = std::floor(size.y - edge - title - mark - thickness);
        layout.ramp = {middle, y, length, thickness};
        layout.title = {middle + 0.5 * length, y + thickness + mark + canvas.px(kTitleGapPt)};
        layout.title_anchor = Anchor::top;
        break;
      }
      case Side::top: {  // order: title, color ramp, values
        layout.ramp = {middle, std::ceil(edge + title), length, thickness};
        layout.title = {middle + 0.5 * length, edge};
        layout.title_anchor = Anchor::top;
        break;
      }
    }
    edge += title + mark + thickness + wider + canvas.px(kBetweenPt);
    places.push_back(layout);
  }
  return places;
}

double tick_position(const BarLayout& layout, const ScalarBarItem& bar, double value) {
  const double share = share_of(bar, value);
  return layout.upright ? layout.ramp.y + (1 - share) * layout.ramp.height : layout.ramp.x + share * layout.ramp.width;
}

void draw_scalar_bars(Canvas& canvas, const Overlay& overlay) {
  const std::vector<BarLayout> places = layout_scalar_bars(canvas, overlay);
  const double hair = canvas.hairline_width(), mark = std::round(canvas.px(kTickPt));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ScalarBarItem& bar = overlay.scalar_bars[i];
    const BarLayout& layout = places[i];
    const Rect& r = layout.ramp;

    // color ramp with a border
    std::vector<shared::OverlayStop> stops;
    for (const auto& c : bar.colors) stops.push_back({float(share_of(bar, c[0])), {float(c[1]), float(c[2]), float(c[3])}});
    canvas.box({r.x - hair, r.y - hair, r.width + 2 * hair, r.height + 2 * hair}, {canvas.foreground(), kBorderAlpha}, 0, hair);
    canvas.ramp(r, layout.upright, stops);

    // tick marks and values
    for (const BarTick& tick : bar.ticks) {
      const double at = tick_position(layout, bar, tick.value), from = std::round(at - 0.5 * hair);
      if (layout.upright) {
        canvas.box({r.x + r.width + hair, from, mark, hair}, {canvas.foreground()});
        canvas.text(tick.text, {r.x + r.width + canvas.px(kTickPt + kGapPt), at}, Anchor::left, kValueStyle);
      } else {
        canvas.box({from, r.y + r.height + hair, hair, mark}, {canvas.foreground()});
        canvas.text(tick.text, {at, r.y + r.height + canvas.px(kTickPt + kGapPt)}, Anchor::top, kValueStyle);
      }
    }
    if (!bar.overflow_text.empty())
      canvas.text(bar.overflow_text, {r.x, r.y + r.height + canvas.px(2 * kGapPt)}, Anchor::top_left, kValueStyle);
    if (!bar.factor.empty()) {
      if (layout.upright)
        canvas.text(bar.factor, {r.x, r.y - canvas.px(2 * kGapPt)}, Anchor::bottom_left, kValueStyle);
      else
        canvas.text(bar.factor, {r.x + r.width + canvas.px(2 * kGapPt), r.y + 0.5 * r.height}, Anchor::left, kValueStyle);
    }
    if (!bar.title.empty()) canvas.text(bar.title, layout.title, layout.title_anchor, title_look(layout.upright));
  }
}

}  // namespace catena::render
