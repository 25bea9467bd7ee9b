// SPDX-License-Identifier: MIT
#include "engine/scene/units.h"

#include "engine/base/text.h"
#include "engine/io/volume/units.h"
#include "engine/scene/derived_fields.h"
#include "engine/scene/readers.h"

namespace catena::scene {

namespace {

Result<std::string> checked(const json::Node& node) {
  if (node.kind != json::Kind::string || !field::is_unit_name(node.string))
    return json::error_at(node, "\"" + node.label + "\" is not a unit; a word of at most 24 bytes like \"m/s\" was expected");
  return node.string;
}

}  // namespace

std::string unit_of(const Scene& scene, Entity field) {
  if (scene.entities.has<Unit>(field)) return scene.entities.get<Unit>(field).symbol;
  if (!scene.entities.has<FieldSource>(field)) return {};
  const FieldSource& source = scene.entities.get<FieldSource>(field);
  if (source.derived) return derived_unit(scene, *source.derived);
  return source.file ? field::read_units(source.file->path, source.file->grid).value : std::string();
}

std::string length_unit(const Scene& scene) {
  std::string word;
  scene.entities.each<LengthUnit>([&](Entity, const LengthUnit& unit) { word = unit.symbol; });
  if (!word.empty()) return word;
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (word.empty() && source.file) word = field::read_units(source.file->path, source.file->grid).length;
  });
  scene.entities.each<CurvesSource>([&](Entity, const CurvesSource& source) {
    if (word.empty() && source.loaded) word = source.loaded->unit;
  });
  return word;
}

std::string unit_suffix(const std::string& unit) { return unit.empty() ? std::string() : " " + unit; }

Outcome read_unit(Scene& scene, Entity field, const json::Node& node) {
  const json::Node* unit = node.find("unit");
  if (unit == nullptr) return Done{};
  CATENA_TRY(std::string word, checked(*unit));
  scene.entities.emplace<Unit>(field, {std::move(word)});
  return Done{};
}

Part unit_length_part() {
  const Key key = schema::text("unit_length", "Unit shown after lengths, such as `\"mm\"`. Lengths are not converted.")
                      .with_size(0, 24)
                      .with_default("the unit in the file");
  return {{"unit_length", "Unit shown after lengths.", schema::Section::Layout::value, {key}},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_TRY(std::string word, checked(node));
            scene.entities.emplace<LengthUnit>(scene.entities.create(), {std::move(word)});
            return Done{};
          }};
}

}  // namespace catena::scene
