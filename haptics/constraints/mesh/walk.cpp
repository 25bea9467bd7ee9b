#include "haptics/constraints/mesh/walk.h"

namespace catena::haptics {
namespace {

constexpr double kSeam = 1e-7;
constexpr int kSeamNodes = 64;

}  // namespace

MeshWalk walk_mesh(const mesh::TriangleMesh& mesh, std::uint32_t face, const Vec3& x) noexcept {
  MeshWalk walk;
  walk.at = mesh::closest_on_face(mesh, face, x);
  int& faces = walk.faces;
  faces = 1;
  while (true) {
    const mesh::Closest from = walk.at;
    const auto offer = [&](std::uint32_t f) {
      if (f == from.face) return;
      ++faces;
      const mesh::Closest c = mesh::closest_on_face(mesh, f, x);
      if (c.distance2 < walk.at.distance2) walk.at = c;
    };
    if (from.corner >= 0) {
      for (const std::uint32_t f : mesh.fan(mesh.triangles()[from.face][static_cast<std::size_t>(from.corner)])) {
        if (faces >= kFaces) return walk;
        offer(f);
      }
    } else if (from.edge >= 0) {
      mesh::each_across(mesh, from.face, from.edge, offer);
    }
    if (walk.at.distance2 >= from.distance2 && mesh::on_border(mesh, from)) {
      double bound2 = kSeam * kSeam;
      int nodes = kSeamNodes;
      mesh.bvh().nearest(from.point, bound2, nodes, [&](std::uint32_t f) {
        const mesh::Closest near = mesh::closest_on_face(mesh, f, from.point);
        if (near.distance2 <= bound2 && faces < kFaces) offer(f);
      });
    }
    if (walk.at.distance2 >= from.distance2) {
      walk.complete = true;
      return walk;
    }
    if (faces >= kFaces) return walk;
  }
}

}  // namespace catena::haptics
