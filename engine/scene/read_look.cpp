/// What rays make of a volume beside its transfer function: "projection", "color_by" (isosurfaces too), and the scene's "jitter".
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/read_transfer.h"

namespace catena::scene {

Result<std::optional<FieldColors>> read_field_colors(const Scene& scene, const json::Node& object) {
  const json::Node* node = object.find("color_by");
  if (node == nullptr) return std::optional<FieldColors>();
  CATENA_CHECK(json::expect_object(*node, "color_by"));
  CATENA_CHECK(json::only_keys(*node, {"field", "color", "range", "transfer"}));
  FieldColors by;
  by.where = *node;
  CATENA_TRY(by.field, read_field_name(scene, *node));
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, *node));
  by.colors = std::move(scale.colors);
  by.named = std::move(scale.named);
  return std::optional<FieldColors>(std::move(by));
}

Outcome read_projection(Volume& volume, const json::Node& object) {
  CATENA_TRY(const int choice, json::get_choice(object, "projection", 0, {"composite", "maximum", "minimum", "average"}));
  volume.projection = Volume::Projection(choice);
  if (volume.projection == Volume::Projection::composite) return Done{};
  const std::string beside =
      " beside the projection " + in_quotes(object.find("projection")->string) + "; \"composite\" was expected with it";
  if (volume.color_by) return json::error_at(volume.color_by->where, "\"color_by\" stands" + beside);
  if (!volume.transfer.gradient_factors.empty())
    return json::error_at(*object.find("projection"), "an opacity by the gradient stands" + beside);
  return Done{};
}

Outcome read_jitter(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::boolean) return json::error_at(node, "\"jitter\" is no truth value; true or false was expected");
  scene.jitter = node.boolean;
  return Done{};
}

}  // namespace catena::scene
