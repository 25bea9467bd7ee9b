// SPDX-License-Identifier: MIT
/// Reads "points": positions from a table, rendered as spheres.
#include "engine/io/formats.h"
#include "engine/scene/reader_bindings.h"

namespace catena::scene {
namespace {

using PointsItem = FileItem<PointsSource>;

const Table<PointsItem>& points_table() {
  static const auto table = [] {
    Table<PointsItem> t = make_file_table<PointsSource>("points", "Table with the points", io::readable_extensions(io::DataKind::points));
    t.bind(
        schema::number("radius", "world", "Radius of all spheres.")
            .positive()
            .with_default("the table's column `radius`, else fitted to the spacing"),
        [](auto& p) -> auto& { return p.item.radius; });
    t.custom(
        schema::text("radius_by", "Name of the column with the radius of each sphere; not together with `radius`."),
        [](Scene&, const json::Node& item, PointsItem& made) -> Outcome {
          const json::Node* node = item.find("radius_by");
          if (node == nullptr) return Done{};
          CATENA_TRY(made.item.radius_by, json::require_string(item, "radius_by"));
          if (made.item.radius > 0) return json::error_at(*node, "both \"radius_by\" and \"radius\" are given; one of them was expected");
          return Done{};
        },
        [](const Scene&, const PointsItem& made) {
          return made.item.radius_by.empty() ? std::string() : schema::write_value(made.item.radius_by);
        });
    t.bind(
        schema::color("color", "Colour of all spheres if there is no `color_by`."), [](auto& p) -> auto& { return p.item.color; });
    bind_color_by(
        t, ColorTarget::points, [](auto& p) -> auto& { return p.item.color_by; });
    t.bind(
        clip_key(), [](auto& p) -> auto& { return p.item.clipped; });
    t.companion(visible_key());
    return t;
  }();
  return table;
}

}  // namespace

static Part points_part() {
  return {make_list_component("points", "Points from a table, rendered as spheres.", points_table()),
          [](Scene& scene, const json::Node& node) { return read_file_items(scene, node, points_table()); }};
}

static Outcome load_points(Scene& scene) {
  return load_visible<PointsSource>(scene, [&](Entity e, const PointsSource& points) -> Outcome {
    CATENA_CHECK(resolve_points(scene, e));
    return load_color_field(scene, points.color_by);
  });
}

Drawable points() { return make_drawable<PointsSource>(points_part, "points", "set of points", "sets of points", "points", load_points); }

}  // namespace catena::scene
