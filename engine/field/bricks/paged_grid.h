// SPDX-License-Identifier: MIT
/// Scalar grid of which only some bricks are in memory, for haptics. The value of a node is
///   the stored voxel   where its brick is in the snapshot that the Cursor refers to
///   else               the trilinear value of a coarser level, which is in memory as a whole (nearest interpolation: of its nearest voxel)
/// so the field is continuous whichever bricks are there, and equal to the bit to a grid that is loaded as a whole where all are. The
/// cursor tells which was used. A cursor without a snapshot gets the coarse level. Statistics (range, largest gradient) are those of the
/// coarse level.
#pragma once
#include <memory>

#include "engine/field/bricks/brick_snapshot.h"
#include "engine/field/bricks/brick_source.h"
#include "engine/field/bricks/recent_bricks.h"
#include "engine/field/grid/cell_range.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Part of the finest level of a brick source, over a coarser grid. Immutable; any thread, each with its own Cursor.
class PagedGrid final : public CellField {
 public:
  /// Part of level 0 of a source.
  struct Part {
    Index3 first, size;  ///< First voxel; voxels along each axis, at least 2.
    Mapping mapping;     ///< World from index, of this part; `first` has the index (0, 0, 0).
  };
  /// `coarse` covers the same part of the world and has linear or nearest interpolation, which the grid takes over.
  PagedGrid(std::shared_ptr<const BrickSource> source, const Part& part, std::shared_ptr<const ScalarGrid> coarse);

  ScalarSample sample(const Vec3& world, Cursor& cursor) const noexcept override;
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override;
  ScalarCell cell(const Index3& base, Cursor& cursor) const noexcept override;
  Index3 cell_base(const Vec3& index) const noexcept override { return range_.cell_base(index); }
  const ScalarGrid& resident_grid() const noexcept override { return *coarse_; }
  /// Minimum of the coarse grid; finer voxels may be below it.
  double min_value() const noexcept override { return coarse_->min_value(); }
  /// Maximum of the coarse grid; finer voxels may be above it.
  double max_value() const noexcept override { return coarse_->max_value(); }
  Interpolation interpolation() const noexcept override { return coarse_->interpolation(); }
  std::size_t bytes() const noexcept override { return coarse_->bytes(); }

  /// Returns the same part of the source over another coarse grid, at the position of `mapping`.
  std::shared_ptr<const PagedGrid> over(std::shared_ptr<const ScalarGrid> coarse, const Mapping& mapping) const;
  /// Returns the source of the bricks.
  const BrickSource& source() const { return bricks_->source(); }
  /// Returns the bricks in memory, which all grids over the same source share.
  RecentBricks& bricks() const { return *bricks_; }
  /// Returns the voxel of the source's finest level that has the index (0, 0, 0).
  const Index3& first_voxel() const { return first_; }
  /// Returns the brick that contains a voxel of the grid's index space, clamped to the grid.
  Index3 brick_of(const Vec3& index) const noexcept;
  /// Returns the identity of a brick of the source's finest level.
  BrickId brick_id(const Index3& brick) const noexcept;
  /// Returns the number of bricks of the source's finest level.
  std::uint64_t brick_count() const noexcept;
  /// Returns the position of the brick with a number.
  Index3 brick_at(std::uint64_t number) const noexcept;
  /// Reads a brick. Blocks. The Error is a complete message.
  Result<std::shared_ptr<const Brick>> read(const Index3& brick) const;

 private:
  struct Cell;
  const Cell& fetch(const Index3& base, Cursor& cursor) const noexcept;
  double coarse_value(const Vec3& index, Cursor& cursor) const noexcept;

  PagedGrid(std::shared_ptr<RecentBricks> bricks, const Part& part, std::shared_ptr<const ScalarGrid> coarse);

  std::shared_ptr<RecentBricks> bricks_;
  Index3 first_, counts_;  ///< First voxel in level 0; bricks of level 0.
  CellRange range_;
  std::shared_ptr<const ScalarGrid> coarse_;
};

/// Returns the field with linear or nearest interpolation, and its paged grid too. The field is a scalar grid.
AnyField with_interpolation(AnyField field, Interpolation linear_or_nearest);

}  // namespace catena::field
