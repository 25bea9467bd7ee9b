// SPDX-License-Identifier: MIT
/// Parts of paged grids around the planes of slices (engine/field/bricks/slab.h), read by a thread, so that frames do not wait for them.
/// The planes that were requested last are retained. Frame thread.
#pragma once
#include <memory>

#include "engine/field/bricks/slab.h"

namespace catena::render {

/// Cache of slabs.
class SlabCache {
 public:
  SlabCache();
  ~SlabCache();
  SlabCache(SlabCache&&) noexcept;
  SlabCache& operator=(SlabCache&&) noexcept;

  /// Returns the slab of a plane; null: it is being read, cannot be read, or the plane does not meet the grid. `waits`: returns when it has
  /// been read. An Error if no thread can be started.
  Result<std::shared_ptr<const field::ScalarGrid>> get(const std::shared_ptr<const field::PagedGrid>& grid, const Vec3& point,
                                                       const Vec3& normal, bool waits);
  /// Returns whether a slab has been read that get() has not returned yet.
  bool has_arrived() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;  ///< Null until the first request.
};

}  // namespace catena::render
