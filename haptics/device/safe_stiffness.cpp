#include "haptics/device/safe_stiffness.h"

#include <cmath>
#include <limits>

#include "engine/base/assert.h"
#include "engine/base/numbers.h"

namespace catena::haptics {

SafeStiffness safe_stiffness(const Mechanics& mechanics, double period_s) {
  CATENA_ASSERT(period_s > 0);
  SafeStiffness out;
  out.by_damping_n_per_m = 2 * mechanics.damping_ns_per_m / (period_s + 2 * mechanics.delay_s);
  out.by_friction_n_per_m =
      mechanics.encoder_step_m > 0 ? 2 * mechanics.friction_n / mechanics.encoder_step_m : std::numeric_limits<double>::infinity();
  return out;
}

double safe_rotational_stiffness(const Mechanics& mechanics, double period_s) {
  CATENA_ASSERT(period_s > 0 && mechanics.delay_s >= 0);
  return 2 * mechanics.rotational_damping_nms_per_rad / (period_s + 2 * mechanics.delay_s);
}

std::string safe_stiffness_text(const Mechanics& mechanics, double period_s) {
  const SafeStiffness safe = safe_stiffness(mechanics, period_s);
  const auto whole = [](double value) { return to_text(std::round(value)); };
  std::string text =
      whole(safe.n_per_m()) + " N/m: " + (mechanics.delay_s > 0 ? "2 b / (T + 2 delay) = " : "2 b / T = ") + whole(safe.by_damping_n_per_m);
  if (mechanics.encoder_step_m > 0) text += ", 2 f_c / step = " + whole(safe.by_friction_n_per_m);
  if (!(safe.n_per_m() > 0))
    text += std::string("; a device without ") + (mechanics.damping_ns_per_m > 0 ? "friction" : "damping") +
            " shows no spring safely: state \"damping\", \"friction\" or \"stiffness_cap\" of \"device\"";
  return text;
}

}  // namespace catena::haptics
