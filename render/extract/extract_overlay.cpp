// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/scene/drawable.h"
#include "engine/scene/labels.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/units.h"
#include "engine/scene/visibility.h"
#include "render/extract/drawable.h"
#include "render/extract/extract_internal.h"

namespace catena::render {
namespace {

constexpr int kFromExponent = 5, kToExponent = -4;  // decimal exponents from which on the tick numbers get a common factor
constexpr double kSlack = 1e-9;

/// Replaces each hyphen by the minus sign U+2212.
std::string typeset(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;) text.replace(at, 1, "\u2212");
  return text;
}

std::string formatted(const std::string& format, double value) {
  const std::size_t at = format.find('%'), kind = format.find_first_of("efg", at);
  const int precision = format[at + 1] == '.' ? std::stoi(format.substr(at + 2, kind - at - 2)) : 6;
  const char* number = format[kind] == 'e' ? "%.*e" : format[kind] == 'f' ? "%.*f" : "%.*g";
  char text[512];
  std::snprintf(text, sizeof text, number, precision, value);
  return format.substr(0, at) + typeset(text) + format.substr(kind + 1);
}

std::string superscript(int n) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = n < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(n))) text += digits[c - '0'];
  return text;
}

}  // namespace

namespace {

/// Returns ticks of a symlog scale within lo..hi: 0 and powers of ten of both signs with |tick| >= `min_magnitude`, in a stride of powers
/// that gives about `count`. Adds 2 and 5 times the powers where there are fewer than three ticks.
std::vector<double> decade_ticks(double lo, double hi, double min_magnitude, int count) {
  const double largest = std::max(std::fabs(lo), std::fabs(hi)),
               smallest = lo > 0 || hi < 0 ? std::min(std::fabs(lo), std::fabs(hi)) : min_magnitude;
  const int first = static_cast<int>(std::floor(std::log10(smallest) + kSlack)),
            last = static_cast<int>(std::floor(std::log10(largest) + kSlack));
  const bool both = lo < 0 && hi > 0;
  const int stride = std::max(1, static_cast<int>(std::ceil((both ? 2.0 : 1.0) * (last - first + 1) / std::max(count, 1) - 0.5)));
  std::vector<double> ticks;
  const auto add = [&](double value) {
    if (value >= lo - kSlack * std::fabs(lo) && value <= hi + kSlack * std::fabs(hi)) ticks.push_back(std::clamp(value, lo, hi));
  };
  const auto fill = [&](const std::vector<double>& factors) {
    ticks.clear();
    if (lo <= 0 && hi >= 0) ticks.push_back(0);
    for (int power = last; power >= first; power -= stride)
      for (const double factor : factors) {
        const double size = factor * std::pow(10.0, power);
        if (size < smallest * (1 - kSlack)) continue;
        add(size);
        add(-size);
      }
  };
  fill({1});
  if (static_cast<int>(ticks.size()) < 3 && stride == 1) fill({1, 2, 5});
  std::sort(ticks.begin(), ticks.end());
  ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
  return ticks;
}

/// Formats a decade tick: "0.01", "200", "10⁻⁶", "2×10⁵".
std::string decade_text(double value) {
  const double size = std::fabs(value);
  if (value == 0 || (size >= 0.999e-3 && size < 0.999e4)) return formatted("%.4g", value);
  const int power = static_cast<int>(std::floor(std::log10(size) + kSlack));
  const double factor = value / std::pow(10.0, power);
  const std::string ten = "10" + superscript(power);
  if (std::fabs(std::fabs(factor) - 1) < 1e-6) return value < 0 ? typeset("-") + ten : ten;
  return formatted("%.4g", factor) + "×" + ten;
}

}  // namespace

ScalarBarTicks make_scalar_bar_ticks(double lo, double hi, int count, const std::string& format, double linear_below) {
  ScalarBarTicks scale;
  if (!std::isfinite(lo) || !std::isfinite(hi)) return scale;
  if (linear_below > 0 && lo < hi) {
    const std::vector<double> values = decade_ticks(lo, hi, linear_below, count);
    for (const double value : values) scale.ticks.push_back({value, format.empty() ? decade_text(value) : formatted(format, value)});
    if (scale.ticks.size() > 1) return scale;
    scale = {};
  }
  // nice steps are coarse: a few ticks more are better than too few
  std::vector<AxisTick> ticks = nice_ticks(lo, hi, count);
  for (int about = count + 1; about <= 2 * count && static_cast<int>(ticks.size()) + 1 < count; ++about) ticks = nice_ticks(lo, hi, about);
  if (!format.empty() || ticks.size() < 2) {
    for (const AxisTick& tick : ticks) scale.ticks.push_back({tick.value, formatted(format.empty() ? "%.6g" : format, tick.value + 0.0)});
    return scale;
  }
  const double step = ticks[1].value - ticks[0].value;
  double max_value = 0;
  for (const AxisTick& tick : ticks) max_value = std::max(max_value, std::fabs(tick.value));
  int exponent = max_value > 0 ? static_cast<int>(std::floor(std::log10(max_value) + kSlack)) : 0;
  if (exponent < kFromExponent && exponent > kToExponent) exponent = 0;
  const int decimals = std::clamp(exponent - static_cast<int>(std::floor(std::log10(step) + kSlack)), 0, 15);
  for (const AxisTick& tick : ticks)
    scale.ticks.push_back({tick.value, formatted("%." + std::to_string(decimals) + "f", tick.value / std::pow(10.0, exponent) + 0.0)});
  if (exponent != 0) scale.factor = "×10" + superscript(exponent);
  return scale;
}

