// SPDX-License-Identifier: MIT
#include "engine/base/numbers.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/derivatives.h"
#include "engine/geometry/flow/flow.h"
#include "engine/geometry/flow/flow_source.h"
#include "engine/geometry/flow/trace_internal.h"

namespace catena::flow {
namespace {

/// Integrates one direction of a streamline from the seed through a flow source with DP5(4) in arc length (flow_source.h). Steps are
/// refined until the Hermite midpoint agrees with a half step; on grids every knot that leaves a cell lies on its face, found on the
/// Hermite and corrected by true steps. No step turns by more than 60 degrees: one that does is halved, down to 1e-9 L, so that a line
/// never jumps through a zero.
template <class Medium>
class March {
 public:
  March(Medium& medium, const Flow& flow, const TraceOptions& options)
      : medium_(medium), flow_(flow), options_(options), domain_(flow.field->domain_length()) {}

  Branch run(const Vec3& seed, const Vec3& u_seed, double sign) {
    seed_ = seed;
    u_seed_ = u_seed;
    sign_ = sign;
    Branch branch;
    branch.knots.push_back({0, seed, u_seed});
    u_ = sign * u_seed;
    forced_ = 1e-8 * domain_;
    if (!medium_.start(seed, u_seed, sign, q_)) {
      branch.end = boundary();
      return branch;
    }
    std::optional<LineEnd> end = start_in_cell();
    while (!end) {
      end = advance(branch.knots);
      if (!end && (s_ >= options_.length || branch.knots.size() >= options_.max_knots)) end = LineEnd{};
    }
    branch.end = *end;
    return branch;
  }

 private:
  static LineEnd critical() { return {Termination::critical, SampleStatus::zero}; }
  LineEnd boundary() const { return {Termination::boundary, medium_.outside_status()}; }
  double stop_step() const { return 1e-9 * domain_; }  ///< a step of this length that still turns too far is at a zero

  /// Returns the rate function of the Runge-Kutta stages; it stops if the direction turns by more than 60 degrees from the step's start.
  auto rates() {
    return [this](const Vec3& q, Vec3& w) {
      const StopReason stop = medium_.rate(q, w, u_last_);
      if (stop != StopReason::none) return stop;
      return dot(u_last_, u_) < 0.5 ? StopReason::turned : StopReason::none;
    };
  }

  /// Advances to the cell that the motion enters and evaluates the rate there; returns the line's end if it ends here.
  std::optional<LineEnd> start_in_cell() {
    for (int attempt = 0; attempt < 4; ++attempt) {
      Vec3 u;
      const StopReason stop = medium_.rate(q_, w_, u);
      if (stop != StopReason::none) return make_line_end(stop, medium_.outside_status());
      if (dot(u, u_) < 0.5) return critical();
      u_ = u;
      medium_.set_reference(u_);
      const CellAdvance cell_advance = medium_.advance_cell(q_, w_);
      if (cell_advance == CellAdvance::boundary) return boundary();
      if (cell_advance == CellAdvance::here) break;
    }
    return std::nullopt;
  }

