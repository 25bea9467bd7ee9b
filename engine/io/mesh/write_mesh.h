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

namespace catena::mesh {

/// One named array with values at the points of a mesh.
struct PointValues {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< `components` values per point; NaN: no value there
};

/// The mesh to write.
struct MeshExport {
  std::vector<Vec3> points, normals;  ///< One normal per point, or no normals
  std::vector<Triangle> triangles;
  std::vector<PointValues> values{};  ///< Written to .vtp only
};

void write_vtp(OutputFile& out, const MeshExport& surface);
void write_ply(OutputFile& out, const MeshExport& surface);
void write_stl(OutputFile& out, const MeshExport& surface);
void write_obj(OutputFile& out, const MeshExport& surface);

/// Writes the file atomically, in the format of its extension. Error: another extension, or the file cannot be written.
Outcome write_mesh(const std::string& path, const MeshExport& surface);
/// Describes a loss of precision in the file's format, for a note (a clause without a full stop); empty: none that matters. Reported for
/// .stl, whose 32-bit coordinates far from the origin merge corners in more than 1 % of the triangles.
std::string describe_precision_loss(const std::string& path, const MeshExport& surface);

}  // namespace catena::mesh
