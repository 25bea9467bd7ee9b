// SPDX-License-Identifier: MIT
#include "engine/app/cli/field_sampler.h"

#include <limits>

#include "engine/base/numbers.h"

namespace catena::app {

Result<FieldSampler> FieldSampler::load(scene::Scene& scene) {
  FieldSampler samples;
  std::vector<scene::Entity> fields;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource&) { fields.push_back(e); });
  for (const scene::Entity e : fields) {
    CATENA_TRY(field::AnyField field, scene::resolve_field(scene, e, scene.entities.get<scene::FieldSource>(e).where));
    samples.fields_.push_back({scene.entities.get<scene::Name>(e).value, std::move(field)});
  }
  return samples;
}

std::size_t FieldSampler::column_count() const {
  std::size_t n = 0;
  for (const NamedField& field : fields_) n += static_cast<std::size_t>(field.components());
  return n;
}

bool FieldSampler::NamedField::sample(const Vec3& world, double (&numbers)[3]) {
  if (field.scalar) {
    const field::ScalarSample s = field.scalar->sample(world, cursor);
    numbers[0] = s.value;
    return s.inside;
  }
  const field::VectorSample s = field.vector->sample(world, cursor);
  for (int a = 0; a < 3; ++a) numbers[a] = s.value[a];
  return s.inside;
}

std::string FieldSampler::csv_header() const {
  std::string line;
  for (const NamedField& field : fields_) {
    if (field.field.scalar) line += "," + field.name;
    for (const char* axis : {"_x", "_y", "_z"})
      if (field.field.vector) line += "," + field.name + axis;
  }
  return line;
}

void FieldSampler::append_csv_cells(std::string& line, const Vec3& world) {
  for (NamedField& field : fields_) {
    double numbers[3];
    const bool inside = field.sample(world, numbers);
    for (int c = 0; c < field.components(); ++c) {
      line += ',';
      if (inside) append_number(line, numbers[c]);
    }
  }
}

std::vector<mesh::PointValues> FieldSampler::sample_points(const std::vector<Vec3>& points) {
  std::vector<mesh::PointValues> all;
  for (NamedField& field : fields_) {
    mesh::PointValues values{field.name, field.components(), {}};
    values.values.reserve(points.size() * static_cast<std::size_t>(values.components));
    for (const Vec3& p : points) {
      double numbers[3];
      const bool inside = field.sample(p, numbers);
      for (int c = 0; c < values.components; ++c) values.values.push_back(inside ? numbers[c] : std::numeric_limits<double>::quiet_NaN());
    }
    all.push_back(std::move(values));
  }
  return all;
}

}  // namespace catena::app
