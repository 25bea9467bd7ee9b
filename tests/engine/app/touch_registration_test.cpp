// SPDX-License-Identifier: MIT
/// Three places touched by a device and by a controller: the motion that is known beforehand, and touches that do not count.
#include "engine/app/viewer/xr/touch_registration.h"

#include <gtest/gtest.h>

namespace touches_test {

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
  std::vector<std::string> said{};
  bool error = false;  ///< the last thing that was said

  void step(const TouchRegistration::TouchInput& device, const TouchRegistration::TouchInput& controller, double dt = kFrame) {
    for (const TouchRegistration::Message& news : touches.step(t += dt, device, controller)) {
      said.push_back(news.text);
      error = news.is_error;
    }
  }
  /// Let go, pressed for long enough, at places that tremble by half a millimetre, and let go again.
  void device(const Vec3& at, double tremble = 5e-4) { touch(at, tremble, true); }
  void controller(const Vec3& at, double tremble = 5e-4) { touch(at, tremble, false); }
  void touch(const Vec3& at, double tremble, bool by_device) {
    for (int k = 0; k < 20; ++k) {
      const TouchRegistration::TouchInput now{at + Vec3(k % 2 == 0 ? tremble : -tremble, 0, 0), k > 1 && k < 18};
      step(by_device ? now : TouchRegistration::TouchInput{Vec3(9.0), false}, by_device ? TouchRegistration::TouchInput{} : now);
    }
  }
};

TEST(Touches, FindTheMotionInWhicheverOrder) {
  for (const bool together : {false, true}) {
    Person person;
    for (const Vec3& place : kTouched) {
      person.device(place);
      if (together) person.controller(room_of(place));
    }
    if (!together)
      for (const Vec3& place : kTouched) person.controller(room_of(place));
    ASSERT_TRUE(person.touches.registration()) << person.said.back();
    const Registration& found = *person.touches.registration();
    EXPECT_LT(norm(found.origin_m - kOrigin), 1e-4);
    EXPECT_LT(norm(rotation_vector(normalized(found.room_from_device * glm::conjugate(kTurn)))), 1e-3);
    EXPECT_LT(found.residual_m, 1e-4);
    EXPECT_EQ(person.said.size(), 7u);
    EXPECT_NE(person.said.back().find("arm is registered: 0.0 mm are left"), std::string::npos) << person.said.back();
    EXPECT_TRUE(person.touches.prompt().empty());
  }
}

TEST(Touches, WhatIsNoTouchDoesNotCount) {
  Person person;
  const auto refused = [&](const char* words) {
    ASSERT_FALSE(person.said.empty());
    EXPECT_TRUE(person.error);
    EXPECT_NE(person.said.back().find(words), std::string::npos) << person.said.back();
    person.said.clear();
  };
  // what is down at first
  person.step({kTouched[0], true}, {});
  for (int k = 0; k < 30; ++k) person.step({kTouched[0], true}, {});
  EXPECT_TRUE(person.said.empty());
  person.device(kTouched[0], 0.004);
  refused("place 1 of arm does not count: it moved by 8 mm");
  person.step({std::nullopt, true}, {});
  refused("it is not known where it is");
  person.step({}, {});
  person.step({Vec3(NAN, 0, 0), true}, {});
  refused("it is not known where it is");
  person.step({}, {});
  person.step({kTouched[0], true}, {});
  person.step({std::nullopt, true}, {});
  refused("it was lost while it touched");
  person.step({}, {});
  person.device(kTouched[0]);
  EXPECT_EQ(person.said, std::vector<std::string>{"place 1 of arm is touched"});
  person.device(kTouched[0] + Vec3(0, 0, 0.01));
  refused("it is 10 mm from place 1; at least 20 mm were expected");
  // a clock that goes back begins the touch again, and ends it all the same
  person.step({kTouched[1], true}, {});
  person.step({kTouched[1], true}, {}, -50);
  for (int k = 0; k < 13; ++k) person.step({kTouched[1], true}, {});
  EXPECT_TRUE(person.said.empty());
  person.step({kTouched[1], true}, {});
  EXPECT_EQ(person.said, std::vector<std::string>{"place 2 of arm is touched"});
  EXPECT_NE(person.touches.prompt().find("arm: place 3 of 3. Controller: place 1 of 3."), std::string::npos) << person.touches.prompt();
}

TEST(Touches, PlacesThatDoNotFitAreAskedForAgain) {
  Person person;
  for (int k = 0; k < 3; ++k) person.device(Vec3(0.05 * k, 0, 1e-3 * (k % 2)));
  for (const Vec3& place : kTouched) person.controller(room_of(place));
  EXPECT_TRUE(person.error);
  EXPECT_NE(person.said.back().find("nearly on one line"), std::string::npos) << person.said.back();
  // edges of another length: 40 mm too long
  for (const Vec3& place : kTouched) person.device(place);
  for (int k = 0; k < 3; ++k) person.controller(room_of(kTouched[k]) + (k == 1 ? 0.04 * rotate(kTurn, Vec3(-1, 0, 0)) : Vec3(0.0)));
  EXPECT_TRUE(person.error);
  EXPECT_NE(person.said.back().find("the places do not fit"), std::string::npos) << person.said.back();
  EXPECT_FALSE(person.touches.registration());
  for (const Vec3& place : kTouched) person.device(place);
  for (const Vec3& place : kTouched) person.controller(room_of(place));
  EXPECT_TRUE(person.touches.registration());
}

}  // namespace touches_test
