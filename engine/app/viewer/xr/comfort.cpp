// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/comfort.h"

namespace catena::xr_interaction {
namespace {

constexpr double kTurns = 0.7, kArms = 0.3, kMinWish = 0.1;

}  // namespace

double SnapTurn::step(double stick) {
  const double size = std::fabs(stick);
  if (size < kArms) armed_ = true;
  if (!armed_ || !(size > kTurns)) return 0;
  armed_ = false;
  return stick < 0 ? step_rad_ : -step_rad_;
}

double Vignette::step(const Placement& before, const Placement& now, const Vec3& head_m, double dt_s) {
  if (!(dt_s > 0)) return strength_;
  const double speed = norm(now.to_room(before.to_world(head_m)) - head_m) / dt_s;
  const double turn = norm(rotation_vector(normalized(glm::quat_cast(transpose(now.world_from_room) * before.world_from_room)))) / dt_s;
  const double scaling = std::fabs(std::log(now.meters_per_unit / before.meters_per_unit)) / dt_s;
  double request =
      std::max({speed / options_.full_speed_m_per_s, turn / options_.full_turn_rad_per_s, scaling / options_.full_scaling_per_s});
  request = request >= kMinWish ? std::min(1.0, request) : 0;
  strength_ = std::clamp(request, strength_ - dt_s / options_.fall_s, strength_ + dt_s / options_.rise_s);
  return strength_;
}

}  // namespace catena::xr_interaction
