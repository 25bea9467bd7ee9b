#include "engine/study/judge.h"

#include <cmath>

namespace catena::study {
namespace {

Vec3 closest_on(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 way = b - a;
  const double length2 = dot(way, way);
  if (!(length2 > 0)) return a;
  return a + way * std::fmin(1.0, std::fmax(0.0, dot(p - a, way) / length2));
}

}  // namespace

Judge::Judge(const Task& task, const Stimulus& stimulus)
    : task_(task),
      path_(stimulus.path),
      radius_(stimulus.radius),
      start_radius_(task.world(task.start_mm)),
      reach_(task.world(task.reach_mm)) {
  for (Vec3& p : path_) p = flat(p);
  start_ = flat(stimulus.start);
  end_ = flat(stimulus.end);
}

Vec3 Judge::flat(const Vec3& p) const noexcept { return task_.dimensions == 3 ? p : p - task_.view * dot(p - task_.plane, task_.view); }

double Judge::off_path(const Vec3& cursor) const noexcept {
  const Vec3 p = flat(cursor);
  double least2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path_.size(); ++i) {
    const Vec3 off = p - closest_on(path_[i - 1], path_[i], p);
    least2 = std::fmin(least2, dot(off, off));
  }
  return std::sqrt(least2);
}

double Judge::crossing(const Vec3& from, const Vec3& to) const noexcept {
  if (task_.target == Target::plane) {
    const double above = from.z - end_.z, now = to.z - end_.z;
    return above > 0 && now <= 0 ? above / (above - now) : -1;
  }
  // |from + u way - start| = radius, from the inside
  const Vec3 off = from - start_, way = to - from;
  const double a = dot(way, way), b = dot(off, way), c = dot(off, off) - radius_ * radius_;
  const Vec3 out = to - start_;
  if (c > 0 || dot(out, out) < radius_ * radius_ || !(a > 0)) return -1;
  return std::fmin(1.0, std::fmax(0.0, (std::sqrt(std::fmax(0.0, b * b - a * c)) - b) / a));
}

void Judge::end(double t_s, const Vec3& at, bool by_target) noexcept {
  phase_ = Phase::ended;
  measured_.by_target = by_target;
  measured_.time_s = t_s - start_s_;
  const double off = task_.kind == TaskKind::advection ? norm(at - end_) : ticks_ > 0 ? off_sum_ / static_cast<double>(ticks_) : 0;
  measured_.error_mm = task_.mm(off);
  measured_.end_mm = {task_.mm(at.x), task_.mm(at.y), task_.mm(at.z)};
}

Measured Judge::given_up() const noexcept {
  Measured out = measured_;
  out.by_target = false;
  out.time_s = task_.limits.ends_s;
  out.error_mm = task_.mm(task_.kind == TaskKind::advection ? norm(last_ - end_) : off_path(last_));
  out.end_mm = {task_.mm(last_.x), task_.mm(last_.y), task_.mm(last_.z)};
  return out;
}

Judge::Phase Judge::tick(double t_s, const Vec3& cursor, double force_n) noexcept {
  if (phase_ == Phase::ended || !is_finite(cursor)) return phase_;
  const Vec3 now = flat(cursor), before = last_;
  const double before_s = last_s_;
  last_ = now;
  last_s_ = t_s;
  if (phase_ != Phase::running) {
    const bool within = norm(now - start_) <= start_radius_;
    if (within) phase_ = Phase::ready;
    if (within || phase_ == Phase::waiting) return phase_;
    phase_ = Phase::running;
    start_s_ = t_s;
  } else {
    measured_.travelled_mm += task_.mm(norm(now - before));
  }
  measured_.peak_force_n = std::fmax(measured_.peak_force_n, force_n);
  if (task_.kind == TaskKind::tracing) {
    off_sum_ += off_path(cursor);
    ++ticks_;
    if (norm(now - end_) <= reach_) end(t_s, now, true);
  } else if (const double u = crossing(before, now); u >= 0) {
    end(start_s_ == t_s ? t_s : before_s + u * (t_s - before_s), before + u * (now - before), true);
  }
  if (phase_ == Phase::running && t_s - start_s_ >= task_.limits.ends_s) end(t_s, now, false);
  return phase_;
}

}  // namespace catena::study
