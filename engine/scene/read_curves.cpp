/// "curves": polylines from a file, drawn as tubes.
#include "engine/scene/read_named.h"

namespace catena::scene {
namespace {

using CurvesItem = FileItem<DrawnCurves>;

const Table<CurvesItem>& curves_table() {
  static const auto table = [] {
    Table<CurvesItem> t = file_table<DrawnCurves>("curves", "The file", curves::curve_endings());
    t.bind(
        schema::number("radius", "world", "Of the tubes.").positive().by_default("0.003 diagonals of all, less of many"),
        [](auto& c) -> auto& { return c.drawn.radius; });
    t.hand(
        schema::color("color", "One colour for all.").by_default("by the direction, `[|x|, |y|, |z|]`"),
        [](Scene&, const json::Node& item, CurvesItem& made) -> Outcome {
          if (item.find("color") == nullptr) return Done{};
          return schema::read_value(schema::color("color", ""), item, made.drawn.color.emplace());
        },
        [](const Scene&, const CurvesItem& made) { return made.drawn.color ? schema::write_value(*made.drawn.color) : std::string(); });
    bind_color_by(
        t, ColorSubjects::curves, [](auto& c) -> auto& { return c.drawn.color_by; });
    t.bind(
        clip_key(), [](auto& c) -> auto& { return c.drawn.clipped; });
    t.beside(visible_key());
    return t;
  }();
  return table;
}

}  // namespace

Part curves_part() {
  return {list_of("curves", "Curves from a file, such as the fibres of a tractogram.", curves_table()),
          [](Scene& scene, const json::Node& node) { return read_file_items(scene, node, curves_table()); }};
}

}  // namespace catena::scene
