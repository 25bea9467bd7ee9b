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
#include "engine/mesh/mesh.h"

namespace catena::app {

/// Numbers by point.
struct PointValues {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< NaN: none there
};

struct Surface {
  std::vector<Vec3> points, normals;  ///< as many, or no normals
  std::vector<mesh::Triangle> triangles;
  std::vector<PointValues> values{};  ///< .vtp only
};

bool is_surface_file(std::string_view path);
/// ".vtp, .ply, .stl or .obj"
std::string surface_endings();
Outcome write_surface(const std::string& path, const Surface& surface);
/// What the file's kind cannot hold of it, a sentence without an end; empty: nothing is lost. 32-bit places (.stl) far from the origin.
std::string lost_in(const std::string& path, const Surface& surface);

}  // namespace catena::app
