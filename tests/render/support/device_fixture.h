// SPDX-License-Identifier: MIT
/// A device with the validation layer; any validation message is a failure.
#pragma once
#include <gtest/gtest.h>

#include <memory>

#include "render/vk/device.h"
#include "tests/support/vulkan.h"

namespace catena::test {

class DeviceFixture : public testing::Test {
 protected:
  void SetUp() override {
    use_lavapipe();
    auto device = render::vk::Device::create({true, test_device(), {}});
    ASSERT_TRUE(device) << device.error().message;
    device_ = std::move(*device);
  }
  void TearDown() override {
    if (!device_ || messages_expected_) return;
    EXPECT_EQ(device_->messages().count(), 0u);
    for (const std::string& text : device_->messages().texts()) ADD_FAILURE() << text;
  }
  bool messages_expected_ = false;
  std::unique_ptr<render::vk::Device> device_;
};

}  // namespace catena::test
