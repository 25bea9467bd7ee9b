// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/online_streamline.h"

#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/derivatives.h"
#include "engine/geometry/flow/flow.h"
#include "haptics/constraints/common/pull_back.h"
#include "haptics/constraints/equations.h"

namespace catena::haptics {
namespace {

using flow::StopReason;
using OnlineMode = OnlineStreamlineMemory::Mode;

// fractions of L
constexpr double kConverged = 1e-12, kLongestStep = 0.1, kFirstTrust = 0.02;
constexpr double kCritical = 1e-7, kCapture = 1e-4, kBoundary = 1e-9, kSmallest = 1e-15, kCalm = 1e-3, kNear = 0.02;
/// Rounding error of a position, relative to its coordinates.
constexpr double kRounding = 4 * 2.220446049250313e-16;
constexpr int kSearches = 2;  ///< maximum searches for a zero per tick
constexpr int kHalvings = 4;  ///< halvings of a step toward a boundary before the full remaining step is tried

/// One tick of one online streamline.
class OnlineTick {
 public:
  OnlineTick(const OnlineStreamlineSpec& spec, const Vec3& probe, LinkState& state, LinkScratch& scratch)
      : spec_(spec),
        tableau_(flow::tableau_of(spec.method)),
        flow_{spec.field.get(), spec.is_line_field, spec.min_speed},
        probe_(probe),
        x_(max_abs(probe) > 1e280 ? probe * 1e-20 : probe),
        state_(state),
        memory_(memory_as<OnlineStreamlineMemory>(state)),
        cursor_(scratch.cursors[0]),
        length_(spec.field->domain_length()) {}

  /// Begins a line at the seed; does nothing if there is no direction at the seed.
  void begin(const Vec3& seed) noexcept {
    memory_ = OnlineStreamlineMemory{};
    memory_.trust_radius = kFirstTrust * length_;
    state_.proxy = seed;
    ++state_.evaluations;
    const StopReason stop = flow::seed_direction(flow_, seed, cursor_, memory_.t);
    memory_.last_smooth = seed;
    memory_.t_last_smooth = memory_.t;
    if (stop == StopReason::none)
      memory_.mode = OnlineMode::following;
    else
      stop_for(stop, seed);
  }

  void run() noexcept {
    state_.residual = 0;
    if (memory_.mode == OnlineMode::seeking) {
      // there is no line through the last point: the probe passes through until there is one
      if (state_.evaluations == 0) begin(probe_);
      state_.proxy = probe_;
      if (memory_.mode == OnlineMode::seeking) return;
    }
    state_.status = LinkStatus::ok;
    if (spec_.method == flow::Method::linear) return linear();
    if (held()) return;
    memory_.zero_searches = 0;
    march();
  }

  /// Sets status and reason for a point without a direction.
  void stop_for(StopReason stop, const Vec3& place) noexcept {
    if (stop == StopReason::outside)
      set_link_status(state_, LinkStatus::boundary, spec_.field->status_outside(place, cursor_));
    else
      set_link_status(state_, LinkStatus::critical, stop == StopReason::incoherent ? SampleStatus::incoherent : SampleStatus::zero);
  }

 private:
  // Eqs. 1-2 as printed
  void linear() noexcept {
    const double dt = equation::distance_to_foot(x_ - state_.proxy, memory_.t);
    if (dt == 0) return;
    const Vec3 next = equation::linear_step(state_.proxy, memory_.t, dt);
    Vec3 u;
    ++state_.evaluations;
    const StopReason stop = flow::direction_at(flow_, next, memory_.t, cursor_, u);
    if (stop != StopReason::none) return stop_for(stop, next);
    state_.proxy = next;
    memory_.t = u;
  }

  /// Returns whether the proxy is still held at a zero or at the boundary. Releases it when the probe has turned back.
  bool held() noexcept {
    if (memory_.mode == OnlineMode::following) return false;
    if (dot(x_ - memory_.hold_point, memory_.hold_direction) >= 0) {
      state_.proxy = memory_.hold_point;
      set_link_status(state_, memory_.mode == OnlineMode::at_boundary ? LinkStatus::boundary : LinkStatus::critical, memory_.reason);
      return true;
    }
    state_.proxy = memory_.p_resume;
    memory_.t = memory_.t_resume;
    memory_.curvature = Vec3(0.0);
    memory_.mode = OnlineMode::following;
    return false;
  }

