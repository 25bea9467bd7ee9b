/// The renderer: a frame packet in, a finished colour image out.   opaque (tubes, glyphs, isosurfaces) -> volume -> compose
/// Passes, their pipelines and images are created when the first packet needs them; mirrors are kept by (grid version, texel
/// format) and dropped when a packet no longer names the grid. Frame thread only.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "render/frame/frame_packet.h"
#include "render/mirror/grid_mirror.h"
#include "render/passes/fast_settings.h"
#include "render/vk/device.h"
#include "render/vk/picture.h"

namespace catena::render {

namespace vk {
class Swapchain;
}

enum class TexelFormat { automatic, r16f, r32f };

struct RenderSettings {
  double step_voxels = 1;                       ///< in smallest voxel edges
  double termination = 1.0 / 512;               ///< a ray ends when less than this gets through
  TexelFormat texels = TexelFormat::automatic;  ///< automatic: r32f where a grid carries an isosurface, r16f elsewhere
  MirrorLayout layout = MirrorLayout::automatic;
  bool skip = true;  ///< leap over bricks that the transfer function leaves empty
  /// Draws a lone volume by the fast raycast, if it can; what is above then holds for everything else.
  std::optional<FastSettings> fast;
};
RenderSettings draft_settings();      ///< every 4th pixel at step 4; where the fast raycast cannot: step 2
RenderSettings balanced_settings();   ///< every 4th pixel at step 2.5, refined where the picture asks for it; where it cannot: step 1
RenderSettings reference_settings();  ///< step 0.1, R32F, termination 1e-4

struct RenderStats {
  std::string device, driver;
  std::uint64_t gpu_bytes = 0;  ///< held now
  std::uint64_t uploads = 0;    ///< copies to the device so far
  std::uint64_t upload_bytes = 0;
  std::uint64_t pipelines = 0;            ///< created so far
  std::uint64_t mirrors = 0;              ///< grids mirrored now
  double mirror_ms = 0;                   ///< spent on building and uploading mirrors so far
  std::string text_fault;                 ///< why text is left out, or empty
  std::uint64_t validation_messages = 0;  ///< warnings and errors of the validation layer so far
};

/// Pixels between the rays of Renderer::probe; prime to every lattice's spacing.
inline constexpr std::uint32_t kProbeSpacing = 13;

/// View depth of the nearest opaque surface: distance along the view axis, world units; infinite where there is none.
struct DepthPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<float> depth;
};

class Renderer {
 public:
  static Result<std::unique_ptr<Renderer>> create(const vk::DeviceOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws and waits for the fence of the finished colour image.
  Outcome draw(const FramePacket& packet, const RenderSettings& settings = {});
  /// The last picture, straight alpha.
  Result<Picture> read_back();
  /// Whether `RenderSettings::fast` holds for what the packet draws.
  bool draws_fast(const FramePacket& packet) const;
  /// The rays of every kProbeSpacing-th pixel alone, as a small picture over black: what `settings` make of them before anything is
  /// interpolated. What quality.h measures errors with.
  Result<Picture> probe(const FramePacket& packet, const RenderSettings& settings);
  /// The opaque depth of the last picture.
  Result<DepthPicture> read_depth();
  /// Shows the last picture in a window (scaled to it). False: the swapchain no longer fits, resize it.
  Result<bool> present(vk::Swapchain& swapchain);

  RenderStats stats() const;
  std::vector<std::string> validation_texts() const;
  vk::Device& device();

 private:
  Renderer();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace catena::render
