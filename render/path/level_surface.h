// SPDX-License-Identifier: MIT
/// Exact intersection of rays and an isosurface of trilinear cells: along a ray, the value in a cell is a cubic polynomial.
#pragma once
#include <memory>

#include "render/frame/frame_packet.h"
#include "render/path/dense_grid.h"
#include "render/path/path_ray.h"

namespace catena::render {

/// Isosurface of a packet, for rays in display units. Immutable: any thread.
class LevelSurface {
 public:
  /// `grid`: the voxels of item.grid.
  LevelSurface(const IsosurfaceItem& item, std::shared_ptr<const DenseGrid> grid) : item_(&item), grid_(std::move(grid)) {}
  /// Item that is intersected.
  const IsosurfaceItem& item() const { return *item_; }
  /// Returns the first crossing between two distances.
  SurfaceHit intersect(const PathRay& ray, double from, double to) const;

 private:
  const IsosurfaceItem* item_;
  std::shared_ptr<const DenseGrid> grid_;
};

}  // namespace catena::render
