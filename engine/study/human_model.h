/// A model of a subject, for trying a study without people: where the hand wants to be, tick by tick, from what the eye has seen. It is a
/// model: what it gives says something about itself, and stands in for nobody.
///
///   eye     what is seen is `delay` old. The cursor is seen beside its place by n = (lateral, lateral, depth + bias): in the picture plane
///           and, in 3D tasks, along the view; lateral and depth are Ornstein-Uhlenbeck processes of the stated deviation and correlation
///           time, the bias is drawn once a subject
///   tracing     x' = v T + g e:  T the path's tangent where the cursor will be after the delay, e from the cursor as it is seen to the
///               closest place of the path; within v / g of the end it goes to the end, at speed g times the distance
///   advection   x' = v h:  h the direction from the cursor to the indicator's tip as it is seen: its length downstream, plus n
///   hand    x' += v times a noise of the motor (one process an axis); v is drawn lognormally, once a subject and once a trial; after a
///           pause of 0.6 s it is reached within 0.2 s. To x comes a tremor: three sines an axis of frequencies and phases drawn once
///           a trial. The hand holds the device by a spring about x and gives way: |x - cursor| <= yield / stiffness
/// It does not learn, tire, look away or know which condition it is in. Haptic thread; the same bits on one type of machine.
#pragma once
#include <array>
#include <vector>

#include "engine/base/random.h"
#include "engine/study/stimulus.h"
#include "haptics/device/simulated_device.h"

namespace catena::study {

/// What is drawn once a subject.
struct HumanModelTraits {
  double speed = 1;       ///< times the model's
  double depth_bias = 0;  ///< mm
};
HumanModelTraits draw_subject_traits(const Study& study, int subject);

/// The mechanism of the simulated device in the model's hand.
haptics::SimulatedDeviceParameters make_hand_parameters(const HumanModelParameters& model, double period_s);

class HumanModel {
 public:
  /// All outlive it. `seed`: of this trial.
  HumanModel(const Study& study, const Task& task, const Stimulus& stimulus, const field::VectorField& field,
             const HumanModelTraits& subject, std::uint64_t seed, double period_s);

  /// Once a tick: where the cursor is now, world units -> where the hand wants to be at the next one.
  Vec3 next_target(const Vec3& cursor) noexcept;

 private:
  /// Keeps its deviation for a correlation time: x <- a x + sqrt(1 - a^2) N(0, 1).
  struct NoiseProcess {
    double decay = 0, innovation = 1, value = 0;
    void begin(double period_s, double correlation_s, Random& random);
    double next(Random& random) noexcept { return value = decay * value + innovation * random.normal(); }
  };
  Vec3 velocity_along_path(const Vec3& seen, double speed) noexcept;
  Vec3 velocity_along_flow(const Vec3& seen, const Vec3& error, double speed) noexcept;
  Vec3 tremor() const noexcept;

  const HumanModelParameters& model_;
  const Task& task_;
  const Stimulus& stimulus_;
  const field::VectorField& field_;
  field::Cursor cursor_;
  Random random_;
  double period_s_, speed_ = 0, bias_ = 0;  ///< world units
  Vec3 right_{1.0, 0.0, 0.0}, up_{0.0, 1.0, 0.0};
  std::array<NoiseProcess, 3> perception_noise_, motor_noise_;
  struct Sine {
    double rate = 0, phase = 0;
  };
  std::array<std::array<Sine, 3>, 3> tremor_;
  std::vector<Vec3> seen_cursors_;  ///< a ring of the last cursors, as long as the delay
  std::size_t closest_corner_ = 0;  ///< corner of the path
  std::uint64_t ticks_ = 0;
  Vec3 target_{0.0};
};

}  // namespace catena::study
