// SPDX-License-Identifier: MIT
/// A model of a subject, for testing a study without people: it computes the hand's target position at every tick from the visible
/// contents of the image. Its results describe the model only and replace no people.
///
///   perception  delayed by `delay_s`. The perceived cursor is displaced by n = (lateral, lateral, depth + bias): in the image plane
///               and, in 3D tasks, along the view direction; lateral and depth are Ornstein-Uhlenbeck processes with the given
///               standard deviation and correlation time, the bias is sampled per subject
///   tracing     x' = v T + g e:  T the path's tangent at the point that the cursor will have reached after the delay, e the vector from
///               the perceived cursor to the closest point of the path, g = `correction_per_s`; within v / g of the end it moves toward the
///               end, at speed g times the distance
///   advection   x' = v h:  h the direction from the cursor to the perceived tip of the indicator: the indicator's vector plus n
///   hand        x' += v times a motor noise (one process per axis); v is lognormally distributed, over subjects and over trials; after a
///               pause of 0.6 s it is reached within 0.2 s. A tremor is added to x: three sines per axis, whose frequencies and phases are
///               sampled per trial. The hand is coupled to the device by a spring at x and yields:
///               |x - cursor| <= yield_n / stiffness_n_per_mm
/// The model does not learn, tire or look away, and does not depend on the condition. Haptic thread; bit-identical on one type of machine.
#pragma once
#include <array>
#include <vector>

#include "engine/base/random.h"
#include "engine/study/stimulus.h"
#include "haptics/device/simulated_device.h"

namespace catena::study {

/// Properties that are sampled once per subject.
struct HumanModelTraits {
  double speed = 1;       ///< Factor on the model's speed
  double depth_bias = 0;  ///< Constant depth error, mm
};
/// Samples the traits of a subject; the same study and subject give the same traits.
HumanModelTraits draw_subject_traits(const Study& study, int subject);

/// Parameters of a simulated device that the model's hand holds. `period_s`: duration of a tick.
haptics::SimulatedDeviceParameters make_hand_parameters(const HumanModelParameters& model, double period_s);

/// The human model in one trial.
class HumanModel {
 public:
  /// `study`, `task`, `stimulus` and `field` must outlive this object. `seed`: of this trial; `period_s`: duration of a tick.
  HumanModel(const Study& study, const Task& task, const Stimulus& stimulus, const field::VectorField& field,
             const HumanModelTraits& subject, std::uint64_t seed, double period_s);

  /// Call once per tick. `cursor`: the probe in this tick, world units. Returns the hand's target position for the next tick, world units.
  Vec3 next_target(const Vec3& cursor) noexcept;

 private:
  /// A noise of unit variance and given correlation time: x <- a x + sqrt(1 - a^2) N(0, 1).
  struct NoiseProcess {
    double decay = 0, innovation = 1, value = 0;
    void begin(double period_s, double correlation_s, Random& random);
    double next(Random& random) noexcept { return value = decay * value + innovation * random.normal(); }
  };
  Vec3 velocity_along_path(const Vec3& perceived_probe, double speed) noexcept;
  Vec3 velocity_along_flow(const Vec3& perceived_probe, const Vec3& error, double speed) noexcept;
  Vec3 tremor() const noexcept;

  const HumanModelParameters& model_;
  const Task& task_;
  const Stimulus& stimulus_;
  const field::VectorField& field_;
  field::Cursor cursor_;
  Random random_;
  double period_s_, speed_ = 0, bias_ = 0;  ///< Duration of a tick, s; speed and depth error in world units
  Vec3 right_{1.0, 0.0, 0.0}, up_{0.0, 1.0, 0.0};
  std::array<NoiseProcess, 3> perception_noise_, motor_noise_;
  struct Sine {
    double rate = 0, phase = 0;
  };
  std::array<std::array<Sine, 3>, 3> tremor_;
  std::vector<Vec3> delayed_cursors_;  ///< Ring buffer of the cursors within the delay
  std::size_t closest_corner_ = 0;     ///< Index of the point of Stimulus::path closest to the perceived cursor
  std::uint64_t ticks_ = 0;
  Vec3 target_{0.0};
};

}  // namespace catena::study
