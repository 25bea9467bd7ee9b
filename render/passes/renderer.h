// SPDX-License-Identifier: MIT
/// Renderer: renders a frame packet into a finished color image. It holds the list of passes (pass.h), in order:
///   environment, widgets, meshes, streamlines, glyphs, points, cursor, isosurfaces, surface colors, slices -> layers -> raycast
///   -> x-ray overlay -> compose -> vignette -> overlay
/// A pass is created when a packet first needs it and destroyed when a packet does not; resident grids are cached by (grid version, texel
/// format) and dropped when a packet does not refer to the grid. A packet with eyes is rendered eye by eye and packed (packing.h); depth
/// and ids are those of the first eye. Frame thread only. All device memory stays within vk::DeviceOptions::memory_budget_bytes; a grid
/// that does not fit is downsampled, which the stats report. A call that fails discards everything of its frame: after
/// VK_ERROR_OUT_OF_DEVICE_MEMORY a smaller packet can be rendered; after VK_ERROR_DEVICE_LOST (device().is_lost()) a new renderer can
/// render the same packets.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
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

/// Bricks of a volume that is larger than the device's memory, in the last image. Counts are those of bricks that the image shows.
struct PagingStats {
  std::uint64_t visible = 0;   ///< bricks that the image shows when it is complete
  std::uint64_t resident = 0;  ///< those of them that are on the device
  /// > 0: the device's memory is too small for this image; levels finer than this one are not shown.
  int finest_level = 0;
  bool is_loading = false;   ///< bricks are being read
  bool has_arrived = false;  ///< bricks have been read that the last image does not show
  /// Returns "72 of 410 bricks"; empty: there are none.
  CATENA_EXPORT std::string message() const;
};

/// Statistics of a renderer. Plain data. Counts are totals since its creation unless stated otherwise.
struct RenderStats {
  std::string device, driver;                       ///< name of the device; name of its driver
  std::uint64_t gpu_bytes = 0;                      ///< device memory in use
  std::uint64_t uploads = 0;                        ///< number of copies to the device
  std::uint64_t upload_bytes = 0;                   ///< bytes of these copies
  std::uint64_t pipelines = 0;                      ///< number of pipelines created
  std::vector<std::string> passes;                  ///< names of the passes of the last image, in order
  std::uint64_t resident_grids = 0;                 ///< number of resident grids
  std::vector<GridDownsampling> downsampled_grids;  ///< grids that are downsampled to fit into the memory budget
  PagingStats paging;                               ///< bricks of a volume that does not fit into the device's memory
  std::uint64_t gpu_budget = 0;                     ///< memory budget, bytes
  std::uint64_t resident_bytes = 0;                 ///< bytes of device images of grid voxels in use
  double residency_ms = 0;                          ///< time spent on building and uploading resident grids
  bool rays_reused = false;                         ///< RenderSettings::reuse_rays avoided most rays of the last image
  bool surfaces_reused = false;  ///< RenderSettings::reuse_rays avoided the rays of all opaque isosurfaces of the last image
  /// One-line messages about items of the last image that are missing or were rendered in another way than requested, and why.
  std::vector<std::string> warnings;
  std::uint64_t validation_messages = 0;  ///< warnings and errors of the validation layer
};

/// Returns whether any item of the packet is rendered by rays, so that the ray step matters.
CATENA_EXPORT bool uses_raycast(const FramePacket& packet);

/// Returns the Error that draw() would fail with if the packet has items that rays cannot render together. Needs no device.
CATENA_EXPORT Outcome check_ray_items(const FramePacket& packet);

/// Returns whether rays sample the same in both packets, so that their results can be reused; opaque items may differ
/// (RenderSettings::reuse_rays).
CATENA_EXPORT bool rays_match(const FramePacket& a, const FramePacket& b);

/// Id of the nearest opaque object at every pixel, 0: none.
struct IdImage {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint32_t> ids;       ///< rows from the top
};

/// View depth of the nearest opaque surface: distance along the view axis, world units; infinite where there is none.
struct DepthImage {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<float> depth;             ///< rows from the top
};

/// Number of tiles whose rays were marched.
struct MarchedTiles {
  std::uint32_t marched = 0, total = 0;  ///< tiles of 16 x 16 pixels
};

/// Content of one pixel of the first eye's image: id of the nearest opaque object (0: none) and its view depth (infinite: none).
struct PickResult {
  std::uint32_t id = 0;  ///< as in IdImage
  double depth = 0;      ///< as in DepthImage
};

/// Last image in device memory: straight alpha, display values. Valid until the next call of the renderer. `layout` is the current layout
/// of the image: TRANSFER_SRC_OPTIMAL unless a window was painted afterwards; whoever changes it must change it back. The image's usage
/// allows copies from it. All writes to it are complete and visible when `timeline`, a timeline semaphore of the device, has reached
/// `timeline_value`; draw() has waited for that, so that other queues of the same family need not wait.
struct RenderedImage {
  VkImage image = VK_NULL_HANDLE;                    ///< owned by the renderer
  VkFormat format = VK_FORMAT_UNDEFINED;             ///< texel format
  VkExtent2D extent{};                               ///< pixels
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< current layout
  VkSemaphore timeline = VK_NULL_HANDLE;             ///< owned by the device
  std::uint64_t timeline_value = 0;                  ///< value at which the image is complete
};

