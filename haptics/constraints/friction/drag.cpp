// SPDX-License-Identifier: MIT
#include "haptics/constraints/friction/friction.h"

#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/friction/friction_contact.h"

namespace catena::haptics {
namespace {

class Drag final : public ContactDrag {
 public:
  Drag(Parameter threshold, ContactSpec contact) : ContactDrag(std::move(contact)), threshold_(std::move(threshold)) {}

 private:
  double threshold(const Vec3& p, LinkState& state, LinkScratch& scratch) const noexcept override {
    return threshold_.at(p, scratch.parameter_cursor, state.evaluations);
  }
  Parameter threshold_;
};

Result<std::shared_ptr<const Constraint>> build_drag(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(Parameter threshold, require_parameter(link, "threshold", json::NumberRange::non_negative, context));
  CATENA_TRY(ContactSpec contact, read_contact(link, SurfaceRequirement::optional_with_level, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Drag>(std::move(threshold), std::move(contact)));
}

}  // namespace

ConstraintType drag_constraint() {
  return {"drag",
          "Isotropic friction: the proxy stays within `threshold` of the probe.",
          "section 3",
          {length_key("threshold", "Distance between probe and proxy at which the proxy slips.").with_initial_value("0.005 L").required(),
           surface_key(), surface_level_key()},
          build_drag};
}

}  // namespace catena::haptics
