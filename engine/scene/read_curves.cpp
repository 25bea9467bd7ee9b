/// "curves": polylines from a file, or the vortex cores of a field, drawn as tubes.
#include "engine/scene/read_named.h"

namespace catena::scene {
namespace {

using CurvesItem = FileItem<DrawnCurves>;

const Table<TracedCores>& cores_table() {
  static const auto table = [] {
    Table<TracedCores> t;
    t.hand(schema::named("field", Role::vector_field, "A vector field.").required(),
           [](Scene& scene, const json::Node& object, TracedCores& made) -> Outcome {
             CATENA_TRY(const Entity field, read_named<FieldSource>(scene, object, "field", "field", "fields"));
             made.field = scene.world.get<Name>(field).value;
             made.where = *object.find("field");
             return Done{};
           });
    t.bind(
        schema::core_criterion_key(), [](auto& cores) -> auto& { return cores.options.criterion; });
    t.bind(
        schema::core_length_key(), [](auto& cores) -> auto& { return cores.options.least_length; });
    t.bind(
        schema::core_swirl_key(), [](auto& cores) -> auto& { return cores.options.least_swirl; });
    return t;
  }();
  return table;
}

const Table<CurvesItem>& curves_table() {
  static const auto table = [] {
    Table<CurvesItem> t = file_table<DrawnCurves>("curves", "The file", curves::curve_endings(), false);
    t.hand(schema::object("vortex_cores", cores_table().keys(), "Or the core lines of the vortices of a field."),
           [](Scene& scene, const json::Node& item, CurvesItem& made) -> Outcome {
             const json::Node* cores = item.find("vortex_cores");
             if ((cores != nullptr) == (item.find("file") != nullptr))
               return json::error_at(cores != nullptr ? *cores : item,
                                     cores != nullptr ? "\"vortex_cores\" stands beside \"file\"; one of them was expected"
                                                      : "neither \"file\" nor \"vortex_cores\" is there; one of them was expected");
             if (cores == nullptr) return Done{};
             CATENA_CHECK(json::expect_object(*cores, "vortex_cores"));
             return cores_table().read(scene, *cores, made.drawn.traced.emplace());
           });
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
  return {
      list_of("curves", "Curves from a file, such as the fibres of a tractogram, or traced along the cores of vortices.", curves_table()),
      [](Scene& scene, const json::Node& node) { return read_file_items(scene, node, curves_table()); }};
}

}  // namespace catena::scene
