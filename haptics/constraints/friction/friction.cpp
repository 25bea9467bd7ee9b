// SPDX-License-Identifier: MIT
#include "haptics/constraints/friction/friction.h"

#include "engine/field/derived/magnitude.h"
#include "engine/geometry/flow/flow.h"
#include "engine/schema/values.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/friction/friction_contact.h"

namespace catena::haptics {
namespace {

constexpr double kAlong = 1e-8, kLongest = 0.1, kShortest = 5e-7;  // fractions of L: slack of e.d; maximum and minimum length of a step
constexpr double kTurn = 0.02, kBent = 0.3;                        // maximum turn of the tangent, and of the normal, over half a step
constexpr double kCorner = 0.5, kCornerError = 1e-6;               // maximum turn at a corner of the line, and its maximum cost in L
constexpr double kShort = 1e-3;                                    // fraction of L: a step so short that the surface may have a crease
constexpr double kStraight = 1e-14;                                // fraction of L: error so small that the step needs no midpoint
constexpr double kThreshold = 0.005;                               // fraction of L: default threshold
constexpr int kTrials = 32, kSlipRounds = 8;
constexpr int kForStep = 40;  // field samples that a step and a slide may need

struct FrictionSpec {
  field::VectorFieldPtr field;
  bool line = false;
  double largest = 0;  ///< X: the maximum magnitude
  Parameter threshold;
  ContactSpec contact;
};

/// Tangential field at a point.
struct Heading {
  SafeDirection t;
  LinkStatus status = LinkStatus::ok;
  SampleStatus reason = SampleStatus::ok;  ///< reason for the status that ends the line
  bool known() const { return t.factor > 0; }
};

struct FrictionMemory {
  ContactMemory contact;
  Heading heading;  ///< at the proxy
  Vec3 side;        ///< the last direction; the axis of a line field is turned to it
  double rate;      ///< -d(e.d)/ds of the last step: 1 - kappa N.e
  double bend;      ///< |dd/ds| of the last step, along the surface
  double arch;      ///< |dn/ds| of the last step
  int blocked;      ///< sign of d in which the line ends at the proxy; 0: in neither direction
};

/// Tick of a friction link.
class FrictionTick {
 public:
  FrictionTick(const FrictionSpec& spec, const Vec3& probe, LinkState& state, LinkScratch& scratch)
      : spec_(spec),
        state_(state),
        scratch_(scratch),
        memory_(memory_as<FrictionMemory>(state)),
        contact_(spec.contact, probe, memory_.contact, state, scratch),
        length_(spec.contact.length) {}

  void run() noexcept {
    if (!contact_.begin()) return;
    const double tau = safe_threshold(spec_.threshold.at(contact_.proxy(), scratch_.parameter_cursor, state_.evaluations));
    if (contact_.was_repositioned() || memory_.heading.status == LinkStatus::budget) arrive(heading_at(contact_.surface_point()));
    bool lost = false, complete = true;
    if (memory_.heading.known()) {
      lost = !slip(tau, complete);
    } else if (norm(contact_.gap()) > tau) {
      lost = !contact_.slide_to(tau);
      if (!lost) arrive(heading_at(contact_.surface_point()));
    }
    if (lost) return contact_.handle_lost_surface();
    if (ending_ == LinkStatus::ok) state_.reason = memory_.heading.reason;
    contact_.end(tau, !complete ? LinkStatus::budget : ending_ != LinkStatus::ok ? ending_ : memory_.heading.status);
  }

 private:
  /// Slips along the streamline and across it, alternately, until neither moves the proxy. Returns false if a slide fails.
  bool slip(double tau, bool& complete) noexcept {
    bool sliding = false;
    for (int round = 0; round < kSlipRounds; ++round) {
      const bool moved = follow(tau, complete);
      if (round > 0 && !moved) return true;
      const double gap = norm(contact_.gap());
      // while sliding, |e| = tau is kept from both sides
      sliding = sliding || gap > tau;
      if (!sliding || std::fabs(gap - tau) <= 1e-13 * length_) return true;
      complete = true;
      const Vec3 before = contact_.proxy();
      if (!contact_.slide_to(tau)) return false;
      arrive(heading_at(contact_.surface_point()));
      if (!memory_.heading.known() || ending_ != LinkStatus::ok) return true;
      // not converged along the line: resumes in the next tick
      complete = is_even(excess_along(tau)) || norm(contact_.proxy() - before) <= kAlong * length_;
      if (memory_.blocked != 0 || contact_.out_of_budget(kForStep)) return true;
    }
    return true;
  }
  /// Returns the amount by which e along the line exceeds the threshold's part along it.
  double excess_along(double tau) const noexcept {
    const double f = memory_.heading.t.factor;
    return std::fabs(dot(contact_.gap(), memory_.heading.t.d)) - tau * (1 - f) / f;
  }
  bool is_even(double excess) const noexcept { return !(excess > std::max(kAlong * length_, 4e-16 * norm(contact_.gap()))); }

