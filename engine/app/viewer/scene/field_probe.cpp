// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/field_probe.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/scene/labels.h"
#include "engine/scene/units.h"

namespace catena::app {

std::vector<FieldSample> sample_fields(const scene::Scene& scene, const Vec3& world) {
  std::vector<FieldSample> values;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    const field::AnyField& any = source.loaded.get() != nullptr ? source.loaded : source.rendered;
    if (any.get() == nullptr || !scene.entities.has<scene::Name>(e)) return;
    FieldSample value;
    value.name = scene.entities.get<scene::Name>(e).value;
    value.unit = scene::unit_of(scene, e);
    field::Cursor cursor;
    if (any.scalar) {
      const field::ScalarSample sample = any.scalar->sample(world, cursor);
      value.is_inside = sample.inside && std::isfinite(sample.value);
      value.value = sample.value;
      if (const scene::LabelMap* map = scene::find_label_map(scene, e)) {
        value.label = scene::describe_label(*map, sample.value);
        // a surface of labels runs between labeled and unlabeled voxels
        if (const double near = field::label_at(*any.scalar->grid(), world); sample.value == 0 && near != 0)
          value.label = "near " + scene::describe_label(*map, near);
      }
    } else {
      const field::VectorSample sample = any.vector->sample(world, cursor);
      value.is_inside = sample.inside && is_finite(sample.value);
      value.value = norm(sample.value);
      value.vector = sample.value;
    }
    values.push_back(std::move(value));
  });
  return values;
}

std::string format_sample(const FieldSample& value, bool components) {
  if (!value.is_inside) return "outside";
  if (!value.label.empty()) return value.label;
  std::string words = fmt::format("{:.4g}", value.value);
  if (components && value.vector) words += fmt::format(" ({:.4g}, {:.4g}, {:.4g})", value.vector->x, value.vector->y, value.vector->z);
  return words;
}

std::string format_point(const Vec3& world, const std::string& unit_length) {
  return fmt::format("{:.5g}, {:.5g}, {:.5g}{}", world.x, world.y, world.z, scene::unit_suffix(unit_length));
}

std::string format_point_samples(const PointSamples& samples, const std::string& unit_length) {
  if (!samples.world) return {};
  std::string words = format_point(*samples.world, unit_length);
  for (const FieldSample& value : samples.samples)
    if (value.is_inside) words += "   " + value.name + " " + format_sample(value) + scene::unit_suffix(value.unit);
  if (!samples.object.empty()) words += "   " + samples.object;
  return words;
}

}  // namespace catena::app
