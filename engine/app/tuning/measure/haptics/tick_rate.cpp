// SPDX-License-Identifier: MIT
/// Tick rate of the servo: the force compared with that of a servo of 10 kHz, and the largest spring stiffness that stays stable.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/tuning/figures/stiffness_limits.h"
#include "engine/app/tuning/measure/format_number.h"
#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/measure/registry.h"
#include "haptics/device/registry.h"
#include "haptics/device/simulated_device.h"
#include "haptics/servo/device_limits.h"

namespace catena::app::tuning {
namespace {

constexpr double kRates_hz[] = {250, 500, 1000, 2000, 4000, 5000, 10000}, kFinest_hz = 10000;

std::vector<Vec3> forces_of(const haptics::HapticProgram& program, const std::vector<haptics::ProbeSample>& path) {
  std::vector<Vec3> forces;
  run_ticks(program, path, [&](const HapticState& out) { forces.push_back(out.force_n); });
  return forces;
}

/// Root mean square of the difference, each force held until the next tick; evaluated at the ticks of the faster servo.
double difference(const std::vector<Vec3>& coarse, double coarse_hz, const std::vector<Vec3>& fine, double fine_hz) {
  double sum = 0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const auto held =
        std::min(coarse.size() - 1, static_cast<std::size_t>(std::floor(static_cast<double>(k) * coarse_hz / fine_hz + 1e-9)));
    const Vec3 d = coarse[held] - fine[k];
    sum += dot(d, d);
  }
  return std::sqrt(sum / static_cast<double>(fine.size()));
}

void mark_current(Curve& curve, double rate_hz) {
  for (std::size_t i = 0; i < curve.points.size(); ++i)
    if (curve.points[i].work == rate_hz) curve.current = static_cast<int>(i);
}

std::string rate_key(double rate_hz) { return fmt::format("`\"device\": {{\"rate\": {:g}}}` or `--rate {:g}`", rate_hz, rate_hz); }

Result<Curve> force_curve(Workload& subject) {
  Curve curve;
  curve.id = "hand-rate-force";
  curve.title = "Tick rate of the servo: accuracy of the force";
  curve.description = fmt::format(
      "The probe moves {}, with the same motion at every rate; a force is held until the next tick, as by a device. The rates differ in "
      "the "
      "delay of the force.",
      subject.motion.description);
  curve.error_name = "difference from the force at 10 kHz, N (RMS)";
  curve.work_name = "ticks per second";
  curve.time_name = "us of processor time per second of motion";
  curve.extra_columns = {"maximum force, N"};
  std::vector<std::vector<haptics::ProbeSample>> paths;
  for (const double rate : kRates_hz) paths.push_back(subject.motion.samples(rate));
  const std::vector<Vec3> truth = forces_of(*subject.program, paths.back());
  const double finer = 2 * kFinest_hz;
  curve.reference_error = difference(truth, kFinest_hz, forces_of(*subject.program, subject.motion.samples(finer)), finer);
  curve.reference = fmt::format("a servo at 10 kHz; it differs from one at 20 kHz by {} N, so that smaller errors cannot be resolved",
                                format_number(curve.reference_error));
  curve.discretization_error_method = "The discretization error is the same at all rates.";
  std::vector<TimedRun> repeats;
  for (std::size_t i = 0; i < std::size(kRates_hz); ++i) {
    const std::vector<Vec3> forces = forces_of(*subject.program, paths[i]);
    Point p{fmt::format("{:g} Hz", kRates_hz[i]),
            rate_key(kRates_hz[i]),
            "",
            difference(forces, kRates_hz[i], truth, kFinest_hz),
            kRates_hz[i],
            {},
            kNotMeasured,
            {0}};
    for (const Vec3& f : forces) p.extra_values[0] = std::max(p.extra_values[0], norm(f));
    if (i + 1 == std::size(kRates_hz)) p.error = curve.reference_error;
    curve.points.push_back(std::move(p));
    const TimedRun ticks = make_tick_run(*subject.program, paths[i]);
    const double rate = kRates_hz[i];
    repeats.push_back([ticks, rate]() -> Result<double> {
      CATENA_TRY(const double ns, ticks());
      return 1e-3 * ns * rate;
    });
  }
  CATENA_CHECK(time_points(curve, repeats, subject.effort.haptics_s));
  mark_current(curve, subject.rate_hz);
  return curve;
}

Result<Curve> stability_curve(Workload& subject) {
  // the device that the scene names, otherwise the simulated one
  StiffnessSetting setting;
  const haptics::SimulatedDeviceParameters simulated = haptics::desktop_device_parameters();
  setting.damping = simulated.device_damping_ns_per_m;
  setting.mass_kg = simulated.mass_kg;
  std::string device = "a simulated device";
  if (subject.scene.device) {
    CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*subject.scene.device, subject.scene.path));
    const haptics::Mechanics m = haptics::resolve_mechanics(haptics::nominal_capabilities(settings.type), settings);
    if (m.damping_ns_per_m > 0 && m.mass_kg > 0) {
      setting.damping = m.damping_ns_per_m;
      setting.mass_kg = m.mass_kg;
      setting.delay_s = m.delay_s;
      device = "the scene's device, " + settings.type;
    }
  }
  const double spring = subject.program->coupling.stiffness_n_per_m;
  Curve curve;
  curve.id = "hand-rate-stability";
  curve.title = "Tick rate of the servo: stability of the coupling";
  curve.description = fmt::format(
      "The stiffness of the coupling is {:g} N/m. It is compared with the maximum stiffness at which {} of {:.3g} kg with a damping b of "
      "{:.3g} N s/m is passive, 2 b / (T + 2 delay), where T is the tick period and the delay of the device is {:g} ms. The last column is "
      "the maximum stiffness at which a simulated mass on a plane comes to rest. Above a ratio of 1 the device may vibrate.",
      spring, device, setting.mass_kg, setting.damping, 1e3 * setting.delay_s);
  curve.error_name = "stiffness of the coupling / maximum passive stiffness";
  curve.work_name = "ticks per second";
  curve.cost = CostKind::work;
  curve.extra_columns = {"2 b / (T + 2 delay), N/m", "simulated, N/m"};
  for (const double rate : kRates_hz) {
    setting.rate_hz = rate;
    const double passive = max_passive_stiffness(setting);
    curve.points.push_back({fmt::format("{:g} Hz", rate),
                            rate_key(rate),
                            "",
                            spring / passive,
                            rate,
                            {},
                            kNotMeasured,
                            {passive, max_stable_stiffness(setting)}});
  }
  curve.discretization_error = 1;
  curve.discretization_error_name = "the limit of stability";
  curve.discretization_error_method = "at or below it the coupling generates no energy";
  mark_current(curve, subject.rate_hz);
  return curve;
}

