/// Everything that a ray blends, in order: volumes and translucent isosurfaces, in front of the opaque depth. A lone volume goes to
/// the fast raycast where the settings ask for it and it can be packed (fast_volume.h); all else to the exact one (volume.h).
#pragma once
#include <optional>

#include "render/passes/fast_volume.h"
#include "render/passes/pass.h"
#include "render/passes/volume.h"

namespace catena::render {

class RaycastPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device);
  PassUse use(const Frame& frame) const override;
  Outcome prepare(Frame& frame) override;
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;
  double build_ms() const override { return fast_pass_ ? fast_pass_->build_ms() : 0; }

  /// The rays of every `spacing`-th pixel alone, into `target` (kVolumeFormat).
  Outcome record_probe(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target);
  /// One volume and no translucent isosurface, of a grid that can be packed.
  static bool draws_fast(const vk::Device& device, const FramePacket& packet);

 private:
  RaycastPass() = default;
  bool ends_at_half(const Frame& frame) const;

  std::optional<VolumePass> exact_pass_;
  std::optional<FastVolumePass> fast_pass_;
  const VolumeItem* fast_ = nullptr;  ///< of this frame
  bool any_ = false;
  std::vector<const field::ScalarGrid*> grids_;
};

extern const PassEntry kRaycastPass;

}  // namespace catena::render
