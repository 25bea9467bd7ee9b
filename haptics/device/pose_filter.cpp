// SPDX-License-Identifier: MIT
#include "haptics/device/pose_filter.h"

#include <cmath>

#include "engine/base/result.h"

namespace catena::haptics {

PoseFilter::PoseFilter(const Vec3& start_m, double smoothing_s, double rate_hz) : position_m_(start_m) {
  CATENA_ASSERT(is_finite(start_m) && rate_hz > 0 && smoothing_s >= 0);
  gain_ = smoothing_s > 0 ? -std::expm1(-1 / (rate_hz * smoothing_s)) : 1;
}

void PoseFilter::step_toward(const Vec3& target_m, const Quat& target) noexcept {
  const Vec3 left = target_m - position_m_;
  // skip the last nanometer: the filtered position comes to rest exactly
  position_m_ = gain_ < 1 && max_abs(left) > 1e-9 ? position_m_ + gain_ * left : target_m;
  if (orientation_ == target) return;
  const Vec3 turn = rotation_vector(normalized(target * glm::conjugate(orientation_)));
  const bool eases = gain_ < 1 && max_abs(turn) > 1e-9;
  orientation_ = eases ? normalized(rotation_from_vector(gain_ * turn) * orientation_) : target;
}

}  // namespace catena::haptics
