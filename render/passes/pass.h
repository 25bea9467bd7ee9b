/// The shaders of the program by name, "compose.frag": what a viewer needs in order to put others in their place. Any thread.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/raycast/camera_rays.h"
#include "render/raycast/render_settings.h"
#include "render/residency/residency_manager.h"
#include "render/vk/commands.h"
#include "render/vk/pipeline.h"
#include "render/vk/resources.h"

namespace catena::render {

struct EmbeddedShader {
  std::string_view name;
  vk::Spirv words;
};

/// One for every file of shaders/passes, in the order of their names.
std::span<const EmbeddedShader> embedded_shaders();

/// How the grid is mirrored for this packet where exact rays, surfaces or slices need it.
ResidencyOptions residency_options(const FramePacket& packet, const RenderSettings& settings, const field::ScalarGrid& grid);

/// A pass: one kind of thing that a picture can hold. It declares which targets it reads and writes; the renderer (renderer.cpp) holds
/// the passes in order and derives clears, barriers and groups from the declarations. A pass is created when a packet first wants
/// it; a scene without streamlines has no streamline pass.
///   wanted -> prepare (uploads, pipelines) -> bounds (they fix near, far and the rays) -> record
/// Frame thread only. To add one: a class here beside its shader, a line in passes.h and one in the list of renderer.cpp.

/// A set of targets, by bits.
using TargetSet = unsigned;
namespace target {
inline constexpr TargetSet opaque_color = 1, opaque_depth = 2, opaque_id = 4, depth_buffer = 8, volume = 16, output = 32,
                           occluded_overlay = 64;
/// Everything that solid things draw into.
inline constexpr TargetSet opaque = opaque_color | opaque_depth | opaque_id | depth_buffer;
}  // namespace target

inline constexpr VkFormat kOpaqueFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kDepthValueFormat = VK_FORMAT_R32_SFLOAT;  ///< depth t of shared/frame.h
inline constexpr VkFormat kIdFormat = VK_FORMAT_R32_UINT;            ///< the object's id, 0: none
inline constexpr VkFormat kDepthBufferFormat = VK_FORMAT_D32_SFLOAT;
/// What of the hand shines through, premultiplied. Its alpha is negative where nothing opaque hides it: the volume's alpha counts there.
inline constexpr VkFormat kOccludedOverlayFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kOutputFormat = VK_FORMAT_R8G8B8A8_UNORM;            ///< straight alpha
inline constexpr VkFormat kFloatOutputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< the same, not rounded

/// The formats of a pipeline that draws into target::opaque, in the order of its outputs.
std::vector<VkFormat> opaque_formats();

/// The images that passes hand to each other, created when a pass first needs them and again when the size changes.
struct Targets {
  vk::Image opaque_color, opaque_depth, opaque_id, depth_buffer, volume, output, occluded_overlay;
  VkFormat output_format = kOutputFormat;  ///< or kFloatOutputFormat; pipelines that draw into the picture follow it
  vk::Image placeholder;                   ///< one texel, bound where a pass has no input

  Outcome ensure(vk::Device& device, std::uint32_t width, std::uint32_t height, TargetSet needed);
  /// Bytes that ensure() would have to add for these.
  std::uint64_t missing_bytes(std::uint32_t width, std::uint32_t height, TargetSet needed) const;
  vk::Image& image(TargetSet one);
  /// Begins rendering into `writes`, within `area` if there is one; what `cleared` names starts empty, the rest keeps what is there.
  void begin(vk::Commands& commands, TargetSet writes, TargetSet cleared, const std::optional<VkRect2D>& area = {});
};

class Triangles;

/// One picture while it is made: what its passes share.
struct Frame {
  vk::Device& device;
  ResidencyManager& residency;
  Targets& targets;
  const FramePacket& packet;
  const RenderSettings& settings;
  CameraRays rays;                              ///< from record() on
  TargetSet written_targets = 0;                ///< by the passes before this one, or to be (prepare: of all passes)
  vk::Image* half_resolution_volume = nullptr;  ///< the volume on every 2nd pixel, instead of target::volume
  VkRect2D half_resolution_area{};
  /// The nearest first at every pixel, at most MAX_LAYERS. A pass before the raycast appends them in prepare() and draws them in
  /// record(); the raycast blends them, also where there is no volume.
  std::vector<Layer> layers{};
  std::uint64_t layers_version = 0;          ///< RayScene::layers_version
  std::size_t eye_index = 0, eye_count = 1;  ///< which of the packet's: what is kept from picture to picture is an eye's own

