/// The ground that friction acts on: all of space, or one level set s = level of a scalar field, on which probe and proxy lie.
/// Shared by drag, friction, modulated_friction and texture.
///   touching   on a level, friction acts only while the incoming probe x is on it: |s - level| / |grad s| <= 1e-6 L, one fetch.
///              Off the level (free side, released, no isosurface link before) the proxy is the probe, bit for bit: FREE.
///              Where x comes on to the level the proxy starts from x, at rest.
///   sliding    to |x - p| = r within 1e-13 L, on the level within 1e-12 L or its round-off; in space in closed form. Newton on
///              both at once, one fetch an iteration:  p += b t - l n,  l = (s - level) / |grad s|,  t = e - (e.n) n over its norm,
///              |e + l n - b t| = r,  e = x - p
///   lost       where that fails (noise, a jump to another sheet, the mask or broken voxels between) the proxy stays where it is for
///              kPatience + kFade ticks, BUDGET, while the next tick tries again; its weight fades in the last kFade (where the
///              coupling has a ramp). Then it starts from x again: NO_SURFACE in that tick, the probe passed through.
///   broken     a field that is not finite at x: the probe passed through, CRITICAL.
/// A resting probe gives a resting proxy bit for bit: nothing is asked while x and p keep their bits (after BUDGET it goes on).
/// Residual: the larger of the distance from the level and |x - p| - limit. Lengths in world units. Haptic thread.
#pragma once
#include <optional>

#include "haptics/constraints/isosurface/level.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

struct ContactSpec {
  field::ScalarFieldPtr surface;  ///< none: all of space
  std::optional<double> level;    ///< none: the surface only says which way is normal
  double length = 4;              ///< L
};

enum class SurfaceKey { optional_with_level, optional, required };
/// Reads `surface` and `level`.
Result<ContactSpec> read_contact(const json::Node& link, SurfaceKey rule, const BuildContext& context);
schema::Key surface_key();        ///< optional
schema::Key surface_level_key();  ///< beside it

/// Zero bytes: nothing is known.
struct ContactMemory {
  Vec3 probe, proxy;  ///< of the last tick
  LevelPoint here;    ///< the surface at the proxy
  double residual, limit;
  Status status;
  bool fresh, settled, touching;
  std::int32_t failures;  ///< ticks in a row
};

/// Of a state from a file: see Constraint::is_sane.
inline bool is_sane(const ContactMemory& m) noexcept {
  return is_sane(m.here) && is_one_of(m.status, Status::bad_probe) && are_bools(m.fresh, m.settled, m.touching) && m.failures >= 0 &&
         m.failures <= 1000;
}

/// One tick of one link.
class Contact {
 public:
  Contact(const ContactSpec& spec, const Vec3& probe, ContactMemory& memory, LinkState& state, LinkScratch& scratch)
      : spec_(spec),
        probe_(probe),
        memory_(memory),
        state_(state),
        field_(spec.surface.get(), spec.level.value_or(0), scratch.cursors[0], state),
        probe_cursor_(scratch.cursors[2]) {}

  /// False: nothing is left to do in this tick, the state is complete.
  bool begin() noexcept;
  /// Where the proxy is, and the surface's normal there.
  const LevelPoint& here() const noexcept { return memory_.here; }
  const Vec3& proxy() const noexcept { return memory_.here.p; }
  const Vec3& probe() const noexcept { return probe_; }
  Vec3 gap() const noexcept { return probe_ - memory_.here.p; }
  /// True where the proxy is not what the last tick left: what is known of its place is void.
  bool placed_anew() const noexcept { return placed_; }
  bool has_normal() const noexcept { return spec_.surface != nullptr; }
  bool spent(int reserve) const noexcept { return state_.evaluations + reserve >= kEvaluationCap || state_.exhausted(); }
  double length() const noexcept { return spec_.length; }

  /// The surface near `wanted`, brought back to the level if asked to. Not valid: there is none.
  LevelPoint look(const Vec3& wanted, bool on_level) noexcept;
  void move_to(const LevelPoint& to) noexcept { memory_.here = to; }
  /// Isotropic drag: |x - p| <= tau leaves p, bit for bit; else it slides to |x - p| = tau. False: lost.
  bool drag(double tau) noexcept;
  bool slide_to(double distance) noexcept;

  void end(double limit, Status status) noexcept;
  void lose() noexcept;

 private:
  bool pass(Status status) noexcept;
  bool relevel(LevelPoint& a) noexcept;
  bool on_level(const LevelPoint& a) const noexcept;

  /// A level field that may be absent.
  class Ground {
   public:
    Ground(const field::ScalarField* field, double level, field::Cursor& cursor, LinkState& state) {
      if (field != nullptr) level_.emplace(*field, level, cursor, state);
    }
    LevelField* operator->() noexcept { return &*level_; }
    LevelField& operator*() noexcept { return *level_; }

   private:
    std::optional<LevelField> level_;
  };

  const ContactSpec& spec_;
  const Vec3 probe_;
  ContactMemory& memory_;
  LinkState& state_;
  Ground field_;
  field::Cursor& probe_cursor_;  ///< the probe's cell is often another one than the proxy's
  LevelPoint at_probe_;
  LevelPoint before_;  ///< memory_.here as the tick found it
  bool placed_ = false;
};

/// The larger of 0 and v; 0 for a NaN: a threshold is never negative.
inline double safe_threshold(double v) noexcept { return v > 0 ? v : 0; }

}  // namespace catena::haptics
