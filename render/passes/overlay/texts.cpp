// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include "render/passes/overlay/canvas.h"

namespace catena::render {
namespace {

constexpr double kDotPt = 2.2, kDotHaloAlpha = 0.75;
const CanvasTextStyle kRowStyle{11, false, false, {}}, kHeadStyle{11, true, false, {}};
constexpr double kPanelAlpha = 0.5, kPadPt = 8, kRowPt = 16, kColumnPt = 12, kMeterPt = 5, kMinWidthPt = 120;

/// Returns the color of a link status word: OK, FREE, BAD_PROBE or another problem.
Color word_color(const std::string& word, bool light) {
  if (word == "OK") return light ? Color{0.05f, 0.45f, 0.1f} : Color{0.45f, 0.9f, 0.5f};
  if (word == "FREE") return light ? Color{0.35f, 0.35f, 0.35f} : Color{0.75f, 0.75f, 0.75f};
  if (word == "BAD_PROBE") return light ? Color{0.7f, 0.05f, 0.05f} : Color{1, 0.45f, 0.4f};
  return light ? Color{0.6f, 0.35f, 0} : Color{1, 0.78f, 0.35f};
}

/// Returns the top left corner of a box of this size that is anchored at the image's margin.
Vec2 corner_of(const Canvas& canvas, Anchor anchor, const Vec2& size) {
  const Vec2 share = anchor_fraction(anchor), room = canvas.size() - size - Vec2(2 * canvas.px(kMarginPt));
  return Vec2(canvas.px(kMarginPt)) + share * room;
}

}  // namespace

void draw_texts(Canvas& canvas, const Overlay& overlay) {
  for (const TextItem& text : overlay.texts) {
    const Vec2 at = anchor_fraction(text.anchor) * canvas.size() + Vec2(canvas.px(text.offset_pt.x), canvas.px(text.offset_pt.y));
    canvas.text(text.text, at, text.anchor, {text.size_pt, text.bold, false, text.color});
  }
}

void draw_labels(Canvas& canvas, const Overlay& overlay, const Camera& camera, double reference_depth) {
  std::vector<LabelItem> labels = overlay.labels;
  labels.insert(labels.end(), overlay.axis_labels.begin(), overlay.axis_labels.end());
  for (const LabelItem& label : labels) {
    const auto projected = project(camera, label.position);
    if (!projected) continue;
    const Vec2 at = Vec2(projected->x, projected->y) +
                    Vec2(overlay.frame.width > 0 ? overlay.frame.x : 0, overlay.frame.width > 0 ? overlay.frame.y : 0);
    // positions far outside of the image are not visible and would exceed the float range
    if (at.x < -canvas.size().x || at.y < -canvas.size().y || at.x > 2 * canvas.size().x || at.y > 2 * canvas.size().y) continue;
    if (label.hide_if_occluded) canvas.set_occlusion_test(Canvas::OcclusionTest{at, projected->z - reference_depth});
    if (label.show_dot) {
      const double r = canvas.px(kDotPt);
      const Color color = canvas.text_color(label.color);
      canvas.box({at.x - r - 1, at.y - r - 1, 2 * r + 2, 2 * r + 2}, {Canvas::outline_color(color), kDotHaloAlpha}, r + 1);
      canvas.box({at.x - r, at.y - r, 2 * r, 2 * r}, {color}, r);
    }
    canvas.text(label.text, at + Vec2(canvas.px(label.offset_pt.x), canvas.px(label.offset_pt.y)), label.anchor,
                {label.size_pt, false, false, label.color});
    canvas.set_occlusion_test(std::nullopt);
  }
}

void draw_status(Canvas& canvas, const StatusItem& status) {
  char force[32];
  std::snprintf(force, sizeof force, "%.2f N", status.force_n);
  const double pad = canvas.px(kPadPt), row = canvas.px(kRowPt), column = canvas.px(kColumnPt);

  // widths of the two columns
  double names = canvas.measure("Force", kHeadStyle).width, words = canvas.measure("00.00 N", kHeadStyle).width;
  words = std::max(words, canvas.measure(force, kHeadStyle).width);
  for (const StatusItem::Row& r : status.rows) {
    names = std::max(names, canvas.measure(r.name, kRowStyle).width);
    words = std::max(words, canvas.measure(r.status_text, kRowStyle).width);
  }
  const double inner = std::max(names + column + words, canvas.px(kMinWidthPt)), meter = status.max_force_n > 0 ? row : 0;
  const Vec2 size(inner + 2 * pad, 2 * pad + meter + row * double(status.rows.size()) + canvas.measure("N", kHeadStyle).height);
  const Vec2 corner = corner_of(canvas, status.anchor, size);
  const bool light = canvas.foreground().r < 0.5f;
  canvas.box({corner.x, corner.y, size.x, size.y}, {canvas.contrast_color(), kPanelAlpha}, canvas.px(4));

  // force, its ratio to the maximum force, and the links
  const double left = corner.x + pad, right = left + inner;
  double y = corner.y + pad;
  canvas.text("Force", {left, y}, Anchor::top_left, kHeadStyle);
  canvas.text(force, {right, y}, Anchor::top_right, kHeadStyle);
  if (meter > 0) {
    const double share = std::clamp(status.force_n / status.max_force_n, 0.0, 1.0), h = canvas.px(kMeterPt);
    const double top = y + row - 0.1 * canvas.px(kRowPt);
    canvas.box({left, top, inner, h}, {canvas.foreground(), 0.25}, 0.5 * h);
    const Color fill = share < 0.8 ? word_color("OK", light) : share < 1 ? word_color("BUDGET", light) : word_color("BAD_PROBE", light);
    if (share > 0) canvas.box({left, top, std::max(h, share * inner), h}, {fill}, 0.5 * h);
    y += row;
  }
  for (const StatusItem::Row& r : status.rows) {
    y += row;
    CanvasTextStyle name = kRowStyle, word = kRowStyle;
    if (!r.is_active) name.color = word_color("FREE", light);
    word.color = word_color(r.is_active ? r.status_text : "FREE", light);
    canvas.text(r.name, {left, y}, Anchor::top_left, name);
    canvas.text(r.status_text, {right, y}, Anchor::top_right, word);
  }
}

}  // namespace catena::render
