// SPDX-License-Identifier: MIT
/// Reads "curves": polylines from a file, or the vortex core lines of a field, rendered as tubes.
#include "engine/io/formats.h"
#include "engine/scene/reader_bindings.h"

namespace catena::scene {
namespace {

using CurvesItem = FileItem<CurvesSource>;

const Table<VortexCoreCurves>& cores_table() {
  static const auto table = [] {
    Table<VortexCoreCurves> t;
    t.custom(schema::reference("field", Role::vector_field, "Vector field whose vortex core lines are traced.").required(),
             [](Scene& scene, const json::Node& object, VortexCoreCurves& made) -> Outcome {
               CATENA_TRY(const Entity field, read_named<FieldSource>(scene, object, "field", "field", "fields"));
               made.field = scene.entities.get<Name>(field).value;
               made.where = *object.find("field");
               return Done{};
             });
    t.bind(
        schema::core_criterion_key(), [](auto& cores) -> auto& { return cores.options.criterion; });
    t.bind(
        schema::core_length_key(), [](auto& cores) -> auto& { return cores.options.min_length; });
    t.bind(
        schema::core_swirl_key(), [](auto& cores) -> auto& { return cores.options.min_swirl; });
    return t;
  }();
  return table;
}

const Table<CurvesItem>& curves_table() {
  static const auto table = [] {
    Table<CurvesItem> t =
        make_file_table<CurvesSource>("curves", "File with the curves", io::readable_extensions(io::DataKind::curves), false);
    t.custom(schema::object("vortex_cores", cores_table().keys(), "Vortex core lines of a vector field, instead of `file`."),
             [](Scene& scene, const json::Node& item, CurvesItem& made) -> Outcome {
               const json::Node* cores = item.find("vortex_cores");
               if ((cores != nullptr) == (item.find("file") != nullptr))
                 return json::error_at(cores != nullptr ? *cores : item,
                                       cores != nullptr ? "both \"vortex_cores\" and \"file\" are given; one of them was expected"
                                                        : "neither \"file\" nor \"vortex_cores\" is given; one of them was expected");
               if (cores == nullptr) return Done{};
               CATENA_CHECK(json::expect_object(*cores, "vortex_cores"));
               return cores_table().read(scene, *cores, made.item.vortex_cores.emplace());
             });
    t.bind(
        schema::number("radius", "world", "Radius of the tubes.")
            .positive()
            .with_default("0.003 times the diagonal of all curves, less if they are many"),
        [](auto& c) -> auto& { return c.item.radius; });
    t.custom(
        schema::color("color", "Colour of all curves if there is no `color_by`.").with_default("by direction, `[|x|, |y|, |z|]`"),
        [](Scene&, const json::Node& item, CurvesItem& made) -> Outcome {
          if (item.find("color") == nullptr) return Done{};
          return schema::read_value(schema::color("color", ""), item, made.item.color.emplace());
        },
        [](const Scene&, const CurvesItem& made) { return made.item.color ? schema::write_value(*made.item.color) : std::string(); });
    bind_color_by(
        t, ColorTarget::curves, [](auto& c) -> auto& { return c.item.color_by; });
    t.bind(
        clip_key(), [](auto& c) -> auto& { return c.item.clipped; });
    t.companion(visible_key());
    return t;
  }();
  return table;
}

}  // namespace

static Part curves_part() {
  return {make_list_component("curves", "Curves from a file, such as the fibres of a tractogram, or vortex core lines of a field.",
                              curves_table()),
          [](Scene& scene, const json::Node& node) { return read_file_items(scene, node, curves_table()); }};
}

static Outcome load_curves(Scene& scene) {
  return load_visible<CurvesSource>(scene, [&](Entity e, const CurvesSource& curves) -> Outcome {
    CATENA_CHECK(resolve_curves(scene, e));
    return load_color_field(scene, curves.color_by);
  });
}

Drawable curves() { return make_drawable<CurvesSource>(curves_part, "curves", "set of curves", "sets of curves", "curves", load_curves); }

}  // namespace catena::scene
