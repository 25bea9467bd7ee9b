/// From a packet's view to the numbers of shaders/shared/frame.h: everything that can lose digits is done in double precision
/// here; shaders get rays in each grid's own index space, with depths counted from the scene and not from a distant eye.
#pragma once
#include <vulkan/vulkan.h>

#include <span>

#include "engine/field/grid/grid.h"
#include "render/frame/camera.h"
#include "render/residency/resident_grid.h"
#include "shaders/shared/frame.h"

namespace catena::render {

struct CameraRays {
  Camera camera;
  Vec3 forward{0.0};
  double reference_depth = 0;
  double depth_near = 1, depth_far = 2;
  std::vector<Plane> clip_planes;
  std::vector<LightItem> lights;
  std::optional<FogItem> fog;
  std::uint32_t spacing = 1;  ///< fragment (i, j) is the ray of pixel (spacing i, spacing j)

  /// `bounds` of everything drawn, and of what rays meet, from whose middle depths are counted, so that they stay while other things move.
  static CameraRays make(const FramePacket& packet, const Bounds& bounds, const Bounds& of_rays = {});
  double view_depth(const Vec3& world) const { return dot(world - camera.position, forward); }
  shared::FrameData frame_data() const;
  /// The ray's part of a grid's data, `whole` being the mapping of the grid that was mirrored; the caller adds table, level, colour, id and
  /// whether it is clipped.
  shared::GridData grid_data(const ResidentGrid& mirror, const field::Mapping& whole) const;
  shared::MeshFrameData mesh_frame_data(const Vec3& origin) const;
  /// The signed distance from a plane along a pixel's ray.
  shared::ClipData clip_data(const Plane& plane) const;
};

/// The pixels that the box around world points (its corners) can cover; the whole picture when one of them is behind the eye. No
/// points: none.
VkRect2D covered_area(std::span<const Vec3> points, const Camera& camera);

/// The pixels that the grids' domains can cover; the whole picture when a corner is behind the eye.
VkRect2D covered_area(std::span<const field::ScalarGrid* const> grids, const Camera& camera);

}  // namespace catena::render
