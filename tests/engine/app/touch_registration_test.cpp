// SPDX-License-Identifier: MIT
/// Three points touched by a device and by a controller: a known motion, and touches that do not count.
#include "engine/app/viewer/xr/touch_registration.h"

#include <gtest/gtest.h>

namespace touch_registration_test {

using namespace catena;
using namespace catena::xr_interaction;

const std::array<Vec3, 3> kTouched{Vec3(0.02, -0.03, 0.11), Vec3(-0.05, 0.01, 0.14), Vec3(0.01, 0.05, 0.12)};
const Quat kTurn = rotation_from_vector({0.3, 2.1, -0.4});
const Vec3 kOrigin(0.4, 0.9, -0.6);
constexpr double kFrame = 0.011;

Vec3 room_of(const Vec3& device) { return kOrigin + rotate(kTurn, device); }

struct Person {
  TouchRegistration touches{"arm"};
  double t = 100;
  std::vector<std::string> messages{};
  bool error = false;  ///< whether the last message was an error

  void step(const TouchRegistration::TouchInput& device, const TouchRegistration::TouchInput& controller, double dt = kFrame) {
    for (const TouchRegistration::Message& news : touches.step(t += dt, device, controller)) {
      messages.push_back(news.text);
      error = news.is_error;
    }
  }
  /// A touch: released, pressed for long enough at a position that trembles by half a millimetre, and released.
  void device(const Vec3& at, double tremble = 5e-4) { touch(at, tremble, true); }
  void controller(const Vec3& at, double tremble = 5e-4) { touch(at, tremble, false); }
  void touch(const Vec3& at, double tremble, bool by_device) {
    for (int k = 0; k < 20; ++k) {
      const TouchRegistration::TouchInput now{at + Vec3(k % 2 == 0 ? tremble : -tremble, 0, 0), k > 1 && k < 18};
      step(by_device ? now : TouchRegistration::TouchInput{Vec3(9.0), false}, by_device ? TouchRegistration::TouchInput{} : now);
    }
  }
};

TEST(Touches, FindTheMotionInAnyOrder) {
  for (const bool together : {false, true}) {
    Person person;
    for (const Vec3& place : kTouched) {
      person.device(place);
      if (together) person.controller(room_of(place));
    }
    if (!together)
      for (const Vec3& place : kTouched) person.controller(room_of(place));
    ASSERT_TRUE(person.touches.registration()) << person.messages.back();
    const Registration& found = *person.touches.registration();
    EXPECT_LT(norm(found.origin_m - kOrigin), 1e-4);
    EXPECT_LT(norm(rotation_vector(normalized(found.room_from_device * glm::conjugate(kTurn)))), 1e-3);
    EXPECT_LT(found.residual_m, 1e-4);
    EXPECT_EQ(person.messages.size(), 7u);
    EXPECT_NE(person.messages.back().find("arm is registered: the residual is 0.0 mm"), std::string::npos) << person.messages.back();
    EXPECT_TRUE(person.touches.prompt().empty());
  }
}

TEST(Touches, InvalidTouchesDoNotCount) {
  Person person;
  const auto refused = [&](const char* words) {
    ASSERT_FALSE(person.messages.empty());
    EXPECT_TRUE(person.error);
    EXPECT_NE(person.messages.back().find(words), std::string::npos) << person.messages.back();
    person.messages.clear();
  };
  // A button that is pressed from the beginning.
  person.step({kTouched[0], true}, {});
  for (int k = 0; k < 30; ++k) person.step({kTouched[0], true}, {});
  EXPECT_TRUE(person.messages.empty());
  person.device(kTouched[0], 0.004);
  refused("point 1 of arm does not count: it moved by 8 mm during the touch");
  person.step({std::nullopt, true}, {});
  refused("the position is not tracked");
  person.step({}, {});
  person.step({Vec3(NAN, 0, 0), true}, {});
  refused("the position is not tracked");
  person.step({}, {});
  person.step({kTouched[0], true}, {});
  person.step({std::nullopt, true}, {});
  refused("tracking was lost during the touch");
  person.step({}, {});
  person.device(kTouched[0]);
  EXPECT_EQ(person.messages, std::vector<std::string>{"point 1 of arm was touched"});
  person.device(kTouched[0] + Vec3(0, 0, 0.01));
  refused("the touched position is 10 mm from point 1; at least 20 mm were expected");
  // A clock that runs backwards restarts the touch, which ends normally.
  person.step({kTouched[1], true}, {});
  person.step({kTouched[1], true}, {}, -50);
  for (int k = 0; k < 13; ++k) person.step({kTouched[1], true}, {});
  EXPECT_TRUE(person.messages.empty());
  person.step({kTouched[1], true}, {});
  EXPECT_EQ(person.messages, std::vector<std::string>{"point 2 of arm was touched"});
  EXPECT_NE(person.touches.prompt().find("arm: point 3 of 3. Controller: point 1 of 3."), std::string::npos) << person.touches.prompt();
}

TEST(Touches, InconsistentPointsAreRequestedAgain) {
  Person person;
  for (int k = 0; k < 3; ++k) person.device(Vec3(0.05 * k, 0, 1e-3 * (k % 2)));
  for (const Vec3& place : kTouched) person.controller(room_of(place));
  EXPECT_TRUE(person.error);
  EXPECT_NE(person.messages.back().find("nearly on one line"), std::string::npos) << person.messages.back();
  // An edge that is 40 mm too long.
  for (const Vec3& place : kTouched) person.device(place);
  for (int k = 0; k < 3; ++k) person.controller(room_of(kTouched[k]) + (k == 1 ? 0.04 * rotate(kTurn, Vec3(-1, 0, 0)) : Vec3(0.0)));
  EXPECT_TRUE(person.error);
  EXPECT_NE(person.messages.back().find("the points do not fit"), std::string::npos) << person.messages.back();
  EXPECT_FALSE(person.touches.registration());
  for (const Vec3& place : kTouched) person.device(place);
  for (const Vec3& place : kTouched) person.controller(room_of(place));
  EXPECT_TRUE(person.touches.registration());
}

}  // namespace touch_registration_test
