// SPDX-License-Identifier: MIT
/// Raycast of one volume that does not fit into the device's memory by its maximum, minimum or mean value along each ray, as
/// ProjectionRaycast (projection.h), from pages of 16-bit numbers (paged_volume.h). Frame thread.
#pragma once
#include <array>
#include <map>
#include <optional>

#include "render/raycast/paged_volume.h"
#include "render/raycast/projection.h"

namespace catena::render {

/// Renders one paged volume by projection.
class PagedProjection {
 public:
  explicit PagedProjection(vk::Device& device) : device_(&device) {}
  /// Creates the pool, of at most `max_bytes`, and uploads changed data; loads pages if `loads`. An Error if the memory does not suffice.
  Outcome prepare(const VolumeItem& item, std::uint64_t max_bytes, bool loads);
  /// Records the rays within a render pass over the volume target.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area, const RayScene& scene);
  /// Returns the pages. After prepare().
  PagedVolume& pages() { return *pages_; }

 private:
  vk::Device* device_;
  VolumeItem item_;
  std::optional<PagedVolume> pages_;
  TransferLut lut_;
  double opacity_length_ = 0;
  std::map<std::array<std::uint32_t, 4>, vk::Pipeline> pipelines_;
  vk::Buffer table_, uniform_;
};

}  // namespace catena::render
