#include "engine/immersive/touches.h"

#include <fmt/format.h>

namespace catena::immersive {
namespace {

constexpr std::size_t kPlaces = 3;
constexpr double kLeap_s = 1;  // between two samples of a touch

std::array<Vec3, kPlaces> three(const std::vector<Vec3>& places) { return {places[0], places[1], places[2]}; }

}  // namespace

std::optional<Touches::News> Touches::take(Side& side, const std::string& whose, double t_s, const Toucher& now) {
  const bool pressed_now = now.pressed && !side.was_pressed;
  side.was_pressed = now.pressed;
  if (side.places.size() == kPlaces) return std::nullopt;
  const bool known = now.place_m && is_finite(*now.place_m);
  const std::size_t which = side.places.size() + 1;
  const auto refused = [&](const std::string& why) {
    side.holds = false;
    return News{fmt::format("place {} of {} does not count: {}", which, whose, why), true};
  };
  if (pressed_now && !known) return refused("it is not known where it is now");
  const bool odd_clock = side.holds && !(t_s >= side.last_s && t_s <= side.last_s + kLeap_s);
  if (pressed_now || odd_clock) {
    side.holds = known;
    side.from_s = t_s;
    side.first = known ? *now.place_m : Vec3(0.0);
    side.sum = Vec3(0.0);
    side.count = 0;
  }
  if (!side.holds) return std::nullopt;
  side.last_s = t_s;
  if (!known) return refused("it was lost while it touched; touch it again");
  if (const double moved = norm(*now.place_m - side.first); moved > kStill_m)
    return refused(fmt::format("it moved by {:.0f} mm while it touched; hold it still and touch again", 1e3 * moved));
  side.sum += *now.place_m;
  ++side.count;
  if (t_s - side.from_s < kHold_s) return std::nullopt;
  side.holds = false;
  const Vec3 place = side.sum / double(side.count);
  for (std::size_t k = 0; k < side.places.size(); ++k)
    if (const double apart = norm(place - side.places[k]); apart < kApart_m)
      return refused(fmt::format("it is {:.0f} mm from place {}; at least {:.0f} mm were expected", 1e3 * apart, k + 1, 1e3 * kApart_m));
  side.places.push_back(place);
  return News{fmt::format("place {} of {} is touched", which, whose)};
}

Touches::News Touches::finish() {
  const auto fit = register_device(three(device_.places), three(controller_.places));
  const auto again = [&](const std::string& why) {
    device_.places.clear();
    controller_.places.clear();
    return News{why + "; touch three places again", true};
  };
  if (!fit) return again(fit.error().message);
  if (fit->residual_m > kMostResidual_m)
    return again(
        fmt::format("the places do not fit: {:.1f} mm are left at them (root mean square), edges differ by up to {:.1f} mm; at most "
                    "{:.0f} mm were expected",
                    1e3 * fit->residual_m, 1e3 * fit->edge_error_m, 1e3 * kMostResidual_m));
  found_ = *fit;
  return News{fmt::format("{} is registered: {:.1f} mm are left at the three places (root mean square), edges differ by up to {:.1f} mm",
                          device_name_, 1e3 * fit->residual_m, 1e3 * fit->edge_error_m)};
}

std::vector<Touches::News> Touches::step(double t_s, const Toucher& device, const Toucher& controller) {
  std::vector<News> news;
  if (found_) return news;
  if (auto one = take(device_, device_name_, t_s, device)) news.push_back(std::move(*one));
  if (auto one = take(controller_, "the controller", t_s, controller)) news.push_back(std::move(*one));
  if (device_.places.size() == kPlaces && controller_.places.size() == kPlaces) news.push_back(finish());
  return news;
}

std::string Touches::prompt() const {
  if (found_) return {};
  const auto done = [](const Side& side) { return side.places.size() == kPlaces; };
  const auto word = [&](const Side& side) {
    return done(side) ? std::string("done") : fmt::format("place {} of 3", side.places.size() + 1);
  };
  return fmt::format(
      "Touch three places, not on one line, with the handle of {0} and with the controller, the same places in the same order: hold it "
      "there "
      "and press its button (the controller's trigger). {0}: {1}. Controller: {2}.",
      device_name_, word(device_), word(controller_));
}

}  // namespace catena::immersive
