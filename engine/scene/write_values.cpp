#include "engine/scene/write_values.h"

#include "engine/base/json_edit.h"
#include "engine/schema/values.h"

namespace catena::scene {
namespace {

/// [a, b, ...] of the texts of the rows.
template <class Rows, class Text>
std::string table_of(const Rows& rows, Text&& text) {
  std::string out = "[";
  for (const auto& row : rows) out += (out.size() > 1 ? ", " : "") + text(row);
  return out + "]";
}

std::string row(double a, double b) { return schema::write_value(std::array<double, 2>{a, b}); }

}  // namespace

std::string text_of(double value) { return schema::write_value(value); }
std::string text_of(bool value) { return schema::write_value(value); }
std::string text_of(std::string_view value) { return json::string_text(value); }
std::string text_of(const Vec3& v) { return schema::write_value(v); }
std::string text_of(const Quat& q) { return schema::write_value(std::vector<double>{q.w, q.x, q.y, q.z}); }
std::string text_of(const Color& c) { return schema::write_value(c); }
std::string text_of(const std::array<double, 2>& range) { return schema::write_value(range); }
std::string text_of(const std::vector<Vec3>& points) { return schema::write_value(points); }
std::string text_of(const std::vector<double>& values) { return schema::write_value(values); }
std::string text_of(const std::vector<TransferFunction::ColorPoint>& table) {
  return table_of(table, [](const auto& p) { return "[" + text_of(p.value) + ", " + text_of(p.color).substr(1); });
}
std::string text_of(const std::vector<TransferFunction::OpacityPoint>& table) {
  return table_of(table, [](const auto& p) { return row(p.value, p.alpha); });
}
std::string text_of(const std::vector<TransferFunction::ExtinctionPoint>& table) {
  return table_of(table, [](const auto& p) { return row(p.value, p.sigma); });
}
std::string text_of(const std::vector<TransferFunction::GradientPoint>& table) {
  return table_of(table, [](const auto& p) { return row(p.gradient, p.factor); });
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
