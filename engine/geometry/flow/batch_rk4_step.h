/// Private to the batch tracer: one Runge-Kutta step of eight lines at once.
///   classical RK4 in the field's own (scaled) time; the rate k5 at the end is the next step's first, and closes an estimate of
///   third order:  error = |h| / 10 |k4 - k5|                 (Hairer, Norsett, Wanner I, II.4)
/// Places in double, rates and displacements in float: a step's rounding is below 1e-7 of its length.
/// Lanes: x, y, z of one sample are one register, the two neighbours along x another half; eight lines take turns stage by stage,
/// so that the processor always has work of several lines. Compiled for the baseline and for AVX2 (chosen once, at the first use):
/// the same operations in the same order, no contraction, hence the same bits. Any thread; allocates only new bricks.
#pragma once
#include <atomic>
#include <memory>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::flow {

/// The velocities of a grid in bricks of 8^3 cells (9^3 voxels, x fastest), made when a line first
/// comes there. The rates are those of the motion in index space, scaled so that none is longer than about one:
///   w = J^-1 v * edge / X,   edge: of the longest voxel edge, X: the largest |v|, each rounded to a power of two
/// so that on grids of one spacing every number is the stored one times a power of two. Corners of invalid cells are NaN, and so
/// is every rate next to them. Any number of threads; a brick is made once, or twice by two threads and one copy dropped.
class VelocityBricks {
 public:
  static constexpr int kStrideY = 27, kStrideZ = 243;          ///< floats
  static constexpr std::size_t kFloatsPerBrick = 729 * 3 + 5;  ///< a load of four at the last voxel stays inside

  explicit VelocityBricks(const field::VectorGrid& grid);
  ~VelocityBricks();
  VelocityBricks(const VelocityBricks&) = delete;
  VelocityBricks& operator=(const VelocityBricks&) = delete;

  /// Local coordinates: index - box.lo + 1, so that a place below the box truncates to a cell that is none.
  Vec3 local_from_index(const Vec3& index) const { return index - lo_ + 1.0; }
  Vec3 index_from_local(const Vec3& local) const { return local - 1.0 + lo_; }
  const Mat3& world_from_rate() const { return world_from_rate_; }  ///< J: of a rate w, in scaled time
  double speed_from_rate() const { return speed_from_rate_; }       ///< |v| = |J w| times this

  /// The brick's rates; null: not made yet.
  const float* find_brick(std::size_t at) const { return brick_table_[at].load(std::memory_order_acquire); }
  const float* make_brick(std::size_t at) const;
  std::uint32_t cells_x() const { return cells_[0]; }
  std::uint32_t cells_y() const { return cells_[1]; }
  std::uint32_t cells_z() const { return cells_[2]; }
  std::uint32_t bricks_x() const { return bricks_[0]; }
  std::uint32_t bricks_y() const { return bricks_[1]; }

 private:
  void fill_brick(const field::Index3& origin, float* out) const;

  const field::VectorGrid& grid_;
  Vec3 lo_{0.0};
  std::uint32_t cells_[3], bricks_[3];
  Mat3 rate_from_velocity_{1.0}, world_from_rate_{1.0};
  double speed_from_rate_ = 1;
  bool is_uniform_ = false;  ///< rate_from_velocity_ is a number
  mutable std::vector<std::atomic<const float*>> brick_table_;
};

using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));
using Int4 = int __attribute__((vector_size(16)));
using Uint4 = unsigned __attribute__((vector_size(16)));

inline constexpr int kLanes = 8;

struct StepControl {
  float tolerance2 = 0;  ///< of the error, voxels, squared
  float max_step = 1;    ///< voxels
};

struct alignas(32) LaneGroup {
  // given
  Double4 q[kLanes];  ///< places, local coordinates
  Float4 k[kLanes];   ///< rates there
  float h[kLanes];    ///< signed steps, scaled time
  // made
  Double4 end[kLanes];
  Float4 k_end[kLanes];
  float error2[kLanes];           ///< squared, voxels
  float max_error2[kLanes];       ///< what the tolerance and the step's own length allow of it
  float displacement2[kLanes];    ///< squared length of the displacement, voxels
  float speed2[kLanes];           ///< |k_end|^2
  float tangent_dot[kLanes];      ///< k . k_end
  float next_h[kLanes];           ///< the step that the estimate and the longest step allow next; signed
  std::uint8_t left_box[kLanes];  ///< a stage lay outside the box (everything else made is meaningless then)
};

void step_lanes(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group);
/// The rate at one place; false: outside the box.
bool rate_at(const VelocityBricks& bricks, const Double4& q, Float4& k);

/// For the test that both give the same bits: the baseline version; and whether the machine has another one.
void step_lanes_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group);
bool has_avx2_lanes();

}  // namespace catena::flow
