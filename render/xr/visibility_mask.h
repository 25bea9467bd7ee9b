/// What of a view the lenses never show: triangles that the runtime knows, drawn black right before the eye, so that no ray is marched
/// behind them. XR_KHR_visibility_mask. Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/stereo/xr_views.h"
#include "render/xr/session.h"

namespace catena::render::xr {

/// At the distance 1 before the eye: right and up are tangents.
struct HiddenMesh {
  std::vector<std::array<float, 2>> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices each
  bool empty() const { return triangles.empty(); }
};

/// Empty where the runtime does not offer it, or hides nothing.
Result<HiddenMesh> load_hidden_mesh(Session& session, std::size_t view);

/// The mesh as a part of the scene, so near that nothing stands before it.
MeshItem make_mask_item(const HiddenMesh& mesh, const Placement& placement, const XrEye& eye);

}  // namespace catena::render::xr
