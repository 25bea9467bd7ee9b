// SPDX-License-Identifier: MIT
/// Fast raycast of one volume, or of several channels in pages, with a measured error (render/quality/quality.h): packed codes,
/// pre-integrated transfer function, Hermite midpoints, skipping of homogeneous bricks; rays on a ray grid of every 4th, 2nd or every
/// pixel, refined where the fourth difference of the image predicts an interpolation error.   ray grid -> marks -> finer ray grid -> .. ->
/// every pixel A large grid is packed as the bricks that are visible under its transfer function. What is not supported (several volumes,
/// too many bricks) is rendered by VolumeRaycast. Frame thread only.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "render/raycast/camera_rays.h"
#include "render/raycast/dirty_tiles.h"
#include "render/raycast/fast_volume_resources.h"
#include "render/raycast/render_settings.h"
#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

/// Fast raycast: resources of one volume and the ray grids of every eye.
class FastVolumeRaycast {
 public:
  static Result<FastVolumeRaycast> create(vk::Device& device);
  /// Packs the volume if it changed; loads pages if `loads`. `left`: device bytes that it may allocate in addition to what it holds. An
  /// Error if that does not suffice.
  Outcome prepare(std::span<const VolumeItem> items, const FastSettings& settings, std::uint64_t left, bool loads) {
    return resources_.prepare(items, settings, left, loads);
  }
  /// Returns the pages; null: the volume is not paged.
  PagedVolume* pages() { return resources_.pages(); }
  const PagedVolume* pages() const { return resources_.pages(); }
  /// Selects the eye (of `eyes`) of the following calls: images reused from frame to frame are kept per eye.
  void select_eye(std::size_t eye, std::size_t eyes) {
    eye_states_.resize(eyes);
    eye_index_ = eye;
  }
  /// Returns whether the volume is packed as bricks: it is too large to be kept together with a resident grid.
  bool is_bricked() const { return resources_.is_bricked(); }
  /// Renders into `target` (cleared first; of the image's size), or into half_resolution() if the settings end there and `target` is null;
  /// not inside a render pass. `opaque_depth` null: nothing opaque, `none` is bound instead; otherwise pixels near opaque objects are
  /// always marched and `target` is required. `keep`: content of `target` and of the ray grids from the last call is reused where the
  /// result would be identical to the bit.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, const VkRect2D& area,
                 const VkExtent3D& image_size, vk::Image* target, const vk::Image* opaque_depth, const vk::Image& none, bool keep = false);
  /// Returns whether the last call reused most of its previous result.
  bool reused_previous() const { return reused_previous_; }
  /// Returns the mask of the tiles that the last call re-marched, if it reused the others; null: nothing was reused, or there was nothing
  /// opaque.
  vk::Image* dirty_tiles() {
    return reused_previous_ && eye_state().reuse->state.has_opaque ? &eye_state().opaque_tiles->dirty_tiles() : nullptr;
  }
  /// Returns the masks of the blocks of 4 x 4 rays (R8_UINT, 1: marched) that the last call marched in addition to the first ray grid, at
  /// every 2nd pixel and at every pixel. Null: none at that spacing.
  std::array<vk::Image*, 2> marked_blocks() {
    return {marched_half_ ? &eye_state().half.marks : nullptr, marched_full_ ? &eye_state().full.marks : nullptr};
  }
  /// Invalidates the reused content: the eye's target was overwritten by others.
  void invalidate_target() { eye_state().reuse.reset(); }
  /// Renders the rays of every `spacing`-th pixel only into `target` (kVolumeFormat).
  Outcome record_ray_samples(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, std::uint32_t spacing,
                             vk::Image& target, const vk::Image* opaque_depth, const vk::Image& none);
  /// Renders, for those of these rays that are in `area`, the depth t at which alpha exceeds 0.5 into the red channel; NO_DEPTH where it
  /// never does.
  Outcome record_half_opacity_depth(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, std::uint32_t spacing,
                                    vk::Image& target, const VkRect2D& area, const vk::Image* opaque_depth, const vk::Image& none);
  /// Returns the volume at every 2nd pixel, the input of Upsampler.
  vk::Image& half_resolution() { return eye_state().half.color; }
  /// Returns whether enough of the volume is homogeneous that rays skip it.
  bool skips_empty_space() const;
  /// Returns the device bytes of packed codes and gradients.
  std::uint64_t grid_bytes() const {
    return resources_.pages() ? resources_.pages()->bytes() : resources_.words().bytes() + resources_.gradients().bytes();
  }
  double build_ms() const { return resources_.build_ms(); }

 private:
  /// Ray grid: rays of every n-th pixel, with its image, refinement marks and shader data.
  struct RayGrid {
    vk::Image color, marks;
    vk::Buffer data;
  };
  explicit FastVolumeRaycast(vk::Device& device) : device_(&device), resources_(device) {}
  Outcome ensure(RayGrid& level, std::uint32_t spacing, const VkExtent3D& target);
  /// Tiles of a ray grid that are rendered; the others keep their content.
  enum class Tiles { all, marked, dirty };
  using Constants = std::array<std::uint32_t, 12>;
  Result<const vk::Pipeline*> pipeline(const Constants& constants, bool tiles);
  std::uint32_t shading(const FastSettings& settings) const { return shaded_channels() == 0 ? 0 : settings.smooth_gradients ? 2 : 1; }
  std::uint32_t shaded_channels() const;  ///< one bit per volume
  Result<shared::FrameData> write_frame(const CameraRays& rays, const FastSettings& settings);
  Outcome mark(vk::Commands& commands, RayGrid& level, vk::Image& coarser, bool opaque);
  /// Parameters of rendering a ray grid: its target, the coarser grid to interpolate (or null) and whether rays are marched.
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
                         DrawParams params);
  Outcome draw(vk::Commands& commands, RayGrid& level, const DrawParams& draw);
  Outcome interpolate(vk::Commands& commands, vk::Image& half, vk::Image& target, const VkRect2D& area, bool keep);
  struct ReuseState {
    FastSettings settings;
    RayImageState state;
  };
  /// Images of one eye that are reused from frame to frame.
  struct EyeState {
    RayGrid quarter, half, full;
    std::optional<DirtyTiles> opaque_tiles;
    std::optional<ReuseState> reuse;
  };
  EyeState& eye_state() { return eye_states_[eye_index_]; }

  vk::Device* device_;
  FastVolumeResources resources_;
  vk::Image placeholder_gradients_;  ///< one voxel, bound if the shading needs no gradients
  vk::Sampler linear_;
  vk::Buffer frame_;
  std::vector<EyeState> eye_states_{1};
  std::size_t eye_index_ = 0;
  RayGrid sample_grid_;
  std::map<std::tuple<Constants, bool, bool>, vk::Pipeline> pipelines_;
  std::array<vk::Pipeline, 2> mark_pipelines_;         // without and with an opaque depth
  std::array<vk::Pipeline, 2> interpolate_pipelines_;  // all pixels, dirty tiles only
  vk::Buffer interpolate_data_;
  vk::Image placeholder_tiles_;
  std::uint32_t lights_ = 0;  ///< constant HAS_LIGHTS of the image's rays
  bool reused_previous_ = false;
  bool marched_half_ = false, marched_full_ = false;  ///< blocks were marched in the last call
};

/// Compute dispatch with one invocation per ray grid point, for the pixels of an area: parameters of upsample.comp and interpolate.comp.
struct UpsampleDispatch {
  shared::UpsampleData data{};
  std::uint32_t x = 0, y = 0;
};
/// Returns the dispatch that covers `area`.
UpsampleDispatch make_upsample_dispatch(const VkRect2D& area, const VkExtent3D& image_size);

/// Interpolates a volume at every 2nd pixel to the finished image and composites it over the opaque objects and the background: replaces
/// the pass `compose` for the fast raycast.
class Upsampler {
 public:
  explicit Upsampler(vk::Device& device) : device_(&device) {}
  /// Renders into `image`. `opaque` null: nothing opaque, `none` is bound instead. `area`: pixels that the volume may cover. Transitions
  /// the images to their layouts.
  Outcome record(vk::Commands& commands, vk::Image& half_grid, vk::Image* opaque, const vk::Image& none,
                 const std::array<float, 4>& background, bool is_linear, const VkRect2D& area, vk::Image& image);

 private:
  vk::Device* device_;
  std::array<vk::Pipeline, 2> pipelines_;  // without and with an opaque color image
  vk::Buffer uniform_;
};

}  // namespace catena::render
