#include "haptics/device/simulated_tool.h"

#include "engine/base/assert.h"

namespace catena::haptics {

SimulatedTool::SimulatedTool(std::unique_ptr<Device> position, std::vector<Waypoint> path, const ToolParameters& parameters)
    : position_(std::move(position)), path_(std::move(path)), parameters_(parameters) {
  CATENA_ASSERT(position_ && !path_.empty() && parameters_.inertia_kg_m2 > 0 && parameters_.period_s > 0 && parameters_.substeps > 0);
  capabilities_ = position_->capabilities();
  capabilities_.name += " with orientation";
  capabilities_.has_orientation = true;
  capabilities_.max_torque_nm = parameters_.max_torque_nm;
  capabilities_.mechanics.rotational_damping_nms_per_rad = parameters_.damping_nms_per_rad;
  for (Waypoint& waypoint : path_) waypoint.orientation = normalised(waypoint.orientation);
  orientation_ = path_.front().orientation;
}

Quat SimulatedTool::wish(double t_s, Vec3& rate) noexcept {
  while (segment_ + 1 < path_.size() && path_[segment_ + 1].t_s <= t_s) ++segment_;
  const Waypoint& a = path_[segment_];
  rate = Vec3(0.0);
  if (segment_ + 1 == path_.size() || t_s <= a.t_s) return a.orientation;
  const Waypoint& b = path_[segment_ + 1];
  rate = rotation_vector(normalised(b.orientation * glm::conjugate(a.orientation))) / (b.t_s - a.t_s);
  return normalised(rotation_of(rate * (t_s - a.t_s)) * a.orientation);
}

DeviceInput SimulatedTool::read() noexcept {
  const double h = parameters_.period_s / parameters_.substeps;
  const double start = path_.front().t_s + (static_cast<double>(ticks_) - 1) * parameters_.period_s;
  for (int k = 1; k <= parameters_.substeps && ticks_ > 0; ++k) {
    Vec3 wish_rate;
    const Quat target = wish(start + k * h, wish_rate);
    const Vec3 torque = rotation_vector(normalised(target * glm::conjugate(orientation_))) * parameters_.grip_stiffness_nm_per_rad +
                        (wish_rate - rate_) * parameters_.grip_damping_nms_per_rad - rate_ * parameters_.damping_nms_per_rad + torque_nm_;
    rate_ += torque * (h / parameters_.inertia_kg_m2);
    orientation_ = normalised(rotation_of(rate_ * h) * orientation_);
  }
  ++ticks_;
  DeviceInput input = position_->read();
  input.orientation = orientation_;
  return input;
}

void SimulatedTool::write(const DeviceOutput& output) noexcept {
  const double magnitude = norm(output.torque_nm);
  torque_nm_ = !std::isfinite(magnitude)               ? Vec3(0.0)
               : magnitude > parameters_.max_torque_nm ? output.torque_nm * (parameters_.max_torque_nm / magnitude)
                                                       : output.torque_nm;
  position_->write(output);
}

}  // namespace catena::haptics
