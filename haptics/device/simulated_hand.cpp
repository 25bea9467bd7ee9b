#include "haptics/device/simulated_hand.h"

#include "engine/base/assert.h"

namespace catena::haptics {

SimulatedHand::SimulatedHand(std::vector<Waypoint> path, const HandParameters& parameters)
    : path_(std::move(path)), parameters_(parameters), capabilities_{.name = "simulated hand", .max_force_n = 100} {
  CATENA_ASSERT(!path_.empty() && parameters_.mass_kg > 0 && parameters_.period_s > 0);
  position_m_ = path_.front().position_m;
}

Vec3 SimulatedHand::wish(double t_s, Vec3& velocity) noexcept {
  while (segment_ + 1 < path_.size() && path_[segment_ + 1].t_s <= t_s) ++segment_;
  const Waypoint& a = path_[segment_];
  velocity = Vec3(0.0);
  if (segment_ + 1 == path_.size() || t_s <= a.t_s) return a.position_m;
  const Waypoint& b = path_[segment_ + 1];
  velocity = (b.position_m - a.position_m) / (b.t_s - a.t_s);
  return a.position_m + velocity * (t_s - a.t_s);
}

DeviceInput SimulatedHand::read() noexcept {
  const double dt = parameters_.period_s;
  Vec3 wish_velocity;
  const Vec3 target = wish(path_.front().t_s + static_cast<double>(ticks_) * dt, wish_velocity);
  if (ticks_ > 0) {
    const Vec3 force =
        (target - position_m_) * parameters_.stiffness_n_per_m + (wish_velocity - velocity_) * parameters_.damping_ns_per_m + force_n_;
    velocity_ += force * (dt / parameters_.mass_kg);
    position_m_ += velocity_ * dt;
  }
  ++ticks_;
  DeviceInput input;
  input.position_m = position_m_;
  input.buttons = path_[segment_].buttons;
  return input;
}

void SimulatedHand::write(const DeviceOutput& output) noexcept { force_n_ = output.force_n; }

}  // namespace catena::haptics