  /// Takes one accepted step, or changes the step size, or returns the end of the line.
  std::optional<LineEnd> advance(std::vector<Knot>& knots) {
    if (h_ <= 0) h_ = 1e-3 * domain_;
    double h = std::min({h_, medium_.max_step(), options_.max_step, options_.length - s_});
    const bool forced = idle_ > 8;
    if (forced) h = std::min(h, forced_);

    // trial step: full step, embedded error, half step against the Hermite
    Step step = runge_kutta_step(tableaus::dp54, q_, w_, h, true, rates());
    if (step.stop != StopReason::none) return shorten(knots, step.stop, h);
    Vec3 u_end = u_last_;
    // far from the origin the rounding of positions limits the tolerance: a smaller tolerance would halve the step endlessly
    const double rounding = kRounding * norm(medium_.world_difference(q_));
    const double tolerance = std::max(options_.tolerance * domain_, rounding);
    const double hermite_tolerance = std::max(options_.hermite_tolerance * domain_, rounding);
    const double error = norm(medium_.world_difference(step.error));
    if (!(error <= tolerance)) return reject(h, step_factor(error, tolerance, 0.1, 0.8));
    const Step half = runge_kutta_step(tableaus::dp54, q_, w_, 0.5 * h, false, rates());
    if (half.stop != StopReason::none) return shorten(knots, half.stop, h);
    Hermite piece(q_, step.displacement, h, w_, step.end_rate);
    const double gap = norm(medium_.world_difference((piece.evaluate(0.5) - q_) - half.displacement));
    if (!(gap <= hermite_tolerance)) return reject(h, step_factor(gap, hermite_tolerance, 0.1, 0.9));
    const double grown = h * std::min(step_factor(error, tolerance, 0.5, 3.0), step_factor(gap, hermite_tolerance, 0.5, 3.0));

    // the step leaves the cell: it is shortened to end on the face
    CellExit cell_exit;
    const bool leaves_cell = !forced && medium_.find_exit(piece, cell_exit);
    if (leaves_cell) {
      if (cell_exit.theta * h <= 1e-14 * domain_) {
        ++idle_;
        if (!medium_.cross_face(cell_exit)) return boundary();
        return start_without_settling();
      }
      if (!land_on_face(medium_, tableaus::dp54, q_, w_, cell_exit, domain_, rates(), h, step))
        return shorten(knots, StopReason::turned, h);
      u_end = u_last_;
      piece = Hermite(q_, step.displacement, h, w_, step.end_rate);
    }
    forced_ = forced ? std::min(2 * forced_, domain_) : 1e-8 * domain_;
    idle_ = 0;
    Vec3 next = q_ + step.displacement;
    if (leaves_cell) next[cell_exit.axis] = cell_exit.face;
    if (sign_ > 0 && closes(next, h, piece, knots)) return LineEnd{Termination::lap, SampleStatus::ok};

    // accept the step
    const Vec3 u_start = u_;
    q_ = next;
    w_ = step.end_rate;
    u_ = u_end;
    s_ += h;
    h_ = std::max(grown, h);
    medium_.set_reference(u_);
    std::optional<LineEnd> end;
    if (leaves_cell && !medium_.cross_face(cell_exit)) end = boundary();
    if (!end) end = start_in_cell();
    // if knots are closer than 1e-10 L, only the later one is stored; the knot at the seed is always stored
    const bool close = s_ - std::fabs(knots.back().s) < 1e-10 * domain_;
    if (close && knots.size() > 1) knots.pop_back();
    if (!close || knots.size() > 1 || end) knots.push_back({sign_ * s_, medium_.world(q_), sign_ * u_, medium_.rounding_error(q_)});
    if (!end && norm(u_ - u_start) * kCapture * 2 * domain_ > h) end = capture(knots);
    return end;
  }

  std::optional<LineEnd> start_without_settling() {
    Vec3 u;
    const StopReason stop = medium_.rate(q_, w_, u);
    if (stop != StopReason::none) return make_line_end(stop, medium_.outside_status());
    if (dot(u, u_) < 0.5) return critical();
    u_ = u;
    return std::nullopt;
  }

  std::optional<LineEnd> reject(double h, double factor) {
    h_ = h * factor;
    if (h_ < 1e-13 * domain_) return critical();
    return std::nullopt;
  }

  /// Handles a stage without a direction or with too large a turn: halves the step, searches for a zero, or ends the line.
  std::optional<LineEnd> shorten(std::vector<Knot>& knots, StopReason stop, double h) {
    if (h <= stop_step()) return make_line_end(stop, medium_.outside_status());
    if ((stop == StopReason::still || stop == StopReason::turned) && flow_.min_speed <= 0 && h <= 4 * kCapture * domain_ &&
        knots.size() != tried_at_) {
      tried_at_ = knots.size();
      if (const auto end = capture(knots)) return end;
    }
    h_ = 0.5 * h;
    return std::nullopt;
  }

