// SPDX-License-Identifier: MIT
/// Device resources of the fast raycast for one volume, or for several paged ones with the same pages (channels): its packed codes (dense,
/// as bricks, or paged), the pre-integrated tables of the transfer functions, the map of bricks that rays skip, and gradients for shading.
/// Rebuilt when the grid, the transfer function or the need
/// for gradients changes. Frame thread only.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "render/raycast/paged_volume.h"
#include "render/raycast/preintegrated.h"
#include "render/raycast/render_settings.h"
#include "render/residency/brick_map.h"
#include "render/residency/gradient_volume.h"
#include "render/residency/packed_atlas.h"
#include "render/residency/packed_volume.h"

namespace catena::render {

/// Packed form of one volume. Owns its images.
class FastVolumeResources {
 public:
  explicit FastVolumeResources(vk::Device& device) : device_(&device) {}
  /// Returns whether the grid can be packed, dense or as bricks.
  static bool can_pack(const vk::Device& device, const field::ScalarGrid& grid);
  /// Returns whether 256 codes resolve all features of the transfer function and represent the values with a small error; those of a paged
  /// volume are dithered if the error would be larger. Caches the last result per thread.
  static bool can_quantize(const VolumeItem& item);
  /// Packs what changed, and loads pages of a paged volume if `loads`. An Error if it takes more than `settings.permitted_bytes`, or more
  /// than `left` bytes in addition to what it holds; the content is not usable then.
  Outcome prepare(std::span<const VolumeItem> items, const FastSettings& settings, std::uint64_t left, bool loads);

  /// Returns the volumes; more than one only if they are paged.
  const std::vector<VolumeItem>& items() const { return items_; }
  /// Returns a counter of changes to the packed data or the appearance.
  std::uint64_t version() const { return appearance_version_; }
  bool is_bricked() const { return bricks_.has_value(); }
  /// Returns the shaders' constant 5: of packed.glsl whether the volume is bricked, of page_table.glsl whether levels halve voxels.
  bool is_regular() const { return pages_ ? pages_->halves_voxels() : is_bricked(); }
  /// Returns the pages; null: the volume is not paged.
  PagedVolume* pages() { return pages_ ? &*pages_ : nullptr; }
  const PagedVolume* pages() const { return pages_ ? &*pages_ : nullptr; }
  bool is_masked() const { return pages_ ? pages_->is_masked() : !bricks_ && packed_.codes.has_mask; }
  /// Returns whether codes are dithered, so that rays interpolate the tables between codes.
  bool is_dithered() const { return pages_ && std::ranges::any_of(pages_->codes(), &CodeScale::is_dithered); }
  /// Returns the share of bricks that rays may skip (0 to 1); 1 if packed as bricks or paged.
  double skippable_share() const { return bricks_ || pages_ ? 1 : map_.skippable_share; }
  /// Returns the field whose index space the local coordinates are relative to.
  const field::Field& domain() const { return pages_ ? static_cast<const field::Field&>(pages_->grid()) : *item().grid; }
  /// Returns the image of packed codes: PagedVolume::words, PackedAtlas::words or PackedVolume::words.
  const vk::Image& words() const { return pages_ ? pages_->words() : bricks_ ? bricks_->atlas.words : packed_.words; }
  /// Returns the pre-integrated tables, one below the other.
  const vk::Image& table() const { return table_; }
  /// Returns the map of bricks that rays skip: PagedVolume::map, PackedAtlas::map or HomogeneousMap::image.
  const vk::Image& map() const { return pages_ ? pages_->map() : bricks_ ? bricks_->atlas.map : map_.image; }
  /// Returns the gradients; empty without smooth gradients.
  const vk::Image& gradients() const { return bricks_ ? bricks_->atlas.gradients : gradients_; }
  float gradient_nodes() const;  ///< gradient samples per brick and axis; 0: one gradient per voxel of the whole volume
  /// Returns the local coordinates as those of a resident grid without images.
  ResidentGrid local_geometry() const;
  double build_ms() const { return build_ms_; }

 private:
  Outcome pack_dense(bool gradients, bool other_range);
  Outcome pack_bricks(bool other_range, std::uint64_t permitted_bytes);
  Outcome prepare_pages(std::span<const VolumeItem> items, std::uint64_t permitted_bytes, bool loads);
  Outcome upload_tables(std::span<const PreintegratedTable> tables);
  const VolumeItem& item() const { return items_.front(); }

  vk::Device* device_;
  std::vector<VolumeItem> items_;
  ValueInterval active_;
  std::uint64_t version_ = 0, appearance_version_ = 0;
  // Dense packing.
  PackedVolume packed_;
  HomogeneousMap map_;
  vk::Image gradients_;
  // Packing as bricks.
  struct Bricks {
    BrickScan scan;
    PackedAtlas atlas;
  };
  std::optional<Bricks> bricks_;
  std::optional<PagedVolume> pages_;
  vk::Image table_;
  double build_ms_ = 0;
};

}  // namespace catena::render
