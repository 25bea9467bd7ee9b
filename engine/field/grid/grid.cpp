// SPDX-License-Identifier: MIT
// Sampling of grids: finds the cell that contains a point and evaluates its polynomial.
#include "engine/field/grid/grid.h"

#include <cmath>

#include "engine/field/derived/halo.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {
namespace {

bool is_finite_corner(double v) { return std::isfinite(v); }
bool is_finite_corner(const Vec3& v) { return is_finite(v); }
constexpr auto to_corner = [](const auto& value) { return corner_value(value); };
constexpr auto finite_corner = [](const auto& corner) { return is_finite_corner(corner); };

template <class Grid>
struct WalksOf;
template <>
struct WalksOf<ScalarGrid> {
  using Linear = ScalarCellCache;
  using Cubic = CubicCellCache<float, double>;
};
template <>
struct WalksOf<VectorGrid> {
  using Linear = VectorCellCache;
  using Cubic = CubicCellCache<nanovdb::Vec3f, Vec3>;
};

/// Returns the cell cache for linear and nearest interpolation, filled with the corners of the cell at `base`.
template <class Grid>
typename WalksOf<Grid>::Linear& linear_walk(const Grid& grid, const typename Grid::Storage& storage, const Index3& base, Cursor& cursor) {
  auto& walk = cell_cache<typename WalksOf<Grid>::Linear>(cursor, &grid, grid.version(), storage);
  if (!walk.filled || !(walk.base == base)) [[unlikely]]
    fetch_cell(walk, storage, base, to_corner, finite_corner);
  return walk;
}

/// Returns the cell cache for cubic interpolation; if the cell is valid, it also holds the samples around it.
template <class Grid>
typename WalksOf<Grid>::Cubic& cubic_walk(const Grid& grid, const typename Grid::Storage& storage, const typename Grid::Halo& ghosts,
                                          const Index3& base, Cursor& cursor) {
  auto& walk = cell_cache<typename WalksOf<Grid>::Cubic>(cursor, &grid, grid.version(), storage, *ghosts.grid);
  if (!walk.filled || !(walk.base == base)) [[unlikely]] {
    fetch_cell(walk, storage, base, to_corner, finite_corner);
    if (walk.valid) fetch_cubic_samples(walk, storage, base);
  }
  return walk;
}

/// Returns the cell cache of the grid's interpolation, which is the same for every call with one cursor; `ghosts` is null unless it is
/// cubic.
template <class Grid>
typename WalksOf<Grid>::Linear& walk_to(const Grid& grid, const typename Grid::Storage& storage, const typename Grid::Halo* ghosts,
                                        const Index3& base, Cursor& cursor) {
  return ghosts ? cubic_walk(grid, storage, *ghosts, base, cursor) : linear_walk(grid, storage, base, cursor);
}

}  // namespace

ScalarGrid::ScalarGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage,
                       const GridStats& stats, Interpolation interpolation, std::shared_ptr<const Halo> ghosts)
    : storage_(std::move(storage)), stats_(stats), interpolation_(interpolation), halo_(std::move(ghosts)) {
  CATENA_ASSERT(storage_ && storage_->values && (interpolation_ == Interpolation::cubic) == (halo_ != nullptr));
  set_domain(std::move(name), mapping, index_box);
}

ScalarGrid::~ScalarGrid() = default;

std::shared_ptr<const ScalarGrid> ScalarGrid::with_interpolation(Interpolation interpolation) const {
  return std::make_shared<ScalarGrid>(name(), mapping(), index_box(), storage_, stats_, interpolation);
}

std::shared_ptr<const ScalarGrid> ScalarGrid::with_mapping(const Mapping& mapping) const {
  return std::make_shared<ScalarGrid>(name(), mapping, index_box(), storage_, stats_, interpolation_, halo_);
}

Result<std::shared_ptr<const ScalarGrid>> ScalarGrid::as_cubic() const {
  CATENA_TRY(auto halo, make_halo(*storage_, stats_));
  auto ghosts = std::make_shared<const Halo>(Halo{std::move(halo)});
  return std::shared_ptr<const ScalarGrid>(
      std::make_shared<ScalarGrid>(name(), mapping(), index_box(), storage_, stats_, Interpolation::cubic, std::move(ghosts)));
}

ScalarSample ScalarGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  ScalarSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const Index3 base = storage_->cell_base(index);
  if (halo_) {
    const auto& walk = cubic_walk(*this, *storage_, *halo_, base, cursor);
    if (walk.valid) {
      const auto cubic = field::cubic<1>(walk.samples, position_in_cell(index, base));
      s.value = cubic.value[0];
      s.gradient = mapping().world_from_index_gradient({cubic.slope[0][0], cubic.slope[1][0], cubic.slope[2][0]});
      s.inside = index_box().contains(index, kDomainSlack);
      return s;
    }
  }
  const ScalarCellCache& walk = walk_to(*this, *storage_, halo_.get(), base, cursor);
  const Vec3 position = position_in_cell(index, walk.base);
  if (interpolation_ != Interpolation::nearest) [[likely]] {
    Vec3 g;
    trilinear(walk.corner, position, s.value, g);
    s.gradient = mapping().world_from_index_gradient(g);
  } else {
    s.value = walk.corner[(position.x >= 0.5 ? 1u : 0u) + (position.y >= 0.5 ? 2u : 0u) + (position.z >= 0.5 ? 4u : 0u)];
  }
  s.inside = walk.valid && index_box().contains(index, kDomainSlack);
  return s;
}

