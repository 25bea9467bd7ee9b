// SPDX-License-Identifier: MIT
/// Private to this module: traces core lines from seeds and corrects each point across the line. Off the haptic thread; one object per
/// field.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "engine/geometry/flow/vortex_core_criterion.h"

namespace catena::flow {

/// Estimated point on a core line, from one Newton step at the center of a cell, with the axis of rotation.
struct CoreSeed {
  Vec3 position{0.0}, axis{0.0};
};

/// A traced core line, before smoothing.
struct CoreTrace {
  std::vector<Vec3> points;
  std::vector<double> swirls;
  bool closed = false;
  bool first_exits_domain = false, last_exits_domain = false;  ///< Its ends lie where the line exits the domain or the mask.
};

/// Traces core lines one after the other; records their points, so that no line is traced twice.
class CoreTracer {
 public:
  /// `scale`: scale of the velocity; `step`: step size along a line; `spacing`: edge of the cells in which seeds were searched, both world
  /// units; `has_kinks`: grad v has kinks at cell faces (grids).
  CoreTracer(const field::VectorField& field, CoreCriterion criterion, double scale, double step, double spacing, bool has_kinks);
  /// Traces the core line at a seed. Returns false when there is none or it has already been traced.
  bool trace(const CoreSeed& seed, CoreTrace& out);
  /// Number of points on all lines traced so far.
  std::size_t point_count() const { return point_count_; }

 private:
  struct CorrectedPoint {
    Vec3 position{0.0};
    CoreSample sample;
    bool ok = false, exits_domain = false;
  };
  CorrectedPoint correct(Vec3 position, const Vec3& along);
  bool is_traced(const Vec3& position, std::uint32_t own) const;
  void record(const Vec3& position);
  bool follow(const CorrectedPoint& from, Vec3 along, CoreTrace& out, bool& leaves);
  std::uint64_t bucket(std::int64_t x, std::int64_t y, std::int64_t z) const;

  CoreField flow_;
  double step_, spacing_, difference_, tolerance_, rough_;
  struct RecordedPoint {
    Vec3 position{0.0};
    std::uint32_t line;
    std::size_t number;  ///< Running index over all recorded points.
  };
  std::unordered_map<std::uint64_t, std::vector<RecordedPoint>> recorded_;
  std::uint32_t line_ = 0;
  std::size_t point_count_ = 0;
};

/// Joins lines whose ends are within `max_gap` (world units) and continue each other.
void join_traces(std::vector<CoreTrace>& traces, double max_gap);

}  // namespace catena::flow
