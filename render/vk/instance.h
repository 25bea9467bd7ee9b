// SPDX-License-Identifier: MIT
/// Vulkan instance, its messages, and conversion of every VkResult to a Result with a one-line message.
#pragma once
#include <vulkan/vulkan.h>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"

namespace catena::render::vk {

/// Returns the name of a result code, for instance "VK_ERROR_DEVICE_LOST".
CATENA_EXPORT const char* result_name(VkResult result);
/// Returns an error "Vulkan could not WHAT: VK_ERROR_...".
CATENA_EXPORT Error vulkan_error(VkResult result, const std::string& what);

}  // namespace catena::render::vk

/// Returns an error from the enclosing function unless the call succeeds.
#define CATENA_VK(call, what) \
  if (const VkResult vk_result = (call); vk_result != VK_SUCCESS) return ::catena::render::vk::vulkan_error(vk_result, what)

namespace catena::render::vk {

/// Factory of a window's surface, set by the viewer; empty for headless programs.
struct CATENA_EXPORT SurfaceFactory {
  std::vector<std::string> instance_extensions;               ///< instance extensions that the surface requires
  std::function<VkResult(VkInstance, VkSurfaceKHR*)> create;  ///< creates the surface for an instance
  /// Returns whether there is a window.
  explicit operator bool() const { return static_cast<bool>(create); }
};

/// Provider of Vulkan objects in place of Catena, for an XR runtime or a host application with a device of its own; it also defines the
/// queue. Catena creates the objects whose function is empty. The extensions, layers and features in `info` are required; the provider
/// may add others. A result other than VK_SUCCESS becomes the Error. Frame thread.
struct CATENA_EXPORT VulkanProvider {
  /// Creates the instance, like vkCreateInstance.
  std::function<VkResult(const VkInstanceCreateInfo& info, VkInstance* created)> instance;
  /// Selects a physical device of the instance; it must still meet Catena's requirements.
  std::function<VkResult(VkInstance instance, VkPhysicalDevice* chosen)> physical_device;
  /// Creates the device, like vkCreateDevice, with one queue for graphics and compute.
  std::function<VkResult(VkPhysicalDevice physical, const VkDeviceCreateInfo& info, VkDevice* created)> device;
  /// Queue family whose first queue is used; nullopt: the first family with graphics and compute.
  std::optional<std::uint32_t> queue_family;
  /// Mutex held around every use of the queue, if others use it too; must outlive the device. Null: none.
  std::mutex* queue_lock = nullptr;
  /// true: the provider owns instance and device, and Catena does not destroy them.
  bool keeps_ownership = false;
};

/// Warnings and errors reported by Vulkan. Thread-safe, as the driver may report from any thread.
class CATENA_EXPORT Messages {
 public:
  /// Adds a message.
  void add(std::string text);
  /// Returns the number of messages.
  std::uint64_t count() const;
  std::vector<std::string> texts() const;  ///< the first 64

 private:
  mutable std::mutex mutex_;
  std::uint64_t count_ = 0;
  std::vector<std::string> texts_;
};

/// Vulkan instance of version 1.3, with the validation layer (including synchronization checks) if requested. Warnings and errors of the
/// layer and the loader are counted and their texts kept; tests assert that there are none. Frame thread.
class CATENA_EXPORT Instance {
 public:
  /// Creates or borrows the instance. A one-line Error on failure.
  static Result<std::unique_ptr<Instance>> create(bool validation, const SurfaceFactory& surface, const VulkanProvider& maker = {});
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  /// Returns the Vulkan handle.
  VkInstance handle() const { return instance_; }
  /// Returns the window's surface; null without a window.
  VkSurfaceKHR surface() const { return surface_; }
  /// Returns the warnings and errors reported so far.
  const Messages& messages() const { return messages_; }
  /// Deliberately leaks the instance: it is not destroyed.
  void abandon() { owned_ = false; }

 private:
  Instance() = default;
  VkInstance instance_ = VK_NULL_HANDLE;
  bool owned_ = true;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  Messages messages_;
};

}  // namespace catena::render::vk
