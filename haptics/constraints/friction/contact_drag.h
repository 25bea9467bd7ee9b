/// Isotropic friction in space or on a level set: |x - p| <= tau leaves p, bit for bit, else p slides to |x - p| = tau. What tau
/// is at the proxy, before it moves, the constraint says: drag, texture. The ground's rules are those of friction/contact.h.
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/constraints/friction/contact.h"

namespace catena::haptics {

class ContactDrag : public Constraint {
 public:
  explicit ContactDrag(ContactSpec contact) : contact_(std::move(contact)) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept final {
    memory_of<ContactMemory>(state) = ContactMemory{};
    state.proxy = probe;
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept final {
    Contact contact(contact_, probe, memory_of<ContactMemory>(state), state, scratch);
    if (!contact.begin()) return;
    const double tau = safe_threshold(threshold(contact.proxy(), state, scratch));
    if (!contact.drag(tau)) return contact.lose();
    contact.end(tau, Status::ok);
  }
  bool is_sane(const LinkState& state) const noexcept final { return haptics::is_sane(memory_of<ContactMemory>(state)); }
  double domain_length() const noexcept final { return contact_.length; }

 private:
  virtual double threshold(const Vec3& p, LinkState& state, LinkScratch& scratch) const noexcept = 0;
  ContactSpec contact_;
};

}  // namespace catena::haptics
