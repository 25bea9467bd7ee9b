/// Private to this room: follows core lines from seeds, each place corrected across the line. Off the tick; one object a field.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "engine/geometry/flow/vortex_core_criterion.h"

namespace catena::flow {

/// Where a core may be: found by one Newton step from the middle of a cell.
struct CoreSeed {
  Vec3 position{0.0}, axis{0.0};
};

/// A line as it was traced.
struct CoreTrace {
  std::vector<Vec3> points;
  std::vector<double> swirls;
  bool closed = false;
  bool first_exits_domain = false, last_exits_domain = false;  ///< its ends are where the domain or the mask is left
};

class CoreTracer {
 public:
  /// `step`: along a line; `spacing`: of the cells in which seeds were sought.
  CoreTracer(const field::VectorField& field, CoreCriterion criterion, double scale, double step, double spacing, bool has_kinks);
  /// Follows the line at a seed. False: there is none, or it is traced already.
  bool trace(const CoreSeed& seed, CoreTrace& out);
  /// Places on lines so far.
  std::size_t point_count() const { return point_count_; }

 private:
  struct CorrectedPoint {
    Vec3 position{0.0};
    CoreSample sample;
    bool ok = false, exits_domain = false;
  };
  CorrectedPoint correct(Vec3 place, const Vec3& along);
  bool is_traced(const Vec3& place, std::uint32_t own) const;
  void record(const Vec3& place);
  bool follow(const CorrectedPoint& from, Vec3 along, CoreTrace& out, bool& leaves);
  std::uint64_t bucket(std::int64_t x, std::int64_t y, std::int64_t z) const;

  CoreField flow_;
  double step_, spacing_, difference_, tolerance_, rough_;
  struct RecordedPoint {
    Vec3 position{0.0};
    std::uint32_t line;
    std::size_t number;  ///< of all
  };
  std::unordered_map<std::uint64_t, std::vector<RecordedPoint>> recorded_;
  std::uint32_t line_ = 0;
  std::size_t point_count_ = 0;
};

/// Joins lines whose ends are within `reach` and lead to each other.
void join_traces(std::vector<CoreTrace>& traces, double reach);

}  // namespace catena::flow
