// SPDX-License-Identifier: MIT
/// Loads curves from tractograms; the formats are rows of a registry.
///   .tck  MRtrix: a text header up to END, then triples of floats (datatype Float32LE, Float32BE, Float64LE, Float64BE) in scanner
///         millimeters; a triple of NaN ends a line, a triple of infinities the file
///   .trk  TrackVis, versions 1 to 3: a header of 1000 bytes (hdr_size reveals the byte order), then lines of points in "voxmm"; with v the
///         voxel size, d the dimensions, o the map from voxel_order to the axes of vox_to_ras:  world = vox_to_ras o (point / v - 1/2).
///         A header without vox_to_ras or voxel_order means the identity and LPS. Scalars become point values; properties are skipped.
///   .vtp, .vtk, .vtu  VTK polylines, also those named by a .pvd or .series file, with the point array that is the default for coloring;
///         read by catena-read-vtk
/// Rejected with one line "FILE: place: what; what was expected": numbers that are not finite, an inconsistent header, a truncated file,
/// more memory than the budget allows (engine/base/memory_limit.h). Off the haptic thread.
#pragma once
#include <string_view>

#include "engine/base/export.h"
#include "engine/geometry/curves/curves.h"

namespace catena::curves {

/// Loads a file in any of these formats. `step`: time step, for a file with several. Returns an Error when the file is rejected.
CATENA_EXPORT Result<CurveSetPtr> load_curves(const std::string& path, int step = 0);

/// Parses the contents of a .tck file; `name` begins every message.
CATENA_EXPORT Result<CurveSet> parse_tck(std::string_view bytes, const std::string& name);
/// Parses the contents of a .trk file; `name` begins every message.
CATENA_EXPORT Result<CurveSet> parse_trk(std::string_view bytes, const std::string& name);
/// Reads the lines of a file through catena-read-vtk, at a time step.
CATENA_EXPORT Result<CurveSet> read_lines(const std::string& path, int step);

}  // namespace catena::curves
