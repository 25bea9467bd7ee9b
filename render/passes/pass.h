// SPDX-License-Identifier: MIT
/// Interface of the renderer's passes, the targets they share, and the embedded shaders.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/raycast/camera_rays.h"
#include "render/raycast/paged_volume.h"
#include "render/raycast/render_settings.h"
#include "render/residency/residency_manager.h"
#include "render/vk/commands.h"
#include "render/vk/pipeline.h"
#include "render/vk/resources.h"

namespace catena::render {

/// Shader embedded in the program, by file name (for instance "compose.frag"), so that it can be replaced. Any thread.
struct EmbeddedShader {
  std::string_view name;
  vk::Spirv words;
};

/// Returns one entry for every file of shaders/passes, sorted by name. Any thread.
std::span<const EmbeddedShader> embedded_shaders();

/// Returns how the grid is stored on the device for this packet, for exact rays, surfaces and slices.
ResidencyOptions residency_options(const FramePacket& packet, const RenderSettings& settings, const field::ScalarGrid& grid);

/// A pass renders one kind of item. It declares which targets it reads and writes; the renderer (renderer.cpp) holds the passes in order
/// and derives clears, barriers and groups from the declarations. A pass is created when a packet first needs it; a scene without
/// streamlines has no streamline pass.
///   is_needed -> prepare (uploads, pipelines) -> bounds (they fix near, far and the rays) -> record
/// Frame thread only. To add one: a class here beside its shader, a line in passes.h and one in the list of renderer.cpp.

/// Set of targets, as bits.
using TargetSet = unsigned;
namespace target {
inline constexpr TargetSet opaque_color = 1, opaque_depth = 2, opaque_id = 4, depth_buffer = 8, volume = 16, output = 32,
                           occluded_overlay = 64;
/// All targets that opaque geometry is rendered into.
inline constexpr TargetSet opaque = opaque_color | opaque_depth | opaque_id | depth_buffer;
}  // namespace target

inline constexpr VkFormat kOpaqueFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kDepthValueFormat = VK_FORMAT_R32_SFLOAT;  ///< depth t of shared/frame.h
inline constexpr VkFormat kIdFormat = VK_FORMAT_R32_UINT;            ///< object id, 0: none
inline constexpr VkFormat kDepthBufferFormat = VK_FORMAT_D32_SFLOAT;
/// Format of the x-ray overlay, premultiplied. A negative alpha marks pixels where the cursor is the nearest opaque object: there it is
/// multiplied by the alpha of the volume.
inline constexpr VkFormat kOccludedOverlayFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kOutputFormat = VK_FORMAT_R8G8B8A8_UNORM;            ///< straight alpha
inline constexpr VkFormat kFloatOutputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< straight alpha, without rounding to 8 bits

/// Returns the color formats of a pipeline that renders into target::opaque, in the order of its outputs.
std::vector<VkFormat> opaque_formats();

/// Returns an id image of one texel, to be bound where a pass has no ids.
Result<vk::Image> create_placeholder_id(vk::Device& device);

/// Images shared by the passes, created when first needed and re-created when the size changes.
struct Targets {
  vk::Image opaque_color, opaque_depth, opaque_id, depth_buffer, volume, output, occluded_overlay;
  VkFormat output_format = kOutputFormat;  ///< kOutputFormat or kFloatOutputFormat; pipelines that write the output use it
  vk::Image placeholder;                   ///< image of one texel, bound where a pass has no input

  /// Creates the missing images of `needed` and the placeholder. An Error if there is no memory.
  Outcome ensure(vk::Device& device, std::uint32_t width, std::uint32_t height, TargetSet needed);
  /// Returns the bytes that ensure() would have to allocate for these.
  std::uint64_t missing_bytes(std::uint32_t width, std::uint32_t height, TargetSet needed) const;
  /// Returns the image of a single target.
  vk::Image& image(TargetSet one);
  /// Begins rendering into `writes`, within `area` if it is set; targets in `cleared` are cleared, the others keep their content.
  void begin(vk::Commands& commands, TargetSet writes, TargetSet cleared, const std::optional<VkRect2D>& area = {});
};

class HandShadow;
class Triangles;

/// State of one image while it is rendered, shared by its passes.
struct Frame {
  vk::Device& device;
  ResidencyManager& residency;
  Targets& targets;
  const FramePacket& packet;
  const RenderSettings& settings;
  CameraRays rays;                              ///< valid in record()
  TargetSet written_targets = 0;                ///< written by the passes before this one; in use(): by all passes
  vk::Image* half_resolution_volume = nullptr;  ///< set: volume rendered at every 2nd pixel, used instead of target::volume
  /// Pixels that half_resolution_volume may cover.
  VkRect2D half_resolution_area{};
  /// Translucent layers, nearest first at every pixel, at most MAX_LAYERS. A pass before the raycast appends them in prepare() and renders
  /// them in record(); the raycast blends them, even if there is no volume.
  std::vector<Layer> layers{};
  std::uint64_t layers_version = 0;          ///< see RayScene::layers_version
  std::size_t eye_index = 0, eye_count = 1;  ///< index and number of the packet's eyes: data reused from image to image is stored per eye
  bool is_first = true, is_last = true;      ///< first, last of the packets of one image; grids and passes stay until the last

