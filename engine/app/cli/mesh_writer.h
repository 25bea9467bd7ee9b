/// Triangles for other programs, by the ending of the name:
///   .vtp   VTK's XML PolyData, raw appended: doubles, with the normals and the values of every point
///   .ply   binary, doubles, with the normals
///   .stl   binary, single precision, a normal a triangle
///   .obj   text, numbers that read back exactly, with the normals
/// World units.
#pragma once
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::app {

/// NumberArray by point.
struct PointValues {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< NaN: none there
};

struct MeshExport {
  std::vector<Vec3> points, normals;  ///< as many, or no normals
  std::vector<mesh::Triangle> triangles;
  std::vector<PointValues> values{};  ///< .vtp only
};

bool is_mesh_export_path(std::string_view path);
/// ".vtp, .ply, .stl or .obj"
std::string mesh_export_extensions();
Outcome write_mesh_file(const std::string& path, const MeshExport& surface);
/// What the file's kind cannot hold of it, a sentence without an end; empty: nothing is lost. 32-bit places (.stl) far from the origin.
std::string describe_precision_loss(const std::string& path, const MeshExport& surface);

}  // namespace catena::app
