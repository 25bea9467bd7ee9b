/// "points": places from a table, drawn as balls.
#include "engine/scene/read_named.h"

namespace catena::scene {
namespace {

using PointsItem = FileItem<DrawnPoints>;

const Table<PointsItem>& points_table() {
  static const auto table = [] {
    Table<PointsItem> t = file_table<DrawnPoints>("points", "The table", curves::point_endings());
    t.bind(
        schema::number("radius", "world", "Of all balls.").positive().by_default("the table's column `radius`, or fitted to the spacing"),
        [](auto& p) -> auto& { return p.drawn.radius; });
    t.hand(
        schema::text("radius_by", "The column that says each ball's radius, not beside `radius`."),
        [](Scene&, const json::Node& item, PointsItem& made) -> Outcome {
          const json::Node* node = item.find("radius_by");
          if (node == nullptr) return Done{};
          CATENA_TRY(made.drawn.radius_by, json::require_string(item, "radius_by"));
          if (made.drawn.radius > 0) return json::error_at(*node, "\"radius_by\" stands beside \"radius\"; one of them was expected");
          return Done{};
        },
        [](const Scene&, const PointsItem& made) {
          return made.drawn.radius_by.empty() ? std::string() : schema::write_value(made.drawn.radius_by);
        });
    t.bind(
        schema::color("color", "Of all balls, without `color_by`."), [](auto& p) -> auto& { return p.drawn.color; });
    bind_color_by(
        t, ColorSubjects::points, [](auto& p) -> auto& { return p.drawn.color_by; });
    t.bind(
        clip_key(), [](auto& p) -> auto& { return p.drawn.clipped; });
    t.beside(visible_key());
    return t;
  }();
  return table;
}

}  // namespace

Part points_part() {
  return {list_of("points", "Places from a table, drawn as balls.", points_table()),
          [](Scene& scene, const json::Node& node) { return read_file_items(scene, node, points_table()); }};
}

}  // namespace catena::scene
