/// "curves": polylines from a file, drawn as tubes.
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

struct CurvesItem {
  std::string name;
  DrawnCurves curves;
};

Outcome read_curves_name(Scene& scene, const json::Node& item, CurvesItem& made) {
  CATENA_TRY(made.name, json::require_string(item, "name"));
  const json::Node& node = *item.find("name");
  CATENA_CHECK(check_name("curves", made.name, node));
  if (find_curves(scene, made.name))
    return json::error_at(node, "second curves are called " + in_quotes(made.name) + "; a name of their own was expected");
  return Done{};
}

Outcome read_curves_file(Scene& scene, const json::Node& item, CurvesItem& made) {
  CATENA_TRY(const std::string file, json::require_string(item, "file"));
  std::string& path = made.curves.path;
  path = resolved_path(scene.path, file);
  if (const std::string fault = file_fault(path, curves::is_curve_file(path), curves::curve_endings()); !fault.empty())
    return json::error_at(*item.find("file"), "curves " + in_quotes(made.name) + ": file " + fault);
  return Done{};
}

const Table<CurvesItem>& curves_table() {
  static const auto table = [] {
    Table<CurvesItem> t;
    t.hand(schema::identifier("name", "By which a link names them.").required(), read_curves_name);
    t.hand(schema::file("file", "The file: " + alternatives(curves::curve_endings()) + ".").required(), read_curves_file);
    t.bind(
        schema::number("radius", "world", "Of the tubes.").positive().by_default("0.003 diagonals of all, less of many"),
        [](auto& c) -> auto& { return c.curves.radius; });
    t.hand(
        schema::color("color", "One colour for all.").by_default("by the direction, `[|x|, |y|, |z|]`"),
        [](Scene&, const json::Node& item, CurvesItem& made) -> Outcome {
          if (item.find("color") == nullptr) return Done{};
          return schema::read_value(schema::color("color", ""), item, made.curves.color.emplace());
        },
        [](const Scene&, const CurvesItem& made) { return made.curves.color ? schema::write_value(*made.curves.color) : std::string(); });
    t.hand(
        color_by_key(ColorSubjects::curves),
        [](Scene& scene, const json::Node& item, CurvesItem& made) {
          return read_color_by(scene, item, ColorSubjects::curves, made.curves.color_by);
        },
        [](const Scene& scene, const CurvesItem& made) {
          return made.curves.color_by ? text_of(scene, *made.curves.color_by) : std::string();
        });
    t.bind(
        clip_key(), [](auto& c) -> auto& { return c.curves.clipped; });
    t.beside(visible_key());
    return t;
  }();
  return table;
}

Outcome read_curves(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    CurvesItem made;
    made.curves.where = item;
    CATENA_CHECK(curves_table().read(scene, item, made));
    const Entity e = scene.world.create();
    scene.world.emplace<Name>(e, {made.name});
    scene.world.emplace<DrawnCurves>(e, std::move(made.curves));
    return read_visible(scene, e, item);
  });
}

}  // namespace

Part curves_part() { return {list_of("curves", "Curves from a file, such as the fibres of a tractogram.", curves_table()), read_curves}; }

}  // namespace catena::scene
