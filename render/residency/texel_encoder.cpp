// SPDX-License-Identifier: MIT
#include "render/residency/texel_encoder.h"

#include <Imath/half.h>
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>

namespace catena::render {

TexelEncoder::TexelEncoder(const field::ScalarGrid& grid, bool float32_texels) : float32(float32_texels), offset(0), scale(1) {
  double lo = grid.stats().min, hi = grid.stats().max;
  const Vec3 voxels = grid.index_box().hi - grid.index_box().lo + Vec3(1.0);
  const float background = grid.background();
  const bool inactive_inside = double(grid.stats().active_voxels) < voxels.x * voxels.y * voxels.z;
  if (inactive_inside && std::isfinite(background)) {
    lo = std::min(lo, double(background));
    hi = std::max(hi, double(background));
  }
  if (!(lo <= hi)) lo = hi = 0;
  min = float(lo);
  max = float(hi);
  if (grid.interpolation() == field::Interpolation::cubic) {  // ghost values exceed the data's range by at most its width
    const double span = grid.stats().max - grid.stats().min;
    min = float(std::max(std::min(lo, grid.stats().min - span), -double{FLT_MAX}));
    max = float(std::min(std::max(hi, grid.stats().max + span), double{FLT_MAX}));
  }
  if (float32) return;
  const double largest = std::max(std::fabs(lo), std::fabs(hi)), range = hi - lo;
  if (range < 0.5 * largest && range > 0) {
    offset = float(lo);
    scale = float(range);
  } else if (largest > 0) {
    // a power of two that scales the largest magnitude to 0.5..1: the relative rounding of half floats is equal there
    scale = std::exp2(float(std::clamp(std::ilogb(largest) + 1, -120, 120)));
  }
  if (range == 0) offset = float(lo);
}

void TexelEncoder::write(const float* from, std::size_t count, std::byte* out) const {
  for (std::size_t i = 0; i < count; ++i) {
    const float value = from[i] >= min ? std::min(from[i], max) : min;
    if (float32) {
      std::memcpy(out + 4 * i, &value, 4);
    } else {
      const std::uint16_t half = imath_float_to_half((value - offset) / scale);
      std::memcpy(out + 2 * i, &half, 2);
    }
  }
}

BrickRange TexelEncoder::round_trip(const BrickRange& r) const {
  if (float32 || r.empty()) return r;
  const auto back = [this](float v) { return offset + scale * imath_half_to_float(imath_float_to_half((v - offset) / scale)); };
  return {back(r.min), back(r.max)};
}

}  // namespace catena::render
