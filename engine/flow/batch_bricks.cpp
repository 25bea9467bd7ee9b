#include "engine/flow/batch_bricks.h"

#include <cmath>
#include <limits>

namespace catena::flow {

namespace {

double power_of_two(double x) { return x > 0 && std::isfinite(x) ? std::ldexp(1.0, std::ilogb(x)) : 1.0; }

}  // namespace

VelocityBricks::VelocityBricks(const field::VectorGrid& grid) : grid_(grid), lo_(grid.index_box().lo) {
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    cells_[axis] = static_cast<std::uint32_t>(grid.index_box().hi[axis] - lo_[axis]);
    bricks_[axis] = (cells_[axis] + 7) / 8;
    count *= bricks_[axis];
  }
  table_ = std::vector<std::atomic<const float*>>(count);
  const double edge = power_of_two(grid.longest_edge()), fastest = power_of_two(grid.stats().max);
  world_from_rate_ = grid.mapping().world_from_index_linear;
  speed_from_rate_ = fastest / edge;
  rate_from_velocity_ = grid.mapping().index_from_world_linear;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) rate_from_velocity_[column][row] *= edge / fastest;
  const double a = rate_from_velocity_[0][0];
  plain_ = rate_from_velocity_ == Mat3(a);
}

VelocityBricks::~VelocityBricks() {
  for (const auto& brick : table_) delete[] brick.load(std::memory_order_relaxed);
}

const float* VelocityBricks::make(std::size_t at) const {
  const auto i = static_cast<std::uint32_t>(at);
  const field::Index3 first{static_cast<std::int32_t>(lo_.x), static_cast<std::int32_t>(lo_.y), static_cast<std::int32_t>(lo_.z)};
  const std::uint32_t x = i % bricks_[0], y = i / bricks_[0] % bricks_[1], z = i / bricks_[0] / bricks_[1];
  std::unique_ptr<float[]> made(new float[kFloats]());
  fill({first.x + static_cast<std::int32_t>(8 * x), first.y + static_cast<std::int32_t>(8 * y), first.z + static_cast<std::int32_t>(8 * z)},
       made.get());
  const float* expected = nullptr;
  if (table_[at].compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return made.release();
  return expected;
}

void VelocityBricks::fill(const field::Index3& origin, float* out) const {
  grid_.read_block(origin, {9, 9, 9}, {out, 729 * 3});
  if (plain_) {
    const double a = rate_from_velocity_[0][0];
    for (int n = 0; n < 729 * 3; ++n) out[n] = static_cast<float>(a * out[n]);
  } else {
    for (int n = 0; n < 729; ++n) {
      const Vec3 w = rate_from_velocity_ * Vec3(out[3 * n], out[3 * n + 1], out[3 * n + 2]);
      for (int c = 0; c < 3; ++c) out[3 * n + c] = static_cast<float>(w[c]);
    }
  }
  if (!grid_.has_mask()) return;

  // a voxel counts if any cell that it is a corner of is valid: a cell is invalid where one of its corners is
  const field::Box& box = grid_.index_box();
  field::Cursor cursor;
  bool valid[1000];
  for (int z = 0, n = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 10; ++x, ++n) {
        const field::Index3 base{origin.x + x - 1, origin.y + y - 1, origin.z + z - 1};
        const bool inside =
            base.x >= box.lo.x && base.y >= box.lo.y && base.z >= box.lo.z && base.x < box.hi.x && base.y < box.hi.y && base.z < box.hi.z;
        valid[n] = inside && grid_.cell(base, cursor).valid;
      }
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 9; ++x) {
        bool counts = false;
        for (int c = 0; c < 8; ++c) counts = counts || valid[((z + (c >> 2)) * 10 + y + (c >> 1 & 1)) * 10 + x + (c & 1)];
        if (counts) continue;
        for (int c = 0; c < 3; ++c) out[3 * ((z * 9 + y) * 9 + x) + c] = std::numeric_limits<float>::quiet_NaN();
      }
}

}  // namespace catena::flow
