/// "points": places from a table, drawn as balls.
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

struct PointsItem {
  std::string name;
  DrawnPoints points;
};

Outcome read_points_name(Scene& scene, const json::Node& item, PointsItem& made) {
  CATENA_TRY(made.name, json::require_string(item, "name"));
  const json::Node& node = *item.find("name");
  CATENA_CHECK(check_name("points", made.name, node));
  if (find_points(scene, made.name))
    return json::error_at(node, "second points are called " + in_quotes(made.name) + "; a name of their own was expected");
  return Done{};
}

Outcome read_points_file(Scene& scene, const json::Node& item, PointsItem& made) {
  CATENA_TRY(const std::string file, json::require_string(item, "file"));
  std::string& path = made.points.path;
  path = resolved_path(scene.path, file);
  if (const std::string fault = file_fault(path, curves::is_point_file(path), curves::point_endings()); !fault.empty())
    return json::error_at(*item.find("file"), "points " + in_quotes(made.name) + ": file " + fault);
  return Done{};
}

const Table<PointsItem>& points_table() {
  static const auto table = [] {
    Table<PointsItem> t;
    t.hand(schema::identifier("name", "By which a link names them.").required(), read_points_name);
    t.hand(schema::file("file", "The table: " + alternatives(curves::point_endings()) + ".").required(), read_points_file);
    t.bind(
        schema::number("radius", "world", "Of all balls.").positive().by_default("the table's column `radius`, or fitted to the spacing"),
        [](auto& p) -> auto& { return p.points.radius; });
    t.hand(
        schema::text("radius_by", "The column that says each ball's radius, not beside `radius`."),
        [](Scene&, const json::Node& item, PointsItem& made) -> Outcome {
          const json::Node* node = item.find("radius_by");
          if (node == nullptr) return Done{};
          CATENA_TRY(made.points.radius_by, json::require_string(item, "radius_by"));
          if (made.points.radius > 0) return json::error_at(*node, "\"radius_by\" stands beside \"radius\"; one of them was expected");
          return Done{};
        },
        [](const Scene&, const PointsItem& made) {
          return made.points.radius_by.empty() ? std::string() : schema::write_value(made.points.radius_by);
        });
    t.bind(
        schema::color("color", "Of all balls, without `color_by`."), [](auto& p) -> auto& { return p.points.color; });
    t.hand(
        color_by_key(ColorSubjects::points),
        [](Scene& scene, const json::Node& item, PointsItem& made) {
          return read_color_by(scene, item, ColorSubjects::points, made.points.color_by);
        },
        [](const Scene& scene, const PointsItem& made) {
          return made.points.color_by ? text_of(scene, *made.points.color_by) : std::string();
        });
    t.bind(
        clip_key(), [](auto& p) -> auto& { return p.points.clipped; });
    t.beside(visible_key());
    return t;
  }();
  return table;
}

Outcome read_points(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    PointsItem made;
    made.points.where = item;
    CATENA_CHECK(points_table().read(scene, item, made));
    const Entity e = scene.world.create();
    scene.world.emplace<Name>(e, {made.name});
    scene.world.emplace<DrawnPoints>(e, std::move(made.points));
    return read_visible(scene, e, item);
  });
}

}  // namespace

Part points_part() { return {list_of("points", "Places from a table, drawn as balls.", points_table()), read_points}; }

}  // namespace catena::scene
