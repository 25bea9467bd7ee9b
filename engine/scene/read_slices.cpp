/// "slices": a plane, as a point with a normal, an axis with a place on it, or a widget; colours; contours.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/read_parts.h"
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

Outcome read_plane(Scene& scene, const json::Node& item, Slice& slice) {
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

const Table<Slice::Contours>& contours_table() {
  using Contours = Slice::Contours;
  static const auto table = [] {
    Table<Contours> t;
    t.bind(schema::numbers("levels", "value", "These values: one of the three.").ranged("rising").without_default().items(1, kMaxContours),
           &Contours::levels);
    t.bind(
        schema::integer("count", "", "Or so many within the range of the colours, its ends left out.", 1, kMaxContours).without_default(),
        &Contours::count);
    t.bind(schema::number("spacing", "value", "Or all multiples of this.").positive().without_default(), &Contours::spacing);
    t.bind(schema::color("color", "Of the lines."), &Contours::color);
    t.bind(schema::number("width", "pixels", "Of the lines.").limited({0.0, kWidest, true}), &Contours::width);
    t.check([](Scene&, const json::Node& node, Contours& contours) -> Outcome {
      if (contours.levels.size() > static_cast<std::size_t>(kMaxContours))
        return json::error_at(*node.find("levels"), "\"levels\" holds " + std::to_string(contours.levels.size()) + " levels; at most " +
                                                        std::to_string(kMaxContours) + " were expected");
      for (std::size_t i = 1; i < contours.levels.size(); ++i)
        if (!(contours.levels[i] > contours.levels[i - 1]))
          return json::error_at(node.find("levels")->items[i], "\"levels\" has " + to_text(contours.levels[i]) + " after " +
                                                                   to_text(contours.levels[i - 1]) + "; rising numbers were expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

Outcome read_contours(Scene& scene, const json::Node& item, Slice& slice) {
  const json::Node* node = item.find("contours");
  if (node == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*node, "contours"));
  int ways = 0;
  for (const char* key : {"levels", "count", "spacing"}) ways += node->find(key) != nullptr;
  slice.contours.emplace().where = *node;
  CATENA_CHECK(json::only_keys(*node, schema::names_of(contours_table().keys())));
  if (ways != 1)
    return json::error_at(*node,
                          "contours say their levels in no way, or in several; one of \"levels\", \"count\" and \"spacing\" was expected");
  return contours_table().read_known(scene, *node, *slice.contours);
}

Outcome read_colors(Scene& scene, const json::Node& item, Slice& slice) {
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, item));
  slice.shown.where = item;
  slice.shown.colors = std::move(scale.colors);
  slice.shown.named = std::move(scale.named);
  return Done{};
}

schema::Members plane_members(const Scene& scene, const Slice& slice) {
  if (slice.widget) return {{"widget", schema::write_value(scene.world.get<Name>(slice.widget).value)}};
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0), at(0.0);
    axis[i] = 1;
    at[i] = slice.point[i];
    if (slice.normal == axis && slice.point == at)
      return {{"axis", schema::write_value(std::string(1, "xyz"[i]))}, {"at", schema::write_value(slice.point[i])}};
  }
  return {{"point", schema::write_value(slice.point)}, {"normal", schema::write_value(slice.normal)}};
}

const Table<Slice>& slice_table() {
  static const auto table = [] {
    Table<Slice> t;
    bind_field(
        t, schema::named("field", Role::any_field, "A scalar field, or a vector field, whose magnitude is shown.").required(),
        [](auto& slice) -> auto& { return slice.shown.field; });
    t.group(
        {schema::vec3("point", "world", "A point of the plane: with `normal`."), schema::direction("normal", "Its normal, of any length."),
         schema::word("axis", {"x", "y", "z"}, "Or the axis that is its normal: with `at`."),
         schema::number("at", "world", "Where it crosses the axis."),
         schema::named("widget", Role::widget, "Or a cutting plane to follow: one of the three.")},
        read_plane, plane_members);
    t.group(color_scale_keys(), read_colors,
            [](const Scene&, const Slice& slice) { return scale_members(slice.shown.colors, slice.shown.named); });
    t.bind(opacity_key("Of the slice."), &Slice::opacity);
    t.hand(schema::object("contours", contours_table().keys(), "Lines of constant value; they say their levels in one of three ways."),
           read_contours, [](const Scene& scene, const Slice& slice) {
             return slice.contours ? contours_table().write(scene, *slice.contours) : std::string();
           });
    t.bind(schema::boolean("lit", "Lit as a surface is."), &Slice::lit);
    t.bind(clip_key(), &Slice::clipped);
    t.beside(visible_key());
    return t;
  }();
  return table;
}

Outcome read_slices(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    Slice slice;
    slice.where = item;
    CATENA_CHECK(slice_table().read(scene, item, slice));
    const Entity e = scene.world.create();
    scene.world.emplace<Slice>(e, std::move(slice));
    return read_visible(scene, e, item);
  });
}

}  // namespace

std::string text_of(const Scene& scene, const Slice& slice) { return slice_table().write(scene, slice); }

Part slices_part() {
  return {
      list_of(
          "slices",
          "Planes through a field, coloured by its values. A plane is said as `axis` and `at`, as `point` and `normal`, or as `widget`.",
          slice_table()),
      read_slices};
}

}  // namespace catena::scene
