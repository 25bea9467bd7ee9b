#include "haptics/constraints/friction.h"

#include <fmt/format.h>

#include "engine/field/magnitude.h"
#include "engine/flow/direction.h"
#include "haptics/constraints/read_parameter.h"
#include "haptics/constraints/safe_direction.h"
#include "haptics/constraints/surface_contact.h"

namespace catena::haptics {
namespace {

constexpr double kAlong = 1e-10, kLongest = 0.1, kShortest = 1e-12;  // of L: slack of e.d, steps
constexpr double kTurn = 0.02;                                       // of the tangent over half a step
constexpr double kStraight = 1e-14;                                  // of L: an error that needs no midpoint
constexpr double kThreshold = 0.005;                                 // of L: default
constexpr int kSteps = 24, kTrials = 40, kRounds = 8;
constexpr int kForStep = 40;  // fetches that a step and a slide may need

struct Spec {
  field::VectorFieldPtr field;
  bool line = false;
  double largest = 0;  ///< X
  Parameter threshold;
  ContactSpec contact;
};

/// The tangential field at a place.
struct Heading {
  SafeDirection t;
  Status status = Status::ok;
  bool known() const { return t.factor > 0; }
};

struct Memory {
  ContactMemory contact;
  Heading heading;  ///< at the proxy
  Vec3 side;        ///< the last direction: line fields are turned to it
  double rate;      ///< -d(e.d)/ds of the last step: 1 - kappa N.e
  double bend;      ///< |dd/ds| of the last step
};

/// One tick of one link.
class Tick {
 public:
  Tick(const Spec& spec, const Vec3& probe, LinkState& state, LinkScratch& scratch)
      : spec_(spec),
        state_(state),
        scratch_(scratch),
        memory_(memory_of<Memory>(state)),
        contact_(spec.contact, probe, memory_.contact, state, scratch),
        length_(spec.contact.length) {}

  void run() noexcept {
    if (!contact_.begin()) return;
    const double tau = safe_threshold(spec_.threshold.at(contact_.proxy(), scratch_.parameter, state_.evaluations));
    if (contact_.placed_anew()) arrive(heading_at(contact_.here()));
    bool lost = false, complete = true;
    if (memory_.heading.known()) {
      lost = !slip(tau, complete);
    } else if (norm(contact_.gap()) > tau) {
      lost = !contact_.slide_to(tau);
      if (!lost) arrive(heading_at(contact_.here()));
    }
    if (lost) return contact_.lose();
    contact_.end(tau, !complete ? Status::budget : ending_ != Status::ok ? ending_ : memory_.heading.status);
  }

 private:
  /// Along the streamline, across it, until neither moves.
  bool slip(double tau, bool& complete) noexcept {
    bool sliding = false;
    for (int round = 0; round < kRounds; ++round) {
      const bool moved = follow(tau, complete);
      if (round > 0 && !moved) return true;
      const double gap = norm(contact_.gap());
      // once it slides, |e| = tau is kept from both sides
      sliding = sliding || gap > tau;
      if (!sliding || std::fabs(gap - tau) <= 1e-13 * length_) return true;
      complete = true;
      if (!contact_.slide_to(tau)) return false;
      arrive(heading_at(contact_.here()));
      if (!memory_.heading.known() || contact_.spent(kForStep)) return true;
    }
    return true;
  }

  /// Follows the streamline until |e.d| <= b. True: it moved.
  bool follow(double tau, bool& complete) noexcept {
    bool moved = false;
    double longest = kLongest * length_;
    for (int trial = 0; trial < kTrials && memory_.heading.known(); ++trial) {
      const Vec3 d = memory_.heading.t.d, e = contact_.gap(), p = contact_.proxy();
      const double g = dot(e, d), f = memory_.heading.t.factor;
      const double excess = std::fabs(g) - tau * (1 - f) / f;
      complete = true;
      if (!(excess > std::max(kAlong * length_, 4e-16 * norm(e)))) return moved;
      complete = false;
      if (steps_ >= kSteps || contact_.spent(kForStep)) return moved;
      const double rate = memory_.rate != 0 ? std::min(std::max(memory_.rate, 0.1), 10.0) : 1;
      const double wanted = std::min(excess / rate, longest);
      const double h = g > 0 ? wanted : -wanted;

      // the direction half way
      Vec3 middle = d;
      if (memory_.bend * h * h > 8 * kStraight * length_ || !(memory_.bend > 0)) {
        const Heading half = heading_at(contact_.look(p + d * (0.5 * h), false));
        if (!half.known() || norm(half.t.d - d) > kTurn) {
          if (!shorten(longest, wanted)) return stop_at(half, complete, moved);
          continue;
        }
        middle = half.t.d;
      }

      // the step
      const LevelPoint to = contact_.look(p + middle * h, true);
      const Heading there = heading_at(to);
      if (!to.valid || !there.known()) {
        if (!shorten(longest, wanted)) return stop_at(there, complete, moved);
        continue;
      }
      const Vec3 e2 = contact_.probe() - to.p;
      const double g2 = dot(e2, there.t.d);
      memory_.bend = norm(there.t.d - d) / wanted;
      const double slope = (g - g2) / h, beyond = (g > 0 ? g - g2 : g2 - g) - excess;
      const bool nearer = std::fabs(g2) <= 0.5 * std::fabs(g) || norm(e2) < norm(e);
      if (!nearer || beyond > 0.25 * excess) {
        if (slope > rate) memory_.rate = slope;
        if (!shorten(longest, wanted)) return moved;
        continue;
      }
      memory_.rate = slope;
      contact_.move_to(to);
      arrive(there);
      longest = std::min(2 * longest, kLongest * length_);
      moved = true;
      ++steps_;
    }
    return moved;
  }

