// SPDX-License-Identifier: MIT
/// Loads triangle meshes: STL (binary and ASCII) and OBJ here; PLY, GIFTI and VTK surfaces through catena-read-vtk. Corners with equal
/// coordinates are welded; stored normals, colors, texture coordinates, groups and materials are ignored: the outward side is where the
/// corners are counter-clockwise. OBJ polygons become triangle fans. Rejected with one line "FILE: place: what; what was expected": numbers
/// that are not finite, vertex indices out of range, a file that is truncated or longer than it states, more than kMaxTriangles, more
/// memory than the budget allows (engine/base/memory_limit.h). Off the haptic thread.
#pragma once
#include <string_view>

#include "engine/base/export.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::mesh {

inline constexpr std::size_t kMaxTriangles = 20'000'000;  ///< Meshes with more triangles are rejected.

/// Placement of a mesh: world = scale * file + offset.
struct MeshTransform {
  double scale = 1;  ///< World units per unit of the file.
  Vec3 offset{0.0};  ///< World units, added after scaling.
  bool operator==(const MeshTransform&) const = default;
};

/// Loads a file in any of these formats and creates the mesh. `step`: time step, for a file with several. Returns an Error when the file
/// is rejected.
CATENA_EXPORT Result<MeshPtr> load_mesh(const std::string& path, const MeshTransform& placement = {}, int step = 0);

/// Parses the contents of an .stl file; `name` begins every message.
CATENA_EXPORT Result<TriangleSoup> parse_stl(std::string_view bytes, const std::string& name);
/// Parses the contents of an .obj file; `name` begins every message.
CATENA_EXPORT Result<TriangleSoup> parse_obj(std::string_view text, const std::string& name);

/// Reads the surface of a file through catena-read-vtk. Returns an Error with a complete message when there is none.
CATENA_EXPORT Result<TriangleSoup> read_surface(const std::string& path, int step);

}  // namespace catena::mesh
