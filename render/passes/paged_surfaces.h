// SPDX-License-Identifier: MIT
/// Opaque isosurfaces of volumes that do not fit into the device's memory: pages of 16-bit numbers (paged_volume.h), one pool per field.
/// A number represents integers of 8 and 16 bits exactly (number_scale). Part of the isosurface pass. Frame thread.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/passes/pass.h"
#include "render/raycast/paged_volume.h"
#include "render/vk/pipeline.h"

namespace catena::render {

/// Pools and pipelines of the isosurfaces that are drawn from pages.
class PagedSurfaces {
 public:
  /// Prepares the pools of the items' fields, which are paged, drops others, and loads pages unless an image waits for them anyway. A field
  /// for whose pool the memory does not suffice has none.
  Outcome prepare(Frame& frame, const std::vector<const IsosurfaceItem*>& items);
  /// Returns whether an item has pages. Its grid in memory is not needed then.
  bool has_pages(const IsosurfaceItem& item) const { return item.paged && !item.color_by && pools_.contains(item.paged.get()); }
  /// Returns whether no item has pages.
  bool is_empty() const { return pools_.empty(); }
  /// Returns the pools.
  std::vector<PagedVolume*> pages();
  /// Returns a message about fields without a pool; empty: there are none.
  const std::string& warning() const { return warning_; }
  /// Returns a counter of changes to pools and pages.
  std::uint64_t version() const { return version_; }
  /// Returns the shader data of an item with pages.
  shared::GridData grid_data(const CameraRays& rays, const IsosurfaceItem& item) const;
  /// Draws an item with pages into the opaque targets. `uniform` holds the frame's data, with the item's as grid 0.
  Outcome draw(vk::Commands& commands, Frame& frame, const IsosurfaceItem& item, const vk::Buffer& uniform);
  /// Makes the visits of rays visible to the host. Outside of a rendering scope.
  void finish_visits(vk::Commands& commands);

 private:
  struct Pool {
    std::shared_ptr<const field::PagedGrid> grid;
    PagedVolume pages;
    std::vector<double> levels;  ///< of the items, rising
  };
  Outcome add_pool(Frame& frame, const std::shared_ptr<const field::PagedGrid>& grid, std::size_t sharers);
  Result<const vk::Pipeline*> pipeline(vk::Device& device, bool is_masked);

  std::map<const field::PagedGrid*, Pool> pools_;
  std::map<bool, vk::Pipeline> pipelines_;
  std::uint64_t version_ = 0, pages_version_ = 0;
  std::string warning_;
};

}  // namespace catena::render
