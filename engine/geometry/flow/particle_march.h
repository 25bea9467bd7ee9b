// SPDX-License-Identifier: MIT
/// Private to this module: moves a particle with a velocity that changes with time, by DP5(4) in time. The state has the position, the time
/// and the arc length. On grids every step that leaves a cell ends on its face, as for streamlines (trace.cpp); steps of the series are
/// ends of steps as well, because they are ends of march(). Steps are refined until the cubic in arc length that is
/// kept agrees with the continuous extension of the step.
#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "engine/geometry/flow/trace_internal.h"
#include "engine/geometry/flow/unsteady_source.h"

namespace catena::flow {

/// State of an integration step: position (of the source), time, arc length.
struct PathState {
  Vec3 q{0.0};
  double t = 0, s = 0;
  PathState& operator+=(const PathState& d) {
    q += d.q;
    t += d.t;
    s += d.s;
    return *this;
  }
  friend PathState operator+(PathState a, const PathState& b) { return a += b; }
  friend PathState operator*(double f, const PathState& a) { return {f * a.q, f * a.t, f * a.s}; }
};
inline const Vec3& position_of(const PathState& state) { return state.q; }

/// A particle: where it is, and the knots of its path if they are kept.
struct Particle {
  Vec3 position{0.0};
  double time = 0;
  bool keeps_knots = false;
  double s = 0;                  ///< Length of the path so far, world units.
  double step = 0;               ///< Next step, in time; 0: not known yet.
  std::optional<LineEnd> end{};  ///< Set once it cannot move on.
  std::vector<Knot> knots{};     ///< s of the knots rises, and their tangents are those of the motion.
  std::vector<double> times{};   ///< Times of the knots.
};

/// Moves particles in one source. `sign` -1: backward in time. `length`: L.
template <class Source>
class ParticleMarch {
 public:
  ParticleMarch(Source& source, double sign, double length, double tolerance, std::size_t max_knots)
      : source_(source), sign_(sign), length_(length), tolerance_(tolerance * length), max_knots_(max_knots) {}

  /// Moves a particle to the time `until`, or to the end of its path.
  void march(Particle& particle, double until) {
    at_ = {};
    keeps_ = particle.keeps_knots;
    at_.t = particle.time;
    at_.s = particle.s;
    idle_ = 0;
    forced_ = 1e-8 * length_;
    particle.end = begin(particle);
    while (!particle.end && at_.t != until) particle.end = advance(particle, until);
    particle.position = source_.world(at_.q);
    particle.time = at_.t;
    particle.s = at_.s;
  }

 private:
  static constexpr double kRounding = 16 * 2.220446049250313e-16;
  static constexpr double kFaceGap = 1e-9;                 ///< times L: error of the cubic in time that finds faces well enough
  static constexpr double kClose = 1e-10, kApart = 1e-13;  ///< times L: knots that count as one place; least distance of two knots

  LineEnd boundary() const { return {Termination::boundary, source_.outside_status()}; }
  static LineEnd not_finite() { return {Termination::boundary, SampleStatus::not_finite}; }

  auto rates() {
    return [this](const PathState& at, PathState& rate) {
      v_ = sign_ * source_.velocity(at.q, at.t);
      rate = {source_.index_rate(v_), sign_, keeps_ ? length_of_vector(v_) : 0.0};
      return is_finite(v_) ? StopReason::none : StopReason::outside;
    };
  }

  std::optional<LineEnd> begin(Particle& particle) {
    if (!source_.start(particle.position, at_.q)) return boundary();
    if (const auto end = start_in_cell()) return end;
    if (particle.keeps_knots && particle.knots.empty()) {
      particle.knots.push_back({0, particle.position, direction(v_)});
      particle.times.push_back(particle.time);
    }
    return std::nullopt;
  }

  /// Enters the cell that the motion enters, and evaluates the rate there.
  std::optional<LineEnd> start_in_cell() {
    for (int attempt = 0; attempt < 4; ++attempt) {
      if (rates()(at_, rate_) != StopReason::none) return not_finite();
      const CellAdvance result = source_.advance_cell(at_.q, rate_.q);
      if (result == CellAdvance::boundary) return boundary();
      if (result == CellAdvance::here) break;
    }
    return std::nullopt;
  }