/// Chooses one rate for both: the higher of the rates that the force and the stability require.
void choose_one_rate(Curve& force, Curve& stability) {
  for (Curve* curve : {&force, &stability}) {
    choose_setting(*curve);
    if (curve->chosen < 0) return;
  }
  Curve &slower = force.chosen < stability.chosen ? force : stability, &faster = &slower == &force ? stability : force;
  if (slower.chosen == faster.chosen) return;
  const auto setting = [](const Curve& curve) { return curve.points[static_cast<std::size_t>(curve.chosen)].setting; };
  if (faster.is_flat)  // no requirement: the scene's rate stays
    slower.choice_reason = fmt::format(
        "{} would suffice for this quantity, but the scene's {} is kept: the force favours no rate, and the servo has one rate for both.",
        setting(slower), setting(faster));
  else if (slower.is_flat)
    slower.choice_reason =
        fmt::format("The force favours no rate; the stability needs {}, and the servo has one rate for both.", setting(faster));
  else
    slower.choice_reason = fmt::format("{} would suffice here; {} needs {}, and the servo has one rate.", setting(slower),
                                       &slower == &force ? "the stability" : "the force", setting(faster));
  slower.chosen = faster.chosen;
}

}  // namespace

Result<std::vector<Curve>> measure_tick_rate(Workload& subject) {
  CATENA_TRY(Curve force, force_curve(subject));
  CATENA_TRY(Curve stability, stability_curve(subject));
  choose_one_rate(force, stability);
  return std::vector<Curve>{std::move(force), std::move(stability)};
}

}  // namespace catena::app::tuning
