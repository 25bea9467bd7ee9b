// SPDX-License-Identifier: MIT
#include "engine/geometry/geodesics/geodesics.h"

#include <queue>
#include <unordered_map>

#include "engine/geometry/mesh/mesh.h"

namespace catena::geodesics {
namespace {

constexpr int kBudget = 20'000;  // BVH nodes per query
constexpr double kFar = 1e3;     // search radius in the local frame, where the mesh lies within 1/2

/// Returns the vertices of a shortest edge path from a corner of one face to a corner of another; empty if there is none, or none is found
/// within kMaxVisitedVertices.
std::vector<Vec3> path_along_edges(const mesh::TriangleMesh& mesh, const mesh::ClosestPoint& from, const mesh::ClosestPoint& to,
                                   const Vec3& goal) {
  struct Visited {
    double distance = 0;
    std::uint32_t before = 0;
    bool done = false;
  };
  const auto position = [&](std::uint32_t v) { return mesh.vertices()[v]; };
  std::unordered_map<std::uint32_t, Visited> all;
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const Vec3 start = mesh.world_from_local(from.point);
  for (const std::uint32_t v : mesh.triangles()[from.face]) {
    all[v] = {norm(position(v) - start), v, false};
    queue.push({all[v].distance + norm(goal - position(v)), v});
  }
  const mesh::Triangle& goals = mesh.triangles()[to.face];
  while (!queue.empty() && all.size() < kMaxVisitedVertices) {
    const std::uint32_t v = queue.top().second;
    queue.pop();
    Visited& current = all[v];
    if (current.done) continue;
    current.done = true;
    const double distance = current.distance;
    if (std::find(goals.begin(), goals.end(), v) != goals.end()) {
      std::vector<Vec3> path{position(v)};
      for (std::uint32_t at = v; all[at].before != at;) path.push_back(position(at = all[at].before));
      return {path.rbegin(), path.rend()};
    }
    for (const std::uint32_t f : mesh.faces_around(v))
      for (const std::uint32_t next : mesh.triangles()[f]) {
        if (next == v) continue;
        const double new_distance = distance + norm(position(next) - position(v));
        const auto [it, inserted] = all.try_emplace(next, Visited{new_distance, v, false});
        if (!inserted && (it->second.done || !(new_distance < it->second.distance))) continue;
        it->second = {new_distance, v, false};
        queue.push({new_distance + norm(goal - position(next)), next});
      }
  }
  return {};
}

}  // namespace

std::vector<Vec3> path_on_mesh(const mesh::TriangleMesh& mesh, const Vec3& from, const Vec3& to) {
  const auto nearest = [&](const Vec3& world, std::uint32_t hint) {
    int budget = kBudget;
    return mesh::nearest_point(mesh, mesh.local_from_world(world), kFar, budget, hint);
  };
  if (!is_finite(from) || !is_finite(to)) return {};
  const mesh::NearestResult first = nearest(from, 0), last = nearest(to, 0);
  if (!first.found || !last.found) return {};
  const Vec3 a = mesh.world_from_local(first.closest.point), b = mesh.world_from_local(last.closest.point);
  std::vector<Vec3> path;
  if (first.closest.face != last.closest.face) {
    path = path_along_edges(mesh, first.closest, last.closest, b);
    if (path.empty()) return {};
  }
  path.insert(path.begin(), a);
  path.push_back(b);
  std::uint32_t hint = first.closest.face;
  return shorten_path(std::move(path), [&](Vec3& p) {
    const mesh::NearestResult result = nearest(p, hint);
    if (!result.found) return false;
    hint = result.closest.face;
    p = mesh.world_from_local(result.closest.point);
    return true;
  });
}

}  // namespace catena::geodesics
