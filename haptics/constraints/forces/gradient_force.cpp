// SPDX-License-Identifier: MIT
#include "haptics/constraints/forces/forces.h"

#include "engine/field/derived/magnitude.h"
#include "haptics/constraints/common/link_schema.h"

namespace catena::haptics {
namespace {

class GradientForce final : public Constraint {
 public:
  GradientForce(field::ScalarFieldPtr field, const Parameter& displacement, double sign)
      : field_(std::move(field)), displacement_(displacement), sign_(sign), largest_(field::compute_max_gradient(*field_)) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    state.proxy = probe;
    state.status = LinkStatus::ok;
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    // sampled at the probe, not at the last proxy: a resting probe gets a constant force
    const double maximum = displacement_.at(probe, scratch.parameter_cursor, state.evaluations);
    state.residual = 0;
    state.limit = 0;
    state.proxy = probe;
    state.status = LinkStatus::free;
    ++state.evaluations;
    const field::ScalarSample sample = field_->sample(probe, scratch.cursors[0]);
    const double slope = norm(sample.gradient);
    const bool known = sample.inside && std::isfinite(sample.value) && std::isfinite(slope);
    if (!known) return;
    state.status = LinkStatus::ok;
    const double part = largest_ > 0 ? std::fmin(1.0, slope / largest_) : 0;
    const Vec3 shift = direction(sample.gradient) * (sign_ * maximum * part);
    const Vec3 proxy = probe + shift;
    if (max_abs(shift) > 0 && is_finite(proxy)) state.proxy = proxy;
  }

  bool is_energy_source() const noexcept override { return true; }
  double domain_length() const noexcept override { return field_->domain_length(); }

 private:
  field::ScalarFieldPtr field_;
  Parameter displacement_;
  double sign_;
  double largest_;  ///< X: the maximum magnitude
};

Result<std::shared_ptr<const Constraint>> build_gradient_force(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const field::ScalarFieldPtr field, require_scalar_field(link, "field", "a gradient force", context));
  CATENA_TRY(const Parameter displacement, require_parameter(link, "displacement", json::NumberRange::non_negative, context));
  CATENA_CHECK(json::require_string(link, "direction"));
  CATENA_TRY(const int direction, json::get_choice(link, "direction", 0, {"up_gradient", "down_gradient"}));
  return std::shared_ptr<const Constraint>(std::make_shared<GradientForce>(field, displacement, direction == 0 ? 1.0 : -1.0));
}

}  // namespace

ConstraintType gradient_force_constraint() {
  return {"gradient_force",
          "Pulls the probe towards higher or lower values of a scalar field.",
          "not in the paper",
          {scalar_field_key("field").required(), length_key("displacement", "Maximum distance between proxy and probe.").required(),
           schema::choice("direction", {"up_gradient", "down_gradient"},
                          "Direction of the force: towards higher values (`up_gradient`) or lower values (`down_gradient`).")
               .required()},
          build_gradient_force};
}

}  // namespace catena::haptics
