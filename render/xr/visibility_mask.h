// SPDX-License-Identifier: MIT
/// Parts of a view that the lenses never show (XR_KHR_visibility_mask): triangles from the runtime, rendered black right in front of the
/// eye, so that no ray is marched behind them. Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/stereo/xr_views.h"
#include "render/xr/session.h"

namespace catena::render::xr {

/// Hidden area mesh in the plane at distance 1 in front of the eye: coordinates to the right and up are tangents.
struct HiddenMesh {
  std::vector<std::array<float, 2>> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices per triangle
  bool empty() const { return triangles.empty(); }
};

/// Loads the mesh of a view; empty if the runtime does not support it or hides nothing. An Error if the call fails.
Result<HiddenMesh> load_hidden_mesh(Session& session, std::size_t view);

/// Returns the mesh as a scene item, so near to the eye that nothing is in front of it.
MeshItem make_mask_item(const HiddenMesh& mesh, const Placement& placement, const XrEye& eye);

}  // namespace catena::render::xr
