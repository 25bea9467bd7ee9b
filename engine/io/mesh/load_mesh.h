/// Reads triangle meshes: STL (binary and ASCII) and OBJ here; PLY, GIFTI and VTK's surfaces by the program catena-read-vtk. Corners are
/// joined as they lie; stored normals, colours, texture coordinates, groups and materials are not used: the outside is where the corners
/// run counter-clockwise. OBJ polygons become fans. Refused, with one line "FILE: place: what; what was expected": numbers that are not
/// finite, indices of vertices that are not there, a file that ends too early or is longer than it says, more than kMaxTriangles, more than
/// the memory that is allowed (engine/base/memory_limit.h). Off the tick.
#pragma once
#include <string_view>

#include "engine/geometry/mesh/mesh.h"

namespace catena::mesh {

inline constexpr std::size_t kMaxTriangles = 20'000'000;  ///< More are refused.

bool is_mesh_file(std::string_view path);  ///< by its ending, any case; .vtk, .vtu and .vtm may hold fields instead
/// The endings, in lower case with the dot.
const std::vector<std::string_view>& mesh_endings();

/// world = scale * file + offset
struct MeshTransform {
  double scale = 1;  ///< of the file's numbers
  Vec3 offset{0.0};  ///< world units, added after the scale
  bool operator==(const MeshTransform&) const = default;
};

/// Reads a file of any of these formats and makes the mesh. `step`: of a file that has several in time.
Result<MeshPtr> load_mesh(const std::string& path, const MeshTransform& placement = {}, int step = 0);

/// The contents of a file; `name` begins every message.
Result<TriangleSoup> parse_stl(std::string_view bytes, const std::string& name);
/// The contents of an .obj file.
Result<TriangleSoup> parse_obj(std::string_view text, const std::string& name);

/// The surface in a file of the reader program: a whole sentence where there is none.
Result<TriangleSoup> read_surface(const std::string& path, int step);

}  // namespace catena::mesh
