/// Private to the batch tracer: the velocities of a grid in bricks of 8^3 cells (9^3 voxels, x fastest), made when a line first
/// comes there. The rates are those of the motion in index space, scaled so that none is longer than about one:
///   w = J^-1 v * edge / X,   edge: of the longest voxel edge, X: the largest |v|, each rounded to a power of two
/// so that on grids of one spacing every number is the stored one times a power of two. Corners of invalid cells are NaN, and so
/// is every rate next to them. Any number of threads; a brick is made once, or twice by two threads and one copy dropped.
#pragma once
#include <atomic>
#include <memory>
#include <vector>

#include "engine/field/grid.h"

namespace catena::flow {

class VelocityBricks {
 public:
  static constexpr int kStrideY = 27, kStrideZ = 243;  ///< floats
  static constexpr std::size_t kFloats = 729 * 3 + 5;  ///< a load of four at the last voxel stays inside

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
  const float* find(std::size_t at) const { return table_[at].load(std::memory_order_acquire); }
  const float* make(std::size_t at) const;
  std::uint32_t cells_x() const { return cells_[0]; }
  std::uint32_t cells_y() const { return cells_[1]; }
  std::uint32_t cells_z() const { return cells_[2]; }
  std::uint32_t bricks_x() const { return bricks_[0]; }
  std::uint32_t bricks_y() const { return bricks_[1]; }

 private:
  void fill(const field::Index3& origin, float* out) const;

  const field::VectorGrid& grid_;
  Vec3 lo_{0.0};
  std::uint32_t cells_[3], bricks_[3];
  Mat3 rate_from_velocity_{1.0}, world_from_rate_{1.0};
  double speed_from_rate_ = 1;
  bool plain_ = false;  ///< rate_from_velocity_ is a number
  mutable std::vector<std::atomic<const float*>> table_;
};

}  // namespace catena::flow
