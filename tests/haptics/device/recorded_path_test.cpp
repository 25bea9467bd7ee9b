// SPDX-License-Identifier: MIT
#include "haptics/device/recorded_path.h"

#include <gtest/gtest.h>

#include "haptics/device/registry.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::haptics::recorded_path_test {

TEST(RecordedPath, PlaysItsFileAndHoldsTheLastPose) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "p.csv", "t,x,y,z,buttons,qw,qx,qy,qz\n0,1,2,3,0,1,0,0,0\n0.5,4,5,6,3,0,0,0,1\n");
  const auto opened = test::value_of(open_device("recorded:" + (folder / "p.csv"), {}));
  Device& device = *opened;
  EXPECT_TRUE(device.capabilities().has_orientation);
  const DeviceInput first = device.read();
  EXPECT_TRUE(first.is_recorded);
  EXPECT_EQ(first.t_s, 0);
  EXPECT_EQ(first.position_m, Vec3(1, 2, 3));
  for (int k = 0; k < 3; ++k) {
    const DeviceInput last = device.read();
    EXPECT_EQ(last.t_s, 0.5);
    EXPECT_EQ(last.position_m, Vec3(4, 5, 6));
    EXPECT_EQ(last.orientation, Quat(0, 0, 0, 1));
    EXPECT_EQ(last.buttons, 3u);
    EXPECT_EQ(last.status, DeviceStatus::ready);
  }
}

TEST(RecordedPath, ReportsErrorsOfItsFile) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "p.csv", "t,x,y,z\n0,1,2,3\n0,1,2,3\n");
  EXPECT_NE(open_device("recorded:" + (folder / "p.csv"), {}).error().message.find("p.csv:3:"), std::string::npos);
  EXPECT_NE(open_device("recorded:" + (folder / "none.csv"), {}).error().message.find("none.csv"), std::string::npos);
  EXPECT_NE(open_device("recorded", {}).error().message.find("recorded:PATH.csv"), std::string::npos);
}

}  // namespace catena::haptics::recorded_path_test
