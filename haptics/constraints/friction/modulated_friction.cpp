// SPDX-License-Identifier: MIT
#include "haptics/constraints/friction/friction.h"

#include "engine/field/derived/magnitude.h"
#include "engine/geometry/flow/flow.h"
#include "engine/schema/values.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/equations.h"
#include "haptics/constraints/friction/friction_contact.h"

namespace catena::haptics {
namespace {

constexpr double kMinimum = 0.001, kMaximum = 0.01;  // fractions of L; defaults of the minimum and maximum threshold

struct ModulatedFrictionSpec {
  field::VectorFieldPtr field;
  bool line = false, as_published = false;
  double largest_speed = 0, largest_slope = 0;  ///< X of v and of grad s: the maximum magnitudes
  Parameter minimum, maximum;                   ///< tau_min, tau_max
  ContactSpec contact;
};

struct ModulatedFrictionMemory {
  ContactMemory contact;
  double angle;  ///< u at the proxy
};

class ModulatedFriction final : public Constraint {
 public:
  explicit ModulatedFriction(ModulatedFrictionSpec spec) : spec_(std::move(spec)) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_as<ModulatedFrictionMemory>(state) = ModulatedFrictionMemory{};
    state.proxy = probe;
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    ModulatedFrictionMemory& memory = memory_as<ModulatedFrictionMemory>(state);
    Contact contact(spec_.contact, probe, memory.contact, state, scratch);
    if (!contact.begin()) return;
    const Vec3 before = contact.proxy();
    if (contact.was_repositioned()) memory.angle = angle(contact.surface_point(), memory, state, scratch);
    const double minimum = spec_.minimum.at(before, scratch.parameter_cursor, state.evaluations);
    const double maximum = spec_.maximum.at(before, scratch.parameter_cursor, state.evaluations);
    const double u = memory.angle, hard = spec_.as_published ? 1 - u : std::fabs(u);
    const double tau = safe_threshold(equation::drag_threshold(hard, minimum, maximum));
    if (norm(contact.gap()) > tau) {
      if (!contact.slide_to(tau)) return contact.handle_lost_surface();
      memory.angle = angle(contact.surface_point(), memory, state, scratch);
    }
    contact.end(tau, LinkStatus::ok);
  }
  bool is_sane(const LinkState& state) const noexcept override {
    return haptics::is_sane(memory_as<ModulatedFrictionMemory>(state).contact);
  }
  double domain_length() const noexcept override { return spec_.contact.length; }

 private:
  /// Returns the angle u of Eqs. 8-9 at a point.
  double angle(const LevelPoint& at, ModulatedFrictionMemory& memory, LinkState& state, LinkScratch& scratch) const noexcept {
    if (state.evaluations + 2 >= kMaxEvaluations) return memory.angle;
    field::Cursor& cursor = scratch.cursors[1];
    ++state.evaluations;
    Vec3 v;
    bool inside;
    if (spec_.line) {
      const field::LineSample line = spec_.field->sample_line(at.p, cursor);
      inside = line.inside;
      if (flow::axis_direction(line, 0, Vec3(0.0), v) == flow::StopReason::incoherent) return 0;
      v *= line.speed;
    } else {
      const field::VectorSample sample = spec_.field->sample(at.p, cursor);
      inside = sample.inside;
      v = sample.value;
    }
    if (!inside || !at.finite) return 0;
    const SafeDirection field = safe_normalize(v, spec_.largest_speed);
    const SafeDirection surface = safe_normalize(at.n * at.slope, spec_.largest_slope);
    const double u = equation::cosine(field.d, field.factor, surface.d, surface.factor);
    return std::min(std::max(spec_.line ? std::fabs(u) : u, -1.0), 1.0);
  }

  ModulatedFrictionSpec spec_;
};

Result<std::shared_ptr<const Constraint>> build_modulated_friction(const json::Node& link, const BuildContext& context) {
  ModulatedFrictionSpec spec;
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "modulated_friction", context));
  spec.field = field;
  CATENA_CHECK(schema::read_value(schema::line_kind_key(), link, spec.line));
  CATENA_CHECK(schema::read_value(law_key(""), link, spec.as_published));
  CATENA_TRY(spec.contact, read_contact(link, SurfaceRequirement::required, context));
  const double length = spec.contact.length;
  CATENA_TRY(spec.minimum, get_parameter(link, "tau_min", kMinimum * length, json::NumberRange::non_negative, context));
  CATENA_TRY(spec.maximum, get_parameter(link, "tau_max", kMaximum * length, json::NumberRange::non_negative, context));
  spec.largest_speed = field::compute_max_magnitude(*field);
  spec.largest_slope = field::compute_max_gradient(*spec.contact.surface);
  return std::shared_ptr<const Constraint>(std::make_shared<ModulatedFriction>(std::move(spec)));
}

}  // namespace

ConstraintType modulated_friction_constraint() {
  return {"modulated_friction",
          "Friction whose threshold depends on the angle between a vector field and a surface.",
          "section 6.1, Eqs. 7-9",
          {schema::reference("field", schema::Role::vector_field, "Vector field whose angle to the surface sets the threshold.").required(),
           schema::line_kind_key(),
           schema::reference("surface", schema::Role::scalar_field, "Scalar field whose gradient is the normal of the surface.").required(),
           level_key("Level of `surface` on which the friction acts; without `level` the friction acts in space."),
           length_key("tau_min", "Threshold where the field is tangential to the surface.").with_default("0.001 L"),
           length_key("tau_max", "Threshold where the field is normal to the surface.").with_default("0.01 L"),
           law_key("Law of the threshold; `robust`: the threshold increases as the field approaches the normal; `as_published`: Eq. 7 of "
                   "the paper as printed.")},
          build_modulated_friction};
}

}  // namespace catena::haptics
