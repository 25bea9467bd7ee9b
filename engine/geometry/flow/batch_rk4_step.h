// SPDX-License-Identifier: MIT
/// Private to the batch tracer: one Runge-Kutta step of eight lines at once.
///   Classical RK4 in the field's own (scaled) time. The rate k5 at the end of the step is the first rate of the next step and gives a
///   third-order error estimate:  error = |h| / 10 |k4 - k5|                 (Hairer, Norsett, Wanner I, II.4)
/// Positions are double, rates and displacements float: the rounding error of a step is below 1e-7 of its length.
/// SIMD layout: x, y, z of one sample share one register, with the neighbor along x in its upper half; the eight lines are interleaved
/// stage by stage to hide latency. Compiled for the baseline and for AVX2 (selected at the first use): the same operations in the same
/// order without contraction, hence bitwise equal results. Any thread; allocates only new bricks.
#pragma once
#include <atomic>
#include <memory>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::flow {

/// Velocities of a grid in bricks of 8^3 cells (9^3 voxels, x fastest), created when a line first enters them. The stored rates are
/// velocities in index space, scaled so that none is longer than about one:
///   w = J^-1 v * edge / X,   edge: the longest voxel edge, X: the largest |v|, each rounded down to a power of two
/// so that for uniform spacing every number is the stored one times a power of two. Voxels that are a corner of no valid cell are NaN, and
/// so is every rate interpolated from them. Any number of threads; two threads may create the same brick, and one copy is then dropped.
class VelocityBricks {
 public:
  static constexpr int kStrideY = 27, kStrideZ = 243;          ///< Strides between neighboring voxels along y and z, in floats.
  static constexpr std::size_t kFloatsPerBrick = 729 * 3 + 5;  ///< Includes padding: a load of four floats at the last voxel stays inside.

  /// Refers to `grid`, which must outlive this object; no brick is created yet.
  explicit VelocityBricks(const field::VectorGrid& grid);
  ~VelocityBricks();
  VelocityBricks(const VelocityBricks&) = delete;
  VelocityBricks& operator=(const VelocityBricks&) = delete;

  /// Converts to local coordinates: index - box.lo + 1, so that a position below the box truncates to an invalid cell index.
  Vec3 local_from_index(const Vec3& index) const { return index - lo_ + 1.0; }
  /// Converts local coordinates to index coordinates.
  Vec3 index_from_local(const Vec3& local) const { return local - 1.0 + lo_; }
  const Mat3& world_from_rate() const { return world_from_rate_; }  ///< J: world velocity from a rate w, up to the time scale.
  double speed_from_rate() const { return speed_from_rate_; }       ///< Scale factor of the speed: |v| = |J w| times this.

  /// Returns the rates of the brick with index `at`; null: not created yet. Lock-free.
  const float* find_brick(std::size_t at) const { return brick_table_[at].load(std::memory_order_acquire); }
  /// Creates the brick with index `at`, or returns the one that another thread created. Allocates.
  const float* make_brick(std::size_t at) const;
  /// Number of cells along x.
  std::uint32_t cells_x() const { return cells_[0]; }
  /// Number of cells along y.
  std::uint32_t cells_y() const { return cells_[1]; }
  /// Number of cells along z.
  std::uint32_t cells_z() const { return cells_[2]; }
  /// Number of bricks along x.
  std::uint32_t bricks_x() const { return bricks_[0]; }
  /// Number of bricks along y.
  std::uint32_t bricks_y() const { return bricks_[1]; }

 private:
  void fill_brick(const field::Index3& origin, float* out) const;

  const field::VectorGrid& grid_;
  Vec3 lo_{0.0};
  std::uint32_t cells_[3], bricks_[3];
  Mat3 rate_from_velocity_{1.0}, world_from_rate_{1.0};
  double speed_from_rate_ = 1;
  bool is_uniform_ = false;  ///< rate_from_velocity_ is a multiple of the identity.
  mutable std::vector<std::atomic<const float*>> brick_table_;
};

using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));
using Int4 = int __attribute__((vector_size(16)));
using Uint4 = unsigned __attribute__((vector_size(16)));

/// Number of lines that step_lanes() advances at once.
inline constexpr int kLanes = 8;

/// Step-size control of step_lanes().
struct StepControl {
  float tolerance2 = 0;  ///< Squared error tolerance, voxels^2.
  float max_step = 1;    ///< Maximum step size, voxels.
};

/// The state of eight lines: input and output of one step.
struct alignas(32) LaneGroup {
  // input
  Double4 q[kLanes];  ///< Positions, local coordinates.
  Float4 k[kLanes];   ///< Rates at q.
  float h[kLanes];    ///< Signed step sizes, scaled time.
  // output
  Double4 end[kLanes];
  Float4 k_end[kLanes];
  float error2[kLanes];           ///< Squared error estimate, voxels^2.
  float max_error2[kLanes];       ///< Maximum squared error: by the tolerance and by the step's own length.
  float displacement2[kLanes];    ///< Squared length of the displacement, voxels^2.
  float speed2[kLanes];           ///< |k_end|^2.
  float tangent_dot[kLanes];      ///< k . k_end.
  float next_h[kLanes];           ///< Next signed step size, by the error estimate and the maximum step size.
  std::uint8_t left_box[kLanes];  ///< Nonzero: a stage lay outside the box (the other outputs are meaningless).
};

/// Advances all eight lines of `group` by one step.
void step_lanes(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group);
/// Interpolates the rate k at q (local coordinates). Returns false outside the box.
bool rate_at(const VelocityBricks& bricks, const Double4& q, Float4& k);

/// Baseline version of step_lanes(), for the test that both versions give bitwise equal results.
void step_lanes_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group);
/// Whether the CPU supports the AVX2 version.
bool has_avx2_lanes();

}  // namespace catena::flow
