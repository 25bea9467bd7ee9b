#include "engine/scene/write_values.h"

#include <charconv>
#include <cmath>

#include "engine/base/json_edit.h"
#include "engine/schema/values.h"

namespace catena::scene {
namespace {

std::string component(float value) {
  CATENA_ASSERT(std::isfinite(value));
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// [a, b, ...] of the texts of the items.
template <class Items, class Text>
std::string list(const Items& items, Text&& text) {
  std::string out = "[";
  for (const auto& item : items) out += (out.size() > 1 ? ", " : "") + text(item);
  return out + "]";
}

std::string row(double a, double b) { return text_of(std::array<double, 2>{a, b}); }

}  // namespace

std::string text_of(double value) { return json::number_text(value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(std::string_view value) { return json::string_text(value); }
std::string text_of(const Vec3& v) { return "[" + text_of(v.x) + ", " + text_of(v.y) + ", " + text_of(v.z) + "]"; }
std::string text_of(const Quat& q) { return "[" + text_of(q.w) + ", " + text_of(q.x) + ", " + text_of(q.y) + ", " + text_of(q.z) + "]"; }
std::string text_of(const Color& c) { return schema::write_value(c); }
std::string text_of(const std::array<double, 2>& range) { return "[" + text_of(range[0]) + ", " + text_of(range[1]) + "]"; }
std::string text_of(const std::vector<Vec3>& points) {
  return list(points, [](const Vec3& p) { return text_of(p); });
}
std::string text_of(const std::vector<double>& values) {
  return list(values, [](double v) { return text_of(v); });
}
std::string text_of(const std::vector<TransferFunction::ColorPoint>& table) {
  return list(table, [](const auto& p) {
    return "[" + text_of(p.value) + ", " + component(p.color.r) + ", " + component(p.color.g) + ", " + component(p.color.b) + "]";
  });
}
std::string text_of(const std::vector<TransferFunction::OpacityPoint>& table) {
  return list(table, [](const auto& p) { return row(p.value, p.alpha); });
}
std::string text_of(const std::vector<TransferFunction::ExtinctionPoint>& table) {
  return list(table, [](const auto& p) { return row(p.value, p.sigma); });
}
std::string text_of(const std::vector<TransferFunction::GradientPoint>& table) {
  return list(table, [](const auto& p) { return row(p.gradient, p.factor); });
}

std::string text_of(const Background& background) { return background.transparent ? "\"transparent\"" : text_of(background.color); }

Members pose_members(widget::Kind kind, const widget::Pose& pose) {
  const std::string first = text_of(pose.points[0]), second = text_of(pose.points[1]);
  switch (kind) {
    case widget::Kind::cutting_plane:
      return {{"center", first}, {"normal", std::nullopt}, {"orientation", text_of(pose.orientation)}};
    case widget::Kind::seed:
    case widget::Kind::isolevel:
      return {{"position", first}};
    case widget::Kind::rake:
    case widget::Kind::ruler:
      return {{"from", first}, {"to", second}};
    case widget::Kind::box:
      return {{"lo", first}, {"hi", second}};
  }
  CATENA_ASSERT(false);
  return {};
}

}  // namespace catena::scene
