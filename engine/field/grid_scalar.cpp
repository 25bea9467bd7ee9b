#include "engine/base/assert.h"
#include "engine/field/grid_storage.h"

namespace catena::field {
namespace {

using ScalarWalk = Walk<float, double>;
constexpr auto scalar_corner = [](float v) -> double { return v; };
constexpr auto finite_scalar_corner = [](double v) { return std::isfinite(v); };

ScalarWalk& walk_to(const ScalarGrid& grid, const ScalarGrid::Storage& storage, const Index3& base, Cursor& cursor) {
  ScalarWalk& walk = walk_of<ScalarWalk>(cursor, &grid, grid.version(), storage);
  if (!walk.filled || !(walk.base == base)) [[unlikely]]
    fetch(walk, storage, base, scalar_corner, finite_scalar_corner);
  return walk;
}

}  // namespace

ScalarGrid::ScalarGrid(std::string name, const Mapping& mapping, const Box& index_box, std::unique_ptr<Storage> storage,
                       const GridStats& stats)
    : storage_(std::move(storage)), stats_(stats) {
  CATENA_ASSERT(storage_ && storage_->values);
  set_domain(std::move(name), mapping, index_box);
}

ScalarGrid::~ScalarGrid() = default;

ScalarSample ScalarGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  ScalarSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const ScalarWalk& walk = walk_to(*this, *storage_, storage_->base_of(index), cursor);
  Vec3 g;
  trilinear(walk.corner, place_in_cell(index, walk.base), s.value, g);
  s.gradient = mapping().world_gradient(g);
  s.inside = walk.valid && index_box().contains(index, domain_slack);
  return s;
}

Reason ScalarGrid::why_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return Reason::not_finite;
  return reason_outside(walk_to(*this, *storage_, storage_->base_of(index), cursor), index_box(), index, finite_scalar_corner);
}

ScalarCell ScalarGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const ScalarWalk& walk = walk_to(*this, *storage_, storage_->clamp(base), cursor);
  ScalarCell c;
  c.base = walk.base;
  c.valid = walk.valid;
  c.corner = walk.corner;
  return c;
}

Index3 ScalarGrid::base_of(const Vec3& index) const noexcept { return storage_->base_of(index); }
std::size_t ScalarGrid::bytes() const noexcept { return storage_->bytes(); }
float ScalarGrid::background() const { return storage_->values->tree().background(); }
bool ScalarGrid::has_mask() const { return storage_->may_be_invalid; }

void ScalarGrid::read_block(const Index3& origin, const Index3& size, std::span<float> out) const {
  CATENA_ASSERT(out.size() >= static_cast<std::size_t>(size.x) * size.y * size.z);
  for_blocks(*storage_->values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const float* values = leaf ? leaf->data()->mValues : nullptr;
    const float constant = leaf ? 0.f : accessor.getValue(block);
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        float* row = out.data() + (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x)
          row[x - origin.x] = values ? values[(x & 7) * 64 + (y & 7) * 8 + (z & 7)] : constant;
      }
  });
}

void ScalarGrid::read_cell_valid(const Index3& origin, const Index3& size, std::span<std::uint8_t> out) const {
  CATENA_ASSERT(out.size() >= static_cast<std::size_t>(size.x) * size.y * size.z);
  Cursor cursor;
  std::size_t n = 0;
  for (std::int32_t z = origin.z; z < origin.z + size.z; ++z)
    for (std::int32_t y = origin.y; y < origin.y + size.y; ++y)
      for (std::int32_t x = origin.x; x < origin.x + size.x; ++x, ++n) {
        const Index3 base{x, y, z};
        out[n] = storage_->legal(base) && (!storage_->may_be_invalid || walk_to(*this, *storage_, base, cursor).valid);
      }
}

bool ScalarGrid::constant_block(const Index3& origin, float& value) const {
  const auto accessor = storage_->values->getAccessor();
  if (accessor.probeLeaf(coord(origin))) return false;
  value = accessor.getValue(coord(origin));
  return true;
}

}  // namespace catena::field