  /// Follows the streamline until |e.d| <= b. Returns true if the proxy moved.
  bool follow(double tau, bool& complete) noexcept {
    bool moved = false;
    Reach reach;
    const int blocked = memory_.blocked;
    memory_.blocked = 0;
    while (memory_.heading.known()) {
      const Vec3 d = memory_.heading.t.d, e = contact_.gap(), p = contact_.proxy();
      const double g = dot(e, d), excess = excess_along(tau);
      complete = true;
      if (is_even(excess)) return moved;
      complete = false;
      if (trials_++ >= kTrials || contact_.out_of_budget(kForStep)) return moved;
      const double rate = memory_.rate > 0 ? std::min(std::max(memory_.rate, 0.1), 10.0) : 1;
      // near the end of the line found in the last tick, try short steps first
      if (!moved && reach.longest == 0) reach.longest = (blocked == (g > 0 ? 1 : -1) ? 4 * kShortest : kLongest) * length_;
      const double even = memory_.bend > 0 ? std::max(1.8 * kTurn / memory_.bend, 4 * kShortest * length_) : reach.longest;
      const double size = std::min(std::min(excess / rate, even), reach.longest), h = g > 0 ? size : -size;

      // direction at the middle of the step
      Vec3 middle = d;
      const double bent = memory_.bend + memory_.arch;
      const bool straight = memory_.bend > 0 && bent * h * h <= 8 * kStraight * length_;
      const bool learned = bent * bent * h * h * (size + norm(p - last_.from)) <= 4 * kStraight * length_;
      if (!straight && last_.known && learned) {
        middle = d + last_.turn * (0.5 * h);
      } else if (!straight) {
        const LevelPoint halfway = contact_.sample_surface(p + d * (0.5 * h), false);
        const Heading half = heading_at(halfway);
        const double turn = turn_to(halfway, half, size);
        if (turn > most_turn(kTurn, size)) {
          if (!refuse(reach, turn, size)) return stop_at(half, h, complete, moved);
          continue;
        }
        middle = half.t.d;
      }

      // end of the step
      const LevelPoint to = contact_.sample_surface(p + middle * h, true);
      const Heading there = heading_at(to);
      const double turn = to.valid ? turn_to(to, there, size) : 2;
      if (turn > most_turn(3 * kTurn, size)) {
        if (!refuse(reach, turn, size)) return stop_at(there, h, complete, moved);
        continue;
      }
      const Vec3 e2 = contact_.probe() - to.p;
      const double g2 = dot(e2, there.t.d), slope = (g - g2) / h, beyond = (g > 0 ? g - g2 : g2 - g) - excess;
      const bool nearer = std::fabs(g2) <= 0.5 * std::fabs(g) || norm(e2) < norm(e);
      memory_.bend = turn / size;
      memory_.arch = norm(to.n - contact_.surface_point().n) / size;
      if (!nearer || beyond > 0.25 * excess) {
        if (slope > rate) memory_.rate = slope;
        // the closest point may be a corner of the line
        if (++reach.overshoots > 1) reach.corner = size;
        if ((turn > 3 * kTurn && beyond > 0) || !refuse(reach, 0, size)) {
          memory_.blocked = h > 0 ? 1 : -1;
          complete = true;
          return moved;
        }
        continue;
      }
      memory_.rate = slope;
      last_ = {true, p, (there.t.d - d) * (1 / h)};
      contact_.move_to(to);
      arrive(there);
      accept(reach, size);
      moved = true;
    }
    return moved;
  }

  /// Maximum length of a step, world units, and the known distance of a corner of the line ahead of the proxy.
  struct Reach {
    double longest = 0;
    double corner = 0;   ///< distance within which a corner lies; 0: none known
    double turn = 0;     ///< turn of the last rejected step
    int overshoots = 0;  ///< number of steps past the closest point
  };

  /// Returns the chord length of the angle by which the line turns from the proxy to `to`, in the tangent plane; 2 if the line ends there.
  double turn_to(const LevelPoint& to, const Heading& there, double size) const noexcept {
    if (!there.known() || (size > kShort * length_ && norm(to.n - contact_.surface_point().n) > kBent)) return 2;
    const Vec3& here = memory_.heading.t.d;
    const Vec3 flat = here - to.n * dot(here, to.n);
    const double size_of_it = norm(flat);
    return size_of_it > 0 ? norm(there.t.d - flat * (1 / size_of_it)) : 2;
  }
  /// Returns the maximum turn of a step; a larger turn is allowed for a corner that costs little.
  double most_turn(double smooth, double size) const noexcept { return std::max(smooth, std::min(kCorner, kCornerError * length_ / size)); }
  /// Halves the step after a rejection; a turn that does not decrease with it is a corner. Returns false if the step is too short to go on.
  bool refuse(Reach& reach, double turn, double size) const noexcept {
    if (reach.corner > 0 || (reach.turn > 0 && turn > 0.9 * reach.turn)) reach.corner = size;
    reach.turn = turn;
    reach.longest = 0.5 * size;
    return reach.longest > kShortest * length_;
  }
  void accept(Reach& reach, double size) const noexcept {
    reach.turn = 0;
    reach.longest = std::min(4 * reach.longest, kLongest * length_);
    if (!(reach.corner > 0)) return;
    reach.corner -= size;
    if (reach.corner > kShortest * length_) reach.longest = std::min(reach.corner, std::max(0.5 * reach.corner, kCornerError * length_));
  }

