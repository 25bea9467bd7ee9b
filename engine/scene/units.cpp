#include "engine/scene/units.h"

#include "engine/base/text.h"
#include "engine/field/units.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {

namespace {

Result<std::string> checked(const json::Node& node) {
  if (node.kind != json::Kind::string || !field::is_unit(node.string))
    return json::error_at(node, "\"" + node.label + "\" is no unit; a word of at most 24 bytes like \"m/s\" was expected");
  return node.string;
}

}  // namespace

std::string unit_of(const Scene& scene, Entity field) {
  if (scene.world.has<Unit>(field)) return scene.world.get<Unit>(field).word;
  if (!scene.world.has<FieldSource>(field)) return {};
  const FieldSource& source = scene.world.get<FieldSource>(field);
  return source.file ? field::units_of(source.file->path, source.file->grid).value : std::string();
}

std::string unit_length(const Scene& scene) {
  std::string word;
  scene.world.each<UnitOfLength>([&](Entity, const UnitOfLength& unit) { word = unit.word; });
  if (!word.empty()) return word;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (word.empty() && source.file) word = field::units_of(source.file->path, source.file->grid).length;
  });
  scene.world.each<DrawnCurves>([&](Entity, const DrawnCurves& source) {
    if (word.empty() && source.loaded) word = source.loaded->unit;
  });
  return word;
}

std::string after_number(const std::string& unit) { return unit.empty() ? std::string() : " " + unit; }

Outcome read_unit(Scene& scene, Entity field, const json::Node& node) {
  const json::Node* unit = node.find("unit");
  if (unit == nullptr) return Done{};
  CATENA_TRY(std::string word, checked(*unit));
  scene.world.emplace<Unit>(field, {std::move(word)});
  return Done{};
}

Part unit_length_part() {
  const Key key = schema::text("unit_length", "The word shown after lengths, such as `\"mm\"`; it changes no number.")
                      .items(0, 24)
                      .by_default("the file's");
  return {{"unit_length", "The word shown after lengths.", schema::Component::Shape::value, {key}},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_TRY(std::string word, checked(node));
            scene.world.emplace<UnitOfLength>(scene.world.create(), {std::move(word)});
            return Done{};
          }};
}

}  // namespace catena::scene