  std::optional<LineEnd> advance(Particle& particle, double until) {
    const double remaining = std::fabs(until - at_.t), speed = length_of_vector(source_.world_difference(rate_.q));
    if (!(particle.step > 0)) particle.step = speed > 0 ? 1e-3 * length_ / speed : 1e-2 * remaining;
    double h = std::min(particle.step, remaining);
    if (speed > 0) h = std::min(h, source_.max_step() / speed);
    const bool forced = idle_ > 8;
    if (forced && speed > 0) h = std::min(h, forced_ / speed);
    const double smallest = 1e-14 * (std::fabs(at_.t) + remaining);

    // trial step
    auto step = runge_kutta_step<true>(tableaus::dp54, at_, rate_, h, true, rates());
    if (step.stop != StopReason::none) return shorten(particle, h, smallest);
    Vec3 v_end = v_;
    const double tolerance = std::max(tolerance_, kRounding * norm(source_.world_difference(at_.q)));
    const double error = norm(source_.world_difference(step.error.q));
    const Hermite piece(at_.q, step.displacement.q, h, rate_.q, step.end_rate.q);
    // the cubic in time only has to find the faces, because steps end on them exactly
    const double face_gap = norm(source_.world_difference(step.bend.q)) / 16;
    const double worst = std::max(
        {error, keeps_ ? arc_gap(step, h, v_end) : 0.0, face_gap * std::min(1.0, std::max(0.01, tolerance / (kFaceGap * length_)))});
    if (!(worst <= tolerance) && h > smallest) {
      particle.step = h * step_factor(worst, tolerance, 0.1, 0.8);
      return std::nullopt;
    }
    const double grown = h * step_factor(worst, tolerance, 0.5, 3.0);

    // the step leaves the cell: it is shortened to end on the face
    CellExit exit;
    const bool leaves = !forced && source_.find_exit(piece, exit);
    if (leaves) {
      if (exit.theta * norm(source_.world_difference(step.displacement.q)) <= 1e-14 * length_ &&
          exit.theta * speed * h <= 1e-14 * length_) {
        ++idle_;
        if (!source_.cross_face(exit)) return boundary();
        return rates()(at_, rate_) == StopReason::none ? std::nullopt : std::optional(not_finite());
      }
      if (!land_on_face(source_, tableaus::dp54, at_, rate_, exit, length_, rates(), h, step, std::max(1e-14, 1e-3 * tolerance / length_)))
        return shorten(particle, h, smallest);
      v_end = v_;
    }
    forced_ = forced ? std::min(2 * forced_, length_) : 1e-8 * length_;
    idle_ = 0;

    // accept the step
    const Vec3 tangent = direction(v_end);
    const bool reaches_end = !leaves && h == remaining;
    at_ += step.displacement;
    if (reaches_end) at_.t = until;
    if (leaves) at_.q[exit.axis] = exit.face;
    particle.step = std::max(grown, leaves ? particle.step : grown);
    std::optional<LineEnd> end;
    if (leaves && !source_.cross_face(exit)) end = boundary();
    if (particle.keeps_knots) keep(particle, tangent);
    if (!end) end = start_in_cell();
    if (!end && particle.keeps_knots && particle.knots.size() >= max_knots_) end = LineEnd{};
    return end;
  }

  /// Difference of the cubic in arc length from the continuous extension of the step half way in time, world units.
  double arc_gap(const StepOf<PathState>& step, double h, const Vec3& v_end) const {
    if (!(step.displacement.s > kClose * length_)) return 0;
    const PathState middle = 0.5 * step.displacement + (h / 8) * (rate_ + -1.0 * step.end_rate) + (1.0 / 16) * step.bend;
    const Vec3 whole = source_.world_difference(step.displacement.q), u0 = direction(source_.world_difference(rate_.q));
    const Hermite arc(Vec3(0.0), whole, step.displacement.s, max_abs(u0) > 0 ? u0 : direction(whole), direction(v_end));
    return norm(arc.evaluate(middle.s / step.displacement.s) - source_.world_difference(middle.q));
  }

  std::optional<LineEnd> shorten(Particle& particle, double h, double smallest) {
    particle.step = 0.5 * h;
    return h > smallest ? std::nullopt : std::optional(not_finite());
  }

  /// Adds a knot at the current position. A particle that rests has two knots at one place, with the times between which it rests.
  void keep(Particle& particle, const Vec3& tangent) {
    std::vector<Knot>& knots = particle.knots;
    const Vec3 position = source_.world(at_.q);
    const Vec3 u = max_abs(tangent) > 0 ? tangent : knots.back().t;
    if (!(max_abs(knots.back().t) > 0)) knots.back().t = direction(position - knots.back().p);
    const auto is_close = [&](std::size_t k) { return at_.s - knots[k].s < kClose * length_; };
    if (knots.size() > 2 && is_close(knots.size() - 1) && is_close(knots.size() - 2)) {
      knots.pop_back();
      particle.times.pop_back();
    }
    const double s = std::max(at_.s, knots.back().s + kApart * length_);
    knots.push_back({s, position, u, source_.rounding_error(at_.q)});
    particle.times.push_back(at_.t);
  }

  static double length_of_vector(const Vec3& v) {
    const double squared = dot(v, v);
    return squared > 1e-200 && squared < 1e200 ? std::sqrt(squared) : norm(v);
  }

  Source& source_;
  double sign_, length_, tolerance_;
  std::size_t max_knots_;
  PathState at_, rate_;
  Vec3 v_{0.0};         ///< velocity of the last stage, in the direction of the integration
  bool keeps_ = false;  ///< the current particle keeps its knots
  int idle_ = 0;        ///< number of consecutive cell changes without progress
  double forced_ = 0;
};

}  // namespace catena::flow
