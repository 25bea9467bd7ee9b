// SPDX-License-Identifier: MIT
#include "haptics/constraints/forces/forces.h"

#include "haptics/constraints/common/link_schema.h"

namespace catena::haptics {
namespace {

constexpr double kRoundOff = 1e-15;  // a gap of less than this times the coordinates counts as zero

class Viscosity final : public Constraint {
 public:
  Viscosity(const Parameter& amount, bool is_time) : amount_(amount), is_time_(is_time) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    state.proxy = probe;
    state.residual = 0;
    state.status = LinkStatus::ok;
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    state.status = LinkStatus::ok;
    state.residual = 0;
    state.limit = 0;
    const double time = time_s(state, scratch), dt = state.dt_s > 0 ? state.dt_s : 0;
    const Vec3 gap = probe - state.proxy;
    const bool there = max_abs(gap) <= kRoundOff * std::fmax(max_abs(probe), max_abs(state.proxy));
    if (there || !(time > 0) || !std::isfinite(dt)) {
      state.proxy = probe;
      return;
    }
    const double part = dt / (time + dt);
    const Vec3 next = state.proxy + gap * part;
    state.proxy = is_finite(next) ? next : state.proxy * (1 - part) + probe * part;
  }

 private:
  double time_s(LinkState& state, LinkScratch& scratch) const noexcept {
    const double amount = amount_.at(state.proxy, scratch.parameter_cursor, state.evaluations);
    if (is_time_) return amount;
    return state.stiffness_n_per_m > 0 ? amount / state.stiffness_n_per_m : 0;
  }

  Parameter amount_;
  bool is_time_;
};

Result<std::shared_ptr<const Constraint>> build_viscosity(const json::Node& link, const BuildContext& context) {
  const bool time = link.find("time") != nullptr, coefficient = link.find("coefficient") != nullptr;
  if (time == coefficient)
    return json::error_at(link, std::string("a viscosity has ") + (time ? "both" : "neither") +
                                    " \"time\" and \"coefficient\"; exactly one of them was expected");
  CATENA_TRY(const Parameter amount, require_parameter(link, time ? "time" : "coefficient", json::NumberRange::non_negative, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Viscosity>(amount, time));
}

}  // namespace

ConstraintType viscosity_constraint() {
  return {"viscosity",
          "Viscous resistance to the motion of the probe. Exactly one of `time` and `coefficient` is required.",
          "not in the paper",
          {schema::number("time", "s", "Relaxation time; the force is stiffness x time x velocity.")
               .non_negative()
               .or_field()
               .with_initial_value("0.05")
               .recommended(),
           schema::number("coefficient", "N s/m", "Damping coefficient; the force is coefficient x velocity.")
               .non_negative()
               .or_field()
               .with_initial_value("2")},
          build_viscosity};
}

}  // namespace catena::haptics
