// SPDX-License-Identifier: MIT
#include "engine/scene/to_json.h"

#include "engine/base/json_edit.h"
#include "engine/schema/values.h"

namespace catena::scene {
namespace {

/// Returns a JSON array of the rows' texts: [a, b, ...].
template <class Rows, class Text>
std::string table_of(const Rows& rows, Text&& text) {
  std::string out = "[";
  for (const auto& row : rows) out += (out.size() > 1 ? ", " : "") + text(row);
  return out + "]";
}

std::string row(double a, double b) { return schema::write_value(std::array<double, 2>{a, b}); }

}  // namespace

std::string to_json(double value) { return schema::write_value(value); }
std::string to_json(bool value) { return schema::write_value(value); }
std::string to_json(std::string_view value) { return json::serialize_string(value); }
std::string to_json(const Vec3& v) { return schema::write_value(v); }
std::string to_json(const Quat& q) { return schema::write_value(std::vector<double>{q.w, q.x, q.y, q.z}); }
std::string to_json(const Color& c) { return schema::write_value(c); }
std::string to_json(const std::array<double, 2>& range) { return schema::write_value(range); }
std::string to_json(const Threshold& threshold) {
  return threshold.size() == 1 ? to_json(threshold.front()) : table_of(threshold, [](const auto& range) { return to_json(range); });
}
std::string to_json(const std::vector<Vec3>& points) { return schema::write_value(points); }
std::string to_json(const std::vector<double>& values) { return schema::write_value(values); }
std::string to_json(const std::vector<TransferFunction::ColorPoint>& table) {
  return table_of(table, [](const auto& p) { return "[" + to_json(p.value) + ", " + to_json(p.color).substr(1); });
}
std::string to_json(const std::vector<TransferFunction::OpacityPoint>& table) {
  return table_of(table, [](const auto& p) { return row(p.value, p.alpha); });
}
std::string to_json(const std::vector<TransferFunction::ExtinctionPoint>& table) {
  return table_of(table, [](const auto& p) { return row(p.value, p.sigma); });
}
std::string to_json(const std::vector<TransferFunction::GradientPoint>& table) {
  return table_of(table, [](const auto& p) { return row(p.gradient, p.factor); });
}

std::string to_json(const Background& background) { return background.transparent ? "\"transparent\"" : to_json(background.color); }

Members pose_members(widget::Kind kind, const widget::Pose& pose) {
  const std::string first = to_json(pose.points[0]), second = to_json(pose.points[1]);
  switch (kind) {
    case widget::Kind::cutting_plane:
      return {{"center", first}, {"normal", std::nullopt}, {"orientation", to_json(pose.orientation)}};
    case widget::Kind::seed:
    case widget::Kind::isolevel:
      return {{"position", first}};
    case widget::Kind::rake:
    case widget::Kind::ruler:
      return {{"from", first}, {"to", second}};
    case widget::Kind::box:
      return {{"min", first}, {"max", second}};
  }
  CATENA_ASSERT(false);
  return {};
}

}  // namespace catena::scene
