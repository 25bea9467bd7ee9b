// SPDX-License-Identifier: MIT
/// Polylines loaded from a file, such as the fibers of a tractogram, or traced. Every reader returns this plain struct; the same object
/// is rendered and used for haptics. Points are in world units (in patient space: mm, +x to the right, +y to the front, +z to the head) and
/// in single precision, as such files store them. Immutable after creation; reading is safe from any thread and does not allocate.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::curves {

/// One scalar per point, under the name that the file gives it.
struct PointValues {
  std::string name;           ///< Name of the scalar in the file.
  std::vector<float> values;  ///< One value per point.
};

/// A set of polylines. Plain data.
struct CATENA_EXPORT CurveSet {
  std::string name;               ///< File name.
  std::vector<glm::vec3> points;  ///< All points, line by line; neighboring points on a line differ.
  std::vector<std::uint32_t>
      line_offsets;  ///< Line k has the points [line_offsets[k], line_offsets[k + 1]), at least two; one entry more than lines.
  std::vector<PointValues> values{};       ///< Scalars per point; may be empty.
  std::string unit{};                      ///< Unit of length; empty: not specified by the file.
  bool is_patient_space = false;           ///< True: the axes are those of patient space (see the top of this file).
  std::string note{};                      ///< Text for the user about points left out or rounded; may be empty.
  Vec3 min_corner{0.0}, max_corner{0.0};   ///< Corners of the bounding box of all points, world units.
  std::uint64_t version = 0;               ///< Unique in the process.
  MemoryReservation memory_reservation{};  ///< Counts the memory against the data budget.

  /// Number of lines.
  std::size_t line_count() const { return line_offsets.empty() ? 0 : line_offsets.size() - 1; }
  /// Memory used by points, values and offsets, bytes.
  std::size_t bytes() const;
  const PointValues* find_values(std::string_view name) const;  ///< Values with that name; nullptr: none.
  /// Returns the index of the line that contains the point with index `point`.
  std::uint32_t line_of(std::uint32_t point) const;
};
/// Shared, immutable set of curves.
using CurveSetPtr = std::shared_ptr<const CurveSet>;

inline constexpr std::size_t kMaxPoints = 1'000'000'000;  ///< Files with more points are rejected.

/// Collects the lines that a reader or a tracer produces. A point equal to the previous one on its line is dropped, and so is a line of
/// fewer than two points.
class CATENA_EXPORT CurveSetBuilder {
 public:
  /// Checks the memory budget for `max_points` points and reserves them. `name` begins every message. Returns an Error when there are more
  /// than kMaxPoints or too little memory.
  static Result<CurveSetBuilder> create(std::string name, std::size_t max_points, std::vector<std::string> value_names);

  /// Appends a point to the open line. `values`: one per name in `value_names`. Returns false, and adds nothing, when the point is not
  /// finite or a coordinate exceeds 1e15, where squared distances lose their precision.
  bool add(const Vec3& point, const float* values = nullptr);
  /// Ends the open line; the next add() starts another one. A line without points counts as one without a length.
  void end_line();
  /// Number of lines that have ended so far.
  std::size_t line_count() const { return set_.line_offsets.size() - 1; }

  /// Ends a line that is still open and returns the set. Returns an Error when no line remains.
  Result<CurveSet> finish();

 private:
  CurveSet set_;
  std::size_t dropped_ = 0;
  double max_rounding_ = 0;  ///< Largest rounding error of a coordinate by single precision, world units.
};

}  // namespace catena::curves