  /// Triangles of the cursors shown through occluders (x-ray overlay): the first indices of these. Set by the cursor pass in prepare().
  Triangles* occluded_triangles = nullptr;
  std::uint32_t occluded_index_count = 0;
  VkRect2D occluded_area{};  ///< pixels of target::occluded_overlay that are valid; the others were never cleared

  HandShadow* hand_shadow = nullptr;  ///< valid in record()

  /// Returns whether any of the targets has been written.
  bool has(TargetSet targets_) const { return (written_targets & targets_) != 0; }
  /// Returns the resident grid (GPU copy) in the texel format for this packet. It is cached while packets refer to the grid.
  Result<std::shared_ptr<const ResidentGrid>> resident_grid(const field::ScalarGrid& grid) const;
};

/// Targets that a pass reads and writes.
struct PassUse {
  TargetSet reads = 0, writes = 0;
  /// True: the pass begins and ends its rendering itself; false: the renderer does, for all adjacent passes with equal targets together.
  bool owns_rendering = false;
};

/// Access to the rays of a pass for error measurement and depth images: sparse ray samples and information about the last image.
class RaySampler {
 public:
  /// Renders the rays of every `spacing`-th pixel in each direction into `target` (kVolumeFormat).
  virtual Outcome record_ray_samples(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target) = 0;
  /// Renders the depth t (shaders/shared/frame.h) at which the alpha of these rays exceeds 0.5 into the red channel of `target`
  /// (kVolumeFormat), within `area` of it; NO_DEPTH where it never does. Not to be recorded together with the image.
  virtual Outcome record_half_opacity_depth(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target,
                                            const VkRect2D& area) = 0;
  /// Returns whether record_half_opacity_depth() can be used with the prepared items.
  virtual bool has_half_opacity_depth() const = 0;
  /// Returns whether the fast raycast was prepared last and its rays skip empty space.
  virtual bool skips_empty_space() const = 0;
  /// Returns whether the fast raycast failed to allocate memory for this packet's volume.
  virtual bool was_out_of_memory(const FramePacket& packet) const = 0;
  /// Returns whether in the last image only the tiles where opaque objects changed were re-marched.
  virtual bool reused_previous() const = 0;
  /// Returns the mask of these tiles, R8_UINT; null: there are none, or the whole image was marched.
  virtual vk::Image* dirty_tiles() = 0;
  /// Returns FastVolumeRaycast::marked_blocks of the fast raycast's last image.
  virtual std::array<vk::Image*, 2> marked_blocks() = 0;

 protected:
  ~RaySampler() = default;
};

/// Interface of a pass. Owned by the renderer. Frame thread.
class Pass {
 public:
  virtual ~Pass() = default;
  /// Returns the targets that the pass reads and writes.
  virtual PassUse use(const Frame& frame) const = 0;
  /// Uploads what changed since the last frame. An Error if there is no memory or the items cannot be rendered.
  virtual Outcome prepare(Frame& frame) = 0;
  /// Returns the world bounds of the items found by prepare().
  virtual Bounds bounds() const { return {}; }
  /// Returns the volumes in pages that were prepared last.
  virtual std::vector<PagedVolume*> pages() { return {}; }
  /// Returns whether data that the pass reads in the background have arrived since prepare().
  virtual bool has_new_data() const { return false; }
  /// Records the rendering commands.
  virtual Outcome record(vk::Commands& commands, Frame& frame) = 0;
  /// Returns the total milliseconds spent on building images from grids, excluding resident grids.
  virtual double build_ms() const { return 0; }
  /// Returns the bytes of device images of grid voxels, excluding resident grids.
  virtual std::uint64_t grid_bytes() const { return 0; }
  /// Returns whether this pass's part of the last image was reused from the one before (RenderSettings::reuse_rays).
  virtual bool reused_previous() const { return false; }
  /// Returns whether its rays end on surfaces of grids: they define the reference depth if no ray sampler does.
  virtual bool casts_surface_rays() const { return false; }
  /// Returns the ray sampler; null: the pass casts no rays that are blended with other items.
  virtual RaySampler* ray_sampler() { return nullptr; }
  /// Returns a one-line message about items of the last image that are missing or were rendered in another way than requested, and why;
  /// empty: none.
  virtual std::string warning() const { return {}; }
};

/// Names of grids that a pass draws from the level in memory although finer ones are stored.
class CoarseGrids {
 public:
  void clear() { names_.clear(); }
  void add(const std::string& name);
  /// Returns a warning that lists the names; empty: there are none.
  std::string warning() const;

 private:
  std::vector<std::string> names_;
};

/// Entry of a pass in the renderer's list.
struct PassEntry {
  const char* name;
  bool (*is_needed)(const Frame& frame);
  Result<std::unique_ptr<Pass>> (*create)(vk::Device& device);
  // Memory that the budget for resident grids must leave free while the pass is needed.
  TargetSet reserved_targets = target::opaque;
  std::uint64_t reserved_pixel_bytes = 0;  ///< for images of its own
};

}  // namespace catena::render
