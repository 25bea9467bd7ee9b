// SPDX-License-Identifier: MIT
/// Safe normalization (the sigma of the paper's Eq. 9), and friction on a surface. An absolute eps would break under a change of units:
///   m = max|v_i|; not 0 < m < inf: direction 0, factor 0.   w = v / m, r = |w|, d = w / r, q = min((m / X) r, 1e3),
///   factor = q^2 / (q^2 + 1e-12), X the field's largest magnitude (engine/field/derived/magnitude.h); X = 0 gives 0.
/// safe_normalize: any thread; the rest: haptic thread.
#pragma once
#include <optional>

#include "engine/base/vec.h"
#include "haptics/constraints/isosurface/level_set_field.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// A safely normalized vector.
struct SafeDirection {
  Vec3 d{0.0};        ///< unit direction; 0 where there is none
  double factor = 0;  ///< 0..1: 1 in well-defined regions, 0 where the field is ill-defined
};

/// Normalizes v safely. `largest` is X. `normal` (unit, or zero): only the component of v tangential to it counts, v - (v.n) n.
inline SafeDirection safe_normalize(const Vec3& v, double largest, const Vec3& normal = Vec3(0.0)) noexcept {
  const double m = max_abs(v);
  if (!(m > 0) || !is_finite(v) || !(largest > 0)) return {};
  Vec3 w = m > 1e-300 ? v * (1 / m) : Vec3(v.x / m, v.y / m, v.z / m);
  w = w - normal * dot(w, normal);
  const double r = std::sqrt(dot(w, w));
  if (!(r > 0)) return {};
  const double q = std::min(m / largest * r, 1e3);
  return {w * (1 / r), q * q / (q * q + 1e-12)};
}

/// The domain that friction acts on: all of space, or one level set s = level of a scalar field, on which probe and proxy lie.
/// Shared by drag, friction, modulated_friction and texture.
///   touching   on a level, friction acts only while the incoming probe x is on it: |s - level| / |grad s| <= 1e-6 L, one field sample.
///              Off the level (free side, released, no isosurface link before) the proxy is the probe, bit for bit: FREE.
///              Where x comes on to the level the proxy starts from x, at rest.
///   sliding    to |x - p| = r within 1e-13 L, on the level within 1e-12 L or its round-off; in space in closed form. Newton on
///              both at once, one sample per iteration:  p += b t - l n,  l = (s - level) / |grad s|,  t = e - (e.n) n over its norm,
///              |e + l n - b t| = r,  e = x - p
///   lost       where that fails (noise, a jump to another sheet, the mask or non-finite voxels between) the proxy stays where it is for
///              kPatience + kFade ticks (8 + 20), BUDGET, while each tick retries; its weight fades in the last kFade (where the
///              coupling has a ramp). Then it restarts from x: NO_SURFACE in that tick, the probe passed through.
///   broken     a field that is not finite at x: the probe passed through, CRITICAL.
/// A resting probe gives a resting proxy bit for bit: nothing is sampled while x and p keep their bits (after BUDGET it resumes).
/// Residual: the larger of the distance from the level and |x - p| - limit. Lengths in world units. Haptic thread.
///
/// Surface and level that a friction link states.
struct ContactSpec {
  field::ScalarFieldPtr surface;  ///< null: all of space
  std::optional<double> level;    ///< none: the surface only gives the normal
  double length = 4;              ///< domain length L, world units
};

/// Which of `surface` and `level` a link type needs: both or neither; any, but `level` only with `surface`; `surface`.
enum class SurfaceRequirement { optional_with_level, optional, required };
/// Reads `surface` and `level`; an Error names the offending key's line.
Result<ContactSpec> read_contact(const json::Node& link, SurfaceRequirement rule, const BuildContext& context);
schema::Key surface_key();        ///< optional key that names a scalar field
schema::Key surface_level_key();  ///< key for the level of that field

/// State of a friction contact between ticks. Zero bytes: not initialized.
struct ContactMemory {
  Vec3 probe, proxy;                    ///< probe and proxy of the last tick, world units
  LevelPoint surface_point;             ///< sample of the surface at the proxy
  double residual, limit;               ///< residual and limit of the last tick, world units
  LinkStatus status;                    ///< status of the last tick
  bool initialized, settled, touching;  ///< valid; converged for `probe`; the probe is on the level (always true in space)
  std::int32_t consecutive_failures;    ///< ticks in a row in which the surface was lost
};

/// Validates a state from a file: see Constraint::is_sane.
inline bool is_sane(const ContactMemory& m) noexcept {
  return is_sane(m.surface_point) && is_valid_enum(m.status, LinkStatus::bad_probe) &&
         are_valid_bools(m.initialized, m.settled, m.touching) && m.consecutive_failures >= 0 && m.consecutive_failures <= 1000;
}

