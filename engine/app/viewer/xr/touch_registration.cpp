// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/touch_registration.h"

#include <fmt/format.h>

namespace catena::xr_interaction {
namespace {

constexpr std::size_t kPointCount = 3;
constexpr double kLeap_s = 1;  // maximum seconds between two samples of one touch

std::array<Vec3, kPointCount> three(const std::vector<Vec3>& places) { return {places[0], places[1], places[2]}; }

}  // namespace

std::optional<TouchRegistration::Message> TouchRegistration::add_sample(Side& side, const std::string& target_name, double t_s,
                                                                        const TouchInput& now) {
  const bool pressed_now = now.pressed && !side.was_pressed;
  side.was_pressed = now.pressed;
  if (side.points.size() == kPointCount) return std::nullopt;
  const bool known = now.position_m && is_finite(*now.position_m);
  const std::size_t which = side.points.size() + 1;
  const auto refused = [&](const std::string& reason) {
    side.is_sampling = false;
    return Message{fmt::format("point {} of {} does not count: {}", which, target_name, reason), true};
  };
  if (pressed_now && !known) return refused("the position is not tracked");
  const bool odd_clock = side.is_sampling && !(t_s >= side.last_s && t_s <= side.last_s + kLeap_s);
  if (pressed_now || odd_clock) {
    side.is_sampling = known;
    side.start_s = t_s;
    side.first = known ? *now.position_m : Vec3(0.0);
    side.sum = Vec3(0.0);
    side.count = 0;
  }
  if (!side.is_sampling) return std::nullopt;
  side.last_s = t_s;
  if (!known) return refused("tracking was lost during the touch; touch the point again");
  if (const double moved = norm(*now.position_m - side.first); moved > kMaxMotion_m)
    return refused(fmt::format("it moved by {:.0f} mm during the touch; hold it still and touch the point again", 1e3 * moved));
  side.sum += *now.position_m;
  ++side.count;
  if (t_s - side.start_s < kHold_s) return std::nullopt;
  side.is_sampling = false;
  const Vec3 place = side.sum / double(side.count);
  for (std::size_t k = 0; k < side.points.size(); ++k)
    if (const double apart = norm(place - side.points[k]); apart < kMinSeparation_m)
      return refused(fmt::format("the touched position is {:.0f} mm from point {}; at least {:.0f} mm were expected", 1e3 * apart, k + 1,
                                 1e3 * kMinSeparation_m));
  side.points.push_back(place);
  return Message{fmt::format("point {} of {} was touched", which, target_name)};
}

TouchRegistration::Message TouchRegistration::finish() {
  const auto fit = compute_registration(three(device_.points), three(controller_.points));
  const auto again = [&](const std::string& why) {
    device_.points.clear();
    controller_.points.clear();
    return Message{why + "; touch all three points again", true};
  };
  if (!fit) return again(fit.error().message);
  if (fit->residual_m > kMaxResidual_m)
    return again(fmt::format(
        "the points do not fit: the residual is {:.1f} mm (root mean square), distances differ by up to {:.1f} mm; a residual of "
        "at most {:.0f} mm was expected",
        1e3 * fit->residual_m, 1e3 * fit->edge_error_m, 1e3 * kMaxResidual_m));
  registration_ = *fit;
  return Message{fmt::format("{} is registered: the residual is {:.1f} mm (root mean square), distances differ by up to {:.1f} mm",
                             device_name_, 1e3 * fit->residual_m, 1e3 * fit->edge_error_m)};
}

std::vector<TouchRegistration::Message> TouchRegistration::step(double t_s, const TouchInput& device, const TouchInput& controller) {
  std::vector<Message> messages;
  if (registration_) return messages;
  if (auto one = add_sample(device_, device_name_, t_s, device)) messages.push_back(std::move(*one));
  if (auto one = add_sample(controller_, "the controller", t_s, controller)) messages.push_back(std::move(*one));
  if (device_.points.size() == kPointCount && controller_.points.size() == kPointCount) messages.push_back(finish());
  return messages;
}

std::string TouchRegistration::prompt() const {
  if (registration_) return {};
  const auto done = [](const Side& side) { return side.points.size() == kPointCount; };
  const auto word = [&](const Side& side) {
    return done(side) ? std::string("done") : fmt::format("point {} of 3", side.points.size() + 1);
  };
  return fmt::format(
      "Touch three points, not on one line, with the handle of {0} and with the controller, in the same order. At each point press the "
      "button of the handle, or the trigger of the controller, and hold still. {0}: {1}. Controller: {2}.",
      device_name_, word(device_), word(controller_));
}

}  // namespace catena::xr_interaction
