/// Private to the batch tracer: one direction of one line, fed by the steps of its lane. It accepts or shortens them, sees the
/// lap, the length and the places where the exact marcher has to help, and turns the steps into knots.
#pragma once
#include "engine/flow/batch_step.h"
#include "engine/flow/trace_parts.h"

namespace catena::flow {

/// A place that a line passed: local coordinates, the rate there, and the (signed, scaled) time to the next one.
struct RawStep {
  double q[3];
  float h;
  float k[3];
};

class BatchBranch {
 public:
  /// `out` is made anew in its memory; `steps` is memory only.
  BatchBranch(const VelocityBricks& bricks, const Flow& flow, const TraceOptions& options, double lap_gap, const Vec3& seed,
              const Vec3& tangent, double sign, std::vector<RawStep>& steps, Branch& out);
  double sign() const { return sign_; }

  /// Puts the lane on the seed; false: `out` is finished already.
  bool start(LaneGroup& group, int i);
  /// Takes what step_lanes() made of the lane and says how it goes on; false: `out` is finished.
  bool take(LaneGroup& group, int i);

 private:
  bool place(LaneGroup& group, int i, const Vec3& world, double first_step);
  bool shorten(LaneGroup& group, int i, float factor);
  bool go_by_hand(LaneGroup& group, int i);
  bool came_round(const LaneGroup& group, int i);
  double world_length(const Vec3& local) const;
  double speed(const Float4& k) const;
  void add_knots();

  const VelocityBricks& bricks_;
  const Flow& flow_;
  const TraceOptions& options_;
  double lap_gap_;
  Vec3 seed_, tangent_;
  double sign_;
  std::vector<RawStep>& steps_;
  Vec3 seed_local_{0.0};
  Vec3 seed_normal_{0.0};  ///< the tangent as a covector of local coordinates
  double height_ = 0;      ///< above the seed's plane, world units
  double way_ = 0;         ///< sum of the chords, world units
  Branch& out_;
};

}  // namespace catena::flow
