// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/batch_rk4_step.h"

#include <cmath>
#include <cstring>
#include <limits>

#define CATENA_INLINE [[gnu::always_inline]] static inline

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
  brick_table_ = std::vector<std::atomic<const float*>>(count);
  const double edge = power_of_two(grid.max_voxel_edge()), fastest = power_of_two(grid.stats().max);
  world_from_rate_ = grid.mapping().world_from_index_linear;
  speed_from_rate_ = fastest / edge;
  rate_from_velocity_ = grid.mapping().index_from_world_linear;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) rate_from_velocity_[column][row] *= edge / fastest;
  const double a = rate_from_velocity_[0][0];
  is_uniform_ = rate_from_velocity_ == Mat3(a);
}

VelocityBricks::~VelocityBricks() {
  for (const auto& brick : brick_table_) delete[] brick.load(std::memory_order_relaxed);
}

const float* VelocityBricks::make_brick(std::size_t at) const {
  const auto i = static_cast<std::uint32_t>(at);
  const field::Index3 first{static_cast<std::int32_t>(lo_.x), static_cast<std::int32_t>(lo_.y), static_cast<std::int32_t>(lo_.z)};
  const std::uint32_t x = i % bricks_[0], y = i / bricks_[0] % bricks_[1], z = i / bricks_[0] / bricks_[1];
  std::unique_ptr<float[]> brick(new float[kFloatsPerBrick]());
  fill_brick(
      {first.x + static_cast<std::int32_t>(8 * x), first.y + static_cast<std::int32_t>(8 * y), first.z + static_cast<std::int32_t>(8 * z)},
      brick.get());
  const float* expected = nullptr;
  if (brick_table_[at].compare_exchange_strong(expected, brick.get(), std::memory_order_acq_rel)) return brick.release();
  return expected;
}