SampleStatus ScalarGrid::status_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return SampleStatus::not_finite;
  return cell_status(walk_to(*this, *storage_, halo_.get(), storage_->cell_base(index), cursor), index_box(), index, finite_corner);
}

const CubicSamples<1>* ScalarGrid::cubic_samples(const Index3& base, Cursor& cursor) const noexcept {
  if (!halo_ || !storage_->is_legal_base(base)) return nullptr;
  const auto& walk = cubic_walk(*this, *storage_, *halo_, base, cursor);
  return walk.valid ? &walk.samples : nullptr;
}

ScalarCell ScalarGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const ScalarCellCache& walk = walk_to(*this, *storage_, halo_.get(), storage_->clamp_base(base), cursor);
  ScalarCell c;
  c.base = walk.base;
  c.valid = walk.valid;
  c.corner = walk.corner;
  return c;
}

Index3 ScalarGrid::cell_base(const Vec3& index) const noexcept { return storage_->cell_base(index); }
std::size_t ScalarGrid::bytes() const noexcept { return storage_->bytes() + (halo_ ? halo_->memory.size() : 0); }
float ScalarGrid::background() const { return storage_->values->tree().background(); }
bool ScalarGrid::has_mask() const { return storage_->has_invalid_cells; }
bool ScalarGrid::has_cell_mask() const { return storage_->has_cell_mask; }
double ScalarGrid::min_value() const noexcept { return storage_->data_range ? storage_->data_range->data_min : stats_.min; }
double ScalarGrid::max_value() const noexcept { return storage_->data_range ? storage_->data_range->data_max : stats_.max; }

VectorGrid::VectorGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage,
                       const GridStats& stats, std::shared_ptr<const Halo> ghosts)
    : storage_(std::move(storage)), stats_(stats), halo_(std::move(ghosts)) {
  CATENA_ASSERT(storage_ && storage_->values);
  set_domain(std::move(name), mapping, index_box);
}

VectorGrid::~VectorGrid() = default;

Result<std::shared_ptr<const VectorGrid>> VectorGrid::as_cubic() const {
  CATENA_TRY(auto halo, make_halo(*storage_, stats_));
  auto ghosts = std::make_shared<const Halo>(Halo{std::move(halo)});
  return std::shared_ptr<const VectorGrid>(
      std::make_shared<VectorGrid>(name(), mapping(), index_box(), storage_, stats_, std::move(ghosts)));
}

std::shared_ptr<const VectorGrid> VectorGrid::as_linear() const {
  return std::make_shared<VectorGrid>(name(), mapping(), index_box(), storage_, stats_);
}

const CubicSamples<3>* VectorGrid::cubic_samples(const Index3& base, Cursor& cursor) const noexcept {
  if (!halo_ || !storage_->is_legal_base(base)) return nullptr;
  const auto& walk = cubic_walk(*this, *storage_, *halo_, base, cursor);
  return walk.valid ? &walk.samples : nullptr;
}

VectorSample VectorGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  VectorSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const Index3 base = storage_->cell_base(index);
  if (halo_) {
    const auto& walk = cubic_walk(*this, *storage_, *halo_, base, cursor);
    if (walk.valid) {
      s.value = cubic_vector(walk.samples, position_in_cell(index, base));
      s.inside = index_box().contains(index, kDomainSlack);
      return s;
    }
  }
  const VectorCellCache& walk = walk_to(*this, *storage_, halo_.get(), base, cursor);
  s.value = trilinear(walk.corner, position_in_cell(index, walk.base));
  s.inside = walk.valid && index_box().contains(index, kDomainSlack);
  return s;
}

LineSample VectorGrid::sample_line(const Vec3& world, Cursor& cursor) const noexcept {
  LineSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const VectorCellCache& walk = walk_to(*this, *storage_, halo_.get(), storage_->cell_base(index), cursor);
  static_cast<LineAxis&>(s) = line_axis(walk.corner, position_in_cell(index, walk.base));
  s.inside = walk.valid && index_box().contains(index, kDomainSlack);
  return s;
}

SampleStatus VectorGrid::status_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return SampleStatus::not_finite;
  return cell_status(walk_to(*this, *storage_, halo_.get(), storage_->cell_base(index), cursor), index_box(), index, finite_corner);
}

VectorCell VectorGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const VectorCellCache& walk = walk_to(*this, *storage_, halo_.get(), storage_->clamp_base(base), cursor);
  VectorCell c;
  c.base = walk.base;
  c.valid = walk.valid;
  c.corner = walk.corner;
  return c;
}

Index3 VectorGrid::cell_base(const Vec3& index) const noexcept { return storage_->cell_base(index); }
std::size_t VectorGrid::bytes() const noexcept { return storage_->bytes() + (halo_ ? halo_->memory.size() : 0); }
bool VectorGrid::has_mask() const { return storage_->has_invalid_cells; }
double VectorGrid::min_magnitude() const noexcept { return storage_->data_range ? storage_->data_range->data_min : stats_.min; }
double VectorGrid::max_magnitude() const noexcept { return storage_->data_range ? storage_->data_range->data_max : stats_.max; }

}  // namespace catena::field
