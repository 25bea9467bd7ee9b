// SPDX-License-Identifier: MIT
/// Requirements on a Vulkan device, for a host application that creates the device itself and lends it to Catena (VulkanProvider,
/// instance.h): check them before creating the device, and enable these extensions and features besides one's own. Any thread.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/export.h"

namespace catena::render::vk {

inline constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_3;  ///< version of the instance and of the device

/// Feature chain for vkCreateDevice, to be passed as pNext = &core. Not movable, as it points into itself.
struct CATENA_EXPORT DeviceFeatures {
  VkPhysicalDeviceFeatures2 core{};        ///< start of the chain
  VkPhysicalDeviceVulkan12Features v12{};  ///< second in the chain
  VkPhysicalDeviceVulkan13Features v13{};  ///< last in the chain
  DeviceFeatures();
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;
};

/// Enables the features that Catena requires; features already enabled stay enabled.
CATENA_EXPORT void enable_required(DeviceFeatures& features);
/// Returns the required device extensions. `presents`: Catena presents images in a window of its own.
CATENA_EXPORT std::vector<const char*> required_extensions(bool presents = false);
/// Returns the first requirement that the device does not meet, by its name such as "independentBlend"; empty: it meets all. `surface`:
/// surface on which images are presented; null for offscreen rendering.
CATENA_EXPORT std::string missing_requirement(VkPhysicalDevice physical, VkSurfaceKHR surface = VK_NULL_HANDLE);

}  // namespace catena::render::vk