/// One tick of one friction link; constructed in each tick. Haptic thread.
class Contact {
 public:
  Contact(const ContactSpec& spec, const Vec3& probe, ContactMemory& memory, LinkState& state, LinkScratch& scratch)
      : spec_(spec),
        probe_(probe),
        memory_(memory),
        state_(state),
        field_(spec.surface.get(), spec.level.value_or(0), scratch.cursors[0], state),
        probe_cursor_(scratch.cursors[2]) {}

  /// Prepares the tick. False: nothing is left to do in this tick, and the LinkState is complete.
  bool begin() noexcept;
  /// Returns the sample of the surface at the proxy: position and normal.
  const LevelPoint& surface_point() const noexcept { return memory_.surface_point; }
  const Vec3& proxy() const noexcept { return memory_.surface_point.p; }
  const Vec3& probe() const noexcept { return probe_; }
  Vec3 gap() const noexcept { return probe_ - memory_.surface_point.p; }
  /// Returns true where the proxy is not the one that the last tick left: cached values at its position are invalid.
  bool was_repositioned() const noexcept { return repositioned_; }
  bool has_normal() const noexcept { return spec_.surface != nullptr; }
  bool out_of_budget(int reserve) const noexcept { return state_.evaluations + reserve >= kMaxEvaluations || state_.exhausted(); }
  double length() const noexcept { return spec_.length; }

  /// Samples the surface near `target`, projected back to the level if `on_level`. Not valid: there is none.
  LevelPoint sample_surface(const Vec3& target, bool on_level) noexcept;
  void move_to(const LevelPoint& to) noexcept { memory_.surface_point = to; }
  /// Applies isotropic drag: |x - p| <= tau leaves p, bit for bit; else p slides to |x - p| = tau. False: the surface is lost.
  bool drag(double tau) noexcept;
  /// Slides the proxy to the given distance from the probe, on the level if there is one. False: the surface is lost.
  bool slide_to(double distance) noexcept;

  /// Completes the tick: writes proxy, residual, `limit` and status to the LinkState and to the memory.
  void end(double limit, LinkStatus status) noexcept;
  /// Completes a tick in which the surface was lost (`lost` above).
  void handle_lost_surface() noexcept;

 private:
  bool pass_through(LinkStatus status) noexcept;
  bool project_to_level(LevelPoint& a) noexcept;
  bool is_on_level(const LevelPoint& a) const noexcept;

  /// Level field that may be absent.
  class SurfaceField {
   public:
    SurfaceField(const field::ScalarField* field, double level, field::Cursor& cursor, LinkState& state) {
      if (field != nullptr) level_.emplace(*field, level, cursor, state);
    }
    LevelSetField* operator->() noexcept { return &*level_; }
    LevelSetField& operator*() noexcept { return *level_; }

   private:
    std::optional<LevelSetField> level_;
  };

  const ContactSpec& spec_;
  const Vec3 probe_;
  ContactMemory& memory_;
  LinkState& state_;
  SurfaceField field_;
  field::Cursor& probe_cursor_;  ///< cursor of its own: the probe's cell often differs from the proxy's
  LevelPoint probe_point_;
  LevelPoint previous_point_;  ///< memory_.surface_point at the start of the tick
  bool repositioned_ = false;
};

/// Returns the larger of 0 and v; 0 for a NaN: a threshold is never negative.
inline double safe_threshold(double v) noexcept { return v > 0 ? v : 0; }

/// Isotropic friction in space or on a level set: |x - p| <= tau leaves p, bit for bit, else p slides to |x - p| = tau. The derived
/// class gives tau at the proxy before it moves: drag, texture. The rules on a surface are those of Contact.
/// Haptic thread: no allocation, lock or throw.
class ContactDrag : public Constraint {
 public:
  explicit ContactDrag(ContactSpec contact) : contact_(std::move(contact)) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept final {
    memory_as<ContactMemory>(state) = ContactMemory{};
    state.proxy = probe;
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept final {
    Contact contact(contact_, probe, memory_as<ContactMemory>(state), state, scratch);
    if (!contact.begin()) return;
    const double tau = safe_threshold(threshold(contact.proxy(), state, scratch));
    if (!contact.drag(tau)) return contact.handle_lost_surface();
    contact.end(tau, LinkStatus::ok);
  }
  bool is_sane(const LinkState& state) const noexcept final { return haptics::is_sane(memory_as<ContactMemory>(state)); }
  double domain_length() const noexcept final { return contact_.length; }

 private:
  /// Returns tau at the proxy p, world units.
  virtual double threshold(const Vec3& p, LinkState& state, LinkScratch& scratch) const noexcept = 0;
  ContactSpec contact_;
};

}  // namespace catena::haptics
