// SPDX-License-Identifier: MIT
#include "engine/field/bricks/paged_grid.h"

#include <cmath>
#include <new>

namespace catena::field {
namespace {

/// Clamps a position in a cell to the cell.
Vec3 clamped_to_cell(const Vec3& f) {
  const auto axis = [](double x) { return std::min(std::max(x, 0.0), 1.0); };
  return {axis(f.x), axis(f.y), axis(f.z)};
}

}  // namespace

/// Cell cache in the cursor's memory.
struct PagedGrid::Cell {
  std::uint64_t version;
  const BrickSnapshot* bricks;
  Index3 base;
  bool valid, coarse;
  std::array<double, 8> corner;
};

PagedGrid::PagedGrid(std::shared_ptr<const BrickSource> source, const Part& part, std::shared_ptr<const ScalarGrid> coarse)
    : PagedGrid(std::make_shared<RecentBricks>(std::move(source)), part, std::move(coarse)) {}

PagedGrid::PagedGrid(std::shared_ptr<RecentBricks> bricks, const Part& part, std::shared_ptr<const ScalarGrid> coarse)
    : bricks_(std::move(bricks)), first_(part.first), counts_(brick_counts(source().levels().front())), coarse_(std::move(coarse)) {
  const Index3& size = part.size;
  CATENA_ASSERT(std::min({size.x, size.y, size.z}) >= 2 && coarse_->interpolation() != Interpolation::cubic);
  const Index3 last{size.x - 1, size.y - 1, size.z - 1};
  range_.set_box({0, 0, 0}, last);
  set_domain(coarse_->name(), part.mapping, {Vec3(0.0), Vec3(last.x, last.y, last.z)});
}

std::shared_ptr<const PagedGrid> PagedGrid::over(std::shared_ptr<const ScalarGrid> coarse, const Mapping& mapping) const {
  const Index3 last = range_.last_voxel();
  const Part part{first_, {last.x + 1, last.y + 1, last.z + 1}, mapping};
  return std::shared_ptr<const PagedGrid>(new PagedGrid(bricks_, part, std::move(coarse)));
}

AnyField with_interpolation(AnyField field, Interpolation linear_or_nearest) {
  const std::shared_ptr<const ScalarGrid> grid = field.scalar->grid()->with_interpolation(linear_or_nearest);
  field.scalar = grid;
  if (field.paged) field.paged = field.paged->over(grid, field.paged->mapping());
  return field;
}

BrickId PagedGrid::brick_id(const Index3& brick) const noexcept { return {version(), brick_number(counts_, brick)}; }

std::uint64_t PagedGrid::brick_count() const noexcept { return field::brick_count(counts_); }

Index3 PagedGrid::brick_at(std::uint64_t number) const noexcept { return field::brick_at(counts_, number); }

Index3 PagedGrid::brick_of(const Vec3& index) const noexcept {
  const Index3 last = range_.last_voxel();
  const auto axis = [](double x, std::int32_t first, std::int32_t last_voxel) {
    const double voxel = x >= 0 ? std::min(std::floor(x), static_cast<double>(last_voxel)) : 0;
    return (static_cast<std::int32_t>(voxel) + first) / kBrickEdge;
  };
  return {axis(index.x, first_.x, last.x), axis(index.y, first_.y, last.y), axis(index.z, first_.z, last.z)};
}

Result<std::shared_ptr<const Brick>> PagedGrid::read(const Index3& brick) const { return bricks_->read(0, brick); }

/// Returns the value of the coarse grid at a node of this grid.
double PagedGrid::coarse_value(const Vec3& index, Cursor& cursor) const noexcept {
  const Vec3 at = coarse_->mapping().index_from_world(mapping().world_from_index(index));
  const Index3 base = coarse_->cell_base(at);
  const ScalarCell cell = coarse_->cell(base, cursor);
  if (!cell.valid) return std::nan("");
  const Vec3 f = clamped_to_cell(position_in_cell(at, base));
  return interpolation() == Interpolation::nearest ? cell.corner[nearest_corner(f)] : cell.value(f);
}

/// Returns the cell at a valid base index.
const PagedGrid::Cell& PagedGrid::fetch(const Index3& base, Cursor& cursor) const noexcept {
  static_assert(sizeof(Cell) <= sizeof(Cursor::memory) && std::is_trivially_copyable_v<Cell>);
  Cell* cell = std::launder(reinterpret_cast<Cell*>(cursor.memory));
  if (cursor.owner == this && cell->version == version() && cell->bricks == cursor.bricks && cell->base == base) return *cell;
  cell = new (cursor.memory) Cell{version(), cursor.bricks, base, true, false, {}};
  cursor.owner = this;
  Cursor coarse;
  for (unsigned n = 0; n < 8; ++n) {
    const Index3 node{base.x + static_cast<std::int32_t>(n & 1), base.y + static_cast<std::int32_t>(n >> 1 & 1),
                      base.z + static_cast<std::int32_t>(n >> 2)};
    const Index3 voxel{node.x + first_.x, node.y + first_.y, node.z + first_.z};
    const Index3 at{voxel.x / kBrickEdge, voxel.y / kBrickEdge, voxel.z / kBrickEdge};
    const BrickId id = brick_id(at);
    const Brick* brick = cursor.bricks ? cursor.bricks->find(id) : nullptr;
    if (brick != nullptr) {
      cell->corner[n] = brick->value(voxel.x - at.x * kBrickEdge, voxel.y - at.y * kBrickEdge, voxel.z - at.z * kBrickEdge);
    } else {
      cell->corner[n] = static_cast<float>(coarse_value(Vec3(node.x, node.y, node.z), coarse));
      cell->coarse = true;
      cursor.missing_grid = id.grid;
      cursor.missing_brick = id.number;
    }
    cell->valid = cell->valid && std::isfinite(cell->corner[n]);
  }
  cursor.is_coarse = cursor.is_coarse || cell->coarse;
  return *cell;
}

ScalarSample PagedGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  ScalarSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const Cell& cell = fetch(range_.cell_base(index), cursor);
  const Vec3 position = position_in_cell(index, cell.base);
  if (interpolation() == Interpolation::nearest) {
    s.value = cell.corner[nearest_corner(position)];
  } else {
    Vec3 g;
    trilinear(cell.corner, position, s.value, g);
    s.gradient = mapping().world_from_index_gradient(g);
  }
  s.inside = cell.valid && index_box().contains(index, kDomainSlack);
  return s;
}

SampleStatus PagedGrid::status_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return SampleStatus::not_finite;
  if (!index_box().contains(index, kDomainSlack)) return SampleStatus::outside_box;
  return fetch(range_.cell_base(index), cursor).valid ? SampleStatus::ok : SampleStatus::not_finite;
}

ScalarCell PagedGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const Cell& cell = fetch(range_.clamp_base(base), cursor);
  return {cell.base, cell.valid, cell.corner};
}

}  // namespace catena::field
