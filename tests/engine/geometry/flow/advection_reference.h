// SPDX-License-Identifier: MIT
/// The advection function f_V of Eqs. 3-4 of the paper, in the field's own time: one call moves p along V for a signed dt.
///   f_V(p, -dt) equals f_-V(p, dt) bit for bit (Eq. 4): every method only forms products h * v.
/// The program integrates in arc length (engine/geometry/flow/flow.h); this code tests its methods in another parameter.
/// The embedded pairs choose their sub-steps such that the estimated error of each is <= tolerance * L.
#pragma once
#include "engine/geometry/flow/runge_kutta.h"

namespace catena::flow {

struct Advected {
  Vec3 displacement{0.0};  ///< f_V(p, dt); the paper adds it to p
  int evaluations = 0;
  bool inside = true;    ///< false: a stage left the domain; the displacement stops before it
  bool complete = true;  ///< false: the evaluation cap was reached first
};

/// The velocity (not its direction): the rate of Eq. 3 in the field's own time.
struct AdvectedVelocity {
  const Flow& flow;
  field::Cursor& cursor;
  Vec3 reference{0.0};

  StopReason operator()(const Vec3& p, Vec3& v) const {
    if (flow.is_line_field) {
      const field::LineSample line = flow.field->sample_line(p, cursor);
      if (!line.inside) return StopReason::outside;
      const StopReason stop = axis_direction(line, flow.min_speed, reference, v);
      v *= stop == StopReason::still ? 0.0 : line.speed;
      return stop == StopReason::still ? StopReason::none : stop;
    }
    const field::VectorSample sample = flow.field->sample(p, cursor);
    if (!sample.inside || !is_finite(sample.value)) return StopReason::outside;
    v = norm(sample.value) <= flow.min_speed ? Vec3(0.0) : sample.value;
    return StopReason::none;
  }
};

/// f_V(p, dt) in the field's own time. `linear`, `euler` and other fixed methods take one step, pairs as many as needed.
inline Advected advect(const Flow& flow, const Vec3& p, double dt, Method method, double tolerance_length, field::Cursor& cursor,
                       int cap = 100000) {
  Advected out;
  const Tableau& tableau = tableau_of(method);
  const double length = flow.field->domain_length();

  // The first stage.
  AdvectedVelocity velocity{flow, cursor};
  if (flow.is_line_field) {
    const StopReason stop = seed_direction(flow, p, cursor, velocity.reference);
    out.evaluations = 1;
    if (stop == StopReason::outside) return {Vec3(0.0), 1, false, true};
    if (stop == StopReason::still) return out;
    if (stop == StopReason::incoherent) return {Vec3(0.0), 1, false, true};
  }
  Vec3 first(0.0);
  ++out.evaluations;
  if (!is_finite(p) || !std::isfinite(dt) || velocity(p, first) != StopReason::none) {
    out.inside = false;
    return out;
  }

  // Fixed methods: one step.
  if (!tableau.embedded) {
    if (out.evaluations + tableau.stages - 1 > cap) {
      out.complete = false;
      return out;
    }
    const Step step = runge_kutta_step(tableau, p, first, dt, false, velocity);
    out.evaluations += step.evaluations;
    if (step.stop == StopReason::none && is_finite(step.displacement))
      out.displacement = step.displacement;
    else
      out.inside = false;
    return out;
  }

  // Embedded pairs: as many sub-steps as the tolerance requires, none longer than a tenth of the domain.
  const double sign = dt < 0 ? -1.0 : 1.0;
  double left = std::fabs(dt), h = left;
  while (left > 0) {
    const double speed = norm(first);
    if (!(speed > 0)) return out;
    if (std::isfinite(tolerance_length)) h = std::min(h, 0.1 * length / speed);
    h = std::min(h, left);
    if (out.evaluations + tableau.stages > cap) {
      out.complete = false;
      return out;
    }
    const Step step = runge_kutta_step(tableau, p + out.displacement, first, sign * h, true, velocity);
    out.evaluations += step.evaluations;
    if (step.stop != StopReason::none) {
      if (h * speed <= 1e-12 * length) {
        out.inside = false;
        return out;
      }
      h *= 0.25;
      continue;
    }
    const double error = norm(step.error);
    if (!(error <= tolerance_length)) {
      const double shorter = h * step_factor(error, tolerance_length, 0.1, 0.8);
      if (!(shorter > 0) || h * speed <= 1e-15 * length) {
        out.complete = false;
        return out;
      }
      h = shorter;
      continue;
    }
    out.displacement += step.displacement;
    first = step.end_rate;
    if (flow.is_line_field) velocity.reference = direction(first);
    left = h < left ? left - h : 0;
    h *= step_factor(error, tolerance_length, 0.5, 4.0);
  }
  return out;
}

}  // namespace catena::flow
