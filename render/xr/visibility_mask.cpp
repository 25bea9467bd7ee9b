// SPDX-License-Identifier: MIT
#include "render/xr/visibility_mask.h"

#include <algorithm>
#include <cmath>

namespace catena::render::xr {

namespace {

constexpr double kNearM = 0.02;  // distance of the mask from the eye, nearer than any object

}  // namespace

Result<HiddenMesh> load_hidden_mesh(Session& session, std::size_t view) {
  HiddenMesh mesh;
  const auto get = session.dispatch().GetVisibilityMaskKHR;
  if (!session.instance().capabilities().visibility_mask || !get) return mesh;
  XrVisibilityMaskKHR mask{};
  mask.type = XR_TYPE_VISIBILITY_MASK_KHR;
  const auto ask = [&] {
    return get(session.handle(), XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, std::uint32_t(view),
               XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask);
  };
  CATENA_XR_CHECK(session, ask(), "report its visibility mask");
  constexpr std::uint32_t kMaxCount = 1'000'000;
  if (mask.vertexCountOutput == 0 || mask.indexCountOutput == 0 || mask.vertexCountOutput > kMaxCount || mask.indexCountOutput > kMaxCount)
    return mesh;
  std::vector<XrVector2f> vertices(mask.vertexCountOutput);
  mesh.triangles.resize(mask.indexCountOutput);
  mask.vertexCapacityInput = mask.vertexCountOutput;
  mask.indexCapacityInput = mask.indexCountOutput;
  mask.vertices = vertices.data();
  mask.indices = mesh.triangles.data();
  CATENA_XR_CHECK(session, ask(), "report its visibility mask");
  mesh.triangles.resize(std::min<std::size_t>(mesh.triangles.size(), mask.indexCountOutput) / 3 * 3);
  // a mesh with an index beyond its vertices or a position that is not finite is ignored
  if (std::ranges::any_of(mesh.triangles, [&](std::uint32_t i) { return i >= vertices.size(); })) return HiddenMesh{};
  if (!std::ranges::all_of(vertices, [](const XrVector2f& v) { return std::isfinite(v.x) && std::isfinite(v.y); })) return HiddenMesh{};
  for (const XrVector2f& v : vertices) mesh.vertices.push_back({v.x, v.y});
  return mesh;
}

MeshItem make_mask_item(const HiddenMesh& mesh, const Placement& placement, const XrEye& eye) {
  auto geometry = std::make_shared<MeshGeometry>();
  for (const auto& [x, y] : mesh.vertices)
    geometry->vertices.push_back(placement.to_world(eye.position + eye.local_from_eye * (kNearM * Vec3(x, y, -1.0))));
  geometry->triangles = mesh.triangles;
  MeshItem item;
  item.geometry = std::move(geometry);
  item.color = {0, 0, 0};
  item.is_clipped = false;
  return item;
}

}  // namespace catena::render::xr
