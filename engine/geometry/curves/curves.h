/// Curves from a file: polylines such as the fibres of a tractogram. What any reader gives is this plain struct, and what is drawn and
/// felt is one object. Points are world units (of a patient's file: mm, +x to the right, +y to the front, +z to the head), in single
/// precision, as such files have them. Immutable once made; reading is safe from every thread, without allocation.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::curves {

/// A number at every point, by the name that the file has for it.
struct PointValues {
  std::string name;           ///< the file's word for it
  std::vector<float> values;  ///< one a point
};

/// A set of polylines. Plain data.
struct CurveSet {
  std::string name;               ///< of the file
  std::vector<glm::vec3> points;  ///< line after line; neighbours on a line differ
  std::vector<std::uint32_t>
      line_offsets;                       ///< line k is the points first[k] to first[k + 1] - 1, two or more; one more than there are lines
  std::vector<PointValues> values{};      ///< may be empty
  std::string unit{};                     ///< of lengths; empty: the file does not say
  bool is_patient_space = false;          ///< axes as above
  std::string note{};                     ///< what was left out, in words; may be empty
  Vec3 min_corner{0.0}, max_corner{0.0};  ///< corners of the box of all points
  std::uint64_t version = 0;              ///< unique in the process
  MemoryReservation memory_reservation{};  ///< counts the memory as data

  /// How many lines there are.
  std::size_t line_count() const { return line_offsets.empty() ? 0 : line_offsets.size() - 1; }
  /// Memory that it holds.
  std::size_t bytes() const;
  const PointValues* find_values(std::string_view name) const;  ///< the values of that name; nullptr: there are none
  /// The line that a point is on.
  std::uint32_t line_of(std::uint32_t point) const;
};
/// Sets of curves are shared and never change.
using CurveSetPtr = std::shared_ptr<const CurveSet>;

inline constexpr std::size_t kMaxPoints = 1'000'000'000;  ///< More are refused.

/// Collects what a reader finds, or what is traced. A point that equals the one before it on its line is left out, and so is a line of
/// fewer than two points.
class CurveSetBuilder {
 public:
  /// Asks for the memory of as many points as the file can hold. `name` begins every message.
  static Result<CurveSetBuilder> create(std::string name, std::size_t most_points, std::vector<std::string> value_names);

  /// False: not finite, or beyond 1e15, where squares of distances lose their meaning. `values`: as many as there are names.
  bool add(const Vec3& point, const float* values = nullptr);
  /// Ends the line; the next add() begins another.
  void end_line();
  /// Lines that have ended so far.
  std::size_t line_count() const { return set_.line_offsets.size() - 1; }

  /// A line that is still open ends here. The error: no line is left.
  Result<CurveSet> finish();

 private:
  CurveSet set_;
  std::size_t dropped_ = 0;
  double max_rounding_ = 0;  ///< the largest difference of a coordinate from what is kept
};

}  // namespace catena::curves
