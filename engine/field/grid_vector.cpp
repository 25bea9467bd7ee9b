#include "engine/base/assert.h"
#include "engine/field/grid_storage.h"

namespace catena::field {
namespace {

using VectorWalk = Walk<nanovdb::Vec3f, Vec3>;
constexpr auto vector_corner = [](const nanovdb::Vec3f& v) { return Vec3(v[0], v[1], v[2]); };
constexpr auto finite_vector_corner = [](const Vec3& v) { return is_finite(v); };

VectorWalk& walk_to(const VectorGrid& grid, const VectorGrid::Storage& storage, const Index3& base, Cursor& cursor) {
  VectorWalk& walk = walk_of<VectorWalk>(cursor, &grid, grid.version(), storage);
  if (!walk.filled || !(walk.base == base)) [[unlikely]]
    fetch(walk, storage, base, vector_corner, finite_vector_corner);
  return walk;
}

}  // namespace

VectorGrid::VectorGrid(std::string name, const Mapping& mapping, const Box& index_box, std::unique_ptr<Storage> storage,
                       const GridStats& stats)
    : storage_(std::move(storage)), stats_(stats) {
  CATENA_ASSERT(storage_ && storage_->values);
  set_domain(std::move(name), mapping, index_box);
}

VectorGrid::~VectorGrid() = default;

VectorSample VectorGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  VectorSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const VectorWalk& walk = walk_to(*this, *storage_, storage_->base_of(index), cursor);
  s.value = trilinear(walk.corner, place_in_cell(index, walk.base));
  s.inside = walk.valid && index_box().contains(index, domain_slack);
  return s;
}

LineSample VectorGrid::sample_line(const Vec3& world, Cursor& cursor) const noexcept {
  LineSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const VectorWalk& walk = walk_to(*this, *storage_, storage_->base_of(index), cursor);
  static_cast<LineAxis&>(s) = line_axis(walk.corner, place_in_cell(index, walk.base));
  s.inside = walk.valid && index_box().contains(index, domain_slack);
  return s;
}

Reason VectorGrid::why_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return Reason::not_finite;
  return reason_outside(walk_to(*this, *storage_, storage_->base_of(index), cursor), index_box(), index, finite_vector_corner);
}

VectorCell VectorGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const VectorWalk& walk = walk_to(*this, *storage_, storage_->clamp(base), cursor);
  VectorCell c;
  c.base = walk.base;
  c.valid = walk.valid;
  c.corner = walk.corner;
  return c;
}

Index3 VectorGrid::base_of(const Vec3& index) const noexcept { return storage_->base_of(index); }
std::size_t VectorGrid::bytes() const noexcept { return storage_->bytes(); }
bool VectorGrid::has_mask() const { return storage_->may_be_invalid; }

void VectorGrid::read_block(const Index3& origin, const Index3& size, std::span<float> xyz_out) const {
  CATENA_ASSERT(xyz_out.size() >= 3 * static_cast<std::size_t>(size.x) * size.y * size.z);
  for_blocks(*storage_->values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const nanovdb::Vec3f* values = leaf ? leaf->data()->mValues : nullptr;
    const nanovdb::Vec3f constant = leaf ? nanovdb::Vec3f(0.f) : accessor.getValue(block);
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        float* row = xyz_out.data() + 3 * (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x) {
          const nanovdb::Vec3f& v = values ? values[(x & 7) * 64 + (y & 7) * 8 + (z & 7)] : constant;
          for (int c = 0; c < 3; ++c) row[3 * (x - origin.x) + c] = v[c];
        }
      }
  });
}

}  // namespace catena::field
