// SPDX-License-Identifier: MIT
/// Registration of a device in the room from three touched points: exact, inexact and degenerate ones.
#include "engine/app/viewer/xr/registration.h"

#include <gtest/gtest.h>

#include <random>

namespace registration_test {

using namespace catena;
using namespace catena::xr_interaction;

using Places = std::array<Vec3, 3>;
const Places kTouched{Vec3(0.02, -0.03, 0.11), Vec3(-0.05, 0.01, 0.14), Vec3(0.01, 0.05, 0.12)};

struct Dice {
  std::mt19937 engine{5};
  Vec3 vec(double size) {
    std::uniform_real_distribution<double> d(-size, size);
    return {d(engine), d(engine), d(engine)};
  }
};

double squares(const Registration& r, const Places& room) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += dot(r.to_room(kTouched[i]) - room[i], r.to_room(kTouched[i]) - room[i]);
  return sum;
}

TEST(Registration, FindsTheRigidMotionOfExactPoints) {
  Dice dice;
  for (int k = 0; k < 200; ++k) {
    const Quat turn = k == 0 ? rotation_from_vector({0, 0, M_PI}) : rotation_from_vector(dice.vec(1.8));
    const Vec3 origin = dice.vec(2);
    Places room;
    for (std::size_t i = 0; i < 3; ++i) room[i] = origin + rotate(turn, kTouched[i]);
    const auto found = compute_registration(kTouched, room);
    ASSERT_TRUE(found);
    EXPECT_LT(norm(found->origin_m - origin), 1e-12);
    EXPECT_LT(norm(rotation_vector(normalized(found->room_from_device * glm::conjugate(turn)))), 1e-12);
    EXPECT_LT(found->residual_m, 1e-13);
    EXPECT_LT(found->edge_error_m, 1e-13);
  }
}

TEST(Registration, InexactPointsGiveTheLeastSquaresFit) {
  Dice dice;
  for (int k = 0; k < 50; ++k) {
    const Quat turn = rotation_from_vector(dice.vec(1.5));
    Places room;
    for (std::size_t i = 0; i < 3; ++i) room[i] = rotate(turn, kTouched[i]) + dice.vec(0.003);
    const auto found = compute_registration(kTouched, room);
    ASSERT_TRUE(found);
    const double best = squares(*found, room);
    EXPECT_NEAR(found->residual_m, std::sqrt(best / 3), 1e-12);
    EXPECT_LT(found->residual_m, 0.0052);
    // No small motion away from the result has a smaller sum of squares.
    for (int j = 0; j < 60; ++j) {
      Registration other = *found;
      const Quat nudge = rotation_from_vector(dice.vec(0.01));
      other.room_from_device = normalized(nudge * other.room_from_device);
      other.origin_m += dice.vec(0.0005);
      EXPECT_GT(squares(other, room), best * (1 - 1e-9));
    }
  }
}

TEST(Registration, RefusesDegeneratePoints) {
  const auto refused = [](Places device, Places room, const char* words) {
    const auto found = compute_registration(device, room);
    ASSERT_FALSE(found);
    EXPECT_NE(found.error().message.find(words), std::string::npos) << found.error().message;
  };
  const Places line{Vec3(0.0), Vec3(0.1, 0, 0), Vec3(0.05, 0.005, 0)};
  refused(line, kTouched, "the device are nearly on one line, 5.0 mm from it");
  refused(kTouched, line, "the room are nearly on one line");
  refused({Vec3(0.0), Vec3(0.001, 0, 0), Vec3(0, 0.1, 0)}, kTouched, "points 1 and 2 of the device are 1.0 mm apart");
  refused(kTouched, {Vec3(0.0), Vec3(0.1, 0, 0), Vec3(0, NAN, 0)}, "point 3 of the room is not finite");
}

TEST(Registration, ReportsTheErrorOfAnEdge) {
  Places room = kTouched;
  room[1] += 0.02 * direction(kTouched[1] - kTouched[0]);
  const auto found = compute_registration(kTouched, room);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->edge_error_m, 0.02, 1e-12);
  EXPECT_GT(found->residual_m, 0.005);
}

}  // namespace registration_test
