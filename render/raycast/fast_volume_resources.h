/// What the fast raycast reads of a volume: its codes, whole or as bricks, the pre-integrated table of its transfer function, the map of
/// what rays leap over, and gradients for light. Packed when the grid, the transfer function or the wish for gradients is new. Frame thread
/// only.
#pragma once
#include <optional>

#include "render/raycast/preintegrated.h"
#include "render/raycast/render_settings.h"
#include "render/residency/brick_map.h"
#include "render/residency/gradient_volume.h"
#include "render/residency/packed_atlas.h"
#include "render/residency/packed_volume.h"

namespace catena::render {

class FastVolumeResources {
 public:
  explicit FastVolumeResources(vk::Device& device) : device_(&device) {}
  /// Whether the grid of a volume can be packed in one of the two ways.
  static bool can_pack(const vk::Device& device, const field::ScalarGrid& grid);
  /// Whether 256 codes of the values take all that there is in the transfer function, and show the values that there are. Remembers the
  /// last answer of the thread.
  static bool can_quantize(const VolumeItem& item);
  /// An error where it takes more than `settings.max_bytes`, or than `left` bytes beside what it has; nothing here counts then.
  Outcome prepare(const VolumeItem& item, const FastSettings& settings, std::uint64_t left);

  const VolumeItem& item() const { return item_; }
  /// Counts what is packed and how it looks.
  std::uint64_t version() const { return appearance_version_; }
  bool is_bricked() const { return bricks_.has_value(); }
  bool is_masked() const { return !bricks_ && packed_.codes.has_mask; }
  /// Share of bricks that rays may leap over; of what is packed as bricks, all that are not kept.
  double skippable_share() const { return bricks_ ? 1 : map_.skippable_share; }
  const vk::Image& words() const { return bricks_ ? bricks_->atlas.words : packed_.words; }
  const vk::Image& table() const { return table_; }
  const vk::Image& map() const { return bricks_ ? bricks_->atlas.map : map_.image; }
  const vk::Image& gradients() const { return bricks_ ? bricks_->atlas.gradients : gradients_; }
  float gradient_nodes() const;  ///< of a brick, an axis; 0: of the whole volume, one a voxel
  /// Where its local positions are, as of a mirror without images.
  ResidentGrid local_geometry() const;
  double build_ms() const { return build_ms_; }

 private:
  Outcome pack_dense(bool gradients, bool other_range);
  Outcome pack_bricks(bool other_range, std::uint64_t most_bytes);
  Outcome upload_table(const PreintegratedTable& table);

  vk::Device* device_;
  VolumeItem item_;
  ValueInterval active_;
  std::uint64_t version_ = 0, appearance_version_ = 0;
  // either whole
  PackedVolume packed_;
  HomogeneousMap map_;
  vk::Image gradients_;
  // or as bricks
  struct Bricks {
    BrickScan scan;
    PackedAtlas atlas;
  };
  std::optional<Bricks> bricks_;
  vk::Image table_;
  double build_ms_ = 0;
};

}  // namespace catena::render
