// SPDX-License-Identifier: MIT
// Loads surfaces read by the program catena-read-vtk: PLY, GIFTI, VTK polygons, and the outer surfaces of volumes.
#include "engine/io/client.h"
#include "engine/io/mesh/load_mesh.h"

namespace catena::mesh {

Result<TriangleSoup> read_surface(const std::string& path, int step) {
  field::LoadRequest request;
  request.path = path;
  request.step = step;
  CATENA_TRY(const field::MappedResponse answer, field::run_reader(field::ReadMode::geometry, request));
  const auto xyz = answer.numbers<double>(answer.response.geometry.points);
  const auto corners = answer.numbers<std::uint32_t>(answer.response.geometry.triangles);
  if (corners.empty()) return Error{path + ": contains no polygons; a surface was expected"};
  TriangleSoup soup;
  soup.vertices.reserve(xyz.size() / 3);
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    soup.vertices.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
    if (!is_finite(soup.vertices.back())) return Error{path + ": a point is not finite; finite numbers were expected"};
  }
  if (corners.size() / 3 > kMaxTriangles)
    return Error{path + ": has " + std::to_string(corners.size() / 3) + " triangles; at most " + std::to_string(kMaxTriangles) +
                 " were expected"};
  soup.triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Triangle triangle{corners[i], corners[i + 1], corners[i + 2]};
    for (const std::uint32_t corner : triangle)
      if (corner >= soup.vertices.size()) return field::damaged_response_error(path, "a triangle refers to a point that does not exist");
    soup.triangles.push_back(triangle);
  }
  return soup;
}

}  // namespace catena::mesh
