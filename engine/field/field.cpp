// SPDX-License-Identifier: MIT
#include "engine/field/field.h"

#include <atomic>

namespace catena::field {
namespace {
std::atomic<std::uint64_t> next_version{1};
}

void Field::set_domain(std::string name, const Mapping& mapping, const Box& index_box) {
  name_ = std::move(name);
  mapping_ = mapping;
  index_box_ = index_box;
  version_ = next_version.fetch_add(1);
  const Vec3 size = index_box.hi - index_box.lo;
  domain_length_ = max_voxel_edge_ = 0;
  for (int a = 0; a < 3; ++a) {
    const double edge = norm(mapping.world_from_index_linear[a]);
    max_voxel_edge_ = std::max(max_voxel_edge_, edge);
    domain_length_ = std::max(domain_length_, edge * size[a]);
  }
}

std::string no_surface_hint(const ScalarField& field, const std::string& name) {
  if (field.interpolation() != Interpolation::nearest) return {};
  return "field \"" + name + "\" has the interpolation \"nearest\", which has no isosurfaces; a field {\"label\": NUMBER, \"of\": \"" +
         name + "\"} at level 0.5, or \"interpolation\": \"linear\", was expected";
}

SampleStatus Field::status_outside(const Vec3& world, Cursor&) const noexcept {
  return is_finite(world) ? SampleStatus::masked : SampleStatus::not_finite;
}

LineSample VectorField::sample_line(const Vec3& world, Cursor& cursor) const noexcept {
  const VectorSample vector_sample = sample(world, cursor);
  LineSample s;
  s.axis = direction(vector_sample.value);
  s.speed = norm(vector_sample.value);
  s.coherence = s.speed > 0 ? 1 : 0;
  s.inside = vector_sample.inside;
  return s;
}

}  // namespace catena::field
