/// Every VkResult becomes a Result with one sentence.
#pragma once
#include <vulkan/vulkan.h>

#include <string>

#include "engine/base/result.h"

namespace catena::render::vk {

const char* result_name(VkResult result);
/// "Vulkan could not WHAT: VK_ERROR_..."
Error vulkan_error(VkResult result, const std::string& what);

}  // namespace catena::render::vk

/// Returns an error from the function around it unless the call succeeds.
#define CATENA_VK(call, what) \
  if (const VkResult vk_result = (call); vk_result != VK_SUCCESS) return ::catena::render::vk::vulkan_error(vk_result, what)
