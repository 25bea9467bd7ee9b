/// One volume, fast, with an error that is measured and not assumed (render/quality/quality.h): packed words, pre-integrated
/// table, Hermite midpoints, leaps over plain bricks; rays on a lattice of every 4th, 2nd or every pixel, refined where the fourth
/// difference of the picture says that interpolation would err.   lattice -> marks -> finer lattice -> .. -> every pixel
/// A grid of many voxels is packed as the bricks that its transfer function asks for. What cannot be drawn so (several volumes at once, too
/// many bricks) belongs to VolumeRaycast. Frame thread only.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "render/raycast/camera_rays.h"
#include "render/raycast/dirty_tiles.h"
#include "render/raycast/fast_volume_resources.h"
#include "render/raycast/render_settings.h"
#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

class FastVolumeRaycast {
 public:
  static Result<FastVolumeRaycast> create(vk::Device& device);
  /// Packs the volume, if it is new. `left`: bytes of the device that it may take beside what it has.
  Outcome prepare(const VolumeItem& item, const FastSettings& settings, std::uint64_t left) {
    return resources_.prepare(item, settings, left);
  }
  /// What follows is one of so many eyes' pictures: each keeps its own from picture to picture.
  void select_eye(std::size_t eye, std::size_t eyes) {
    eye_states_.resize(eyes);
    eye_index_ = eye;
  }
  /// What is packed is too large to be held beside a mirror of its grid.
  bool is_bricked() const { return resources_.is_bricked(); }
  /// Draws into `target` (cleared first; of the picture's size), or into half() where the settings end there and `target` is null;
  /// not within a pass. `opaque_depth` null: nothing opaque, `none` is bound instead; else pixels near it are always marched and
  /// `target` is needed. `keep`: what `target` and the lattices hold since the last call stays where it would come out the same, to the
  /// bit.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, const VkRect2D& area,
                 const VkExtent3D& picture, vk::Image* target, const vk::Image* opaque_depth, const vk::Image& none, bool keep = false);
  /// Whether the last call left most of it as it was.
  bool reused_previous() const { return reused_previous_; }
  /// The tiles that the last call has marched again, where it has kept the others; null: it has not, or nothing was opaque.
  vk::Image* dirty_tiles() {
    return reused_previous_ && eye_state().reuse->state.has_opaque ? &eye_state().opaque_tiles->dirty_tiles() : nullptr;
  }
  /// What the last call has marched beside its first lattice, of every 2nd pixel and of every pixel: blocks of 4 x 4 rays, R8_UINT, 1:
  /// marched. Null: none of that lattice.
  std::array<vk::Image*, 2> marked_blocks() {
    return {marched_half_ ? &eye_state().half.marks : nullptr, marched_full_ ? &eye_state().full.marks : nullptr};
  }
  /// Something else has drawn into the eye's target.
  void invalidate_target() { eye_state().reuse.reset(); }
  /// Draws the rays of every `spacing`-th pixel alone into `target` (kVolumeFormat).
  Outcome record_ray_samples(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, std::uint32_t spacing,
                             vk::Image& target, const vk::Image* opaque_depth, const vk::Image& none);
  /// The same rays; instead of colours the depth t at which alpha passes 0.5 (red), NO_DEPTH where it never does.
  Outcome record_half_opacity_depth(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, std::uint32_t spacing,
                                    vk::Image& target, const vk::Image* opaque_depth, const vk::Image& none);
  /// Every 2nd pixel, for Upsampler.
  vk::Image& half_resolution() { return eye_state().half.color; }
  /// Rays leap over what is empty.
  bool skips_empty_space() const;
  std::uint64_t grid_bytes() const { return resources_.words().bytes() + resources_.gradients().bytes(); }
  double build_ms() const { return resources_.build_ms(); }

 private:
  /// A lattice of rays: what it needs to be drawn.
  struct RayGrid {
    vk::Image color, marks;
    vk::Buffer data;
  };
  explicit FastVolumeRaycast(vk::Device& device) : device_(&device), resources_(device) {}
  Outcome ensure(RayGrid& level, std::uint32_t spacing, const VkExtent3D& target);
  /// Which tiles of a lattice are drawn: the others stay as they are.
  enum class Tiles { all, marked, dirty };
  using Constants = std::array<std::uint32_t, 8>;
  Result<const vk::Pipeline*> pipeline(const Constants& constants, bool tiles);
  std::uint32_t shading(const FastSettings& settings) const {
    return resources_.item().is_shaded ? (settings.smooth_gradients ? 2 : 1) : 0;
  }
  Result<shared::FrameData> write_frame(const CameraRays& rays, const FastSettings& settings);
  Outcome mark(vk::Commands& commands, RayGrid& level, vk::Image& coarser, bool opaque);
  /// What draws a level: its target, the coarser one (or null) and whether rays are marched.
  struct DrawParams {
    vk::Image* target = nullptr;
    const vk::Image* coarser = nullptr;
    bool marches = true;
    Tiles tiles = Tiles::all;
    std::uint32_t shading = 0;
    bool skips_empty = true;
    VkRect2D area{};
    const vk::Image* opaque_depth = nullptr;
    const vk::Image* placeholder = nullptr;
    bool half_opacity_depth = false;
  };
  Outcome record_samples(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, std::uint32_t spacing,
                         DrawParams wanted);
  Outcome draw(vk::Commands& commands, RayGrid& level, const DrawParams& draw);
  Outcome interpolate(vk::Commands& commands, vk::Image& half, vk::Image& target, const VkRect2D& area, bool keep);
  struct ReuseState {
    FastSettings settings;
    RayImageState state;
  };
  /// What stays of an eye's picture.
  struct EyeState {
    RayGrid quarter, half, full;
    std::optional<DirtyTiles> opaque_tiles;
    std::optional<ReuseState> reuse;
  };
  EyeState& eye_state() { return eye_states_[eye_index_]; }

  vk::Device* device_;
  FastVolumeResources resources_;
  vk::Image placeholder_gradients_;  ///< one voxel, bound where shading does not ask for them
  vk::Sampler linear_;
  vk::Buffer frame_;
  std::vector<EyeState> eye_states_{1};
  std::size_t eye_index_ = 0;
  RayGrid sample_grid_;
  std::map<std::pair<Constants, bool>, vk::Pipeline> pipelines_;
  std::array<vk::Pipeline, 2> mark_pipelines_;         // without and with something opaque
  std::array<vk::Pipeline, 2> interpolate_pipelines_;  // of all, of what has changed
  vk::Buffer interpolate_data_;
  vk::Image placeholder_tiles_;
  bool reused_previous_ = false;
  bool marched_half_ = false, marched_full_ = false;  ///< blocks of the last call
};

/// One invocation a lattice point: what upsample.comp and interpolate.comp need for the pixels of an area.
struct UpsampleDispatch {
  shared::UpsampleData data{};
  std::uint32_t x = 0, y = 0;
};
UpsampleDispatch make_upsample_dispatch(const VkRect2D& area, const VkExtent3D& picture);

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
