// SPDX-License-Identifier: MIT
#include "haptics/constraints/streamline/selected_streamline.h"

#include "engine/geometry/flow/curve.h"
#include "haptics/constraints/common/pull_back.h"

namespace catena::haptics {
namespace {

constexpr std::int32_t kKnotCap = 4096, kKnotsAStep = 2;
constexpr double kFarSquared = 1e100;
constexpr double kHugeDistance = 1e280;  ///< beyond this distance only the probe's direction counts, because products would overflow

class SelectedStreamline final : public Constraint {
 public:
  explicit SelectedStreamline(flow::CurvePtr curve) : curve_(std::move(curve)), nearest_(curve_), intervals_(curve_->knots().size() - 1) {
    seed_interval_ = curve_->find_interval(0);
  }

  void start(const Vec3&, LinkState& state, LinkScratch&) const noexcept override {
    SelectedStreamlineMemory& memory = memory_as<SelectedStreamlineMemory>(state);
    memory = {0, seed_interval_, 0};
    state.proxy = curve_->position(0);
    state.residual = 0;
    state.status = LinkStatus::ok;
  }

  void advance(const Vec3& far_probe, LinkState& state, LinkScratch&) const noexcept override {
    const Vec3 probe = max_abs(far_probe) > kHugeDistance ? far_probe * 1e-20 : far_probe;
    SelectedStreamlineMemory& memory = memory_as<SelectedStreamlineMemory>(state);
    state.status = LinkStatus::ok;
    state.residual = 0;
    memory.knots_visited = 2;
    std::size_t k = memory.interval;
    double below = slope_at_knot(k, probe), above = slope_at_knot(k + 1, probe);

    // all points here are equally near (center of a circle): the proxy stays
    const double flat = 1e-13 * curve_->domain_length();
    if (std::fabs(below) <= flat && std::fabs(above) <= flat) return place(memory, k, memory.s, state);

    // downhill direction: up the curve, down it, or a foot in this interval
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
        if (k + 1 == intervals_ && !curve_->is_closed()) return hold(memory, k, curve_->knots().back().s, curve_->last_end(), state);
        k = k + 1 == intervals_ ? 0 : k + 1;
        if (++memory.knots_visited > kKnotCap || k == start) return out_of_budget(memory, k, curve_->knots()[k].s, state);
        below = above;
        above = slope_at_knot(k + 1, probe);
      }
    } else if (way < 0) {
      while (below < 0) {
        if (k == 0 && !curve_->is_closed()) return hold(memory, k, curve_->knots().front().s, curve_->first_end(), state);
        k = k == 0 ? intervals_ - 1 : k - 1;
        if (++memory.knots_visited > kKnotCap || k == start) return out_of_budget(memory, k, curve_->knots()[k + 1].s, state);
        above = below;
        below = slope_at_knot(k, probe);
      }
    }

    // foot in the interval, from its own knots
    const flow::Knot &a = curve_->knots()[k], &b = curve_->knots()[k + 1];
    const double h = b.s - a.s;
    const flow::Hermite piece(a.p, a.vector_to(b), h, a.t, b.t);
    const double theta = piece.foot(probe, below * h, above * h);
    place(memory, k, theta >= 1 ? b.s : a.s + theta * h, state);
  }

  /// Moves the proxy to the nearest point of the whole curve.
  void seek(const Vec3& far_probe, LinkState& state, LinkScratch&) const noexcept override {
    const flow::NearestPoint found = nearest_.find(max_abs(far_probe) > kFarSquared ? direction(far_probe) * kFarSquared : far_probe);
    state.status = LinkStatus::ok;
    auto& memory = memory_as<SelectedStreamlineMemory>(state);
    memory.knots_visited = kKnotsAStep * found.work;
    place(memory, found.interval, found.s, state);
  }

  bool is_sane(const LinkState& state) const noexcept override { return memory_as<SelectedStreamlineMemory>(state).interval < intervals_; }
  bool has_primitive() const noexcept override { return true; }
  /// Returns the tangent at the foot of `at`; a point at an open end.
  bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept override {
    LinkState foot = state;
    advance(at, foot, scratch);
    const SelectedStreamlineMemory& memory = memory_as<SelectedStreamlineMemory>(foot);
    Vec3 p, derivative;
    curve_->evaluate_interval(memory.interval, memory.s, p, derivative);
    const bool ends = foot.status == LinkStatus::boundary || foot.status == LinkStatus::critical;
    out = {ends ? Primitive::Kind::point : Primitive::Kind::line, p, ends ? Vec3(0.0) : direction(derivative)};
    return true;
  }
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const SelectedStreamlineMemory& memory = memory_as<SelectedStreamlineMemory>(state);
    return pull_back_on_curve(*curve_, memory.interval, memory.s, probe, f);
  }
  double domain_length() const noexcept override { return curve_->domain_length(); }

 private:
  double slope_at_knot(std::size_t k, const Vec3& x) const noexcept {
    const flow::Knot& knot = curve_->knots()[k];
    return dot(knot.vector_to(x), knot.t);
  }
  double slope_at(std::size_t k, double s, const Vec3& x) const noexcept {
    Vec3 p, derivative;
    curve_->evaluate_interval(k, s, p, derivative);
    return dot(x - p, derivative);
  }
  void place(SelectedStreamlineMemory& memory, std::size_t k, double s, LinkState& state) const noexcept {
    state.other_work += memory.knots_visited / kKnotsAStep;
    memory.s = s;
    memory.interval = k;
    Vec3 derivative;
    curve_->evaluate_interval(k, s, state.proxy, derivative);
  }
  void hold(SelectedStreamlineMemory& memory, std::size_t k, double s, const flow::LineEnd& end, LinkState& state) const noexcept {
    place(memory, k, s, state);
    const bool critical = end.termination == flow::Termination::critical || end.termination == flow::Termination::incoherent;
    if (end.termination == flow::Termination::boundary || critical)
      set_link_status(state, critical ? LinkStatus::critical : LinkStatus::boundary, end.status);
  }
  void out_of_budget(SelectedStreamlineMemory& memory, std::size_t k, double s, LinkState& state) const noexcept {
    place(memory, k, s, state);
    state.status = LinkStatus::budget;
  }

  flow::CurvePtr curve_;
  flow::NearestOnCurve nearest_;
  std::size_t intervals_;
  std::size_t seed_interval_ = 0;
};

}  // namespace

PulledBackForce pull_back_on_curve(const flow::Curve& curve, std::size_t interval, double s, const Vec3& probe, const Vec3& f) noexcept {
  const auto& knots = curve.knots();
  const flow::Knot &a = knots[interval], &b = knots[interval + 1];
  const bool first = interval == 0 && s <= a.s, last = interval + 2 == knots.size() && s >= b.s;
  if (!curve.is_closed() && (first || last)) return {};
  Vec3 p, tangent;
  curve.evaluate_interval(interval, s, p, tangent);
  const double h = b.s - a.s, theta = (s - a.s) / h, squared = dot(tangent, tangent);
  const flow::Hermite piece(a.p, a.vector_to(b), h, a.t, b.t);
  const Vec3 bend = (2.0 * piece.c2 + (6 * theta) * piece.c3) / (h * h);
  return divide_bounded(tangent * (dot(tangent, f) / squared), 1 - dot(probe - p, bend) / squared);
}

std::shared_ptr<const Constraint> make_selected_streamline(flow::CurvePtr curve) {
  CATENA_ASSERT(curve && curve->knots().size() >= 2);
  return std::make_shared<SelectedStreamline>(std::move(curve));
}

}  // namespace catena::haptics
