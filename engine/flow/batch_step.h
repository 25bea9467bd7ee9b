/// Private to the batch tracer: one Runge-Kutta step of eight lines at once.
///   classical RK4 in the field's own (scaled) time; the rate k5 at the end is the next step's first, and closes an estimate of
///   third order:  error = |h| / 10 |k4 - k5|                 (Hairer, Norsett, Wanner I, II.4)
/// Places in double, rates and displacements in float: a step's rounding is below 1e-7 of its length.
/// Lanes: x, y, z of one sample are one register, the two neighbours along x another half; eight lines take turns stage by stage,
/// so that the processor always has work of several lines. Compiled for the baseline and for AVX2 (chosen once, at the first use):
/// the same operations in the same order, no contraction, hence the same bits. Any thread; allocates only new bricks.
#pragma once
#include "engine/flow/batch_bricks.h"

namespace catena::flow {

using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));
using Int4 = int __attribute__((vector_size(16)));
using Uint4 = unsigned __attribute__((vector_size(16)));

inline constexpr int kLanes = 8;

struct StepControl {
  float tolerance2 = 0;    ///< of the error, voxels, squared
  float longest_step = 1;  ///< voxels
};

struct alignas(32) LaneGroup {
  // given
  Double4 q[kLanes];  ///< places, local coordinates
  Float4 k[kLanes];   ///< rates there
  float h[kLanes];    ///< signed steps, scaled time
  // made
  Double4 end[kLanes];
  Float4 k_end[kLanes];
  float error2[kLanes];       ///< squared, voxels
  float allowed2[kLanes];     ///< what the tolerance and the step's own length allow of it
  float moved2[kLanes];       ///< squared length of the displacement, voxels
  float speed2[kLanes];       ///< |k_end|^2
  float turn[kLanes];         ///< k . k_end
  float next_h[kLanes];       ///< the step that the estimate and the longest step allow next; signed
  std::uint8_t left[kLanes];  ///< a stage lay outside the box (everything else made is meaningless then)
};

void step_lanes(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group);
/// The rate at one place; false: outside the box.
bool rate_at(const VelocityBricks& bricks, const Double4& q, Float4& k);

/// For the test that both give the same bits: the baseline version; and whether the machine has another one.
void step_lanes_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group);
bool has_wide_lanes();

}  // namespace catena::flow
