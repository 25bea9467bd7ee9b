/// One volume, fast, with an error that is measured and not assumed (render/quality/quality.h): packed words, pre-integrated
/// table, Hermite midpoints, leaps over plain bricks; rays on a lattice of every 4th, 2nd or every pixel, refined where the fourth
/// difference of the picture says that interpolation would err.   lattice -> marks -> finer lattice -> .. -> every pixel
/// A grid of many voxels is packed as the bricks that its transfer function asks for. What cannot be drawn so (several volumes at once, too
/// many bricks) belongs to VolumeRaycast. Frame thread only.
#pragma once
#include <array>
#include <map>
#include <optional>

#include "render/mirror/brick_map.h"
#include "render/mirror/gradient_volume.h"
#include "render/mirror/packed_atlas.h"
#include "render/mirror/packed_volume.h"
#include "render/raycast/camera_rays.h"
#include "render/raycast/render_settings.h"
#include "render/raycast/still_tiles.h"
#include "render/raycast/transfer_tables.h"
#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

class FastVolumeRaycast {
 public:
  static Result<FastVolumeRaycast> create(vk::Device& device);
  /// Whether the grid of a volume can be packed in one of the two ways.
  static bool can_pack(const vk::Device& device, const field::ScalarGrid& grid);
  /// What is packed is too large to be held beside a mirror of its grid.
  bool is_large() const { return bricks_.has_value(); }
  /// Packs the volume, its table and its map, if they are new. An error where that takes more than `settings.most_bytes`.
  Outcome prepare(const VolumeItem& item, const FastSettings& settings);
  /// Draws into `target` (cleared first; of the picture's size), or into half() where the settings end there and `target` is null;
  /// not within a pass. `opaque_depth` null: nothing opaque, `none` is bound instead; else pixels near it are always marched and
  /// `target` is needed. `keep`: what `target` and the lattices hold since the last call stays where it would come out the same, to the
  /// bit.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, const VkRect2D& area,
                 const VkExtent3D& picture, vk::Image* target, const vk::Image* opaque_depth, const vk::Image& none, bool keep = false);
  /// Whether the last call left most of it as it was.
  bool has_kept() const { return has_kept_; }
  /// Something else has drawn into the target.
  void forget_target() { kept_.reset(); }
  /// Draws the rays of every `spacing`-th pixel alone into `target` (kVolumeFormat).
  Outcome record_probe(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, std::uint32_t spacing,
                       vk::Image& target, const vk::Image* opaque_depth, const vk::Image& none);
  /// Every 2nd pixel, for Upsampler.
  vk::Image& half() { return half_.color; }
  double build_ms() const { return build_ms_; }

 private:
  /// A lattice of rays: what it needs to be drawn.
  struct Level {
    vk::Image color, marks;
    vk::Buffer data;
  };
  FastVolumeRaycast() = default;
  Outcome ensure(Level& level, std::uint32_t spacing, const VkExtent3D& target);
  /// Which tiles of a lattice are drawn: the others stay as they are.
  enum class Tiles { all, marked, changed };
  using Constants = std::array<std::uint32_t, 7>;
  Result<const vk::Pipeline*> pipeline(const Constants& constants, Tiles tiles);
  Outcome pack_whole(const VolumeItem& item, bool gradients, bool other_range);
  Outcome pack_bricks(const VolumeItem& item, bool other_range, std::uint64_t most_bytes);
  Outcome upload_table(const PreintegratedTable& table);
  bool has_gradients() const { return bricks_ ? bool(bricks_->atlas.gradients) : bool(gradients_.image); }
  std::uint32_t shading(const FastSettings& settings) const { return item_.shade ? (settings.smooth_gradients ? 2 : 1) : 0; }
  float gradient_unit() const;
  float gradient_nodes() const { return bricks_ ? float(bricks_->atlas.gradient_nodes) : 0.0f; }
  Result<shared::FrameData> write_frame(const CameraRays& rays, const FastSettings& settings);
  Outcome mark(vk::Commands& commands, Level& level, vk::Image& coarser, bool opaque);
  /// What draws a level: its target, the coarser one (or null) and whether rays are marched.
  struct Draw {
    vk::Image* target = nullptr;
    const vk::Image* coarser = nullptr;
    bool marches = true;
    Tiles tiles = Tiles::all;
    std::uint32_t shading = 0;
    bool skips = true;
    VkRect2D area{};
    const vk::Image* opaque_depth = nullptr;
    const vk::Image* none = nullptr;
  };
  Outcome draw(vk::Commands& commands, Level& level, const Draw& draw);
  Outcome interpolate(vk::Commands& commands, vk::Image& half, vk::Image& target, const VkRect2D& area, bool keep);
  /// What a picture of rays follows from, beside what is opaque.
  struct Kept {
    shared::FrameData frame;
    FastSettings settings;
    std::uint64_t look = 0;
    const vk::Image* target = nullptr;
    VkImage target_image = VK_NULL_HANDLE;
    VkRect2D area{};
    bool opaque = false;
    bool is(const Kept& other) const;
  };

  vk::Device* device_ = nullptr;
  VolumeItem item_;
  ValueInterval active_;
  std::uint64_t version_ = 0;
  // either whole
  PackedVolume packed_;
  PlainMap map_;
  GradientVolume gradients_;
  // or as bricks
  struct Bricks {
    BrickScan scan;
    PackedAtlas atlas;
  };
  std::optional<Bricks> bricks_;
  vk::Image table_;
  vk::Image no_gradients_;  ///< one voxel, bound where shading does not ask for them
  vk::Sampler linear_;
  vk::Buffer frame_;
  Level quarter_, half_, full_, probe_;
  std::map<std::pair<Constants, Tiles>, vk::Pipeline> pipelines_;
  std::array<vk::Pipeline, 2> mark_pipelines_;         // without and with something opaque
  std::array<vk::Pipeline, 2> interpolate_pipelines_;  // of all, of what has changed
  vk::Buffer interpolate_data_;
  std::optional<StillTiles> opaque_;
  vk::Image no_tiles_;
  std::uint64_t look_ = 0;  ///< counts what is packed and how it looks
  std::optional<Kept> kept_;
  bool has_kept_ = false;
  double build_ms_ = 0;
};

/// One invocation a lattice point: what upsample.comp and interpolate.comp need for the pixels of an area.
struct UpsampleGroups {
  shared::UpsampleData data{};
  std::uint32_t x = 0, y = 0;
};
UpsampleGroups upsample_groups(const VkRect2D& area, const VkExtent3D& picture);

/// From a volume on every 2nd pixel to the finished picture, over opaque over background: what the pass `compose` does for the fast
/// raycast.
class Upsampler {
 public:
  explicit Upsampler(vk::Device& device) : device_(&device) {}
  /// Into `picture`. `opaque` null: there is nothing opaque, `none` is bound instead. `area`: the pixels that the volume may cover. Moves
  /// the images to their layouts.
  Outcome record(vk::Commands& commands, vk::Image& half_lattice, vk::Image* opaque, const vk::Image& none,
                 const std::array<float, 4>& background, const VkRect2D& area, vk::Image& picture);

 private:
  vk::Device* device_;
  std::array<vk::Pipeline, 2> pipelines_;  // without and with something opaque
  vk::Buffer uniform_;
};

}  // namespace catena::render