  /// Ends the line at a zero within kCapture * L. (The only way to reach a zero along a curved stable manifold: rounding turns the line
  /// away.)
  std::optional<LineEnd> capture(std::vector<Knot>& knots) {
    int evaluations = 0;
    const Vec3 p = knots.back().p;
    const auto zero = find_zero(flow_, p, u_, kCapture * domain_, zero_cursor_, 56, evaluations);
    if (!zero) return std::nullopt;
    const double distance = norm(*zero - p);
    if (dot(*zero - p, u_) < 0.2 * distance) return std::nullopt;  // the zero is beside the line, or the line circles around a center
    if (distance > 1e-12 * domain_) knots.push_back({sign_ * (s_ + distance), *zero, sign_ * direction(*zero - p)});
    return critical();
  }

  /// Tests for a closed line: the step crosses the seed's plane within 1e-7 L of the seed, in the seed's direction.
  bool closes(const Vec3& next, double h, const Hermite& piece, std::vector<Knot>& knots) {
    const Vec3 end = medium_.world(next);
    const double height_before = height_, height_after = dot(end - seed_, u_seed_);
    height_ = height_after;
    if (!(height_before < 0 && height_after >= 0) || norm(end - seed_) > 2 * h + 1e-6 * domain_) return false;
    const auto height = [&](double theta) { return dot(medium_.world(piece.evaluate(theta)) - seed_, u_seed_); };
    double at = h * illinois_root(0.0, height_before, 1.0, height_after, height);
    for (int i = 0; i < 2 && at > 0; ++i) {
      const Step landing = runge_kutta_step(tableaus::dp54, q_, w_, at, true, rates());
      if (landing.stop != StopReason::none) return false;
      const Vec3 position = medium_.world(q_ + landing.displacement);
      if (norm(position - seed_) > 1e-7 * domain_ || dot(u_last_, u_seed_) < 0.5) return false;
      at -= dot(position - seed_, u_seed_) / dot(u_last_, u_seed_);
    }
    if (at <= 1e-12 * domain_ && knots.size() > 2) knots.pop_back();
    knots.push_back({std::max(s_ + at, s_ * (1 + 1e-15)), seed_, u_seed_});
    return true;
  }

  static constexpr double kCapture = 1e-5;  ///< times L
  static constexpr double kRounding = 16 * 2.220446049250313e-16;

