// SPDX-License-Identifier: MIT
/// Collects three points that the user touches with the handle of a haptic device and with an XR controller, in either order, and computes
/// from them where the device stands in tracking space (registration.h).
///   touch   a button is pressed, and the point is the mean over the next kHold_s; a touch is rejected with a message if the position moves
///           by more than kMaxMotion_m meanwhile, is lost, or is closer than kMinSeparation_m to an earlier point of the same side
///   result  when both sides have three points: the least-squares motion between them; if that is an Error (nearly collinear) or leaves
///           more than kMaxResidual_m at the points (root mean square), a message reports it, and all three points are requested again
/// The k-th points of both sides correspond: they are the same physical point. Meters, seconds. Frame thread.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/xr/registration.h"

namespace catena::xr_interaction {

/// State of one registration.
class TouchRegistration {
 public:
  static constexpr double kHold_s = 0.15, kMaxMotion_m = 0.005, kMinSeparation_m = 0.02, kMaxResidual_m = 0.01;

  /// Input of one side: its position, if known, and whether its button is down.
  struct TouchInput {
    std::optional<Vec3> position_m{};
    bool pressed = false;
  };
  /// A message for the user.
  struct Message {
    std::string text;  ///< One line.
    bool is_error = false;
  };

  /// `device`: name of the device in messages.
  explicit TouchRegistration(std::string device) : device_name_(std::move(device)) {}

  /// Call once per frame with `device` in device meters and `controller` in tracking space; returns the messages for the user. If the time
  /// `t_s` goes backwards or jumps by more than 1 s, the touch in progress restarts.
  std::vector<Message> step(double t_s, const TouchInput& device, const TouchInput& controller);
  /// Returns the next instruction for the user in a sentence or two; empty when finished.
  std::string prompt() const;
  /// Returns the result once three points of both sides fit.
  const std::optional<Registration>& registration() const { return registration_; }

 private:
  /// Progress of one side.
  struct Side {
    std::vector<Vec3> points{};
    bool was_pressed = true;  ///< Initially true, so that a button already down at the start does not count as a touch.
    bool is_sampling = false;
    double start_s = 0, last_s = 0;
    Vec3 first{0.0}, sum{0.0};
    int count = 0;
  };
  /// Processes one sample of a side; returns a message if a point was accepted or rejected.
  std::optional<Message> add_sample(Side& side, const std::string& target_name, double t_s, const TouchInput& now);
  /// Computes the registration from three points of both sides; on failure clears the points.
  Message finish();

  std::string device_name_;
  Side device_{}, controller_{};
  std::optional<Registration> registration_;
};

}  // namespace catena::xr_interaction
