// SPDX-License-Identifier: MIT
/// Writers of triangle meshes for other programs, selected by file extension:
///   .vtp   VTK's XML PolyData, raw appended: doubles, with the normals and the values at every point
///   .ply   binary, doubles, with the normals
///   .stl   binary, single precision, one normal per triangle
///   .obj   text, numbers that read back exactly, with the normals
/// Coordinates are in world units.
#pragma once
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::app {

/// One named array with values at the points of a mesh.
struct PointValues {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< `components` values per point; NaN: no value there
};

/// The mesh to write.
struct MeshExport {
  std::vector<Vec3> points, normals;  ///< One normal per point, or no normals
  std::vector<mesh::Triangle> triangles;
  std::vector<PointValues> values{};  ///< Written to .vtp only
};

/// Whether the path has one of the extensions above.
bool is_mesh_export_path(std::string_view path);
/// The extensions for messages: ".vtp, .ply, .stl or .obj".
std::string mesh_export_extensions();
/// Writes the file atomically. Error: another extension, or the file cannot be written.
Outcome write_mesh_file(const std::string& path, const MeshExport& surface);
/// Describes a loss of precision in the file's format, for a note (a clause without a full stop); empty: none that matters. Reported for
/// .stl, whose 32-bit coordinates far from the origin merge corners in more than 1 % of the triangles.
std::string describe_precision_loss(const std::string& path, const MeshExport& surface);

}  // namespace catena::app
