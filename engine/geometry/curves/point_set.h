// SPDX-License-Identifier: MIT
/// Points from a text table: .csv, .tsv, .xyz. The first line names the columns; x, y and z are required, in any order and case. Cells are
/// separated by commas, semicolons or tabs, otherwise by blanks. A numeric column becomes point values under its name (an empty cell or
/// "nan": no value); a column of text is left out. Points are world units in single precision; a compact set far from the world's origin is
/// stored relative to its own origin, so that single precision still separates its points. Rejected with one line
/// "FILE:LINE: what; what was expected": positions that are not finite or exceed 1e15, rows of another length, more than kMaxPoints points,
/// more memory than the budget allows. Immutable after creation; reading is safe from any thread.
#pragma once
#include "engine/geometry/curves/curves.h"
#include "engine/geometry/curves/robust_bounds.h"

namespace catena::curves {

/// A set of points. Plain data.
struct PointSet {
  std::string name;                       ///< File name.
  Vec3 origin{0.0};                       ///< Origin of `points`, world units; 0 unless they are far from it and close together.
  std::vector<glm::vec3> points;          ///< Positions relative to `origin`.
  std::vector<PointValues> values{};      ///< Numeric columns.
  std::string note{};                     ///< What was left out, as text for the user; may be empty.
  Vec3 min_corner{0.0}, max_corner{0.0};  ///< Corners of the bounding box of all points, world units.
  RobustBounds robust_bounds;             ///< Bounding box without outliers.
  /// Median distance from a point to its nearest neighbor, world units, estimated from a sample; 0: not defined.
  double median_spacing = 0;
  std::uint64_t version = 0;               ///< Unique in the process.
  MemoryReservation memory_reservation{};  ///< Counts the memory against the data budget.

  /// Position of point i, world units.
  Vec3 position(std::size_t i) const { return origin == Vec3(0.0) ? Vec3(points[i]) : origin + Vec3(points[i]); }
  /// Stores these world positions as `origin` and `points`.
  void set_positions(const std::vector<Vec3>& places);
  /// Memory used by points and values, bytes.
  std::size_t bytes() const { return points.size() * (sizeof(glm::vec3) + values.size() * sizeof(float)); }
  const PointValues* find_values(std::string_view name) const;  ///< Values with that name; nullptr: none.
};
/// Shared, immutable set of points.
using PointSetPtr = std::shared_ptr<const PointSet>;

bool is_point_file(std::string_view path);  ///< By the file extension, any case.
/// File extensions, in lower case with the dot.
const std::vector<std::string_view>& point_endings();

/// Loads the points of a file. `step`: time step, for a file with several. Returns an Error when the file is rejected (see above).
Result<PointSetPtr> load_points(const std::string& path, int step = 0);
/// Parses the contents of a text file; `name` begins every message.
Result<PointSet> parse_points(std::string_view text, const std::string& name);
/// Reads all points of a .vtp, .vtk or .ply file through the catena-read-vtk process, with the point array that is the default for
/// coloring. Corners, bounds and spacing are not computed yet.
Result<PointSet> read_points(const std::string& path, int step);

}  // namespace catena::curves
