// SPDX-License-Identifier: MIT
/// Conversion of a packet's view to the numbers of shaders/shared/frame.h. Everything that could lose digits is computed here in double
/// precision; shaders get rays in each grid's own index space, with depths relative to the scene and not to a distant camera.
#pragma once
#include <vulkan/vulkan.h>

#include <array>
#include <span>

#include "engine/field/grid/grid.h"
#include "render/frame/camera.h"
#include "render/frame/light_place.h"
#include "render/residency/resident_grid.h"
#include "shaders/shared/frame.h"

namespace catena::render {

/// Camera, clip planes, lights and fog of one image, and the depth range of its rays.
struct CameraRays {
  Camera camera;
  /// Unit view direction.
  Vec3 forward{0.0};
  /// View depth at which the shaders' depth t is 0, world units.
  double reference_depth = 0;
  /// Range of the depth buffer, world units.
  double depth_near = 1, depth_far = 2;
  std::vector<Plane> clip_planes;
  std::vector<LightItem> lights;
  IlluminationItem illumination;
  LightPlace light_place;
  std::optional<FogItem> fog;
  std::uint32_t spacing = 1;  ///< fragment (i, j) is the ray of pixel (spacing i, spacing j)

  /// `bounds`: bounds of everything that is rendered. `of_rays`: bounds of the items that rays sample; depths are counted from their
  /// center, so that the reference does not change while other items move. Empty: `bounds`.
  static CameraRays make(const FramePacket& packet, const Bounds& bounds, const Bounds& of_rays = {});
  /// Returns the distance of a world point from the camera plane, along the view direction.
  double view_depth(const Vec3& world) const { return dot(world - camera.position, forward); }
  /// Returns the per-image shader data, without grids.
  shared::FrameData frame_data() const;
  /// Returns the shader data of a grid: mapping of the rays to the index space of `resident`, whose source grid has the mapping `whole`.
  /// The caller adds table, level, color, id and whether it is clipped.
  shared::GridData grid_data(const ResidentGrid& resident, const field::Mapping& whole) const;
  /// Returns the per-image shader data of a mesh whose vertices are relative to `origin`.
  shared::MeshFrameData mesh_frame_data(const Vec3& origin) const;
  /// Returns the coefficients of the signed distance from a plane along a pixel's ray.
  shared::ClipData clip_data(const Plane& plane) const;
};

/// Returns a background color, which is in the display encoding, in the encoding of the images.
glm::vec4 background_data(const std::array<float, 4>& background, bool is_linear);

/// Writes how a volume scatters light.
void set_scattering(const Scattering& scattering, shared::GridData& grid);

/// Returns the pixel rectangle that contains the projections of the points, enlarged by 1 pixel; the whole image if one of them is behind
/// the camera; empty without points.
VkRect2D covered_area(std::span<const Vec3> points, const Camera& camera);

/// Returns the pixels that the fields' domains can cover; the whole image if a corner is behind the camera.
VkRect2D covered_area(std::span<const field::Field* const> fields, const Camera& camera);

}  // namespace catena::render