/// Renders frame packets on one device. A successful draw() produces the last image; it is valid until the next draw(), sample_rays(),
/// replace_shader() or restore_shaders(), or until a read-back fails. Reading, presenting or painting without a last image is a bug of the
/// caller and aborts.
class CATENA_EXPORT Renderer {
 public:
  /// Creates the device and the resources that all images need. A one-line Error if there is no suitable device.
  static Result<std::unique_ptr<Renderer>> create(const vk::DeviceOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Renders the packet and waits until the image is finished. An Error if the packet cannot be rendered, memory is short or the device is
  /// lost.
  Outcome draw(const FramePacket& packet, const RenderSettings& settings = {});
  /// Returns the last image in device memory, for a program that uses the same device (vk::VulkanProvider).
  RenderedImage rendered_image() const;
  /// Reads back the last image, 8 bits per channel, straight alpha. Must not be called if it was rendered with `float_image`.
  Result<Image8> read_back();
  /// Returns the last image, for copies on the device: in the layout TRANSFER_SRC_OPTIMAL, valid as long as the last image is.
  vk::Image& output_image();
  /// Opaque depth of the last image: view depth in world units minus `reference_depth`; NO_DEPTH (shaders/shared/frame.h) where there is no
  /// opaque surface.
  struct OpaqueDepth {
    vk::Image* image;        ///< R32_SFLOAT, in device memory
    double reference_depth;  ///< world units
  };
  /// Returns the opaque depth; nullopt if nothing opaque was rendered.
  std::optional<OpaqueDepth> opaque_depth();
  /// Depth of volumes and translucent surfaces in the last image: the half-opacity depth, at which a ray's alpha exceeds 0.5, in the red
  /// channel of one texel for every `spacing`-th pixel in each direction, relative to the same reference as the opaque depth; NO_DEPTH
  /// where alpha stays below in front of the first opaque surface.
  struct RayDepth {
    vk::Image* image;        ///< owned by the renderer, valid until the next image is rendered
    double reference_depth;  ///< view depth from which the depths are counted, world units
    std::uint32_t spacing;   ///< distance of the sampled pixels
  };
  /// Returns the half-opacity depth of the last image; nullopt if no item is rendered by rays, for projections other than composite, and
  /// without RenderSettings::ray_depth_spacing.
  std::optional<RayDepth> ray_depth();
  /// Returns the image of one texel to bind where there is no image.
  vk::Image& placeholder_image();
  /// Reads back the last image as floats. Must not be called if it was rendered without `float_image`.
  Result<ImageF32> read_back_float();
  /// Returns the maximum image side on this device, pixels.
  std::uint32_t max_image_side() const;
  /// Returns whether the packet can be rendered with RenderSettings::fast. Also false for a volume for which the last attempt ran out of
  /// memory.
  bool can_draw_fast(const FramePacket& packet) const;
  /// Returns whether the rays of the last draw() or sample_rays() were those of the fast raycast and skipped empty space.
  bool skips_empty_space() const;
  /// Renders only the rays of every `spacing`-th pixel in each direction, as a small image: the result of `settings` before interpolation.
  /// Used by quality.h to measure errors. Red, green and blue are composited over the packet's background (whose alpha is ignored); alpha
  /// is that of the rendered items.
  Result<Image8> sample_rays(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing);
  /// Reads back the opaque depth of the last image.
  Result<DepthImage> read_depth();
  /// Reads back the ids of the last image.
  Result<IdImage> read_ids();
  /// Returns the number of marched tiles of 16 x 16 pixels in the last image, and of all tiles. With RenderSettings::reuse_rays only the
  /// tiles where opaque objects changed are marched.
  Result<MarchedTiles> marched_tiles();
  /// Returns the number of rays that the fast raycast marched in the last image where interpolation would not suffice, at every 2nd pixel
  /// and at every pixel, in whole blocks of 16 rays.
  Result<std::array<std::uint64_t, 2>> refined_ray_counts();
  /// Reads back depth and id of one pixel of the last image: transfers two texels only. The pixel must be inside the image.
  Result<PickResult> pick(std::uint32_t x, std::uint32_t y);
  /// Returns the size of one view of the last image, pixels; 0 before the first image.
  std::array<std::uint32_t, 2> view_size() const;
  /// Presents the last image in a window (scaled to it), with the user interface over it in window pixels (ui.h). May be called repeatedly
  /// with different `ui`: the image is not rendered again. Returns false if the swapchain does not match the window and must be resized;
  /// nothing is shown then.
  Result<bool> present(vk::Swapchain& swapchain, const UiItems* ui = nullptr);
  /// Paints what present() would show with this `ui` in a window of this size, without a window.
  Outcome paint_window(std::uint32_t width, std::uint32_t height, const UiItems& ui);
  /// Returns the painted window image, for copies on the device: in the layout TRANSFER_SRC_OPTIMAL, valid until the next paint or a failed
  /// call. Null if there is none.
  vk::Image* window_image();
  /// Reads back the window image painted last by paint_window() or by present() with a user interface: window pixels, alpha 255.
  /// window_image() must not be null.
  Result<Image8> read_back_window();

  /// Replaces the embedded shader `name`, for instance "compose.frag" (pass.h), by the SPIR-V code `words` for all following images.
  /// Returns false if this code is already in use. An Error if there is no such shader or the code uses a binding that the program does not
  /// bind; the shader is unchanged then.
  Result<bool> replace_shader(std::string_view name, std::vector<std::uint32_t> words);
  /// Restores the embedded shaders.
  void restore_shaders();

  /// Returns the current statistics.
  RenderStats stats() const;
  /// Returns what is loaded of a volume that does not fit into the device's memory.
  PagingStats paging() const;
  /// Returns the first 64 messages of the validation layer.
  std::vector<std::string> validation_texts() const;
  /// Returns the device of the renderer.
  vk::Device& device();

 private:
  Renderer();
  Outcome draw_once(const FramePacket& packet, const RenderSettings& settings);
  Outcome load_sampled_pages(const FramePacket& packet, const RenderSettings& settings);
  Result<Image8> sample_rays_once(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::render
