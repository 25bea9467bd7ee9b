#include "haptics/constraints/drag.h"

#include "haptics/constraints/read_parameter.h"
#include "haptics/constraints/surface_contact.h"

namespace catena::haptics {
namespace {

class Drag final : public Constraint {
 public:
  Drag(Parameter threshold, ContactSpec contact) : threshold_(std::move(threshold)), contact_(std::move(contact)) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_of<ContactMemory>(state) = ContactMemory{};
    state.proxy = probe;
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    Contact contact(contact_, probe, memory_of<ContactMemory>(state), state, scratch);
    if (!contact.begin()) return;
    const double tau = safe_threshold(threshold_.at(contact.proxy(), scratch.parameter, state.evaluations));
    if (!contact.drag(tau)) return contact.lose();
    contact.end(tau, Status::ok);
  }
  double domain_length() const noexcept override { return contact_.length; }

 private:
  Parameter threshold_;
  ContactSpec contact_;
};

Result<std::shared_ptr<const Constraint>> build(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(Parameter threshold, require_parameter(link, "threshold", json::Range::not_negative, context));
  CATENA_TRY(ContactSpec contact, read_contact(link, SurfaceKey::optional_with_level, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Drag>(std::move(threshold), std::move(contact)));
}

}  // namespace

ConstraintType drag_constraint() {
  return {"drag",
          "section 3",
          {{"threshold", "parameter", true, "the proxy stays within this distance of the probe, world units", kNotNegativeSchema},
           kSurfaceKey,
           kLevelKey},
          build};
}

}  // namespace catena::haptics
