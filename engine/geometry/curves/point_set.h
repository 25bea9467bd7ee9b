// SPDX-License-Identifier: MIT
/// Sets of points with values. Points are world units in single precision; a compact set far from the world's origin is stored relative to
/// its own origin, so that single precision still separates its points. Immutable after creation; reading is safe from any thread.
#pragma once
#include "engine/base/export.h"
#include "engine/geometry/curves/curves.h"
#include "engine/geometry/curves/robust_bounds.h"

namespace catena::curves {

/// A set of points. Plain data.
struct CATENA_EXPORT PointSet {
  std::string name;                       ///< File name.
  Vec3 origin{0.0};                       ///< Origin of `points`, world units; 0 unless they are far from it and close together.
  std::vector<glm::vec3> points;          ///< Positions relative to `origin`.
  std::vector<PointValues> values{};      ///< Numeric columns.
  std::string note{};                     ///< Text for the user about data left out; may be empty.
  Vec3 min_corner{0.0}, max_corner{0.0};  ///< Corners of the bounding box of all points, world units.
  RobustBounds robust_bounds;             ///< Bounding box without outliers.
  /// Median distance from a point to its nearest neighbor, world units, estimated from a sample; 0: not defined.
  double median_spacing = 0;
  std::uint64_t version = 0;               ///< Unique in the process.
  MemoryReservation memory_reservation{};  ///< Counts the memory against the data budget.

  /// Position of point i, world units.
  Vec3 position(std::size_t i) const { return origin == Vec3(0.0) ? Vec3(points[i]) : origin + Vec3(points[i]); }
  /// Stores these world positions as `origin` and `points`.
  void set_positions(const std::vector<Vec3>& positions);
  /// Memory used by points and values, bytes.
  std::size_t bytes() const { return points.size() * (sizeof(glm::vec3) + values.size() * sizeof(float)); }
  const PointValues* find_values(std::string_view name) const;  ///< Values with that name; nullptr: none.
};
/// Shared, immutable set of points.
using PointSetPtr = std::shared_ptr<const PointSet>;

/// Completes a set whose points and values are set: name, corners, bounds, spacing, version and memory.
CATENA_EXPORT PointSet complete_points(PointSet set, const std::string& name);

}  // namespace catena::curves
