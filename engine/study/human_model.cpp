// SPDX-License-Identifier: MIT
#include "engine/study/human_model.h"

#include <cmath>
#include <numbers>

namespace catena::study {
namespace {

constexpr double kPauseS = 0.6, kGetsGoingS = 0.2;
/// Number of path points that are searched behind and ahead of the last closest point.
constexpr std::size_t kBehind = 40, kBefore = 80;
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::uint64_t kSubjectSeeds = 0x5eed0b5e55ed0001u;

}  // namespace

HumanModelTraits draw_subject_traits(const Study& study, int subject) {
  Random random(mix_bits(mix_bits(kSubjectSeeds + static_cast<std::uint64_t>(study.seed)) + static_cast<std::uint64_t>(subject)));
  HumanModelTraits out;
  out.speed = std::exp(study.human_model.speed_spread_subject * random.normal());
  out.depth_bias = study.human_model.depth_bias_mm * random.normal();
  return out;
}

haptics::SimulatedDeviceParameters make_hand_parameters(const HumanModelParameters& model, double period_s) {
  haptics::SimulatedDeviceParameters hand = haptics::desktop_device_parameters();
  hand.grip_stiffness_n_per_m = 1000 * model.stiffness_n_per_mm;
  hand.grip_damping_ns_per_m = model.damping_ns_per_m;
  hand.period_s = period_s;
  return hand;
}

void HumanModel::NoiseProcess::begin(double period_s, double correlation_s, Random& random) {
  decay = std::exp(-period_s / correlation_s);
  innovation = std::sqrt(1 - decay * decay);
  value = random.normal();
}

HumanModel::HumanModel(const Study& study, const Task& task, const Stimulus& stimulus, const field::VectorField& field,
                       const HumanModelTraits& subject, std::uint64_t seed, double period_s)
    : model_(study.human_model),
      task_(task),
      stimulus_(stimulus),
      field_(field),
      random_(seed),
      period_s_(period_s),
      target_(stimulus.start) {
  speed_ = task.world_from_mm(model_.speed_mm_per_s * subject.speed * std::exp(model_.speed_spread_trial * random_.normal()));
  bias_ = task.dimensions == 3 ? task.world_from_mm(subject.depth_bias) : 0;
  // orthonormal axes of the image plane
  right_ = direction(cross(task.view_direction, std::fabs(task.view_direction.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0)));
  up_ = cross(right_, task.view_direction);
  for (NoiseProcess& process : perception_noise_) process.begin(period_s, model_.seeing_noise_s, random_);
  for (NoiseProcess& process : motor_noise_) process.begin(period_s, model_.motor_noise_s, random_);
  for (auto& axis : tremor_)
    for (Sine& sine : axis) sine = {kTwoPi * random_.between(model_.tremor_lo_hz, model_.tremor_hi_hz), random_.between(0, kTwoPi)};
  delayed_cursors_.assign(static_cast<std::size_t>(std::lround(model_.delay_s / period_s)) + 1, stimulus.start);
}

Vec3 HumanModel::tremor() const noexcept {
  // three sines of equal amplitude a have a root mean square of a sqrt(3/2)
  const double amplitude = task_.world_from_mm(model_.tremor_mm) / std::sqrt(1.5), t = static_cast<double>(ticks_) * period_s_;
  Vec3 sum(0.0);
  for (int axis = 0; axis < 3; ++axis)
    for (const Sine& sine : tremor_[static_cast<std::size_t>(axis)]) sum[axis] += amplitude * std::sin(sine.rate * t + sine.phase);
  return sum;
}

Vec3 HumanModel::velocity_along_path(const Vec3& perceived_probe, double speed) noexcept {
  const std::vector<Vec3>& path = stimulus_.path;
  const std::size_t last = path.size() - 1, from = closest_corner_ > kBehind ? closest_corner_ - kBehind : 0,
                    to = std::min(last, closest_corner_ + kBefore);
  double min_distance2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i <= to; ++i) {
    const Vec3 offset = path[i] - perceived_probe;
    if (dot(offset, offset) < min_distance2) min_distance2 = dot(offset, offset), closest_corner_ = i;
  }
  const double piece = stimulus_.length / static_cast<double>(last);
  const double remaining = piece * static_cast<double>(last - closest_corner_), gain = model_.correction_per_s;
  if (remaining <= speed / gain) {
    const Vec3 to_end = path[last] - perceived_probe;
    return direction(to_end) * std::fmin(speed, gain * norm(to_end));
  }
  const std::size_t target_index = std::min(last - 1, closest_corner_ + static_cast<std::size_t>(speed * model_.delay_s / piece));
  return speed * direction(path[target_index + 1] - path[target_index]) + gain * (path[closest_corner_] - perceived_probe);
}

Vec3 HumanModel::velocity_along_flow(const Vec3& perceived_probe, const Vec3& error, double speed) noexcept {
  const double tip = task_.world_from_mm(task_.indicator_mm);
  const Vec3 flow = direction(field_.sample(perceived_probe, cursor_).value);
  const Vec3 indicator = tip * direction(field_.sample(perceived_probe + 0.5 * tip * flow, cursor_).value);
  return speed * direction(indicator + error);
}

Vec3 HumanModel::next_target(const Vec3& cursor) noexcept {
  const std::size_t newest = ticks_ % delayed_cursors_.size(), oldest = (ticks_ + 1) % delayed_cursors_.size();
  delayed_cursors_[newest] = cursor;
  ++ticks_;
  const double lateral = task_.world_from_mm(model_.lateral_noise_mm),
               depth = task_.dimensions == 3 ? task_.world_from_mm(model_.depth_noise_mm) : 0;
  const Vec3 error = right_ * (lateral * perception_noise_[0].next(random_)) + up_ * (lateral * perception_noise_[1].next(random_)) +
                     task_.view_direction * (depth * perception_noise_[2].next(random_) + bias_);
  const Vec3 jerk(motor_noise_[0].next(random_), motor_noise_[1].next(random_), motor_noise_[2].next(random_));
  const double speed = speed_ * std::fmin(1.0, std::fmax(0.0, (static_cast<double>(ticks_) * period_s_ - kPauseS) / kGetsGoingS));
  if (speed > 0) {
    const Vec3 velocity = task_.kind == TaskKind::tracing ? velocity_along_path(delayed_cursors_[oldest] + error, speed)
                                                          : velocity_along_flow(delayed_cursors_[oldest], error, speed);
    target_ += period_s_ * (velocity + norm(velocity) * model_.motor_noise * jerk);
  }
  // a force above yield_n moves the target: this limits the distance of the target from the cursor
  const double max_distance = task_.world_from_mm(model_.yield_n / model_.stiffness_n_per_mm);
  const Vec3 pull = target_ - cursor;
  if (const double length = norm(pull); length > max_distance) target_ = cursor + pull * (max_distance / length);
  return target_ + tremor();
}

}  // namespace catena::study
