// SPDX-License-Identifier: MIT
/// Raycast of one volume by its maximum, minimum or mean value along each ray (Projection in frame_packet.h), in front of the opaque depth.
///   maximum, minimum   exact for the trilinear field of the texels, independent of the step: the extrema of each cell's cubic polynomial
///   average            midpoints of segments of the step; invalid cells do not count
/// Color and opacity are those of the transfer function at that value; the opacity is 1 - exp(-sigma u) with the table's opacity_length u
/// (where the scene gave opacities, these at its points), as in VTK. Not shaded, as in VTK; fog does not affect it. Frame thread.
#pragma once
#include <array>
#include <map>

#include "render/raycast/volume.h"

namespace catena::render {

/// Renders one volume by projection.
class ProjectionRaycast {
 public:
  static Result<ProjectionRaycast> create(vk::Device& device);
  /// Uploads changed data. `resident`: resident grid of the item.
  Outcome prepare(const VolumeItem& item, std::shared_ptr<const ResidentGrid> resident);
  /// Records the rays within a render pass over the volume target.
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
  BrickRange signed_range_;  ///< range of the values, negated for a minimum projection
  BrickMap map_;
  vk::Buffer table_, uniform_;
};

}  // namespace catena::render
