/// "slices": [{"field", "point" and "normal", or "axis" and "at", or "widget", the colours of read_transfer.h, "opacity", "lit", "clip",
/// "visible",
///             "contours": {"levels" | "count" | "spacing", "color", "width"}}]
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/read_transfer.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

constexpr double kWidest = 100;  // pixels

/// The plane of a widget.
Outcome read_followed(const Scene& scene, const json::Node& item, Slice& slice) {
  for (const char* key : {"point", "normal", "axis", "at"})
    if (const json::Node* node = item.find(key))
      return json::error_at(*node, in_quotes(key) + " is given beside \"widget\", whose plane the slice follows; one of them was expected");
  CATENA_TRY(slice.widget, read_widget_name(scene, item, {widget::Kind::cutting_plane}, "a cutting plane"));
  const widget::Pose& pose = scene.world.get<Widget>(slice.widget).spec.pose;
  slice.point = pose.points[0];
  slice.normal = normal_of(pose);
  return Done{};
}

Outcome read_plane(const Scene& scene, const json::Node& item, Slice& slice) {
  if (item.find("widget") != nullptr) return read_followed(scene, item, slice);
  const json::Node *axis = item.find("axis"), *at = item.find("at"), *point = item.find("point"), *normal = item.find("normal");
  if ((axis || at) && (point || normal))
    return json::error_at(
        point ? *point : *normal,
        "a slice has both an axis and a point or normal; \"axis\" with \"at\", or \"point\" with \"normal\", was expected");
  if (!axis && !at && !point && !normal)
    return json::error_at(item, "a slice has no plane; \"widget\", \"axis\" with \"at\", or \"point\" with \"normal\", was expected");
  if (axis || at) {
    if (!axis) return json::error_at(*at, "\"at\" is given without \"axis\"; \"x\", \"y\" or \"z\" was expected beside it");
    CATENA_TRY(const int which, json::get_choice(item, "axis", 0, {"x", "y", "z"}));
    CATENA_TRY(slice.point[which], json::require_number(item, "at"));
    slice.normal = Vec3(0.0);
    slice.normal[which] = 1;
    return Done{};
  }
  CATENA_TRY(slice.point, json::require_vec3(item, "point"));
  CATENA_TRY(slice.normal, json::require_vec3(item, "normal"));
  if (max_abs(slice.normal) == 0) return json::error_at(*normal, "\"normal\" is zero; a vector other than [0, 0, 0] was expected");
  return Done{};
}

Result<std::vector<double>> read_levels(const json::Node& node) {
  if (node.kind != json::Kind::array || node.items.empty())
    return json::error_at(node, "\"levels\" is no list; rising numbers [level, ...] were expected");
  std::vector<double> levels;
  for (const json::Node& item : node.items) {
    CATENA_TRY(const double level, json::as_number(item, "levels"));
    if (!levels.empty() && !(level > levels.back()))
      return json::error_at(item,
                            "\"levels\" has " + to_text(level) + " after " + to_text(levels.back()) + "; rising numbers were expected");
    levels.push_back(level);
  }
  if (levels.size() > static_cast<std::size_t>(kMostContours))
    return json::error_at(
        node, "\"levels\" holds " + std::to_string(levels.size()) + " levels; at most " + std::to_string(kMostContours) + " were expected");
  return levels;
}

Result<Slice::Contours> read_contours(const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "contours"));
  CATENA_CHECK(json::only_keys(node, {"levels", "count", "spacing", "color", "width"}));
  Slice::Contours contours;
  contours.where = node;
  const json::Node *levels = node.find("levels"), *count = node.find("count"), *spacing = node.find("spacing");
  if ((levels != nullptr) + (count != nullptr) + (spacing != nullptr) != 1)
    return json::error_at(node,
                          "contours say their levels in no way, or in several; one of \"levels\", \"count\" and \"spacing\" was expected");
  if (levels) {
    CATENA_TRY(contours.levels, read_levels(*levels));
  }
  if (count) {
    CATENA_TRY(contours.count, json::get_integer(node, "count", 1, 1, kMostContours));
  }
  CATENA_TRY(contours.spacing, json::get_number(node, "spacing", 0, json::Range::positive));
  CATENA_TRY(contours.color, read_color(node, "color", contours.color));
  CATENA_TRY(contours.width, json::get_number(node, "width", contours.width, json::Range::positive));
  if (contours.width > kWidest)
    return json::error_at(*node.find("width"),
                          "\"width\" is " + to_text(contours.width) + " pixels; at most " + to_text(kWidest) + " was expected");
  return contours;
}

}  // namespace

Outcome read_slices(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"slices\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"field", "point", "normal", "axis", "at", "widget", "color", "range", "transfer", "opacity",
                                        "contours", "lit", "clip", "visible"}));
    Slice slice;
    slice.where = item;
    CATENA_TRY(slice.shown.field, read_field_name(scene, item));
    CATENA_CHECK(read_plane(scene, item, slice));
    CATENA_TRY(ColorScale scale, read_color_scale(scene.path, item));
    slice.shown.colors = std::move(scale.colors);
    slice.shown.named = std::move(scale.named);
    CATENA_TRY(slice.opacity, read_opacity(item, slice.opacity));
    CATENA_TRY(slice.lit, json::get_boolean(item, "lit", false));
    CATENA_TRY(slice.clipped, json::get_boolean(item, "clip", true));
    if (const json::Node* contours = item.find("contours")) {
      CATENA_TRY(slice.contours, read_contours(*contours));
    }
    const Entity e = scene.world.create();
    scene.world.emplace<Slice>(e, std::move(slice));
    CATENA_CHECK(read_visible(scene, e, item));
  }
  return Done{};
}

}  // namespace catena::scene
