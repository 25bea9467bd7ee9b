/// Text and flat shapes over the finished picture: scalar bars, labels, title, orientation marker, status. They are drawn into an image
/// of their own (premultiplied) and blended into the picture (straight alpha), so that both opaque and transparent pictures are right.
/// Without an item there is no pass. Without a font there is no text, and `fault` says why.
#pragma once
#include "render/passes/camera_rays.h"
#include "render/passes/targets.h"
#include "render/text/typesetter.h"
#include "render/vk/commands.h"

namespace catena::render {

class OverlayPass {
 public:
  static Result<OverlayPass> create(vk::Device& device);
  /// Lays the items out and uploads what is new.
  Outcome prepare(const FramePacket& packet, const CameraRays& rays);
  /// After the picture is composed. `opaque_depth`: what hides labels, or none.
  Outcome record(vk::Commands& commands, Targets& targets, vk::Image* opaque_depth);
  const std::string& fault() const { return typesetter_->fault(); }

 private:
  OverlayPass() = default;
  Outcome upload_atlas();

  vk::Device* device_ = nullptr;
  std::unique_ptr<Typesetter> typesetter_;
  vk::Pipeline draw_, blend_;
  vk::Buffer shapes_, stops_, uniform_;
  vk::Image atlas_, image_;
  std::uint64_t atlas_version_ = 0;
  std::uint32_t count_ = 0;
  double slack_ = 0;
};

}  // namespace catena::render