  /// Ends the line at the proxy.
  bool stop_at(const Heading& why, double step, bool& complete, bool moved) noexcept {
    memory_.blocked = step > 0 ? 1 : -1;
    complete = true;
    ending_ = why.status != LinkStatus::ok ? why.status : LinkStatus::critical;
    state_.reason = why.status != LinkStatus::ok ? why.reason : why.known() ? SampleStatus::incoherent : SampleStatus::zero;
    return moved;
  }

  void arrive(const Heading& heading) noexcept {
    memory_.heading = heading;
    if (heading.known()) memory_.side = heading.t.d;
  }

  Heading heading_at(const LevelPoint& at) noexcept {
    if (contact_.out_of_budget(2)) return {{}, LinkStatus::budget};
    field::Cursor& cursor = scratch_.cursors[1];
    if (!at.valid && !(contact_.has_normal() && at.finite)) return boundary_at(at.p, cursor);
    ++state_.evaluations;
    if (spec_.line) {
      const field::LineSample line = spec_.field->sample_line(at.p, cursor);
      if (!line.inside) return boundary_at(at.p, cursor);
      Vec3 d;
      if (flow::axis_direction(line, 0, memory_.side, d) == flow::StopReason::incoherent)
        return {{}, LinkStatus::critical, SampleStatus::incoherent};
      return {safe_normalize(line.speed * d, spec_.largest, at.n), LinkStatus::ok};
    }
    const field::VectorSample v = spec_.field->sample(at.p, cursor);
    if (!is_finite(v.value)) return {{}, LinkStatus::critical, SampleStatus::not_finite};
    if (!v.inside) return boundary_at(at.p, cursor);
    return {safe_normalize(v.value, spec_.largest, at.n), LinkStatus::ok};
  }

  /// Returns the heading of a line that ends because the vector field or the surface ends.
  Heading boundary_at(const Vec3& place, field::Cursor& cursor) const noexcept {
    const SampleStatus reason = spec_.field->status_outside(place, cursor);
    return {
        {}, LinkStatus::boundary, reason != SampleStatus::ok ? reason : spec_.contact.surface->status_outside(place, scratch_.cursors[0])};
  }

  const FrictionSpec& spec_;
  LinkState& state_;
  LinkScratch& scratch_;
  FrictionMemory& memory_;
  Contact contact_;
  double length_;
  /// Last step of this tick: its start and dd/ds. A short step starts from these values.
  struct {
    bool known = false;
    Vec3 from{0.0}, turn{0.0};
  } last_;
  int trials_ = 0;                      ///< trial steps along the line in this tick
  LinkStatus ending_ = LinkStatus::ok;  ///< status of the end of the line; ok: it has not ended
};

class Friction final : public Constraint {
 public:
  explicit Friction(FrictionSpec spec) : spec_(std::move(spec)) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_as<FrictionMemory>(state) = FrictionMemory{};
    state.proxy = probe;
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    FrictionTick(spec_, probe, state, scratch).run();
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const FrictionMemory& memory = memory_as<FrictionMemory>(state);
    return haptics::is_sane(memory.contact) && is_valid_enum(memory.heading.status, LinkStatus::bad_probe);
  }
  double domain_length() const noexcept override { return spec_.contact.length; }

 private:
  FrictionSpec spec_;
};

Result<std::shared_ptr<const Constraint>> build_friction(const json::Node& link, const BuildContext& context) {
  FrictionSpec spec;
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "friction", context));
  spec.field = field;
  spec.largest = field::compute_max_magnitude(*field);
  CATENA_CHECK(schema::read_value(schema::line_kind_key(), link, spec.line));
  CATENA_TRY(spec.contact, read_contact(link, SurfaceRequirement::optional, context));
  if (!spec.contact.surface) spec.contact.length = field->domain_length();
  CATENA_TRY(spec.threshold, get_parameter(link, "threshold", kThreshold * spec.contact.length, json::NumberRange::non_negative, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Friction>(std::move(spec)));
}

}  // namespace

ConstraintType friction_constraint() {
  return {"friction",
          "Friction across a vector field; along the field the probe moves freely.",
          "section 6.1",
          {vector_field_key("field").required(), schema::line_kind_key(),
           length_key("threshold", "Distance between probe and proxy at which the proxy slips across the field.").with_default("0.005 L"),
           surface_key(), surface_level_key()},
          build_friction};
}

}  // namespace catena::haptics
