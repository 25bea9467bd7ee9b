/// Points from a table of text: .csv, .tsv, .xyz. The first line names the columns; x, y and z must be there, in any order and case; cells
/// are parted by commas, semicolons or tabs, else by blanks. A column of numbers is values by its name (an empty cell, or "nan": none), one
/// of words is left out. Points are world units, in single precision; those that lie together far from the world's origin are kept beside
/// an origin of their own, so that single precision does not part them. Refused, with one line "FILE:LINE: what; what was expected": places
/// that are not finite or beyond 1e15, rows of another length, more than kMaxPoints, more than the memory that is allowed. Immutable once
/// made; reading is safe from every thread.
#pragma once
#include "engine/geometry/curves/curves.h"
#include "engine/geometry/curves/robust_bounds.h"

namespace catena::curves {

/// A set of points. Plain data.
struct PointSet {
  std::string name;                        ///< of the file
  Vec3 origin{0.0};                        ///< of `points`; 0 unless they are far from it and near to each other
  std::vector<glm::vec3> points;           ///< the places, less `origin`
  std::vector<PointValues> values{};       ///< columns of numbers
  std::string note{};                      ///< what was left out, in words; may be empty
  Vec3 min_corner{0.0}, max_corner{0.0};   ///< corners of the box of all points, world
  RobustBounds robust_bounds;              ///< all but strays
  double median_spacing = 0;               ///< the median distance of a point from the nearest other one, of a sample; 0: there is none
  std::uint64_t version = 0;               ///< unique in the process
  MemoryReservation memory_reservation{};  ///< counts the memory as data

  /// Of a point in the world.
  Vec3 position(std::size_t i) const { return origin == Vec3(0.0) ? Vec3(points[i]) : origin + Vec3(points[i]); }
  /// Keeps these places as origin and points.
  void set_positions(const std::vector<Vec3>& places);
  /// Memory that it holds.
  std::size_t bytes() const { return points.size() * (sizeof(glm::vec3) + values.size() * sizeof(float)); }
  const PointValues* find_values(std::string_view name) const;  ///< the values of that name; nullptr: there are none
};
/// Sets of points are shared and never change.
using PointSetPtr = std::shared_ptr<const PointSet>;

bool is_point_file(std::string_view path);  ///< by its ending, any case
/// The endings, in lower case with the dot.
const std::vector<std::string_view>& point_endings();

/// Reads a file. `step`: of a file that has several in time.
Result<PointSetPtr> load_points(const std::string& path, int step = 0);
/// The contents of a file; `name` begins every message.
Result<PointSet> parse_points(std::string_view text, const std::string& name);
/// All points in a file of the program catena-read-vtk (.vtp, .vtk, .ply), with the number at each that most would colour by; not yet
/// measured.
Result<PointSet> read_points(const std::string& path, int step);

}  // namespace catena::curves
