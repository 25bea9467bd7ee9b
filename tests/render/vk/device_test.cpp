// SPDX-License-Identifier: MIT
#include "render/vk/device.h"

#include <cstring>

#include "render/vk/commands.h"
#include "tests/render/support/device_fixture.h"

namespace catena::test::device_test {

using namespace catena::render;

class Device : public DeviceFixture {};

TEST_F(Device, ReportsItsProperties) {
  EXPECT_FALSE(device_->info().name.empty());
  EXPECT_FALSE(device_->info().driver.empty());
  EXPECT_EQ(device_->info().is_cpu(), uses_lavapipe());
  EXPECT_GT(device_->info().memory_bytes, 0u);
  const auto lines = vk::list_devices();
  ASSERT_TRUE(lines);
  EXPECT_GE(lines->size(), 1u);
}

TEST_F(Device, AnUnknownDeviceIsAnErrorThatListsTheDevices) {
  const auto other = vk::Device::create({false, "no such device", {}});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("no such device"), std::string::npos);
  EXPECT_NE(other.error().message.find(device_->info().name), std::string::npos);
}

TEST_F(Device, ValidationMessagesAreCounted) {
  EXPECT_EQ(device_->messages().count(), 0u);
  messages_expected_ = true;
  // a buffer without usage violates the specification but is accepted by drivers
  const auto buffer = vk::Buffer::create(*device_, 64, 0, vk::Memory::upload);
  EXPECT_GT(device_->messages().count(), 0u);
  EXPECT_FALSE(device_->messages().texts().front().empty());
}

TEST_F(Device, UploadsAndReadsBack) {
  vk::ImageInfo info;
  info.extent = {7, 5, 1};
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  auto image = vk::Image::create(*device_, info);
  auto from = vk::Buffer::create(*device_, 7 * 5 * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vk::Memory::upload);
  auto to = vk::Buffer::create(*device_, 7 * 5 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback);
  ASSERT_TRUE(image && from && to);
  for (std::size_t i = 0; i < from->bytes().size(); ++i) from->bytes()[i] = std::byte(i);
  auto commands = vk::Commands::begin(*device_);
  ASSERT_TRUE(commands);
  commands->transition(*image, vk::kTransferWrite);
  commands->copy(*from, 0, *image, {0, 0, 0}, {7, 5, 1});
  commands->copy(*image, *to);
  ASSERT_TRUE(commands->finish());
  EXPECT_EQ(std::memcmp(from->bytes().data(), to->bytes().data(), 7 * 5 * 4), 0);
  EXPECT_EQ(device_->counters().uploads, 1u);
  EXPECT_EQ(device_->counters().upload_bytes, 7u * 5 * 4);
}

TEST_F(Device, ResourcesWaitForTheTimeline) {
  const std::uint64_t before = device_->counters().allocated_bytes;
  auto from = vk::Buffer::create(*device_, 1 << 20, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vk::Memory::upload);
  auto to = vk::Buffer::create(*device_, 1 << 20, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::device);
  ASSERT_TRUE(from && to);
  EXPECT_GE(device_->counters().allocated_bytes, before + (2 << 20));
  auto commands = vk::Commands::begin(*device_);
  ASSERT_TRUE(commands);
  commands->copy(*from, *to, 1 << 20);
  const auto value = commands->submit();
  ASSERT_TRUE(value);
  *from = vk::Buffer();
  *to = vk::Buffer();
  // the replaced resources are kept until the copy has completed
  EXPECT_GE(device_->retired_count(), 2u);
  EXPECT_GE(device_->counters().allocated_bytes, before + (2 << 20));
  ASSERT_TRUE(device_->wait(*value));
  EXPECT_EQ(device_->retired_count(), 0u);
  EXPECT_EQ(device_->counters().allocated_bytes, before);
}

TEST_F(Device, AnImpossibleImageIsAnErrorInOneLine) {
  vk::ImageInfo info;
  info.type = VK_IMAGE_TYPE_3D;
  info.format = VK_FORMAT_R32_SFLOAT;
  info.extent = {100000, 2, 2};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const auto image = vk::Image::create(*device_, info);
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("100000 x 2 x 2"), std::string::npos);
  EXPECT_EQ(image.error().message.find('\n'), std::string::npos);
}

}  // namespace catena::test::device_test
