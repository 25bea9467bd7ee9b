/// Everything that a ray blends, in order: volumes, translucent isosurfaces and the layers of other passes, in front of the opaque depth. A
/// lone volume goes to the fast raycast where the settings ask for it and it can be packed (fast_volume.h); all else to the exact one
/// (volume.h), and so does what there is no memory for: the picture is slower then, and the stats' notes say so.
#pragma once
#include <optional>

#include "render/passes/pass.h"
#include "render/raycast/fast_volume.h"
#include "render/raycast/projection.h"
#include "render/raycast/volume.h"

namespace catena::render {

class RaycastPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device);
  PassUse use(const Frame& frame) const override;
  Outcome prepare(Frame& frame) override;
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;
  double build_ms() const override { return fast_pass_ ? fast_pass_->build_ms() : 0; }
  std::string note() const override { return wanted_fast_ && !fast_ ? refused_.reason : std::string(); }

  /// The rays of every `spacing`-th pixel alone, into `target` (kVolumeFormat).
  Outcome record_probe(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target);
  /// One volume and no translucent isosurface, of a grid that can be packed; composite, its look a matter of its value alone.
  static bool draws_fast(const vk::Device& device, const FramePacket& packet);
  /// The fast raycast was tried and had no memory for it.
  bool has_refused(const FramePacket& packet) const {
    return !refused_.reason.empty() && packet.volumes.size() == 1 && packet.volumes.front().grid->version() == refused_.version;
  }

 private:
  RaycastPass() = default;
  bool ends_at_half(const Frame& frame) const;
  /// A grid that the fast raycast had no memory for; not tried again before another one, or other settings, come.
  struct Refused {
    std::uint64_t version = 0, most_bytes = 0;
    bool gradients = false;
    std::string reason;
  };
  bool prepare_fast(Frame& frame);
  /// The volumes, or the one that is projected; into the target that is begun.
  Outcome record_exact(vk::Commands& commands, Frame& frame, const CameraRays& rays, const VkRect2D& area);

  std::optional<VolumeRaycast> exact_pass_;
  std::optional<ProjectionRaycast> projection_pass_;
  std::optional<FastVolumeRaycast> fast_pass_;
  const VolumeItem* fast_ = nullptr;  ///< of this frame
  Refused refused_;
  bool wanted_fast_ = false;
  bool any_ = false, projected_ = false;
  std::vector<const field::ScalarGrid*> grids_;
};

extern const PassEntry kRaycastPass;

}  // namespace catena::render
