#include "engine/app/viewer/shell/values.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/scene/labels.h"
#include "engine/scene/units.h"

namespace catena::app {

std::vector<FieldValue> values_at(const scene::Scene& scene, const Vec3& world) {
  std::vector<FieldValue> values;
  scene.world.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    const field::AnyField& any = source.loaded.get() != nullptr ? source.loaded : source.drawn;
    if (any.get() == nullptr || !scene.world.has<scene::Name>(e)) return;
    FieldValue value;
    value.name = scene.world.get<scene::Name>(e).value;
    value.unit = scene::unit_of(scene, e);
    field::Cursor cursor;
    if (any.scalar) {
      const field::ScalarSample sample = any.scalar->sample(world, cursor);
      value.inside = sample.inside && std::isfinite(sample.value);
      value.value = sample.value;
      if (const scene::LabelMap* map = scene::labels_of(scene, e)) {
        value.label = scene::label_words(*map, sample.value);
        // a surface of labels runs between them and what is none
        if (const double near = field::label_at(*any.scalar->grid(), world); sample.value == 0 && near != 0)
          value.label = "beside " + scene::label_words(*map, near);
      }
    } else {
      const field::VectorSample sample = any.vector->sample(world, cursor);
      value.inside = sample.inside && is_finite(sample.value);
      value.value = norm(sample.value);
      value.vector = sample.value;
    }
    values.push_back(std::move(value));
  });
  return values;
}

std::string value_words(const FieldValue& value, bool components) {
  if (!value.inside) return "outside";
  if (!value.label.empty()) return value.label;
  std::string words = fmt::format("{:.4g}", value.value);
  if (components && value.vector) words += fmt::format(" ({:.4g}, {:.4g}, {:.4g})", value.vector->x, value.vector->y, value.vector->z);
  return words;
}

std::string place_words(const Vec3& world, const std::string& unit_length) {
  return fmt::format("{:.5g}, {:.5g}, {:.5g}{}", world.x, world.y, world.z, scene::after_number(unit_length));
}

std::string line_words(const PlaceValues& place, const std::string& unit_length) {
  if (!place.world) return {};
  std::string words = place_words(*place.world, unit_length);
  for (const FieldValue& value : place.fields)
    if (value.inside) words += "   " + value.name + " " + value_words(value) + scene::after_number(value.unit);
  if (!place.object.empty()) words += "   " + place.object;
  return words;
}

}  // namespace catena::app
