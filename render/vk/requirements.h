/// What Catena needs of a Vulkan device, for a program that makes its device itself and lends it (VulkanProvider, instance.h): ask before
/// the device is made, and make it with these extensions and features besides one's own. Any thread.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

namespace catena::render::vk {

inline constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_3;  ///< of the instance and of the device

/// The chain that vkCreateDevice takes as pNext = &core. It points into itself, so it does not move.
struct DeviceFeatures {
  VkPhysicalDeviceFeatures2 core{};        ///< begins the chain
  VkPhysicalDeviceVulkan12Features v12{};  ///< next in it
  VkPhysicalDeviceVulkan13Features v13{};  ///< last in it
  DeviceFeatures();
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;
};

/// Switches on what Catena needs; what is on already stays on.
void enable_required(DeviceFeatures& features);
/// Of the device. `presents`: Catena shows its pictures in a window of its own.
std::vector<const char*> required_extensions(bool presents = false);
/// What the device has not got of all this: its first word, such as "independentBlend"; empty: it will do. `surface`: where pictures are
/// shown, none for pictures in memory.
std::string missing_requirement(VkPhysicalDevice physical, VkSurfaceKHR surface = VK_NULL_HANDLE);

}  // namespace catena::render::vk