  void hold_at(OnlineMode mode, const Vec3& place, double direction_sign) noexcept {
    if (!has_entry_) remember_entry(direction_sign);
    const Vec3 approach = place - memory_.last_smooth;
    if (mode == OnlineMode::at_zero && max_abs(approach) > 0 && norm(approach) <= kNear * length_) {
      // resumes on the branch by which the proxy came, not on one that it has turned to
      memory_.p_resume = memory_.last_smooth;
      memory_.t_resume = memory_.t_last_smooth;
      memory_.hold_direction = dot(approach, memory_.t_last_smooth) < 0 ? -memory_.t_last_smooth : memory_.t_last_smooth;
    }
    memory_.mode = mode;
    memory_.hold_point = place;
    if (mode != OnlineMode::at_boundary) memory_.reason = mode == OnlineMode::at_zero ? SampleStatus::zero : SampleStatus::incoherent;
    state_.proxy = place;
    set_link_status(state_, mode == OnlineMode::at_boundary ? LinkStatus::boundary : LinkStatus::critical, memory_.reason);
  }

  void remember_entry(double direction_sign) noexcept {
    has_entry_ = true;
    memory_.p_resume = state_.proxy;
    memory_.t_resume = memory_.t;
    memory_.hold_direction = direction_sign * memory_.t;
  }

  /// Computes f_V of Eq. 3 in arc length: a step from the proxy by direction_sign * h. On a grid of line fields h may become shorter.
  flow::Step advect(double direction_sign, double& h) noexcept {
    if (flow_.is_line_field && flow_.field->is_grid()) {
      if (!cells_) cells_.emplace(flow_, cursor_);
      const flow::Step step = cells_->step(tableau_, state_.proxy, memory_.t, direction_sign, h);
      state_.evaluations += step.evaluations;
      return step;
    }
    const auto rate = [this](const Vec3& q, Vec3& u) {
      const StopReason stop = flow::direction_at(flow_, q, memory_.t, cursor_, u);
      return stop == StopReason::none && dot(u, memory_.t) < 0.5 ? StopReason::turned : stop;
    };
    const flow::Step step = flow::runge_kutta_step(tableau_, state_.proxy, memory_.t, direction_sign * h, true, rate);
    state_.evaluations += step.evaluations;
    return step;
  }

  /// Returns the rounding error of the proxy's position: by world coordinates or relative to the grid's origin, whichever is larger.
  double rounding() const noexcept {
    return kRounding * std::max(max_abs(state_.proxy), max_abs(state_.proxy - spec_.field->mapping().origin));
  }

  bool affordable() noexcept {
    if (state_.evaluations + (cells_ ? 3 : 1) * tableau_.stages <= kMaxEvaluations) return true;
    state_.status = LinkStatus::budget;
    return false;
  }

  /// Ends the march at a nearby zero if that is nearer to the probe (item 5).
  bool capture(double direction_sign) noexcept {
    if (spec_.min_speed > 0 || memory_.zero_searches >= kSearches) return false;
    ++memory_.zero_searches;
    const int budget = std::min(kMaxEvaluations - state_.evaluations, 57);
    const auto zero = flow::find_zero(flow_, state_.proxy, memory_.t, kCapture * length_, cursor_, budget - 1, state_.evaluations);
    if (!zero || norm(x_ - *zero) > norm(x_ - state_.proxy)) return false;
    const Vec3 ahead = *zero - state_.proxy;
    const bool forward = direction_sign * dot(ahead, memory_.t) >= 0.2 * norm(ahead);
    if (!forward && dot(ahead, memory_.curvature) > 0) return false;  // around a center; past a saddle, a line bends away from it
    hold_at(OnlineMode::at_zero, *zero, direction_sign);
    return true;
  }

