// SPDX-License-Identifier: MIT
/// A Vulkan instance and device created and owned by another component, such as a headset's runtime or a host program.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "render/vk/commands.h"
#include "render/vk/device.h"

namespace catena::test::xr_vulkan_binding_test {

using namespace catena::render;

/// Creates and owns the instance and the device, and destroys them last.
struct Owner {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::mutex lock;
  int made = 0;

  vk::DeviceOptions options() {
    vk::DeviceOptions o;
    o.validation = true;
    o.provider.instance = [this](const VkInstanceCreateInfo& wanted, VkInstance* out) {
      ++made;
      const VkResult result = vkCreateInstance(&wanted, nullptr, &instance);
      *out = instance;
      return result;
    };
    o.provider.physical_device = [this](VkInstance of, VkPhysicalDevice* out) {
      ++made;
      EXPECT_EQ(of, instance);
      std::uint32_t one = 1;
      const VkResult result = vkEnumeratePhysicalDevices(of, &one, &physical);
      *out = physical;
      return result == VK_INCOMPLETE ? VK_SUCCESS : result;
    };
    o.provider.device = [this](VkPhysicalDevice of, const VkDeviceCreateInfo& wanted, VkDevice* out) {
      ++made;
      EXPECT_EQ(of, physical);
      const VkResult result = vkCreateDevice(of, &wanted, nullptr, &device);
      *out = device;
      return result;
    };
    o.provider.queue_lock = &lock;
    o.provider.keeps_ownership = true;
    return o;
  }
  ~Owner() {
    if (device) vkDestroyDevice(device, nullptr);
    if (instance) vkDestroyInstance(instance, nullptr);
  }
};

/// Copies bytes to the device and back; true if they match.
Outcome copies(vk::Device& device) {
  CATENA_TRY(auto from, vk::Buffer::create(device, 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vk::Memory::upload));
  CATENA_TRY(auto to, vk::Buffer::create(device, 256, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
  for (std::size_t i = 0; i < 256; ++i) from.bytes()[i] = std::byte(i);
  CATENA_TRY(auto commands, vk::Commands::begin(device));
  commands.copy(from, to, 256);
  CATENA_CHECK(commands.finish());
  return std::memcmp(from.bytes().data(), to.bytes().data(), 256) == 0 ? Outcome(Done{}) : Outcome(Error{"the bytes differ"});
}

TEST(VulkanBinding, TheOwnerKeepsInstanceAndDevice) {
  Owner owner;
  {
    auto device = vk::Device::create(owner.options());
    ASSERT_TRUE(device) << device.error().message;
    EXPECT_EQ(owner.made, 3);
    EXPECT_EQ((*device)->handle(), owner.device);
    const Outcome copied = copies(**device);
    EXPECT_TRUE(copied) << copied.error().message;
    EXPECT_EQ((*device)->messages().count(), 0u);
  }
  EXPECT_EQ(vkDeviceWaitIdle(owner.device), VK_SUCCESS);  // the device is still valid
}

TEST(VulkanBinding, TheQueueIsUsedUnderTheOwnersLock) {
  Owner owner;
  auto device = vk::Device::create(owner.options());
  ASSERT_TRUE(device) << device.error().message;
  std::atomic<bool> done{false};
  std::unique_lock held(owner.lock);
  std::thread other([&] {
    EXPECT_TRUE(copies(**device));
    done = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(done);
  held.unlock();
  other.join();
  EXPECT_TRUE(done);
}

TEST(VulkanBinding, AFailedCreationIsAnErrorInOneLine) {
  for (int which = 0; which < 3; ++which) {
    Owner owner;
    vk::DeviceOptions options = owner.options();
    if (which == 0) options.provider.instance = [](const VkInstanceCreateInfo&, VkInstance*) { return VK_ERROR_INCOMPATIBLE_DRIVER; };
    if (which == 1) options.provider.physical_device = [](VkInstance, VkPhysicalDevice*) { return VK_ERROR_INITIALIZATION_FAILED; };
    if (which == 2)
      options.provider.device = [](VkPhysicalDevice, const VkDeviceCreateInfo&, VkDevice*) { return VK_ERROR_FEATURE_NOT_PRESENT; };
    const auto device = vk::Device::create(options);
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().message.find("Vulkan could not "), 0u) << device.error().message;
    if (which == 0) {
      EXPECT_NE(device.error().message.find("(package mesa-vulkan-drivers)"), std::string::npos) << device.error().message;
    }
  }
}

}  // namespace catena::test::xr_vulkan_binding_test