void VelocityBricks::fill_brick(const field::Index3& origin, float* out) const {
  grid_.read_block(origin, {9, 9, 9}, {out, 729 * 3});
  if (is_uniform_) {
    const double a = rate_from_velocity_[0][0];
    for (int n = 0; n < 729 * 3; ++n) out[n] = static_cast<float>(a * out[n]);
  } else {
    for (int n = 0; n < 729; ++n) {
      const Vec3 w = rate_from_velocity_ * Vec3(out[3 * n], out[3 * n + 1], out[3 * n + 2]);
      for (int c = 0; c < 3; ++c) out[3 * n + c] = static_cast<float>(w[c]);
    }
  }
  if (!grid_.has_mask()) return;

  // a voxel is valid if it is a corner of a valid cell (a cell is invalid if one of its corners is); the others become NaN
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

namespace {

constexpr float kRelative2 = 1e-4f;  ///< square of the maximum error relative to the step (a hundredth): keeps steps near zeros small

CATENA_INLINE void load_pair(const float* at, Float8& pair) {
  Float4 low, high;
  std::memcpy(&low, at, sizeof low);
  std::memcpy(&high, at + 3, sizeof high);
  pair = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Brick counts that sample() needs, copied once a step: otherwise the compiler must assume that the stores of the lanes change them.
struct View {
  std::uint32_t cells_x, cells_y, cells_z, bricks_x, bricks_y;
  explicit View(const VelocityBricks& b)
      : cells_x(b.cells_x()), cells_y(b.cells_y()), cells_z(b.cells_z()), bricks_x(b.bricks_x()), bricks_y(b.bricks_y()) {}
};

/// Moves a position that is exactly on an upper face of the box into the last cell; returns false if it is outside.
[[gnu::noinline]] bool onto_last_cell(const View& view, Uint4& c, Float4& f) {
  const std::uint32_t cells[3] = {view.cells_x, view.cells_y, view.cells_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (c[axis] < cells[axis]) continue;
    if (c[axis] > cells[axis] || f[axis] != 0) return false;
    c[axis] -= 1;
    f[axis] = 1;
  }
  return true;
}

/// Trilinear interpolation along z, then y, then x. The fourth component of `k` is undefined.
CATENA_INLINE bool sample(const VelocityBricks& bricks, const View& view, const Double4& p, Float4& k) {
  const Int4 cell = __builtin_convertvector(p, Int4);
  Float4 f = __builtin_convertvector(p - __builtin_convertvector(cell, Double4), Float4);
  Uint4 c = (Uint4)cell - 1;  // unsigned: a negative cell index becomes larger than any cell count
  std::uint32_t x = c[0], y = c[1], z = c[2];
  if (x >= view.cells_x || y >= view.cells_y || z >= view.cells_z) [[unlikely]] {
    if (!onto_last_cell(view, c, f)) {
      k = Float4{};
      return false;
    }
    x = c[0], y = c[1], z = c[2];
  }
  const std::size_t brick = ((z >> 3) * view.bricks_y + (y >> 3)) * view.bricks_x + (x >> 3);
  const float* at = bricks.find_brick(brick);
  if (at == nullptr) [[unlikely]]
    at = bricks.make_brick(brick);
  at += (z & 7) * VelocityBricks::kStrideZ + (y & 7) * VelocityBricks::kStrideY + (x & 7) * 3;
  Float8 c00, c10, c01, c11;
  load_pair(at, c00);
  load_pair(at + VelocityBricks::kStrideY, c10);
  load_pair(at + VelocityBricks::kStrideZ, c01);
  load_pair(at + VelocityBricks::kStrideY + VelocityBricks::kStrideZ, c11);
  c00 += (c01 - c00) * f[2];
  c10 += (c11 - c10) * f[2];
  c00 += (c10 - c00) * f[1];
  const Float4 low = __builtin_shufflevector(c00, c00, 0, 1, 2, 3), high = __builtin_shufflevector(c00, c00, 4, 5, 6, 7);
  k = low + (high - low) * f[0];
  return true;
}

CATENA_INLINE float dot3(const Float4& a, const Float4& b) {
  const Float4 ab = a * b;
  return ab[0] + ab[1] + ab[2];
}

CATENA_INLINE void step_all(const VelocityBricks& bricks, const StepControl& control, LaneGroup& g) {
  const View view(bricks);
  Float4 k2[kLanes], k3[kLanes], k4[kLanes];
  bool inside[kLanes];
  for (int i = 0; i < kLanes; ++i)
    inside[i] = sample(bricks, view, g.q[i] + __builtin_convertvector(g.k[i] * (0.5f * g.h[i]), Double4), k2[i]);
  for (int i = 0; i < kLanes; ++i)
    inside[i] &= sample(bricks, view, g.q[i] + __builtin_convertvector(k2[i] * (0.5f * g.h[i]), Double4), k3[i]);
  for (int i = 0; i < kLanes; ++i) inside[i] &= sample(bricks, view, g.q[i] + __builtin_convertvector(k3[i] * g.h[i], Double4), k4[i]);
  for (int i = 0; i < kLanes; ++i) {
    const Float4 moved = ((g.k[i] + k4[i]) + 2.0f * (k2[i] + k3[i])) * (g.h[i] * (1.0f / 6.0f));
    g.end[i] = g.q[i] + __builtin_convertvector(moved, Double4);
    inside[i] &= sample(bricks, view, g.end[i], g.k_end[i]);
    g.left_box[i] = !inside[i];
    const Float4 error = (k4[i] - g.k_end[i]) * (0.1f * g.h[i]);
    g.displacement2[i] = dot3(moved, moved);
    g.error2[i] = dot3(error, error);
    g.speed2[i] = dot3(g.k_end[i], g.k_end[i]);
    g.tangent_dot[i] = dot3(g.k[i], g.k_end[i]);
  }
  // next step size: h * 0.9 (tolerance / error)^(1/4), limited to 0.2 .. 3 times h and to the maximum step size
  for (int i = 0; i < kLanes; ++i) {
    const float relative2 = kRelative2 * g.displacement2[i];
    g.max_error2[i] = control.tolerance2 < relative2 ? control.tolerance2 : relative2;
    const float ratio = std::sqrt(std::sqrt(std::sqrt(g.max_error2[i] / (g.error2[i] + 1e-37f))));
    float factor = 0.9f * ratio;
    factor = factor < 0.2f ? 0.2f : factor;
    factor = factor > 3.0f ? 3.0f : factor;
    const float longest = control.max_step / std::sqrt(g.speed2[i] + 1e-37f), target_step = std::fabs(g.h[i]) * factor;
    g.next_h[i] = std::copysign(target_step < longest ? target_step : longest, g.h[i]);
  }
}

void step_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& g) { step_all(bricks, control, g); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] void step_avx2(const VelocityBricks& bricks, const StepControl& control, LaneGroup& g) {
  step_all(bricks, control, g);
}
#endif

}  // namespace

bool has_avx2_lanes() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

void step_lanes(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group) {
#if defined(__x86_64__)
  static const bool use_avx2 = has_avx2_lanes();
  if (use_avx2) return step_avx2(bricks, control, group);
#endif
  step_baseline(bricks, control, group);
}

void step_lanes_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group) {
  step_baseline(bricks, control, group);
}

bool rate_at(const VelocityBricks& bricks, const Double4& q, Float4& k) { return sample(bricks, View(bricks), q, k); }

}  // namespace catena::flow
