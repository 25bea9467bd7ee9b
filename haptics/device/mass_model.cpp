// SPDX-License-Identifier: MIT
#include "haptics/device/mass_model.h"

#include <cmath>
#include <limits>

#include "engine/base/numbers.h"
#include "engine/base/result.h"

namespace catena::haptics {

namespace {

// Returns e^A from its series, with A scaled below 1/4 and the result squared back.
Mat3 exponential(Mat3 a) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, max_abs(a[c]));
  int halved = 0;
  for (; largest > 0.25; largest *= 0.5) ++halved;
  for (int i = 0; i < halved; ++i) a *= 0.5;
  Mat3 sum(1.0), term(1.0);
  for (int k = 1; k <= 20; ++k) {
    term = term * a / static_cast<double>(k);
    sum += term;
  }
  for (int i = 0; i < halved; ++i) sum = sum * sum;
  return sum;
}

}  // namespace

LinearStep make_linear_step(double mass_kg, double damping_ns_per_m, double stiffness_n_per_m, double step_s) {
  CATENA_ASSERT(mass_kg > 0 && damping_ns_per_m >= 0 && stiffness_n_per_m >= 0 && step_s >= 0);
  // (x, v T, u T^2/m)' over one step, so that the entries have similar magnitudes
  const double t = step_s;
  Mat3 a(0.0);
  a[1][0] = 1;
  a[0][1] = -stiffness_n_per_m * t * t / mass_kg;
  a[1][1] = -damping_ns_per_m * t / mass_kg;
  a[2][1] = 1;
  const Mat3 e = exponential(a);
  return {t, e[1][0] * t, e[2][0] * t * t / mass_kg, e[1][1], e[2][1] * t / mass_kg};
}

void advance_mass(const LinearStep& step, const Vec3& force_n, double friction_n, MassState& state) noexcept {
  Vec3 u = force_n;
  if (friction_n > 0 && step.v_from_u > 0) {
    // the friction force that would stop the mass, or the maximum friction
    const Vec3 stopping = state.velocity_m_per_s * (step.v_from_v / step.v_from_u) + force_n;
    const double needed = norm(stopping);
    if (needed <= friction_n) {
      state.position_m += state.velocity_m_per_s * step.x_from_v + (u - stopping) * step.x_from_u;
      state.velocity_m_per_s = Vec3(0.0);
      return;
    }
    u -= stopping * (friction_n / needed);
  }
  state.position_m += state.velocity_m_per_s * step.x_from_v + u * step.x_from_u;
  state.velocity_m_per_s = state.velocity_m_per_s * step.v_from_v + u * step.v_from_u;
}

SafeStiffness safe_stiffness(const Mechanics& mechanics, double period_s) {
  CATENA_ASSERT(period_s > 0);
  SafeStiffness out;
  out.by_damping_n_per_m = 2 * mechanics.damping_ns_per_m / (period_s + 2 * mechanics.delay_s);
  out.by_friction_n_per_m =
      mechanics.encoder_step_m > 0 ? mechanics.friction_n / mechanics.encoder_step_m : std::numeric_limits<double>::infinity();
  return out;
}

double safe_rotational_stiffness(const Mechanics& mechanics, double period_s) {
  CATENA_ASSERT(period_s > 0 && mechanics.delay_s >= 0);
  return 2 * mechanics.rotational_damping_nms_per_rad / (period_s + 2 * mechanics.delay_s);
}

std::string describe_safe_stiffness(const Mechanics& mechanics, double period_s) {
  const SafeStiffness safe = safe_stiffness(mechanics, period_s);
  const auto whole = [](double value) { return to_text(std::round(value)); };
  std::string text = whole(safe.min_n_per_m()) + " N/m: " + (mechanics.delay_s > 0 ? "2 b / (T + 2 delay) = " : "2 b / T = ") +
                     whole(safe.by_damping_n_per_m);
  if (mechanics.encoder_step_m > 0) text += ", f_c / step = " + whole(safe.by_friction_n_per_m);
  if (!(safe.min_n_per_m() > 0))
    text += std::string("; a device without ") + (mechanics.damping_ns_per_m > 0 ? "friction" : "damping") +
            " cannot render a spring safely: set \"damping\", \"friction\" or \"stiffness_cap\" of \"device\"";
  return text;
}

}  // namespace catena::haptics
