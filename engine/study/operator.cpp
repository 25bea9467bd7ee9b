#include "engine/study/operator.h"

#include <cmath>
#include <numbers>

namespace catena::study {
namespace {

constexpr double kPauseS = 0.6, kGetsGoingS = 0.2;
/// Corners of the path that are looked at behind and before the one that was closest.
constexpr std::size_t kBehind = 40, kBefore = 80;
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::uint64_t kSubjectSeeds = 0x5eed0b5e55ed0001u;

}  // namespace

SubjectModel subject_model(const Study& study, int subject) {
  Random random(mixed_bits(mixed_bits(kSubjectSeeds + static_cast<std::uint64_t>(study.seed)) + static_cast<std::uint64_t>(subject)));
  SubjectModel out;
  out.speed = std::exp(study.model.speed_spread_subject * random.normal());
  out.depth_bias = study.model.depth_bias_mm * random.normal();
  return out;
}

haptics::HandParameters hand_of(const OperatorModel& model, double period_s) {
  haptics::HandParameters hand = haptics::simulated_device();
  hand.stiffness_n_per_m = 1000 * model.stiffness_n_per_mm;
  hand.damping_ns_per_m = model.damping_ns_per_m;
  hand.period_s = period_s;
  return hand;
}

void Operator::Process::begin(double period_s, double correlation_s, Random& random) {
  keep = std::exp(-period_s / correlation_s);
  add = std::sqrt(1 - keep * keep);
  value = random.normal();
}

Operator::Operator(const Study& study, const Task& task, const Stimulus& stimulus, const field::VectorField& field,
                   const SubjectModel& subject, std::uint64_t seed, double period_s)
    : model_(study.model), task_(task), stimulus_(stimulus), field_(field), random_(seed), period_s_(period_s), wish_(stimulus.start) {
  speed_ = task.world(model_.speed_mm_per_s * subject.speed * std::exp(model_.speed_spread_trial * random_.normal()));
  bias_ = task.dimensions == 3 ? task.world(subject.depth_bias) : 0;
  // two axes of the picture plane, square to each other
  right_ = direction(cross(task.view, std::fabs(task.view.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0)));
  up_ = cross(right_, task.view);
  for (Process& process : seeing_) process.begin(period_s, model_.seeing_noise_s, random_);
  for (Process& process : motor_) process.begin(period_s, model_.motor_noise_s, random_);
  for (auto& axis : tremor_)
    for (Sine& sine : axis) sine = {kTwoPi * random_.between(model_.tremor_lo_hz, model_.tremor_hi_hz), random_.between(0, kTwoPi)};
  seen_.assign(static_cast<std::size_t>(std::lround(model_.delay_s / period_s)) + 1, stimulus.start);
}

Vec3 Operator::tremor() const noexcept {
  // three sines of equal amplitude a: their root mean square is a sqrt(3/2)
  const double amplitude = task_.world(model_.tremor_mm) / std::sqrt(1.5), t = static_cast<double>(ticks_) * period_s_;
  Vec3 sum(0.0);
  for (int axis = 0; axis < 3; ++axis)
    for (const Sine& sine : tremor_[static_cast<std::size_t>(axis)]) sum[axis] += amplitude * std::sin(sine.rate * t + sine.phase);
  return sum;
}

Vec3 Operator::velocity_along_path(const Vec3& seen, double speed) noexcept {
  const std::vector<Vec3>& path = stimulus_.path;
  const std::size_t last = path.size() - 1, from = near_ > kBehind ? near_ - kBehind : 0, to = std::min(last, near_ + kBefore);
  double least2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i <= to; ++i) {
    const Vec3 off = path[i] - seen;
    if (dot(off, off) < least2) least2 = dot(off, off), near_ = i;
  }
  const double piece = stimulus_.length / static_cast<double>(last);
  const double left = piece * static_cast<double>(last - near_), gain = model_.correction_per_s;
  if (left <= speed / gain) {
    const Vec3 way = path[last] - seen;
    return direction(way) * std::fmin(speed, gain * norm(way));
  }
  const std::size_t ahead = std::min(last - 1, near_ + static_cast<std::size_t>(speed * model_.delay_s / piece));
  return speed * direction(path[ahead + 1] - path[ahead]) + gain * (path[near_] - seen);
}

Vec3 Operator::velocity_along_flow(const Vec3& seen, const Vec3& error, double speed) noexcept {
  const double tip = task_.world(task_.indicator_mm);
  const Vec3 here = direction(field_.sample(seen, cursor_).value);
  const Vec3 way = tip * direction(field_.sample(seen + 0.5 * tip * here, cursor_).value);
  return speed * direction(way + error);
}

Vec3 Operator::next(const Vec3& cursor) noexcept {
  const std::size_t newest = ticks_ % seen_.size(), oldest = (ticks_ + 1) % seen_.size();
  seen_[newest] = cursor;
  ++ticks_;
  const double lateral = task_.world(model_.lateral_noise_mm), depth = task_.dimensions == 3 ? task_.world(model_.depth_noise_mm) : 0;
  const Vec3 error = right_ * (lateral * seeing_[0].next(random_)) + up_ * (lateral * seeing_[1].next(random_)) +
                     task_.view * (depth * seeing_[2].next(random_) + bias_);
  const Vec3 jerk(motor_[0].next(random_), motor_[1].next(random_), motor_[2].next(random_));
  const double speed = speed_ * std::fmin(1.0, std::fmax(0.0, (static_cast<double>(ticks_) * period_s_ - kPauseS) / kGetsGoingS));
  if (speed > 0) {
    const Vec3 velocity = task_.kind == TaskKind::tracing ? velocity_along_path(seen_[oldest] + error, speed)
                                                          : velocity_along_flow(seen_[oldest], error, speed);
    wish_ += period_s_ * (velocity + norm(velocity) * model_.motor_noise * jerk);
  }
  // gives way
  const double most = task_.world(model_.yield_n / model_.stiffness_n_per_mm);
  const Vec3 pull = wish_ - cursor;
  if (const double length = norm(pull); length > most) wish_ = cursor + pull * (most / length);
  return wish_ + tremor();
}

}  // namespace catena::study
