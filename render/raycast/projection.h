/// One volume by its greatest, its least or its mean value along each ray (Projection in frame_packet.h), in front of the opaque depth.
///   maximum, minimum   exact for the trilinear field of the texels, whatever the step: the extremes of each cell's cubic
///   average            midpoints of segments of the step; invalid cells do not count
/// Colour and opacity come from the transfer function at that value; the opacity is 1 - exp(-sigma u) with the table's opacity_length u
/// (where the scene gave opacities, these at its points), as VTK takes it. Not shaded, as in VTK; fog leaves it as it is. Frame thread.
#pragma once
#include <array>
#include <map>

#include "render/raycast/volume.h"

namespace catena::render {

class ProjectionRaycast {
 public:
  static Result<ProjectionRaycast> create(vk::Device& device);
  Outcome prepare(const VolumeItem& item, std::shared_ptr<const ResidentGrid> mirror);
  /// CellFinder a pass over the volume target.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area, const RayScene& scene);

 private:
  ProjectionRaycast() = default;
  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  std::map<std::array<std::uint32_t, 3>, vk::Pipeline> pipelines_;
  std::shared_ptr<const ResidentGrid> resident_;
  VolumeItem item_;
  TransferLut lut_;
  double opacity_length_ = 0;
  BrickRange signed_range_;  ///< of signed values
  BrickMap map_;
  vk::Buffer table_, uniform_;
};

}  // namespace catena::render
