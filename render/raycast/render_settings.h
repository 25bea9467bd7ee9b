/// How well and how fast: what renderer and passes are told beside the packet.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "render/residency/resident_grid.h"
#include "render/vk/resources.h"

namespace catena::render {

/// How the fast raycast of one volume (fast_volume.h) trades error for time.
struct FastSettings {
  double step_voxels = 4;          ///< in smallest voxel edges
  std::uint32_t spacing = 1;       ///< pixels between the first rays: 1, 2 or 4
  double refine_half_255 = 0;      ///< spacing 4: marches every 2nd pixel where interpolation is expected to err by more; < 0: nowhere
  double refine_full_255 = -1;     ///< the same for every pixel
  bool smooth_gradients = false;   ///< shading by central differences, as the exact raycast has it, for 8 bytes a voxel more
  double termination = 1.0 / 512;  ///< a ray ends when less than this gets through; the rest is told from what it has met
  bool skip_empty = true;          ///< leap over bricks that the transfer function leaves empty
  /// On the device, for packed words and gradients; the budget's rest, where that is less. What needs more is drawn exactly.
  std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
  /// Away from where the eye looks interpolation may err by more: both thresholds times max(1, e / fovea)^2, e the tangent of the angle
  /// from the gaze. 0: they hold everywhere; so they do in orthographic views, which have no angles.
  double fovea_tangent = 0;
  double gaze_right = 0, gaze_up = 0;  ///< where the eye looks: tangents from the view's axis
  /// The last step to every pixel is interpolation alone.
  bool ends_at_half_resolution() const { return spacing > 1 && refine_full_255 < 0; }
  bool operator==(const FastSettings&) const = default;
  /// Whether the rays of the first lattice are the same: all but the refinement is.
  bool marches_same_rays(FastSettings other) const {
    other.refine_half_255 = refine_half_255;
    other.refine_full_255 = refine_full_255;
    return *this == other;
  }
};

/// What a voxel is stored as on the device.
enum class TexelFormat { automatic, r16f, r32f };

/// How one picture is drawn; the packet says what.
struct RenderSettings {
  double step_voxels = 1;          ///< in smallest voxel edges
  double termination = 1.0 / 512;  ///< a ray ends when less than this gets through
  TexelFormat texel_format =
      TexelFormat::automatic;  ///< automatic: r32f where a grid carries an isosurface or a slice, r16f elsewhere; outliers: r32f
  GridLayout layout = GridLayout::automatic;  ///< how texels lie on the device
  bool skip_empty = true;                     ///< leap over bricks that the transfer function leaves empty
  /// The picture target holds 32-bit floats instead of 8 bits: Renderer::read_back_float(). What is opaque has 11 bits of mantissa.
  bool float_image = false;
  /// Rays begin with a part of a step, another one at every pixel: grain instead of rings where the step is coarse. The packet may
  /// say otherwise. The fast raycast has none.
  bool jitter = false;
  /// Draws a lone volume by the fast raycast, if it can; what is above then holds for everything else.
  std::optional<FastSettings> fast;
  /// While nothing but opaque things moves, only the rays of the tiles under them (fast ones: near them) are marched again, of every eye.
  /// The picture is the same to the bit, but what it took says nothing.
  bool reuse_rays = false;
  /// > 0: the rays of every so-many-th pixel each way are marched once more, after the picture, for Renderer::ray_depth().
  std::uint32_t ray_depth_spacing = 0;
};
RenderSettings draft_settings();      ///< every 4th pixel at step 2; where the fast raycast cannot: step 2, jittered
RenderSettings balanced_settings();   ///< every 2nd pixel at step 1, every one where the picture asks for it; where it cannot: step 1
RenderSettings reference_settings();  ///< step 0.1, R32F, termination 1e-4

/// What rays are told and what they meet beside grids.
inline constexpr VkFormat kVolumeFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< of what rays blend; premultiplied

/// How rays are marched.
struct RaySettings {
  double step_voxels = 1;          ///< in smallest voxel edges
  double termination = 1.0 / 512;  ///< a ray ends when less than this gets through
  bool skip_empty = true;          ///< leap over what is empty
  bool jitter = false;             ///< rays begin with a part of a step
};

/// Something translucent that triangles drew, to be blended with what rays meet, in order: premultiplied colours, and the depth t
/// (shaders/shared/frame.h, R32_SFLOAT) of each; NO_DEPTH: nothing at this pixel. Of the picture's size.
struct Layer {
  vk::Image* color = nullptr;  ///< premultiplied
  vk::Image* depth = nullptr;  ///< R32_SFLOAT
};

/// What a picture's rays meet beside grids.
struct RayScene {
  const vk::Image* opaque_depth = nullptr;  ///< null: nothing opaque
  std::span<const Layer> layers{};          ///< in any order
  std::uint64_t layers_version = 0;         ///< counts what they have shown: equal ones differ where opaque things differ, at most
  const vk::Image* placeholder = nullptr;   ///< bound where there is nothing
};

/// An item with the mirror of its grid, and of the grid that colours it, if there is one.
template <class Item>
struct ResidentItem {
  const Item* item = nullptr;                                ///< what is drawn
  std::shared_ptr<const ResidentGrid> resident, color_grid;  ///< of its grid; of the grid that colours it, or null
};

}  // namespace catena::render
