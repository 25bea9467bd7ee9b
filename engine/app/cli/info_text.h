// SPDX-License-Identifier: MIT
/// Human-readable output of `catena info` for data files, on stdout.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/geometry/curves/curves.h"
#include "engine/geometry/mesh/mesh.h"
#include "engine/io/curves/load_points.h"

namespace catena::app {

/// Prints the contents of a data file at a time step: fields with their grids, a mesh, curves or points, and the time steps.
Outcome print_data_info(const std::string& path, const std::string& grid, int step);

/// Formats three coordinates with eight digits, which large coordinates need.
std::string format_position(const Vec3& v);
/// Print the contents of a mesh, curves or points; each line starts with `indent`.
void print_mesh(const mesh::TriangleMesh& mesh, const char* indent);
void print_curves(const curves::CurveSet& set, const char* indent);
void print_points(const curves::PointSet& set, const char* indent);

}  // namespace catena::app