  Medium& medium_;
  Flow flow_;
  TraceOptions options_;
  double domain_;
  field::Cursor zero_cursor_;
  Vec3 seed_{0.0}, u_seed_{0.0};
  double sign_ = 1;
  Vec3 q_{0.0}, w_{0.0};       ///< current position and the rate there
  Vec3 u_{0.0}, u_last_{0.0};  ///< directions of motion: at the current position, and of the last stage
  double s_ = 0, h_ = 0;
  double height_ = 0;  ///< signed distance from the seed's plane
  int idle_ = 0;       ///< number of consecutive cell changes without progress
  double forced_ = 0;
  std::size_t tried_at_ = 0;
};

std::string triple(const Vec3& v) { return "(" + to_text(v.x) + ", " + to_text(v.y) + ", " + to_text(v.z) + ")"; }

std::string domain_text(const field::Field& field) {
  const Bounds box = field.world_bounds();
  return triple(box.lo) + " to " + triple(box.hi);
}

Error no_direction(const Flow& flow, const Vec3& seed, StopReason stop) {
  const std::string name = flow.field->name().empty() ? "the field" : "field '" + flow.field->name() + "'";
  if (stop == StopReason::outside)
    return Error{"seed " + triple(seed) + " is outside the domain of " + name + " (a box from " + domain_text(*flow.field) +
                 " without masked and non-finite cells)"};
  if (stop == StopReason::incoherent)
    return Error{"seed " + triple(seed) + ": the axes of the line field " + name +
                 " disagree at the seed, so that no single line passes through it"};
  if (flow.min_speed > 0)
    return Error{"seed " + triple(seed) + ": the speed of " + name + " at the seed is not above min_speed " + to_text(flow.min_speed)};
  return Error{"seed " + triple(seed) + ": " + name + " is zero at the seed, so that no line passes through it"};
}

template <class Medium>
Result<Vec3> tangent_in(Medium medium, const Flow& flow, const Vec3& seed) {
  Vec3 u;
  if (const StopReason stop = medium.seed_tangent_at(seed, u); stop != StopReason::none) return no_direction(flow, seed, stop);
  return u;
}

template <class Medium>
Branch march_in(Medium medium, const Flow& flow, const Vec3& start, double sign, const TraceOptions& options) {
  Vec3 u;
  const StopReason stop = medium.seed_tangent_at(start, u);
  if (stop != StopReason::none) return {{}, make_line_end(stop, medium.outside_status())};
  return March<Medium>(medium, flow, options).run(start, u, sign);
}

template <class Medium>
Result<CurvePtr> trace_in(Medium medium, const Flow& flow, const Vec3& seed, const TraceOptions& options) {
  CATENA_TRY(const Vec3 u, tangent_in(medium, flow, seed));
  // the line is traced backward as well, unless it is closed
  Branch forward = March<Medium>(medium, flow, options).run(seed, u, 1);
  Branch backward;
  if (forward.end.termination != Termination::lap) backward = March<Medium>(medium, flow, options).run(seed, u, -1);
  return join_branches(flow, seed, forward, backward);
}

}  // namespace

Result<Vec3> seed_tangent(const Flow& flow, const Vec3& seed) {
  if (!is_finite(seed)) return Error{"seed " + triple(seed) + " is not finite; three finite numbers were expected"};
  return flow.field->grid() ? tangent_in(CellFlowSource(flow), flow, seed) : tangent_in(FormulaFlowSource(flow), flow, seed);
}

Branch trace_branch(const Flow& flow, const Vec3& start, double sign, const TraceOptions& options) {
  return flow.field->grid() ? march_in(CellFlowSource(flow), flow, start, sign, options)
                            : march_in(FormulaFlowSource(flow), flow, start, sign, options);
}

Result<CurvePtr> join_branches(const Flow& flow, const Vec3& seed, const Branch& forward, const Branch& backward) {
  const double domain = flow.field->domain_length();
  if (forward.end.termination == Termination::lap)
    return CurvePtr(std::make_shared<const Curve>(forward.knots, true, forward.end, forward.end, domain));
  std::vector<Knot> knots;
  knots.reserve(backward.knots.size() + forward.knots.size());
  knots.assign(backward.knots.rbegin(), backward.knots.rend());
  knots.insert(knots.end(), forward.knots.begin() + 1, forward.knots.end());
  if (knots.size() < 2) return Error{"seed " + triple(seed) + ": the line has no length in either direction"};
  return CurvePtr(std::make_shared<const Curve>(std::move(knots), false, backward.end, forward.end, domain));
}

TraceOptions resolve_options(const Flow& flow, TraceOptions options) {
  if (!(options.length > 0)) options.length = 10 * flow.field->domain_length();
  if (!(options.max_step > 0)) options.max_step = std::numeric_limits<double>::infinity();
  options.max_knots = std::max<std::size_t>(options.max_knots / 2, 8);
  return options;
}

Result<CurvePtr> trace(const Flow& flow, const Vec3& seed, const TraceOptions& options) {
  if (!is_finite(seed)) return Error{"seed " + triple(seed) + " is not finite; three finite numbers were expected"};
  const TraceOptions filled = resolve_options(flow, options);
  return flow.field->grid() ? trace_in(CellFlowSource(flow), flow, seed, filled) : trace_in(FormulaFlowSource(flow), flow, seed, filled);
}

}  // namespace catena::flow