  /// Iterates Eq. 3 until the residual of Eq. 2 vanishes, safeguarded: Newton with the curvature, trust radius, bracket, descent.
  void march() noexcept {
    double limit = memory_.trust_radius;  // longest step from here that may still succeed
    double failed_distance = -1;          // distance ahead at which a step failed; valid while > 0
    double failed_sign = 0;
    int halvings = 0;  // steps taken since a step failed outside the domain
    for (int i = 0; i < 2 * kMaxEvaluations; ++i) {
      const Vec3 e = x_ - state_.proxy;
      const double g = equation::distance_to_foot(e, memory_.t), direction_sign = g < 0 ? -1.0 : 1.0;
      state_.residual = std::fabs(g);
      if (!(std::fabs(g) > std::max(kConverged * length_, rounding()))) return;
      if (direction_sign != failed_sign) failed_distance = -1;

      // the step: Newton with the curvature, within the trust radius and the bracket
      double h = std::fabs(g) / std::max(std::fabs(1 - dot(memory_.curvature, e)), 0.1);
      h = std::min(std::min(h, limit), kLongestStep * length_);
      if (failed_distance > 0)
        h = std::min(h, halvings >= kHalvings ? failed_distance : std::max(0.5 * failed_distance, kSmallest * length_));
      if (!affordable()) return;
      flow::Step step = advect(direction_sign, h);

      if (step.stop == StopReason::outside) {
        if (!has_entry_) remember_entry(direction_sign);
        if (h <= kBoundary * length_) return hold_on_boundary(direction_sign, h);
        limit = 0.5 * h;
        failed_distance = h;
        failed_sign = direction_sign;
        halvings = 1;
        continue;
      }
      if (step.stop != StopReason::none) {
        if (!has_entry_) remember_entry(direction_sign);
        const bool incoherent = step.stop == StopReason::incoherent;
        if (!incoherent && h <= 4 * kCapture * length_ && capture(direction_sign)) return;
        if (h <= kCritical * length_)
          return hold_at(incoherent ? OnlineMode::at_incoherent : OnlineMode::at_zero, state_.proxy, direction_sign);
        limit = 0.5 * h;
        failed_distance = h;
        failed_sign = direction_sign;
        halvings = 0;
        continue;
      }

      // embedded error
      const double tolerance = spec_.tolerance * length_, error = norm(step.error);
      if (tableau_.embedded && !(error <= tolerance)) {
        if (h <= kCritical * length_ * 1e-3) return hold_at(OnlineMode::at_zero, state_.proxy, direction_sign);
        limit = h * flow::step_factor(error, tolerance, 0.1, 0.8);
        memory_.trust_radius = limit;
        continue;
      }
      const double grown = tableau_.embedded ? h * flow::step_factor(error, tolerance, 0.5, 4.0) : 2 * h;

      // beyond the foot: root of the Hermite interpolant, then one exact step onto it
      const double g_end = dot(e - step.displacement, step.end_rate);
      if (direction_sign * g_end < 0) {
        if (!affordable()) return;
        const flow::Hermite piece(state_.proxy, step.displacement, direction_sign * h, memory_.t, step.end_rate);
        const double theta = piece.foot(x_, direction_sign * h * g, direction_sign * h * g_end);
        h *= theta;
        step = advect(direction_sign, h);
        if (step.stop != StopReason::none) {
          limit = 0.5 * h;
          continue;
        }
      }

      // Armijo condition, without cancellation
      const double change = -dot(step.displacement, e - 0.5 * step.displacement);
      if (!(change <= -1e-4 * std::fabs(g) * h)) {
        limit = 0.5 * h;
        if (h <= kSmallest * length_) return;
        continue;
      }
      accept(step, direction_sign * h, grown);
      limit = memory_.trust_radius;
      // a stage may lie outside although the line does not: the full remaining step is tried every few steps
      if (halvings > 0) halvings = halvings >= kHalvings ? 0 : halvings + 1;
      if (failed_distance > 0) failed_distance = failed_distance > h ? std::max(failed_distance - h, kSmallest * length_) : -1;
      if (norm(memory_.curvature) * kCapture * length_ > 1 && capture(direction_sign)) return;
    }
    state_.status = LinkStatus::budget;
  }

  /// Holds the proxy at the boundary. `step`: a length that leads out of the domain.
  void hold_on_boundary(double direction_sign, double step) noexcept {
    memory_.p_resume = state_.proxy;
    memory_.t_resume = memory_.t;
    memory_.hold_direction = direction_sign * memory_.t;
    memory_.reason = spec_.field->status_outside(state_.proxy + step * memory_.hold_direction, cursor_);
    if (memory_.reason == SampleStatus::ok) memory_.reason = SampleStatus::outside_box;  // a stage beside the line lay outside
    hold_at(OnlineMode::at_boundary, state_.proxy, direction_sign);
  }

  void accept(const flow::Step& step, double h, double grown) noexcept {
    if (std::fabs(h) > 1e-9 * length_) memory_.curvature = (step.end_rate - memory_.t) / h;
    state_.proxy += step.displacement;  // Eq. 3
    memory_.t = step.end_rate;
    memory_.trust_radius = std::min(std::max(memory_.trust_radius, grown), kLongestStep * length_);
    if (norm(memory_.curvature) * kCalm * length_ > 1) return;
    memory_.last_smooth = state_.proxy;
    memory_.t_last_smooth = memory_.t;
  }

