// SPDX-License-Identifier: MIT
#include "haptics/device/simulated_device.h"

#include <cmath>

#include "engine/base/result.h"

namespace catena::haptics {

SimulatedTool::SimulatedTool(std::unique_ptr<Device> position, std::vector<Waypoint> path, const SimulatedToolParameters& parameters)
    : position_(std::move(position)), path_(std::move(path)), parameters_(parameters) {
  CATENA_ASSERT(position_ && !path_.empty() && parameters_.inertia_kg_m2 > 0 && parameters_.period_s > 0 && parameters_.substeps > 0);
  capabilities_ = position_->capabilities();
  capabilities_.name += " with orientation";
  capabilities_.has_orientation = true;
  capabilities_.max_torque_nm = parameters_.max_torque_nm;
  capabilities_.mechanics.rotational_damping_nms_per_rad = parameters_.damping_nms_per_rad;
  for (Waypoint& waypoint : path_) waypoint.orientation = normalized(waypoint.orientation);
  orientation_ = path_.front().orientation;
}

Quat SimulatedTool::target_at(double t_s, Vec3& rate) noexcept {
  while (segment_ + 1 < path_.size() && path_[segment_ + 1].t_s <= t_s) ++segment_;
  const Waypoint& a = path_[segment_];
  rate = Vec3(0.0);
  if (segment_ + 1 == path_.size() || t_s <= a.t_s) return a.orientation;
  const Waypoint& b = path_[segment_ + 1];
  rate = rotation_vector(normalized(b.orientation * glm::conjugate(a.orientation))) / (b.t_s - a.t_s);
  return normalized(rotation_from_vector(rate * (t_s - a.t_s)) * a.orientation);
}

DeviceInput SimulatedTool::read() noexcept {
  const double h = parameters_.period_s / parameters_.substeps;
  const double start = path_.front().t_s + (static_cast<double>(ticks_) - 1) * parameters_.period_s;
  for (int k = 1; k <= parameters_.substeps && ticks_ > 0; ++k) {
    Vec3 wish_rate;
    const Quat target = target_at(start + k * h, wish_rate);
    const Vec3 torque = rotation_vector(normalized(target * glm::conjugate(orientation_))) * parameters_.grip_stiffness_nm_per_rad +
                        (wish_rate - rate_) * parameters_.grip_damping_nms_per_rad - rate_ * parameters_.damping_nms_per_rad + torque_nm_;
    rate_ += torque * (h / parameters_.inertia_kg_m2);
    orientation_ = normalized(rotation_from_vector(rate_ * h) * orientation_);
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

namespace {

constexpr int kSteps = 8;  // substeps per period, where friction or a grip need more than one
constexpr double kTwoPi = 6.283185307179586;
constexpr double kTremorHz[] = {8.3, 9.1, 10.2, 11.6};

Vec3 tremor(double t_s, double rms_m, Vec3& velocity) noexcept {
  // four sines of equal amplitude a: their root mean square is a sqrt(2)
  const double amplitude = rms_m / 1.4142135623730951;
  Vec3 sum(0.0);
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) {
      const double rate = kTwoPi * kTremorHz[k], angle = rate * t_s + 1.3 * axis + 2.1 * k;
      sum[axis] += amplitude * std::sin(angle);
      velocity[axis] += amplitude * rate * std::cos(angle);
    }
  return sum;
}

}  // namespace

SimulatedDeviceParameters desktop_device_parameters() {
  SimulatedDeviceParameters p;
  p.mass_kg = 0.159;
  p.device_damping_ns_per_m = 0.5;
  p.friction_n = 0.1;
  p.encoder_step_m = 4e-5;
  p.max_force_n = 10;
  return p;
}

SimulatedDevice::SimulatedDevice(std::vector<Waypoint> path, const SimulatedDeviceParameters& parameters)
    : path_(std::move(path)), parameters_(parameters) {
  const SimulatedDeviceParameters& p = parameters_;
  CATENA_ASSERT(!path_.empty() && p.mass_kg > 0 && p.hand_mass_kg >= 0 && p.period_s > 0);
  CATENA_ASSERT(p.delay_s >= 0 && p.delay_s <= SimulatedDeviceParameters::kMaxDelayPeriods * p.period_s && p.encoder_step_m >= 0 &&
                p.friction_n >= 0);
  capabilities_ = {.name = "simulated hand",
                   .max_force_n = p.max_force_n,
                   .mechanics = {.mass_kg = p.mass_kg,
                                 .damping_ns_per_m = p.device_damping_ns_per_m,
                                 .friction_n = p.friction_n,
                                 .encoder_step_m = p.encoder_step_m,
                                 .delay_s = p.delay_s}};
  start_s_ = path_.front().t_s;
  path_.reserve(2);  // for set_target()
  mass_ = {path_.front().position_m, p.velocity_m_per_s};
  const double periods = p.delay_s / p.period_s + 1e-9;
  delay_ticks_ = static_cast<std::uint64_t>(periods);
  const double rest_s = std::fmax(0.0, p.delay_s - static_cast<double>(delay_ticks_) * p.period_s);
  before_delay_ = make_partial_step(rest_s > 1e-6 * p.period_s ? rest_s : 0);
  after_delay_ = make_partial_step(p.period_s - before_delay_.step.step_s * before_delay_.count);
}

void SimulatedDevice::set_target(const Vec3& position_m) noexcept {
  // a path of two points: the target positions at the last tick that was read and at the next tick
  path_.resize(2, path_.front());
  const double next_s = start_s_ + static_cast<double>(ticks_) * parameters_.period_s;
  path_.front() = {next_s - parameters_.period_s, path_.back().position_m, path_.back().buttons};
  path_.back() = {next_s, position_m, path_.front().buttons};
  segment_ = 0;
}

SimulatedDevice::PartialStep SimulatedDevice::make_partial_step(double length_s) const {
  const SimulatedDeviceParameters& p = parameters_;
  if (!(length_s > 0)) return {};
  const bool plain = p.friction_n == 0 && p.grip_stiffness_n_per_m == 0 && p.grip_damping_ns_per_m == 0;
  PartialStep out;
  out.count = plain ? 1 : std::max(1, static_cast<int>(std::lround(kSteps * length_s / p.period_s)));
  out.step = make_linear_step(p.mass_kg + p.hand_mass_kg, p.device_damping_ns_per_m + p.grip_damping_ns_per_m, p.grip_stiffness_n_per_m,
                              length_s / out.count);
  return out;
}

Vec3 SimulatedDevice::target_at(double t_s, Vec3& velocity) noexcept {
  while (segment_ + 1 < path_.size() && path_[segment_ + 1].t_s <= t_s) ++segment_;
  const Waypoint& a = path_[segment_];
  velocity = Vec3(0.0);
  if (segment_ + 1 == path_.size() || t_s <= a.t_s) return a.position_m;
  const Waypoint& b = path_[segment_ + 1];
  velocity = (b.position_m - a.position_m) / (b.t_s - a.t_s);
  return a.position_m + velocity * (t_s - a.t_s);
}

const Vec3& SimulatedDevice::past_force(std::uint64_t ticks_ago) const noexcept {
  static const Vec3 none(0.0);
  return ticks_ago <= ticks_ ? force_history_[(ticks_ - ticks_ago) % force_history_.size()] : none;
}

void SimulatedDevice::advance_partial(const PartialStep& part, const Vec3& force_n, double& t_s) noexcept {
  for (int i = 0; i < part.count; ++i) {
    Vec3 velocity;
    Vec3 target = target_at(t_s + 0.5 * part.step.step_s, velocity);
    if (parameters_.tremor_m > 0) target += tremor(t_s + 0.5 * part.step.step_s, parameters_.tremor_m, velocity);
    const Vec3 u =
        force_n + (target - mass_.position_m) * parameters_.grip_stiffness_n_per_m + velocity * parameters_.grip_damping_ns_per_m;
    advance_mass(part.step, u, parameters_.friction_n, mass_);
    t_s += part.step.step_s;
  }
}

DeviceInput SimulatedDevice::read() noexcept {
  const double period_s = parameters_.period_s;
  if (ticks_ > 0) {
    double t = start_s_ + static_cast<double>(ticks_ - 1) * period_s;
    advance_partial(before_delay_, past_force(delay_ticks_ + 2), t);
    advance_partial(after_delay_, past_force(delay_ticks_ + 1), t);
  }
  Vec3 velocity;
  target_at(start_s_ + static_cast<double>(ticks_) * period_s, velocity);
  force_history_[ticks_ % force_history_.size()] = Vec3(0.0);
  ++ticks_;
  DeviceInput input;
  input.position_m = mass_.position_m;
  const double step = parameters_.encoder_step_m;
  if (step > 0)
    for (int axis = 0; axis < 3; ++axis) input.position_m[axis] = step * std::floor(input.position_m[axis] / step + 0.5);
  input.buttons = path_[segment_].buttons;
  return input;
}

// The force acts from the last tick that was read.
void SimulatedDevice::write(const DeviceOutput& output) noexcept {
  if (ticks_ == 0) return;
  const double length = norm(output.force_n), maximum = parameters_.max_force_n;
  Vec3& to = force_history_[(ticks_ - 1) % force_history_.size()];
  to = !std::isfinite(length) ? Vec3(0.0) : length > maximum ? output.force_n * (maximum / length) : output.force_n;
}

}  // namespace catena::haptics
