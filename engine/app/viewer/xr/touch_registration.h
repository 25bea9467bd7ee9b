/// Three places that a person touches with a haptic device's handle and with a headset's controller, in whichever order: what says where
/// the device stands in the room (registration.h).
///   touch     a button is pressed, and the place is the mean of the next kHold_s; what moves by more than kMaxMotion_m meanwhile, is lost,
///   or
///             is closer than kMinSeparation_m to a place that the same thing has touched before, does not count, which is said
///   the end   when both have three places: the motion of least squares between them. What is refused there (nearly one line), or leaves
///             more than kMaxResidual_m at the places (root mean square), is said, and all three are asked for again
/// The k-th place of one is the k-th of the other: it is the same place. Metres, seconds. The frame thread.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/xr/registration.h"

namespace catena::xr_interaction {

class TouchRegistration {
 public:
  static constexpr double kHold_s = 0.15, kMaxMotion_m = 0.005, kMinSeparation_m = 0.02, kMaxResidual_m = 0.01;

  /// One that touches: where it is, if that is known, and whether its button is down.
  struct TouchInput {
    std::optional<Vec3> position_m{};
    bool pressed = false;
  };
  struct Message {
    std::string text;  ///< one line
    bool is_error = false;
  };

  /// `device`: what it is called.
  explicit TouchRegistration(std::string device) : device_name_(std::move(device)) {}

  /// Each picture: `device` in its own metres, `controller` in the room's. What is to be said of it. A clock that goes back, or makes a
  /// leap, begins the touch that is under way again.
  std::vector<Message> step(double t_s, const TouchInput& device, const TouchInput& controller);
  /// What the person does next, in a sentence or two.
  std::string prompt() const;
  /// Once three places of both fit.
  const std::optional<Registration>& registration() const { return registration_; }

 private:
  struct Side {
    std::vector<Vec3> points{};
    bool was_pressed = true;  ///< what is down at first is no touch
    bool is_sampling = false;
    double start_s = 0, last_s = 0;
    Vec3 first{0.0}, sum{0.0};
    int count = 0;
  };
  /// What came of this picture's sample; nothing: no more than before.
  std::optional<Message> add_sample(Side& side, const std::string& whose, double t_s, const TouchInput& now);
  Message finish();

  std::string device_name_;
  Side device_{}, controller_{};
  std::optional<Registration> registration_;
};

}  // namespace catena::xr_interaction
