/// The renderer: a frame packet in, a finished colour image out. It holds the list of passes (pass.h), in order:
///   aids, widgets, meshes, streamlines, glyphs, cursor, isosurfaces, slices -> layers -> raycast -> compose
/// A pass is created when a packet first wants it and goes when one no longer does; mirrors are kept by (grid version, texel
/// format) and dropped when a packet no longer names the grid. A packet with eyes is drawn once an eye and packed (pack.h); depth and
/// ids are the first eye's. Frame thread only.
/// All device memory keeps within vk::DeviceOptions::memory_budget_bytes; a grid that does not fit is drawn coarser and the stats
/// say so. A call that fails leaves nothing of its frame behind: after VK_ERROR_OUT_OF_DEVICE_MEMORY a smaller packet can be drawn;
/// after VK_ERROR_DEVICE_LOST (device().lost()) a new renderer draws the same packets.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "render/frame/frame_packet.h"
#include "render/frame/overlay_items.h"
#include "render/image/image.h"
#include "render/raycast/render_settings.h"
#include "render/residency/residency_manager.h"
#include "render/vk/device.h"

namespace catena::render {

namespace vk {
class Image;
class Swapchain;
}  // namespace vk

/// What a renderer tells of itself. Plain data.
struct RenderStats {
  std::string device, driver;                       ///< the device's name; its driver's
  std::uint64_t gpu_bytes = 0;                      ///< held now
  std::uint64_t uploads = 0;                        ///< copies to the device so far
  std::uint64_t upload_bytes = 0;                   ///< bytes of these copies
  std::uint64_t pipelines = 0;                      ///< created so far
  std::vector<std::string> passes;                  ///< of the last picture, in order
  std::uint64_t resident_grids = 0;                 ///< grids mirrored now
  std::vector<GridDownsampling> downsampled_grids;  ///< of the grids that do not fit into the memory budget
  std::uint64_t gpu_budget = 0;                     ///< bytes that may be held
  std::uint64_t resident_bytes = 0;                 ///< of images of grids' voxels, held now
  double residency_ms = 0;                          ///< spent on building and uploading mirrors so far
  bool rays_reused = false;                         ///< RenderSettings::keep has spared the last picture most of its rays
  bool surfaces_reused = false;                     ///< the same of all opaque isosurfaces
  std::vector<std::string> warnings;      ///< what the last picture lacks, or was drawn otherwise than asked, and why, a sentence each
  std::uint64_t validation_messages = 0;  ///< warnings and errors of the validation layer so far
};

/// Whether anything of the packet is drawn by rays, so that it matters how finely they are marched.
bool uses_raycast(const FramePacket& packet);

/// An error where the packet holds what rays cannot draw together: the sentence that draw() would fail with. It needs no device.
Outcome check_ray_items(const FramePacket& packet);

/// Whether rays meet the same in both, and what they have met can be kept: what is opaque may differ (RenderSettings::keep).
bool rays_match(const FramePacket& a, const FramePacket& b);

/// The nearest opaque object of every pixel, 0: none.
struct IdImage {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint32_t> ids;       ///< rows from the top
};

/// View depth of the nearest opaque surface: distance along the view axis, world units; infinite where there is none.
struct DepthImage {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<float> depth;             ///< rows from the top
};

/// What was marched.
struct MarchedTiles {
  std::uint32_t marched = 0, total = 0;  ///< tiles of 16 x 16 pixels
};

/// What one pixel shows, of the first eye: the id of the nearest opaque object (0: none) and its view depth (infinite: none).
struct PickResult {
  std::uint32_t id = 0;  ///< as in IdImage
  double depth = 0;      ///< as in DepthImage
};

/// The last picture where it lies on the device: straight alpha, display values. Good until the next call of the renderer.
/// `layout` is the image's now, TRANSFER_SRC_OPTIMAL unless a window was painted since; who moves it to another one moves it back. Its
/// usage allows copies from it. All writes to it are done and visible once `timeline`, a timeline semaphore of the device, has reached
/// `value`; draw() has waited for that, so that other queues of the same family need wait for nothing.
struct RenderedImage {
  VkImage image = VK_NULL_HANDLE;                    ///< it belongs to the renderer
  VkFormat format = VK_FORMAT_UNDEFINED;             ///< of the texels
  VkExtent2D extent{};                               ///< pixels
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< the image's now
  VkSemaphore timeline = VK_NULL_HANDLE;             ///< it belongs to the device
  std::uint64_t timeline_value = 0;                  ///< that the semaphore has to reach
};

/// Draws frame packets on one device. A draw() that succeeds makes the last picture; it is there until the next draw(), probe(),
/// replace_shader() or restore_shaders(), or until reading something back fails. To read, show or paint it while there is none is a bug
/// and aborts.
class Renderer {
 public:
  /// Makes the device and what all pictures need. An error where there is no device, or it lacks something: one sentence.
  static Result<std::unique_ptr<Renderer>> create(const vk::DeviceOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws and waits for the fence of the finished colour image.
  Outcome draw(const FramePacket& packet, const RenderSettings& settings = {});
  /// The last picture on the device, for a program that draws with the same device (vk::VulkanProvider).
  RenderedImage rendered_image() const;
  /// The last picture, 8 bits a channel, straight alpha. A bug where it was drawn with `float_image`.
  Result<Image8> read_back();
  /// The image of the last picture, to copy it on the device: in the layout TRANSFER_SRC_OPTIMAL, there as long as the picture is.
  vk::Image& output_image();
  /// The opaque depth of the last picture in world units along the axis, less `reference`; NO_DEPTH (shaders/shared/frame.h) where nothing
  /// is. Nothing at all where there is nothing opaque.
  struct OpaqueDepth {
    vk::Image* image;        ///< R32_SFLOAT, on the device
    double reference_depth;  ///< world units
  };
  /// Nothing where nothing opaque was drawn.
  std::optional<OpaqueDepth> opaque_depth();
  /// What stands for the depth of volumes and translucent surfaces in the last picture: where a ray's alpha passes 0.5, in the red of a
  /// texel for every `spacing`-th pixel each way, counted as the opaque depth; NO_DEPTH where it never does before something opaque.
  /// Nothing at all where nothing is drawn by rays, of a projection, or without RenderSettings::ray_depth_spacing.
  struct RayDepth {
    vk::Image* image;        ///< the renderer's, until the next picture
    double reference_depth;  ///< world units along the view axis: what its depths count from
    std::uint32_t spacing;   ///< pixels from one texel to the next
  };
  /// That of the last picture.
  std::optional<RayDepth> ray_depth();
  /// A texel that is bound where there is no image.
  vk::Image& placeholder_image();
  /// The last picture in floats. A bug where it was drawn without `float_image`.
  Result<ImageF32> read_back_float();
  /// Pixels that a picture can have, each way, on this device.
  std::uint32_t max_image_side() const;
  /// Whether the packet holds what RenderSettings::fast can draw. False also for a volume that the last try had no memory to draw so.
  bool can_draw_fast(const FramePacket& packet) const;
  /// Whether the last picture's or probe's rays were the fast raycast's and leapt over what is empty.
  bool skips_empty_space() const;
  /// The rays of every `spacing`-th pixel each way alone, as a small picture: what `settings` make of them before anything is interpolated.
  /// What quality.h measures errors with. Red, green and blue over the packet's background (its alpha does not count), alpha that of
  /// what is drawn.
  Result<Image8> sample_rays(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing);
  /// The opaque depth of the last picture.
  Result<DepthImage> read_depth();
  /// The ids of the last picture.
  Result<IdImage> read_ids();
  /// Of the last picture's tiles of 16 x 16 pixels the number whose rays were marched, and of all: with RenderSettings::keep those that
  /// something opaque has come to or left.
  Result<MarchedTiles> marched_tiles();
  /// Of the fast raycast's last picture: the rays that were marched where interpolation would not have served, of every 2nd pixel and of
  /// every pixel, in whole blocks of 16.
  Result<std::array<std::uint64_t, 2>> refined_ray_counts();
  /// Depth and id of one pixel of the last picture: two texels come back, not the images. A pixel beyond the picture is a bug.
  Result<PickResult> pick(std::uint32_t x, std::uint32_t y);
  /// Pixels of one view of the last picture; 0 before the first.
  std::array<std::uint32_t, 2> view_size() const;
  /// Shows the last picture in a window (scaled to it), with the user interface over it at the window's own pixels (ui.h). Again with
  /// another `ui`: the picture is not drawn again. False: the swapchain no longer fits, resize it; nothing was shown then.
  Result<bool> present(vk::Swapchain& swapchain, const UiItems* ui = nullptr);
  /// The same without a window: what present() with this `ui` would show in a window of this size.
  Outcome paint_window(std::uint32_t width, std::uint32_t height, const UiItems& ui);
  /// The image that was painted, to copy it on the device: in the layout TRANSFER_SRC_OPTIMAL, until it is painted again or a call fails.
  /// Null where there is none.
  vk::Image* window_image();
  /// What paint_window(), or present() with a user interface, painted last: the window's pixels, alpha 255. A bug where window_image() is
  /// null.
  Result<Image8> read_back_window();

  /// Pictures from now on are drawn with `words` in the place of the embedded shader "compose.frag" (or another of pass.h).
  /// An error where there is no such shader, or where it uses a binding that the program does not bind; nothing has changed then.
  /// False: these words are in use already.
  Result<bool> replace_shader(std::string_view name, std::vector<std::uint32_t> words);
  /// The embedded shaders again.
  void restore_shaders();

  /// As of now.
  RenderStats stats() const;
  /// Texts of the validation layer's messages, the first 64.
  std::vector<std::string> validation_texts() const;
  /// The device that it draws with.
  vk::Device& device();

 private:
  Renderer();
  Outcome draw_once(const FramePacket& packet, const RenderSettings& settings);
  Result<Image8> sample_rays_once(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::render
