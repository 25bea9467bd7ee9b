// SPDX-License-Identifier: MIT
/// Device copy of a volume that does not fit into the device's memory: a pool of pages of mixed levels (page_table.h), for the fast
/// raycast, isosurfaces and projections. Several grids with the same pages, the channels of a data set, share the pool. Rays count their
/// visits in each entry of the page table; between images the pages that most of the image sees are loaded, and others leave. Frame
/// thread; pages are read by threads of its own (page_loader.h).
///   words        R16_UINT, slots of page_width() x kPageNodes x kPageNodes texels (page_loader.h); two or four components for channels
///   sub-bricks   R8_UINT, per slot one texel (SubBrickTexels) for each 8^3 cells
///   map          R32_UINT, the words of the page table
///   visits       buffer of one number per entry of the page table
#pragma once
#include <algorithm>
#include <memory>
#include <optional>

#include "render/raycast/camera_rays.h"
#include "render/residency/page_loader.h"
#include "render/residency/page_table.h"
#include "render/vk/commands.h"

namespace catena::render {

/// What the texels of sub-bricks are.
enum class SubBrickTexels {
  distances,  ///< as in HomogeneousMap (brick_map.h), within the page; of several channels, parts that are invisible in all
  maxima,     ///< of numbers: 0 if no cell is valid, else the upper end of the range
  minima      ///< of numbers: 0 if no cell is valid, else 255 minus the lower end of the range
};

/// Returns the scale of numbers (PageFormat::numbers) of a grid: all values of an integer type of 8 or 16 bits; else the display range of
/// the level in memory, which leaves out outliers, and twice its extent on either side, and `needed`. Values beyond are clamped.
CodeScale number_scale(const field::PagedGrid& grid, const ValueInterval& needed);

/// Returns how many of `left` bytes of the device one of `sharers` pools may have.
std::uint64_t page_pool_bytes(const vk::Device& device, std::uint64_t left, std::size_t sharers);

/// Adds the bindings of the page table's data (shaders/lib/page_table.glsl), except its words and the image of codes, whose numbers other
/// volumes use, too.
void add_page_layout(std::vector<vk::LayoutBinding>& slots);

/// Returns whether two grids have the same pages at the same positions.
bool have_same_pages(const field::PagedGrid& a, const field::PagedGrid& b);

/// Pool of pages of one paged grid, or of several with the same pages.
class PagedVolume {
 public:
  /// Creates the pool, of at most `max_bytes`, and starts the loader. An Error if the memory does not suffice.
  static Result<PagedVolume> create(vk::Device& device, ChannelGrids grids, PageFormat format, std::uint64_t max_bytes);

  const ChannelGrids& grids() const { return grids_; }
  /// Returns the first grid.
  const field::PagedGrid& grid() const { return *grids_.front(); }
  const ChannelCodes& codes() const { return codes_; }
  /// Returns whether cells of a channel may be invalid.
  bool is_masked() const { return std::ranges::any_of(codes_, &CodeScale::has_mask); }
  /// Sets what codes mean, before the first update; other codes remove all pages. `appearances`: of the units of CodeRange, one of each
  /// channel.
  Outcome set_codes(ChannelCodes codes, std::vector<CodeAppearance> appearances);
  /// Sets the codes of a single channel, for projections: only a constant value is homogeneous.
  Outcome set_codes(const CodeScale& codes, SubBrickTexels texels);
  /// Shows the pages that have been read, and requests those that the rays of the last image visited, as fine as a pixel. Waits for
  /// nothing. An Error if a transfer to the device fails.
  Outcome update();
  /// Loads the pages that the rays of the last image visited, as fine as a pixel or, if `finest`, of the finest level. Blocks.
  /// `only_if_they_fit`: none if a coarser level would have to do (PagePlan::bias).
  Outcome finish(bool finest, bool only_if_they_fit);
  /// Sets the camera of the next image. `adds`: its rays are only some of the image, the others were not marched again.
  void begin_image(const CameraRays& rays, bool adds) {
    rays_ = rays;
    adds_visits_ = adds;
  }
  /// Adds what add_page_layout() lists.
  void add_bindings(std::vector<vk::Binding>& bindings) const;
  /// Makes the visits of rays visible to the host. Outside of a rendering scope.
  void finish_visits(vk::Commands& commands);
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
  std::uint64_t bytes() const { return words_.bytes() + sub_bricks_.bytes() + map_.bytes() + visits_.size(); }
  /// Returns whether each level's voxels are exactly those that halving the finest ones makes.
  bool halves_voxels() const;
  /// Returns the local coordinates, which are voxels of the source's finest level, as those of a resident grid without images.
  ResidentGrid local_geometry() const;

 private:
  PagedVolume(vk::Device& device, ChannelGrids grids, PageFormat format, PageTable table)
      : device_(&device), grids_(std::move(grids)), format_(format), table_(std::move(table)) {}
  std::size_t page_bytes() const { return page_words(format_) * texel_words(grids_.size()) * sizeof(std::uint16_t); }
  struct Codes;
  std::uint16_t classify(std::span<const CodeRange> ranges) const;
  PageLook look_of(std::span<const Codes> codes) const;
  Outcome change_codes(ChannelCodes codes);
  std::vector<std::uint8_t> sub_brick_texels(std::size_t slot) const;
  Outcome create_images(const std::array<std::uint32_t, 3>& slots);
  int desired_level(const field::Index3& entry) const;
  void find_looks();
  void read_visits();
  void make_plan(bool finest, bool stepwise);
  Outcome load_roots();
  Outcome upload(std::vector<EncodedPage> pages);
  Outcome upload_sub_bricks(std::span<const std::size_t> slots);
  Outcome upload_map();

  vk::Device* device_;
  ChannelGrids grids_;
  PageFormat format_;
  PageTable table_;
  std::vector<bool> is_costly_;  ///< per level: bricks are costly to read
  std::unique_ptr<PageLoader> loader_;
  ChannelCodes codes_;
  std::vector<CodeAppearance> appearances_;  ///< empty: for projections
  SubBrickTexels texels_ = SubBrickTexels::distances;
  CameraRays rays_;
  PagePlan plan_;
  std::uint64_t version_ = 0, loaded_count_ = 0;
  bool adds_visits_ = false, has_new_looks_ = true;
  std::vector<std::uint32_t> last_visits_;
  std::vector<std::vector<PageRanges>> ranges_;  ///< of the channels of the page in each slot
  vk::Image words_, sub_bricks_, map_;
  vk::Buffer levels_, visits_, staging_;
};

}  // namespace catena::render