  /// Half the step; false: too short to go on.
  bool shorten(double& longest, double tried) const noexcept {
    longest = 0.5 * tried;
    return longest > kShortest * length_;
  }
  /// The line ends here: hold.
  bool stop_at(const Heading& why, bool& complete, bool moved) noexcept {
    complete = true;
    ending_ = why.status != Status::ok ? why.status : Status::critical;
    return moved;
  }

  void arrive(const Heading& heading) noexcept {
    memory_.heading = heading;
    if (heading.known()) memory_.side = heading.t.d;
  }

  Heading heading_at(const LevelPoint& at) noexcept {
    if (!at.valid && !(contact_.has_normal() && at.finite)) return {{}, Status::boundary};
    field::Cursor& cursor = scratch_.cursors[1];
    if (spec_.line && !(max_abs(memory_.side) > 0)) {
      ++state_.evaluations;
      flow::seed_direction({spec_.field.get(), true, 0}, at.p, cursor, memory_.side);
    }
    ++state_.evaluations;
    const field::VectorSample v = spec_.field->sample(at.p, cursor, spec_.line ? &memory_.side : nullptr);
    if (!is_finite(v.value)) return {{}, Status::critical};
    if (!v.inside) return {{}, Status::boundary};
    return {safe_direction(v.value, spec_.largest, at.n), Status::ok};
  }

  const Spec& spec_;
  LinkState& state_;
  LinkScratch& scratch_;
  Memory& memory_;
  Contact contact_;
  double length_;
  int steps_ = 0;               ///< along the line, in this tick
  Status ending_ = Status::ok;  ///< why the line ends, if it does
};

class Friction final : public Constraint {
 public:
  explicit Friction(Spec spec) : spec_(std::move(spec)) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_of<Memory>(state) = Memory{};
    state.proxy = probe;
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    Tick(spec_, probe, state, scratch).run();
  }
  double domain_length() const noexcept override { return spec_.contact.length; }

 private:
  Spec spec_;
};

Result<std::shared_ptr<const Constraint>> build(const json::Node& link, const BuildContext& context) {
  Spec spec;
  CATENA_TRY(const std::string name, json::require_string(link, "field"));
  CATENA_TRY(const field::AnyField any, context.field(*link.find("field"), name));
  if (!any.vector)
    return json::error_at(*link.find("field"), fmt::format("field \"{}\" is a scalar field; friction needs a vector field", name));
  spec.field = any.vector;
  spec.largest = field::largest_magnitude(*any.vector);
  CATENA_TRY(const int kind, json::get_choice(link, "kind", 0, {"vector", "line"}));
  spec.line = kind == 1;
  CATENA_TRY(spec.contact, read_contact(link, SurfaceKey::optional, context));
  if (!spec.contact.surface) spec.contact.length = any.vector->length();
  CATENA_TRY(spec.threshold, get_parameter(link, "threshold", kThreshold * spec.contact.length, json::Range::not_negative, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Friction>(std::move(spec)));
}

}  // namespace

ConstraintType friction_constraint() {
  return {"friction",
          "section 6.1",
          {{"field", "string", true, "a vector field of the scene: free along it, friction across"},
           {"kind", "string", false, "line: v and -v are the same, as for fibres", R"("enum": ["vector", "line"])"},
           {"threshold", "parameter", false, "the proxy slips across at this distance, world units; default 0.005 L", kNotNegativeSchema},
           kSurfaceKey,
           kLevelKey},
          build};
}

}  // namespace catena::haptics
