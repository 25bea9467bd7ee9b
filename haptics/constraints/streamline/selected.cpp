#include "haptics/constraints/streamline/selected.h"

#include "engine/flow/curve.h"
#include "haptics/constraints/rules/pull_back.h"

namespace catena::haptics {
namespace {

constexpr std::int32_t kKnotCap = 4096, kKnotsAStep = 2;
constexpr double kFarSquared = 1e100;
constexpr double kHugeDistance = 1e280;  ///< beyond, only the probe's direction counts, and products would overflow

class SelectedStreamline final : public Constraint {
 public:
  explicit SelectedStreamline(flow::CurvePtr curve) : curve_(std::move(curve)), nearest_(curve_), intervals_(curve_->knots().size() - 1) {
    seed_interval_ = curve_->interval_of(0);
  }

  void start(const Vec3&, LinkState& state, LinkScratch&) const noexcept override {
    SelectedMemory& memory = memory_of<SelectedMemory>(state);
    memory = {0, seed_interval_, 0};
    state.proxy = curve_->position(0);
    state.residual = 0;
    state.status = Status::ok;
  }

  void advance(const Vec3& far_probe, LinkState& state, LinkScratch&) const noexcept override {
    const Vec3 probe = max_abs(far_probe) > kHugeDistance ? far_probe * 1e-20 : far_probe;
    SelectedMemory& memory = memory_of<SelectedMemory>(state);
    state.status = Status::ok;
    state.residual = 0;
    memory.knots = 2;
    std::size_t k = memory.interval;
    double below = slope_at_knot(k, probe), above = slope_at_knot(k + 1, probe);

    // every place here is equally near (the centre of a circle): stay
    const double flat = 1e-13 * curve_->domain_length();
    if (std::fabs(below) <= flat && std::fabs(above) <= flat) return place(memory, k, memory.s, state);

    // downhill: up the curve, down it, or a foot in this interval
    int way = 0;
    if (below > 0 && above > 0)
      way = 1;
    else if (below < 0 && above < 0)
      way = -1;
    else if (!(below >= 0 && above <= 0))
      way = slope_at(k, memory.s, probe) >= 0 ? 1 : -1;

    // knot by knot until the slope changes sign
    const std::size_t start = k;
    if (way > 0) {
      while (above > 0) {
        if (k + 1 == intervals_ && !curve_->closed()) return hold(memory, k, curve_->knots().back().s, curve_->last_end(), state);
        k = k + 1 == intervals_ ? 0 : k + 1;
        if (++memory.knots > kKnotCap || k == start) return out_of_budget(memory, k, curve_->knots()[k].s, state);
        below = above;
        above = slope_at_knot(k + 1, probe);
      }
    } else if (way < 0) {
      while (below < 0) {
        if (k == 0 && !curve_->closed()) return hold(memory, k, curve_->knots().front().s, curve_->first_end(), state);
        k = k == 0 ? intervals_ - 1 : k - 1;
        if (++memory.knots > kKnotCap || k == start) return out_of_budget(memory, k, curve_->knots()[k + 1].s, state);
        above = below;
        below = slope_at_knot(k, probe);
      }
    }

    // the foot, from the interval's own knots
    const flow::Knot &a = curve_->knots()[k], &b = curve_->knots()[k + 1];
    const double h = b.s - a.s;
    const flow::Hermite piece(a.p, a.to(b), h, a.t, b.t);
    const double theta = piece.foot(probe, below * h, above * h);
    place(memory, k, theta >= 1 ? b.s : a.s + theta * h, state);
  }

  /// The nearest place of the whole curve.
  void seek(const Vec3& far_probe, LinkState& state, LinkScratch&) const noexcept override {
    const flow::NearestPlace found = nearest_.at(max_abs(far_probe) > kFarSquared ? direction(far_probe) * kFarSquared : far_probe);
    state.status = Status::ok;
    auto& memory = memory_of<SelectedMemory>(state);
    memory.knots = kKnotsAStep * found.work;
    place(memory, found.interval, found.s, state);
  }

  bool is_sane(const LinkState& state) const noexcept override { return memory_of<SelectedMemory>(state).interval < intervals_; }
  bool has_primitive() const noexcept override { return true; }
  /// The tangent at the foot of `at`; an open end is a point.
  bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept override {
    LinkState foot = state;
    advance(at, foot, scratch);
    const SelectedMemory& memory = memory_of<SelectedMemory>(foot);
    Vec3 p, derivative;
    curve_->evaluate_in(memory.interval, memory.s, p, derivative);
    const bool ends = foot.status == Status::boundary || foot.status == Status::critical;
    out = {ends ? Primitive::Kind::point : Primitive::Kind::line, p, ends ? Vec3(0.0) : direction(derivative)};
    return true;
  }
  PulledBack pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const SelectedMemory& memory = memory_of<SelectedMemory>(state);
    return pull_back_on_curve(*curve_, memory.interval, memory.s, probe, f);
  }
  double domain_length() const noexcept override { return curve_->domain_length(); }

 private:
  double slope_at_knot(std::size_t k, const Vec3& x) const noexcept {
    const flow::Knot& knot = curve_->knots()[k];
    return dot(knot.to(x), knot.t);
  }
  double slope_at(std::size_t k, double s, const Vec3& x) const noexcept {
    Vec3 p, derivative;
    curve_->evaluate_in(k, s, p, derivative);
    return dot(x - p, derivative);
  }
  void place(SelectedMemory& memory, std::size_t k, double s, LinkState& state) const noexcept {
    state.steps += memory.knots / kKnotsAStep;
    memory.s = s;
    memory.interval = k;
    Vec3 derivative;
    curve_->evaluate_in(k, s, state.proxy, derivative);
  }
  void hold(SelectedMemory& memory, std::size_t k, double s, const flow::LineEnd& end, LinkState& state) const noexcept {
    place(memory, k, s, state);
    const bool critical = end.end == flow::End::critical || end.end == flow::End::incoherent;
    if (end.end == flow::End::boundary || critical) stop_link(state, critical ? Status::critical : Status::boundary, end.reason);
  }
  void out_of_budget(SelectedMemory& memory, std::size_t k, double s, LinkState& state) const noexcept {
    place(memory, k, s, state);
    state.status = Status::budget;
  }

  flow::CurvePtr curve_;
  flow::NearestOnCurve nearest_;
  std::size_t intervals_;
  std::size_t seed_interval_ = 0;
};

}  // namespace

PulledBack pull_back_on_curve(const flow::Curve& curve, std::size_t interval, double s, const Vec3& probe, const Vec3& f) noexcept {
  const auto& knots = curve.knots();
  const flow::Knot &a = knots[interval], &b = knots[interval + 1];
  const bool first = interval == 0 && s <= a.s, last = interval + 2 == knots.size() && s >= b.s;
  if (!curve.closed() && (first || last)) return {};
  Vec3 p, tangent;
  curve.evaluate_in(interval, s, p, tangent);
  const double h = b.s - a.s, theta = (s - a.s) / h, squared = dot(tangent, tangent);
  const flow::Hermite piece(a.p, a.to(b), h, a.t, b.t);
  const Vec3 bend = (2.0 * piece.c2 + (6 * theta) * piece.c3) / (h * h);
  return divided(tangent * (dot(tangent, f) / squared), 1 - dot(probe - p, bend) / squared);
}

std::shared_ptr<const Constraint> make_selected_streamline(flow::CurvePtr curve) {
  CATENA_ASSERT(curve && curve->knots().size() >= 2);
  return std::make_shared<SelectedStreamline>(std::move(curve));
}

}  // namespace catena::haptics