  /// The hands that shine through what hides them: the first indices of the cursor's triangles. The cursor's pass states them in prepare().
  Triangles* occluded_triangles = nullptr;
  std::uint32_t occluded_index_count = 0;
  VkRect2D occluded_area{};  ///< the pixels of target::ghost that hold anything; the others were never cleared

  bool has(TargetSet targets_) const { return (written_targets & targets_) != 0; }
  /// The grid on the device, in the texel format that this packet asks for. Kept while packets name it.
  Result<std::shared_ptr<const ResidentGrid>> resident_grid(const field::ScalarGrid& grid) const;
};

struct PassUse {
  TargetSet reads = 0, writes = 0;
  bool owns_rendering = false;  ///< begins and ends its rendering itself; else the renderer does, for all neighbours with equal targets
};

/// Rays of a pass, some of them alone: what the error of a picture is measured with.
class RaySampler {
 public:
  /// The rays of every `spacing`-th pixel, into `target` (kVolumeFormat).
  virtual Outcome record_ray_samples(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target) = 0;
  /// Such rays again: the depth t (shaders/shared/frame.h) at which their alpha passes 0.5, into the red of `target` (kVolumeFormat);
  /// NO_DEPTH where it never does. After the picture.
  virtual Outcome record_half_opacity_depth(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target) = 0;
  virtual bool has_half_opacity_depth() const = 0;
  /// The fast raycast was prepared last, and its rays leap over what is empty.
  virtual bool skips_empty_space() const = 0;
  /// The fast raycast was tried with this packet's volume and had no memory for it.
  virtual bool was_out_of_memory(const FramePacket& packet) const = 0;
  /// Of the last picture only the tiles were marched that something opaque had come to or left.
  virtual bool reused_previous() const = 0;
  /// Those tiles, R8_UINT; null: there are none, or all of the picture was marched.
  virtual vk::Image* dirty_tiles() = 0;
  /// Of the fast raycast's last picture: FastVolumeRaycast::marked_blocks.
  virtual std::array<vk::Image*, 2> marked_blocks() = 0;

 protected:
  ~RaySampler() = default;
};

class Pass {
 public:
  virtual ~Pass() = default;
  virtual PassUse use(const Frame& frame) const = 0;
  /// Uploads what changed since the last frame.
  virtual Outcome prepare(Frame& frame) = 0;
  /// Of what prepare() found to draw.
  virtual Bounds bounds() const { return {}; }
  virtual Outcome record(vk::Commands& commands, Frame& frame) = 0;
  /// Milliseconds spent so far on images made from grids, beside the mirrors.
  virtual double build_ms() const { return 0; }
  /// Of images of grids' voxels, beside the mirrors.
  virtual std::uint64_t grid_bytes() const { return 0; }
  /// The last picture's part was taken from the one before (RenderSettings::keep).
  virtual bool reused_previous() const { return false; }
  /// Its rays end on surfaces of grids: depths count from these where nothing else casts rays.
  virtual bool casts_surface_rays() const { return false; }
  /// Null: it casts no rays that others are blended with.
  virtual RaySampler* ray_sampler() { return nullptr; }
  /// What the last picture lacks, or was drawn otherwise than asked, and why, one sentence; empty: nothing.
  virtual std::string warning() const { return {}; }
};

/// How the renderer knows a pass.
struct PassEntry {
  const char* name;
  bool (*is_needed)(const Frame& frame);
  Result<std::unique_ptr<Pass>> (*create)(vk::Device& device);
  // what the mirrors of grids leave room for, where it is wanted
  TargetSet reserved_targets = target::opaque;
  std::uint64_t reserved_pixel_bytes = 0;  ///< for images of its own
};

}  // namespace catena::render
