/// `catena info` of data files, on stdout, for people.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/geometry/curves/curves.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/geometry/mesh/mesh.h"

namespace catena::app {

/// Fields with their grids, a mesh, curves or points, as they are at a step in time, and the steps.
Outcome print_data_info(const std::string& path, const std::string& grid, int step);

/// Three coordinates, to eight digits, as large ones need them.
std::string format_position(const Vec3& v);
/// What a mesh, curves or points hold, each line after `indent`.
void print_mesh(const mesh::TriangleMesh& mesh, const char* indent);
void print_curves(const curves::CurveSet& set, const char* indent);
void print_points(const curves::PointSet& set, const char* indent);

}  // namespace catena::app
