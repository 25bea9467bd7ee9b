// SPDX-License-Identifier: MIT
#include "engine/study/trial_scorer.h"

#include <cmath>

namespace catena::study {
namespace {

Vec3 closest_on(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 displacement = b - a;
  const double length2 = dot(displacement, displacement);
  if (!(length2 > 0)) return a;
  return a + displacement * std::fmin(1.0, std::fmax(0.0, dot(p - a, displacement) / length2));
}

}  // namespace

TrialScorer::TrialScorer(const Task& task, const Stimulus& stimulus)
    : task_(task),
      path_(stimulus.path),
      circle_radius_(stimulus.radius),
      start_radius_(task.world_from_mm(task.start_radius_mm)),
      target_radius_(task.world_from_mm(task.target_radius_mm)) {
  for (Vec3& p : path_) p = project_to_image(p);
  start_ = project_to_image(stimulus.start);
  end_ = project_to_image(stimulus.end);
}

Vec3 TrialScorer::project_to_image(const Vec3& p) const noexcept {
  return task_.dimensions == 3 ? p : p - task_.view_direction * dot(p - task_.image_plane_point, task_.view_direction);
}

double TrialScorer::distance_to_path(const Vec3& cursor) const noexcept {
  const Vec3 p = project_to_image(cursor);
  double least2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path_.size(); ++i) {
    const Vec3 error = p - closest_on(path_[i - 1], path_[i], p);
    least2 = std::fmin(least2, dot(error, error));
  }
  return std::sqrt(least2);
}

double TrialScorer::find_crossing(const Vec3& from, const Vec3& to) const noexcept {
  if (task_.target == Target::plane) {
    const double above = from.z - end_.z, now = to.z - end_.z;
    return above > 0 && now <= 0 ? above / (above - now) : -1;
  }
  // solves |from + u way - start| = radius for the exit from the circle
  const Vec3 offset = from - start_, displacement = to - from;
  const double a = dot(displacement, displacement), b = dot(offset, displacement),
               c = dot(offset, offset) - circle_radius_ * circle_radius_;
  const Vec3 out = to - start_;
  if (c > 0 || dot(out, out) < circle_radius_ * circle_radius_ || !(a > 0)) return -1;
  return std::fmin(1.0, std::fmax(0.0, (std::sqrt(std::fmax(0.0, b * b - a * c)) - b) / a));
}

void TrialScorer::end_trial(double t_s, const Vec3& at, bool by_target) noexcept {
  phase_ = Phase::ended;
  result_.reached_target = by_target;
  result_.time_s = t_s - start_s_;
  const double error = task_.kind == TaskKind::advection ? norm(at - end_) : ticks_ > 0 ? distance_sum_ / static_cast<double>(ticks_) : 0;
  result_.error_mm = task_.mm_from_world(error);
  result_.end_mm = {task_.mm_from_world(at.x), task_.mm_from_world(at.y), task_.mm_from_world(at.z)};
}

TrialResult TrialScorer::aborted_result() const noexcept {
  TrialResult out = result_;
  out.reached_target = false;
  out.time_s = task_.limits.timeout_s;
  out.error_mm = task_.mm_from_world(task_.kind == TaskKind::advection ? norm(last_ - end_) : distance_to_path(last_));
  out.end_mm = {task_.mm_from_world(last_.x), task_.mm_from_world(last_.y), task_.mm_from_world(last_.z)};
  return out;
}

TrialScorer::Phase TrialScorer::tick(double t_s, const Vec3& cursor, double force_n) noexcept {
  if (phase_ == Phase::ended || !is_finite(cursor)) return phase_;
  const Vec3 position = project_to_image(cursor), previous = last_;
  const double before_s = last_s_;
  last_ = position;
  last_s_ = t_s;
  if (phase_ != Phase::running) {
    const bool within = norm(position - start_) <= start_radius_;
    if (within) phase_ = Phase::ready;
    if (within || phase_ == Phase::waiting) return phase_;
    phase_ = Phase::running;
    start_s_ = t_s;
  } else {
    result_.traveled_mm += task_.mm_from_world(norm(position - previous));
  }
  result_.peak_force_n = std::fmax(result_.peak_force_n, force_n);
  if (task_.kind == TaskKind::tracing) {
    distance_sum_ += distance_to_path(cursor);
    ++ticks_;
    if (norm(position - end_) <= target_radius_) end_trial(t_s, position, true);
  } else if (const double u = find_crossing(previous, position); u >= 0) {
    end_trial(start_s_ == t_s ? t_s : before_s + u * (t_s - before_s), previous + u * (position - previous), true);
  }
  if (phase_ == Phase::running && t_s - start_s_ >= task_.limits.timeout_s) end_trial(t_s, position, false);
  return phase_;
}

}  // namespace catena::study
