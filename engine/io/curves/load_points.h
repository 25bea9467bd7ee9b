// SPDX-License-Identifier: MIT
/// Loads points from a text table: .csv, .tsv, .xyz. The first line names the columns; x, y and z are required, in any order and case.
/// Cells are separated by commas, semicolons or tabs, otherwise by blanks. A numeric column becomes point values under its name (an empty
/// cell or "nan": no value); a column of text is left out. Points of .vtp, .vtk and .ply files are read by the catena-read-vtk process.
/// Rejected with one line "FILE:LINE: what; what was expected": positions that are not finite or exceed 1e15, rows of another length, more
/// than kMaxPoints points, more memory than the budget allows. Any thread.
#pragma once
#include "engine/base/export.h"
#include "engine/geometry/curves/point_set.h"

namespace catena::curves {

/// Loads the points of a file. `step`: time step, for a file with several. Returns an Error when the file is rejected (see above).
CATENA_EXPORT Result<PointSetPtr> load_points(const std::string& path, int step = 0);
/// Parses the contents of a text file; `name` begins every message.
CATENA_EXPORT Result<PointSet> parse_points(std::string_view text, const std::string& name);
/// Parses a text file without complete_points().
CATENA_EXPORT Result<PointSet> read_table(std::string_view text, const std::string& name);
/// Reads all points of a file through the catena-read-vtk process, with the point array that is the default for coloring, without
/// complete_points().
CATENA_EXPORT Result<PointSet> read_points(const std::string& path, int step);

}  // namespace catena::curves
