// SPDX-License-Identifier: MIT
#include "haptics/constraints/friction/friction_contact.h"

#include "engine/field/grid/grid.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/equations.h"
#include "haptics/constraints/isosurface/surface_search.h"

namespace catena::haptics {
namespace {

// fractions of L
constexpr double kTouch = 1e-6, kOnLevel = 1e-12, kAccepted = 1e-9, kGapSlack = 1e-13, kNearLevel = 0.02;
constexpr int kSlideRounds = 12, kPatient = 5, kNewton = 8;
constexpr int kPatience = 8, kFade = 20;
constexpr int kForLevel = 12;      // field samples reserved for the return to the level
constexpr double kLevelled = 0.1;  // minimum e.t / |e| for which sliding shortens the gap

bool usable(const LevelPoint& a) { return a.valid && !a.plateau; }

/// LevelSetField::at with a single division, written in place (a copy would stall on its stores); equal up to rounding.
void fetch(LevelSetField& field, const Vec3& world, LevelPoint& out) noexcept {
  const Vec3 p = field.clamped(world);
  out = LevelPoint{};
  out.p = p;
  if (field.out_of_budget()) return;
  field.count_fetch();
  const field::CellField* grid = field.grid();
  const field::ScalarSample sample = grid ? grid->sample(out.p, field.cursor()) : field.field().sample(out.p, field.cursor());
  out.finite = std::isfinite(sample.value) && is_finite(sample.gradient);
  out.valid = out.finite && (sample.inside || grid == nullptr);
  if (!out.finite) return;
  out.slope = norm(sample.gradient);
  out.sigma = sample.value - field.level();
  if (out.slope > 1e-280 && out.slope < 1e280) {
    const double by = 1 / out.slope;
    out.n = sample.gradient * by;
    out.distance = out.sigma * by;
    out.round_off = 4e-16 * (std::fabs(sample.value) + std::fabs(field.level())) * by + 4e-16 * max_abs(out.p);
  } else {
    out.n = direction(sample.gradient);
    out.distance = out.sigma / out.slope;
    out.round_off = 4e-16 * (std::fabs(sample.value) + std::fabs(field.level())) / out.slope + 4e-16 * max_abs(out.p);
  }
  out.plateau = !(out.slope > 0) || !std::isfinite(out.distance) || !std::isfinite(out.round_off);
  if (out.plateau) out.distance = out.round_off = 0, out.n = Vec3(0.0);
}

}  // namespace

schema::Key surface_key() {
  return schema::reference("surface", schema::Role::scalar_field,
                           "Scalar field of a surface; the friction acts tangentially to the surface.");
}

schema::Key surface_level_key() { return level_key("Level of `surface` on which the friction acts; given only with `surface`."); }

Result<ContactSpec> read_contact(const json::Node& link, SurfaceRequirement rule, const BuildContext& context) {
  ContactSpec spec;
  const json::Node *surface = link.find("surface"), *level = link.find("level");
  if (surface == nullptr && rule != SurfaceRequirement::required) {
    if (level != nullptr) return json::error_at(*level, "\"level\" has no \"surface\"; a scalar field was expected beside it");
    return spec;
  }
  CATENA_TRY(spec.surface, require_scalar_field(link, "surface", "\"surface\"", context));
  spec.length = spec.surface->domain_length();
  if (level == nullptr && rule == SurfaceRequirement::optional_with_level)
    return json::error_at(*surface, "\"surface\" has no \"level\"; the field's value on the surface was expected");
  if (level != nullptr) {
    CATENA_TRY(spec.level, require_level(link, "surface", *spec.surface));
  }
  return spec;
}

bool Contact::is_on_level(const LevelPoint& a) const noexcept {
  return std::fabs(a.distance) <= std::max(kOnLevel * length(), a.round_off);
}

bool Contact::pass_through(LinkStatus status) noexcept {
  memory_ = ContactMemory{};
  memory_.probe = memory_.proxy = state_.proxy = probe_;
  memory_.status = state_.status = status;
  memory_.initialized = true;
  memory_.settled = true;
  state_.residual = state_.limit = 0;
  return false;
}

void Contact::handle_lost_surface() noexcept {
  const int failures = memory_.consecutive_failures + 1;
  if (repositioned_ || !memory_.initialized || failures > kPatience + kFade) return static_cast<void>(pass_through(LinkStatus::no_surface));
  if (failures > kPatience) state_.weight = std::min(state_.weight, 1 - static_cast<double>(failures - kPatience) / kFade);
  memory_.surface_point = previous_point_;
  state_.proxy = previous_point_.p;
  state_.residual = std::fabs(previous_point_.distance);
  memory_.probe = probe_;
  memory_.proxy = state_.proxy;
  memory_.residual = state_.residual;
  memory_.status = state_.status = LinkStatus::budget;
  state_.limit = memory_.limit;
  memory_.settled = false;
  memory_.consecutive_failures = failures;
}

bool Contact::begin() noexcept {
  const bool untouched = memory_.initialized && bitwise_equal(memory_.proxy, state_.proxy);
  if (untouched && memory_.settled && !state_.data_changed && bitwise_equal(memory_.probe, probe_)) {
    state_.residual = memory_.residual;
    state_.limit = memory_.limit;
    state_.status = memory_.status;
    return false;
  }
  if (!untouched || state_.data_changed) memory_ = ContactMemory{};
  previous_point_ = memory_.surface_point;

  if (!spec_.level) {
    if (!memory_.touching) {
      memory_.surface_point = sample_surface(state_.proxy, false);
      memory_.touching = repositioned_ = true;
    }
    return true;
  }

  // tests whether the incoming probe is on the level
  LevelSetField near_probe(*spec_.surface, *spec_.level, probe_cursor_, state_);
  fetch(near_probe, probe_, probe_point_);
  if (!probe_point_.finite) {
    state_.reason = SampleStatus::not_finite;
    return pass_through(LinkStatus::critical);
  }
  const double off = norm(probe_point_.p - probe_) + std::fabs(probe_point_.distance);
  if (probe_point_.plateau || !(off <= std::max(kTouch * length(), probe_point_.round_off))) return pass_through(LinkStatus::free);
  if (memory_.touching) return true;
  LevelPoint start = probe_point_;
  if (std::fabs(start.distance) > kAccepted * length() && !project_to_level(start)) return pass_through(LinkStatus::no_surface);
  memory_.surface_point = start;
  memory_.touching = repositioned_ = true;
  return true;
}

LevelPoint Contact::sample_surface(const Vec3& target, bool on_level) noexcept {
  LevelPoint a;
  if (!spec_.surface) {
    a.p = target;
    a.valid = a.finite = is_finite(target);
    return a;
  }
  fetch(*field_, target, a);
  if (!spec_.level) {
    a.p = target;
    a.distance = 0;
    a.valid = is_finite(target);
  } else if (on_level && !(usable(a) && project_to_level(a))) {
    a.valid = false;
  } else {
    a.valid = usable(a);
  }
  return a;
}

bool Contact::project_to_level(LevelPoint& a) noexcept {
  for (int i = 0; i < kNewton && !this->is_on_level(a); ++i) {
    LevelPoint b;
    fetch(*field_, equation::newton_step_to_level(a.p, a.n, a.distance), b);
    if (!usable(b) || std::fabs(b.distance) > 0.5 * std::fabs(a.distance)) break;
    a = b;
  }
  if (std::fabs(a.distance) <= std::max(kAccepted * length(), a.round_off)) return true;
  const LevelSetHit reached = search_along_gradient(*field_, a, a.n, kNearLevel * length(), kForLevel);
  if (!reached.found || !usable(reached.point)) return false;
  a = reached.point;
  return true;
}

bool Contact::drag(double tau) noexcept { return !(norm(gap()) > tau) || slide_to(tau); }

bool Contact::slide_to(double distance) noexcept {
  const Vec3 e0 = gap();
  if (!spec_.level) {
    memory_.surface_point = sample_surface(is_finite(e0) ? probe_ - direction(e0) * distance : probe_, false);
    return memory_.surface_point.valid;
  }
  const double slack = std::max(kGapSlack * length(), 1e-15 * max_abs(probe_));
  if (distance <= slack) {
    memory_.surface_point = probe_point_;
    return std::fabs(probe_point_.distance) <= kAccepted * length() || project_to_level(memory_.surface_point);
  }

  // solve both conditions together, from the proxy; from the chord if the proxy is far
  const bool near = usable(memory_.surface_point) && norm(e0) - distance <= 0.5 * distance;
  LevelPoint a = memory_.surface_point;
  if (!near) fetch(*field_, probe_ - direction(e0) * distance, a);
  for (int i = 0; i < kSlideRounds && usable(a) && !out_of_budget(kForLevel); ++i) {
    const Vec3 e = probe_ - a.p;
    const double gap = norm(e), across = dot(e, a.n);
    if (this->is_on_level(a) && std::fabs(gap - distance) <= slack) {
      memory_.surface_point = a;
      return true;
    }
    const Vec3 tangential = e - a.n * across;
    const double along = norm(tangential);
    // solves |e + l n - b t| = r for b
    double b = 0;
    if (along > kLevelled * gap) {
      const double level_gap = norm(e + a.n * a.distance), c = (level_gap - distance) * (level_gap + distance);
      const double rest = along * along - c;
      b = rest > 0 ? c / (along + std::sqrt(rest)) : along;
      b = std::min(std::max(b, -0.5 * gap), gap);
    }
    if (i >= kPatient) b *= 0.5;
    fetch(*field_, a.p + tangential * (along > 0 ? b / along : 0.0) - a.n * a.distance, a);
  }

  // a crease, or a sheet that bends away: accepts any point on the level that is no farther from the probe than the previous one
  if (!usable(a) || !project_to_level(a) || norm(probe_ - a.p) > norm(e0)) return false;
  memory_.surface_point = a;
  return true;
}

void Contact::end(double limit, LinkStatus status) noexcept {
  const double excess = norm(gap()) - limit;
  state_.proxy = memory_.surface_point.p;
  state_.residual = std::max(std::fabs(memory_.surface_point.distance), excess > 0 ? excess : 0.0);
  state_.limit = limit;
  state_.status = status;
  memory_.probe = probe_;
  memory_.proxy = state_.proxy;
  memory_.residual = state_.residual;
  memory_.limit = limit;
  memory_.status = status;
  memory_.initialized = true;
  memory_.settled = status != LinkStatus::budget;
  memory_.consecutive_failures = 0;
}

}  // namespace catena::haptics
