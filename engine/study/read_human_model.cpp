// SPDX-License-Identifier: MIT
#include "engine/study/study_tables.h"

namespace catena::study {

using schema::number;

const StudyTable<HumanModelParameters>& human_model_table() {
  using T = HumanModelParameters;
  static const auto table =
      StudyTable<T>()
          .bind(number("speed_mm_per_s", "mm/s", "Median speed of the hand.").with_limits({0.0, 1e4, true}), &T::speed_mm_per_s)
          .bind(number("speed_spread_subject", "", "Standard deviation over subjects of the speed's logarithm.").within(0, 2),
                &T::speed_spread_subject)
          .bind(number("speed_spread_trial", "", "Standard deviation over a subject's trials of the speed's logarithm.").within(0, 2),
                &T::speed_spread_trial)
          .bind(number("motor_noise", "", "Standard deviation of the noise on each axis of the hand's velocity, as a share of its speed.")
                    .within(0, 2),
                &T::motor_noise)
          .bind(number("motor_noise_s", "s", "Correlation time of the motor noise.").with_limits({0.0, 100, true}), &T::motor_noise_s)
          .bind(number("lateral_noise_mm", "mm", "Standard deviation of perceived positions on each axis of the image plane.")
                    .within(0, 1000),
                &T::lateral_noise_mm)
          .bind(number("depth_noise_mm", "mm", "Standard deviation of perceived positions along the view direction, in 3D tasks.")
                    .within(0, 1000),
                &T::depth_noise_mm)
          .bind(number("depth_bias_mm", "mm", "Standard deviation over subjects of a constant depth error, in 3D tasks.").within(0, 1000),
                &T::depth_bias_mm)
          .bind(number("seeing_noise_s", "s", "Correlation time of the lateral and the depth noise.").with_limits({0.0, 100, true}),
                &T::seeing_noise_s)
          .bind(number("tremor_mm", "mm", "Root mean square of the tremor on each axis.").within(0, 100), &T::tremor_mm)
          .bind(number("tremor_min_hz", "Hz", "Lowest frequency of the tremor.").with_limits({0.0, 500, true}), &T::tremor_lo_hz)
          .bind(number("tremor_max_hz", "Hz", "Highest frequency of the tremor.").with_limits({0.0, 500, true}), &T::tremor_hi_hz)
          .bind(number("delay_s", "s", "Delay between perception and movement.").within(0, 1), &T::delay_s)
          .bind(number("correction_per_s", "1/s", "Rate at which the hand corrects a perceived deviation from the path.").within(0, 100),
                &T::correction_per_s)
          .bind(
              number("stiffness_n_per_mm", "N/mm", "Stiffness of the hand's grip about its target position.").with_limits({0.0, 100, true}),
              &T::stiffness_n_per_mm)
          .bind(number("damping_ns_per_m", "N s/m", "Damping of the hand's grip about its target position.").within(0, 1e4),
                &T::damping_ns_per_m)
          .bind(number("yield_n", "N", "Force beyond which the hand yields.").with_limits({0.0, 1000, true}), &T::yield_n)
          .check([](const NoContext&, const json::Node& node, T& model) -> Outcome {
            if (model.tremor_lo_hz <= model.tremor_hi_hz) return Done{};
            return json::error_at(json::member_or_parent(node, "tremor_min_hz"),
                                  "\"tremor_min_hz\" is above \"tremor_max_hz\"; at most that was expected");
          });
  return table;
}

}  // namespace catena::study
