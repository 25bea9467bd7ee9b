/// What of a view the lenses never show: triangles that the runtime knows, drawn black right before the eye, so that no ray is marched
/// behind them. XR_KHR_visibility_mask. Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/stereo/room_eye.h"
#include "render/xr/session.h"

namespace catena::render::xr {

/// At the distance 1 before the eye: right and up are tangents.
struct HiddenMesh {
  std::vector<std::array<float, 2>> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices each
  bool empty() const { return triangles.empty(); }
};

/// Empty where the runtime does not offer it, or hides nothing.
Result<HiddenMesh> hidden_mesh(Session& session, std::size_t view);

/// The mesh as a part of the scene, so near that nothing stands before it.
MeshItem mask_item(const HiddenMesh& mesh, const Placement& placement, const RoomEye& eye);

}  // namespace catena::render::xr