namespace {

constexpr std::size_t kMaxEntries = 20, kMaxNameLength = 24,
                      kNameEnd = 8;  // limits of a legend: entries, and bytes of a name and of its kept end
constexpr double kTitleSizePt = 17, kTitleTopPt = 12;

std::optional<Color> optional_color(const std::optional<Color>& c) {
  if (!c) return std::nullopt;
  return Color{c->r, c->g, c->b};
}

Anchor anchor_of(scene::ImageCorner corner) {
  constexpr Anchor anchors[] = {Anchor::bottom_left, Anchor::bottom_right, Anchor::top_left, Anchor::top_right};
  return anchors[static_cast<int>(corner)];
}

/// Sets the legend to the labels with the most voxels, in the order of their numbers, the smallest at the top.
void set_legend(const scene::LabelMap& map, ScalarBarItem& item) {
  std::vector<scene::LabelEntry> labels = map.labels;
  const std::size_t count = std::min<std::size_t>(labels.size(), kMaxEntries), more = labels.size() - count;
  std::stable_sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.voxel_count > b.voxel_count; });
  labels.resize(count);
  std::sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    const Color& c = labels[i].color;
    for (const double end : {at, at + 1}) item.colors.push_back({end, c.r, c.g, c.b});
    std::string text = labels[i].name.empty() ? to_text(labels[i].value) : labels[i].name;
    // the middle is cut out: names of regions end with their side
    if (text.size() > kMaxNameLength)
      text = sanitize_for_terminal(text.substr(0, kMaxNameLength - kNameEnd)) + "…" +
             sanitize_for_terminal(text.substr(text.size() - kNameEnd));
    item.ticks.push_back({at + 0.5, std::move(text)});
  }
  item.band_count = static_cast<int>(count);
  item.side = item.side == Side::left ? Side::left : Side::right;
  if (more > 0) item.overflow_text = "and " + std::to_string(more) + " more";
}

Legend legend_of(const scene::Scene& scene, scene::Entity item, const FramePacket& packet) {
  const scene::Drawable* kind = scene::find_drawable(scene.entities, item);
  if (kind == nullptr || is_hidden(scene.entities, item)) return {};
  for (const DrawableExtraction& extraction : extractions())
    if (extraction.name == kind->name && extraction.legend != nullptr) return extraction.legend(scene, item, packet);
  return {};
}

void extract_scalar_bars(const scene::Scene& scene, const FramePacket& packet, Overlay& overlay) {
  for (const scene::ScalarBar& bar : scene.annotations.scalar_bars) {
    Legend shown = legend_of(scene, bar.target, packet);
    if (shown.colors.empty()) continue;
    ScalarBarItem item;
    item.title = bar.title ? scene::substitute_time(*bar.title, scene) : shown.name;
    item.side = static_cast<Side>(bar.side);
    if (shown.labels != nullptr) {
      set_legend(*shown.labels, item);
    } else {
      item.colors = std::move(shown.colors);
      item.linear_below = shown.linear_below;
      ScalarBarTicks scale = make_scalar_bar_ticks(item.colors.front()[0], item.colors.back()[0], bar.ticks, bar.format, item.linear_below);
      item.ticks = std::move(scale.ticks);
      item.factor = std::move(scale.factor);
    }
    overlay.scalar_bars.push_back(std::move(item));
  }
}

/// Extracts the force and the link states of the visible cursor.
void extract_status(const scene::Scene& scene, Overlay& overlay) {
  if (!scene.annotations.show_status || !scene.cursor || !scene.entities.has<scene::Cursor>(scene.cursor)) return;
  const scene::Cursor& cursor = scene.entities.get<scene::Cursor>(scene.cursor);
  if (!cursor.visible) return;
  StatusItem& status = overlay.status.emplace();
  status.force_n = norm(cursor.force_n);
  status.max_force_n = scene.coupling.max_force_n;
  for (std::size_t i = 0; i < cursor.statuses.size(); ++i)
    status.rows.push_back({i < cursor.names.size() ? cursor.names[i] : "link " + std::to_string(i + 1), to_string(cursor.statuses[i]),
                           i >= cursor.active.size() || cursor.active[i]});
}

}  // namespace

void extract_overlay(const scene::Scene& scene, FramePacket& packet) {
  const scene::Annotations& from = scene.annotations;
  Overlay& overlay = packet.overlay;
  overlay.font = from.font;
  overlay.scale = from.scale;
  overlay.color = optional_color(from.color);
  extract_scalar_bars(scene, packet, overlay);
  extract_status(scene, overlay);
  for (const scene::Label& label : from.labels) {
    LabelItem item;
    item.position = label.position;
    item.text = label.text;
    item.color = optional_color(label.color);
    item.size_pt = label.size_pt;
    item.show_dot = label.show_dot;
    item.hide_if_occluded = label.hide_when_occluded;
    item.offset_pt = {label.show_dot ? 6.0 : 0.0, 0.0};
    item.anchor = label.show_dot ? Anchor::left : Anchor::center;
    overlay.labels.push_back(std::move(item));
  }
  if (!from.title.empty()) {
    TextItem title;
    title.text = scene::substitute_time(from.title, scene);
    title.anchor = Anchor::top;
    title.offset_pt = {0.0, kTitleTopPt};
    title.size_pt = kTitleSizePt;
    title.bold = true;
    overlay.texts.push_back(std::move(title));
  }
  if (from.orientation_marker) {
    OrientationMarkerItem& marker = overlay.orientation_marker.emplace();
    marker.anchor = anchor_of(from.orientation_marker->corner);
    marker.size_pt = from.orientation_marker->size_pt;
    marker.names = from.orientation_marker->names;
  }
}

}  // namespace catena::render