  const OnlineStreamlineSpec& spec_;
  const flow::Tableau& tableau_;
  flow::Flow flow_;
  Vec3 probe_;
  Vec3 x_;  ///< the probe, or only its direction if it is so far away that products would overflow
  LinkState& state_;
  OnlineStreamlineMemory& memory_;
  field::Cursor& cursor_;
  double length_;
  std::optional<CellStepper> cells_;
  bool has_entry_ = false;  ///< p_resume, t_resume and direction_sign belong to this approach
};

class OnlineStreamline final : public Constraint {
 public:
  explicit OnlineStreamline(const OnlineStreamlineSpec& spec) : spec_(spec) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    OnlineTick(spec_, probe, state, scratch).begin(spec_.seed.value_or(probe));
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    OnlineTick(spec_, probe, state, scratch).run();
  }
  /// With a seed the proxy stays on the line of the seed and moves along it; without one it engages at the probe.
  void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    OnlineTick tick(spec_, probe, state, scratch);
    const bool fresh = memory_as<OnlineStreamlineMemory>(state).trust_radius == 0;
    if (fresh || !spec_.seed) tick.begin(spec_.seed.value_or(probe));
    if (spec_.seed) tick.run();
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const OnlineStreamlineMemory& memory = memory_as<OnlineStreamlineMemory>(state);
    return is_valid_enum(memory.mode, OnlineMode::at_incoherent) && is_valid_enum(memory.reason, SampleStatus::not_finite) &&
           memory.zero_searches >= 0 && memory.zero_searches <= kMaxEvaluations;
  }
  bool has_primitive() const noexcept override { return true; }
  /// Returns the tangent at the foot of `at`; a point where the line is held at an end. At the proxy itself the direction is sampled once
  /// more, because the proxy may have been moved from outside.
  bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept override {
    if (bitwise_equal(at, state.proxy)) return here(at, state, scratch, out);
    LinkState foot = state;
    OnlineTick(spec_, at, foot, scratch).run();
    state.evaluations = foot.evaluations;
    out = line_or_point(foot);
    return memory_as<OnlineStreamlineMemory>(foot).mode != OnlineMode::seeking;
  }
  /// J = t t^T / (1 - kappa N . (x - p)), kappa N by two more samples along the line; 0 where the proxy is held at an end of the line.
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch& scratch) const noexcept override {
    const OnlineStreamlineMemory& memory = memory_as<OnlineStreamlineMemory>(state);
    if (memory.mode == OnlineMode::seeking) return {f};
    if (memory.mode != OnlineMode::following) return {};
    const double h = 1e-5 * spec_.field->domain_length();
    const flow::Flow flow{spec_.field.get(), spec_.is_line_field, spec_.min_speed};
    Vec3 ahead, behind, bend(0.0);
    state.evaluations += 2;
    const Vec3 &p = state.proxy, &t = memory.t;
    if (flow::direction_at(flow, p + t * h, t, scratch.cursors[0], ahead) == StopReason::none &&
        flow::direction_at(flow, p - t * h, t, scratch.cursors[0], behind) == StopReason::none)
      bend = (ahead - behind) / (2 * h);
    return pull_back_on_curve(t, 1 - dot(bend, probe - p), f);
  }
  double domain_length() const noexcept override { return spec_.field->domain_length(); }

 private:
  static Primitive line_or_point(LinkState& state) noexcept {
    const OnlineStreamlineMemory& memory = memory_as<OnlineStreamlineMemory>(state);
    const bool line = memory.mode == OnlineMode::following;
    return {line ? Primitive::Kind::line : Primitive::Kind::point, state.proxy, line ? memory.t : Vec3(0.0)};
  }
  bool here(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept {
    OnlineStreamlineMemory& memory = memory_as<OnlineStreamlineMemory>(state);
    if (memory.mode == OnlineMode::following) {
      Vec3 u;
      ++state.evaluations;
      const StopReason stop =
          flow::direction_at({spec_.field.get(), spec_.is_line_field, spec_.min_speed}, at, memory.t, scratch.cursors[0], u);
      if (stop != StopReason::none) {
        OnlineTick(spec_, at, state, scratch).stop_for(stop, at);
        return false;
      }
      memory.t = u;
    }
    out = line_or_point(state);
    return memory.mode != OnlineMode::seeking;
  }

  OnlineStreamlineSpec spec_;
};

}  // namespace

std::shared_ptr<const Constraint> make_online_streamline(const OnlineStreamlineSpec& spec) {
  CATENA_ASSERT(spec.field);
  return std::make_shared<OnlineStreamline>(spec);
}

}  // namespace catena::haptics
