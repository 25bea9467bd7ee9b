// SPDX-License-Identifier: MIT
/// Textures of line integral convolution on slices (engine/geometry/flow/lic.h), cached in the scene. The texels are anchored to the world:
/// the camera, the size of the image and its tiles do not change them. Frame thread.
#pragma once
#include <memory>
#include <optional>

#include "engine/geometry/flow/lic.h"
#include "engine/scene/scene.h"

namespace catena::render {

/// Returns the texels that cover the part of a plane in a domain, for streaks of a length (world units; 0: fitted to the plane) of 40
/// texels, at most kMaxLicTexels along an edge; empty if the plane misses the domain. An edge of an axis-aligned plane is along an axis.
std::optional<flow::LicPlane> lic_plane(const field::Field& domain, const Vec3& point, const Vec3& normal, double length);
inline constexpr int kMaxLicTexels = 2048;  ///< Maximum number of texels along an edge of a texture.

/// Computes the texture of a slice of `domain`, if it has one and the plane or the flow has changed. Error: the flow's field cannot be
/// loaded, or is no vector field.
Outcome prepare_slice_texture(scene::Scene& scene, scene::Entity slice, const field::Field& domain);
/// Returns the texture of a slice; null: it has none.
std::shared_ptr<const flow::LicTexture> slice_texture(const scene::Scene& scene, scene::Entity slice);

}  // namespace catena::render
