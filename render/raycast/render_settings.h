// SPDX-License-Identifier: MIT
/// Settings of speed and quality, passed to the renderer and the passes in addition to the packet.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "engine/base/export.h"
#include "render/residency/resident_grid.h"
#include "render/vk/resources.h"

namespace catena::render {

/// Trade-off between error and time of the fast raycast of one volume (fast_volume.h).
struct FastSettings {
  double step_voxels = 4;     ///< ray step, in smallest voxel edges
  std::uint32_t spacing = 1;  ///< pixels between the rays of the first ray grid: 1, 2 or 4
  /// Spacing 4: every 2nd pixel is marched where the expected interpolation error exceeds this threshold, 1/255; < 0: nowhere.
  double refine_half_255 = 0;
  double refine_full_255 = -1;  ///< like refine_half_255, for the refinement to every pixel
  /// Shading by central differences, as in the exact raycast, for 8 more bytes per voxel; false: by the gradient of the cell.
  bool smooth_gradients = false;
  /// A ray ends when its transmittance falls below this; the remainder is extrapolated from what it has accumulated.
  double termination = 1.0 / 512;
  bool skip_empty = true;  ///< skip bricks that are empty under the transfer function
  /// Upper limit of device memory for packed codes and gradients, also limited by the remaining budget. A volume that needs more is
  /// rendered by the exact raycast.
  std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
  /// Foveation: both thresholds are multiplied by max(1, e / fovea_tangent)^2, where e is the tangent of the angle from the gaze direction.
  /// 0: off; it is always off in orthographic views, which have no angles.
  double fovea_tangent = 0;
  double gaze_right = 0, gaze_up = 0;  ///< gaze direction: tangents from the view axis
  /// Returns whether the last step to every pixel is interpolation only.
  bool ends_at_half_resolution() const { return spacing > 1 && refine_full_255 < 0; }
  bool operator==(const FastSettings&) const = default;
  /// Returns whether the rays of the first ray grid are the same: all settings but the refinement thresholds are equal.
  bool marches_same_rays(FastSettings other) const {
    other.refine_half_255 = refine_half_255;
    other.refine_full_255 = refine_full_255;
    return *this == other;
  }
};

/// Storage format of a voxel on the device. automatic: see RenderSettings::texel_format.
enum class TexelFormat { automatic, r16f, r32f };

/// Settings of one image's rendering; the packet defines its content.
struct RenderSettings {
  double step_voxels = 1;          ///< ray step, in smallest voxel edges
  double termination = 1.0 / 512;  ///< a ray ends when its transmittance falls below this
  /// automatic: r32f for grids with an isosurface, a slice or nearest interpolation, r16f for others; grids with outliers always use r32f.
  TexelFormat texel_format = TexelFormat::automatic;
  GridLayout layout = GridLayout::automatic;  ///< layout of the texels on the device
  bool skip_empty = true;                     ///< skip bricks that are empty under the transfer function
  /// The output holds 32-bit floats instead of 8 bits: Renderer::read_back_float(). Opaque objects have 11 bits of mantissa.
  bool float_image = false;
  /// Contours of opaque items are antialiased from the ids and depths of neighboring pixels (shaders/lib/smooth_edges.glsl); depth and ids
  /// are unaffected. Not at half resolution.
  bool smooth_edges = false;
  /// Jitter: rays start with an offset of a fraction of a step that differs at every pixel, which turns rings from coarse steps into grain.
  /// FramePacket::jitter overrides it. The fast raycast has no jitter.
  bool jitter = false;
  /// A single volume is rendered by the fast raycast with these settings, if supported; the members above apply to everything else.
  std::optional<FastSettings> fast;
  /// While only opaque objects move, only the rays of the tiles they cover (fast raycast: also of nearby tiles) are re-marched, for every
  /// eye. The image is identical to the bit, but its time is not representative.
  bool reuse_rays = false;
  /// Images of volumes and slices that are larger than memory are complete: what they show is awaited. False: they show what has been read
  /// so far, and what is missing is read in the background (Renderer::paging()).
  bool waits_for_pages = false;
  /// A complete image shows the finest level, however small its voxels are. False: levels whose voxels are not larger than a pixel.
  bool shows_finest_pages = false;
  /// The caller divides an image whose pages do not fit (PagingStats::finest_level): no coarser ones are read for it, and it is not drawn.
  bool divides_for_pages = false;
  /// > 0: the rays of every n-th pixel in each direction are marched a second time, after the image, for Renderer::ray_depth().
  std::uint32_t ray_depth_spacing = 0;
};
CATENA_EXPORT RenderSettings draft_settings();  ///< every 4th pixel at step 2; where the fast raycast is not possible: step 2, jittered
/// Every 2nd pixel at step 1, every pixel where refinement requires it; where the fast raycast is not possible: step 1.
CATENA_EXPORT RenderSettings balanced_settings();
CATENA_EXPORT RenderSettings reference_settings();  ///< step 0.1, R32F, termination 1e-4

/// Ray parameters and scene input besides grids.
inline constexpr VkFormat kVolumeFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< format of what rays blend; premultiplied

/// Ray marching parameters.
struct RaySettings {
  double step_voxels = 1;          ///< ray step, in smallest voxel edges
  double termination = 1.0 / 512;  ///< a ray ends when its transmittance falls below this
  bool skip_empty = true;          ///< skip empty space
  bool jitter = false;             ///< jitter offset of the ray starts
};

/// Translucent layer rendered from triangles, to be blended with the ray samples in depth order: premultiplied colors, and the depth t
/// (shaders/shared/frame.h, R32_SFLOAT) of each; NO_DEPTH: nothing at this pixel. Both images have the image's size.
struct Layer {
  vk::Image* color = nullptr;  ///< premultiplied
  vk::Image* depth = nullptr;  ///< R32_SFLOAT
};

/// Input of the rays besides grids.
struct RayScene {
  const vk::Image* opaque_depth = nullptr;  ///< null: nothing opaque
  std::span<const Layer> layers{};          ///< in any order
  /// Counter of changes of the layers: images with equal versions differ at most where opaque objects differ.
  std::uint64_t layers_version = 0;
  const vk::Image* placeholder = nullptr;  ///< bound where there is no image
};

/// Item with the resident grid of its grid and, if it is colored by another grid, that of the other grid.
template <class Item>
struct ResidentItem {
  const Item* item = nullptr;                                ///< packet item
  std::shared_ptr<const ResidentGrid> resident, color_grid;  ///< GPU copy of the item's grid; GPU copy of the coloring grid, or null
};

}  // namespace catena::render
