// SPDX-License-Identifier: MIT
/// Device copy of a volume that does not fit into the device's memory: a pool of pages of mixed levels (page_table.h), for the fast
/// raycast. Rays count their visits in each entry of the page table; between images the pages that most of the image sees are loaded, and
/// others leave. Frame thread; pages are read by threads of its own (page_loader.h).
///   words        R16_UINT, slots of kPageEdge x kPageNodes x kPageNodes texels (page_loader.h)
///   sub-bricks   R8_UINT, per slot one texel for each 8^3 cells: as in HomogeneousMap (brick_map.h), within the page
///   map          R32_UINT, the words of the page table
///   visits       buffer of one number per entry of the page table
#pragma once
#include <memory>
#include <optional>

#include "render/raycast/camera_rays.h"
#include "render/residency/page_loader.h"
#include "render/residency/page_table.h"
#include "render/vk/resources.h"

namespace catena::render {

/// Pool of pages of one paged grid.
class PagedVolume {
 public:
  /// Creates the pool, of at most `max_bytes`, and starts the loader. An Error if the memory does not suffice.
  static Result<PagedVolume> create(vk::Device& device, std::shared_ptr<const field::PagedGrid> grid, std::uint64_t max_bytes);

  const field::PagedGrid& grid() const { return *grid_; }
  const CodeScale& codes() const { return codes_; }
  /// Sets what codes mean, before the first update; other codes remove all pages.
  Outcome set_codes(const CodeScale& codes, const CodeAppearance& appearance);
  /// Shows the pages that have been read, and requests those that the rays of the last image visited, as fine as a pixel. Waits for
  /// nothing. An Error if a transfer to the device fails.
  Outcome update();
  /// Loads the pages that the rays of the last image visited, of the finest level however small its voxels are in the image. Blocks.
  /// `only_if_they_fit`: none if a coarser level would have to do (PagePlan::bias).
  Outcome finish(bool only_if_they_fit);
  /// Sets the camera of the next image. `adds`: its rays are only some of the image, the others were not marched again.
  void begin_image(const CameraRays& rays, bool adds) {
    rays_ = rays;
    adds_visits_ = adds;
  }
  /// Returns the plan of the last update.
  const PagePlan& plan() const { return plan_; }
  /// Returns whether pages have been read that the next update will place.
  bool has_arrived() const { return loader_->has_arrived(); }
  /// Returns the number of pages loaded so far.
  std::uint64_t loaded_count() const { return loaded_count_; }
  /// Returns a counter of changes to the pages or the map.
  std::uint64_t version() const { return version_; }

  const vk::Image& words() const { return words_; }
  const vk::Image& sub_bricks() const { return sub_bricks_; }
  const vk::Image& map() const { return map_; }
  const vk::Buffer& levels() const { return levels_; }
  const vk::Buffer& visits() const { return visits_; }
  std::uint64_t bytes() const { return words_.bytes() + sub_bricks_.bytes() + map_.bytes() + visits_.size(); }

 private:
  PagedVolume(vk::Device& device, std::shared_ptr<const field::PagedGrid> grid, PageTable table)
      : device_(&device), grid_(std::move(grid)), table_(std::move(table)) {}
  Outcome create_images(const std::array<std::uint32_t, 3>& slots);
  int desired_level(const field::Index3& entry) const;
  void find_looks();
  void read_visits();
  void make_plan(bool is_final);
  Outcome load_roots();
  Outcome upload(std::vector<EncodedPage> pages);
  Outcome upload_sub_bricks(std::span<const std::size_t> slots);
  Outcome upload_map();

  vk::Device* device_;
  std::shared_ptr<const field::PagedGrid> grid_;
  PageTable table_;
  std::unique_ptr<PageLoader> loader_;
  CodeScale codes_;
  CodeAppearance appearance_;
  CameraRays rays_;
  PagePlan plan_;
  std::uint64_t version_ = 0, loaded_count_ = 0;
  bool adds_visits_ = false, has_new_looks_ = true;
  std::vector<std::uint32_t> last_visits_;
  std::vector<PageRanges> ranges_;  ///< of the page in each slot
  vk::Image words_, sub_bricks_, map_;
  vk::Buffer levels_, visits_, staging_;
};

}  // namespace catena::render
