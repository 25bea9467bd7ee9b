#include "engine/flow/batch_step.h"

#include <cmath>
#include <cstring>

#define CATENA_INLINE [[gnu::always_inline]] static inline

namespace catena::flow {

namespace {

constexpr float kRelative2 = 1e-4f;  ///< an error is at most a hundredth of its step: zeros are passed with care

CATENA_INLINE void load_pair(const float* at, Float8& pair) {
  Float4 low, high;
  std::memcpy(&low, at, sizeof low);
  std::memcpy(&high, at + 3, sizeof high);
  pair = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// What a sample reads of the bricks, copied once a step: the lanes' stores could otherwise be taken to change it.
struct View {
  std::uint32_t cells_x, cells_y, cells_z, bricks_x, bricks_y;
  explicit View(const VelocityBricks& b)
      : cells_x(b.cells_x()), cells_y(b.cells_y()), cells_z(b.cells_z()), bricks_x(b.bricks_x()), bricks_y(b.bricks_y()) {}
};

/// A place exactly on an upper face of the box belongs to the last cell.
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

/// Trilinear, along z, then y, then x. The fourth number of a rate is whatever lies behind it.
CATENA_INLINE bool sample(const VelocityBricks& bricks, const View& view, const Double4& p, Float4& k) {
  const Int4 cell = __builtin_convertvector(p, Int4);
  Float4 f = __builtin_convertvector(p - __builtin_convertvector(cell, Double4), Float4);
  Uint4 c = (Uint4)cell - 1;  // no cell wraps round
  std::uint32_t x = c[0], y = c[1], z = c[2];
  if (x >= view.cells_x || y >= view.cells_y || z >= view.cells_z) [[unlikely]] {
    if (!onto_last_cell(view, c, f)) {
      k = Float4{};
      return false;
    }
    x = c[0], y = c[1], z = c[2];
  }
  const std::size_t brick = ((z >> 3) * view.bricks_y + (y >> 3)) * view.bricks_x + (x >> 3);
  const float* at = bricks.find(brick);
  if (at == nullptr) [[unlikely]]
    at = bricks.make(brick);
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
    g.left[i] = !inside[i];
    const Float4 error = (k4[i] - g.k_end[i]) * (0.1f * g.h[i]);
    g.moved2[i] = dot3(moved, moved);
    g.error2[i] = dot3(error, error);
    g.speed2[i] = dot3(g.k_end[i], g.k_end[i]);
    g.turn[i] = dot3(g.k[i], g.k_end[i]);
  }
  // the next step: h * 0.9 (tolerance / error)^(1/4), within 0.2 .. 3, and no longer than the longest
  for (int i = 0; i < kLanes; ++i) {
    const float relative2 = kRelative2 * g.moved2[i];
    g.allowed2[i] = control.tolerance2 < relative2 ? control.tolerance2 : relative2;
    const float share = std::sqrt(std::sqrt(std::sqrt(g.allowed2[i] / (g.error2[i] + 1e-37f))));
    float factor = 0.9f * share;
    factor = factor < 0.2f ? 0.2f : factor;
    factor = factor > 3.0f ? 3.0f : factor;
    const float longest = control.longest_step / std::sqrt(g.speed2[i] + 1e-37f), wanted = std::fabs(g.h[i]) * factor;
    g.next_h[i] = std::copysign(wanted < longest ? wanted : longest, g.h[i]);
  }
}

void step_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& g) { step_all(bricks, control, g); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] void step_avx2(const VelocityBricks& bricks, const StepControl& control, LaneGroup& g) {
  step_all(bricks, control, g);
}
#endif

}  // namespace

bool has_wide_lanes() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

void step_lanes(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group) {
#if defined(__x86_64__)
  static const bool wide = has_wide_lanes();
  if (wide) return step_avx2(bricks, control, group);
#endif
  step_baseline(bricks, control, group);
}

void step_lanes_baseline(const VelocityBricks& bricks, const StepControl& control, LaneGroup& group) {
  step_baseline(bricks, control, group);
}

bool rate_at(const VelocityBricks& bricks, const Double4& q, Float4& k) { return sample(bricks, View(bricks), q, k); }

}  // namespace catena::flow
