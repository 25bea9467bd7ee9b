/// Reads curves from tractograms; one line of a registry a format.
///   .tck  MRtrix: a text header up to END, then triples of floats (datatype Float32LE, Float32BE, Float64LE, Float64BE), scanner
///         millimetres; a triple of NaN ends a line, one of infinities the file
///   .trk  TrackVis, versions 1 to 3: a header of 1000 bytes (hdr_size says the byte order), then lines of points in "voxmm"; with v the
///         voxel size, d the dimensions, o what turns voxel_order into the axes of vox_to_ras:  world = vox_to_ras o (point / v - 1/2).
///         A header without vox_to_ras or voxel_order means the identity and LPS. Scalars are values at points; properties are skipped.
///   .vtp, .vtk, .vtu  VTK's polylines, also those that a .pvd or .series names, with the number at each point that most would colour by,
///   by the program catena-read-vtk
/// Refused, with one line "FILE: place: what; what was expected": numbers that are not finite, a header that says nonsense, a file that
/// ends too early, more than the memory that is allowed (engine/base/memory_limit.h). Off the tick.
#pragma once
#include <string_view>

#include "engine/geometry/curves/curves.h"

namespace catena::curves {

bool is_curve_file(std::string_view path);  ///< by its ending, any case; .vtp, .vtk and .vtu may hold other things instead
/// The endings, in lower case with the dot.
const std::vector<std::string_view>& curve_endings();

/// Reads a file of any of these formats. `step`: of a file that has several in time.
Result<CurveSetPtr> load_curves(const std::string& path, int step = 0);

/// The contents of a file; `name` begins every message.
Result<CurveSet> parse_tck(std::string_view bytes, const std::string& name);
/// The contents of a .trk file.
Result<CurveSet> parse_trk(std::string_view bytes, const std::string& name);
/// The lines in a file of the program catena-read-vtk.
Result<CurveSet> read_lines(const std::string& path, int step);

}  // namespace catena::curves
