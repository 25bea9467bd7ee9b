// SPDX-License-Identifier: MIT
#include "render/vk/instance.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/base/system_failure.h"

namespace catena::render::vk {

const char* result_name(VkResult result) {
  switch (result) {
    case VK_SUCCESS:
      return "VK_SUCCESS";
    case VK_NOT_READY:
      return "VK_NOT_READY";
    case VK_TIMEOUT:
      return "VK_TIMEOUT";
    case VK_INCOMPLETE:
      return "VK_INCOMPLETE";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
      return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
      return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
      return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
      return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    case VK_ERROR_SURFACE_LOST_KHR:
      return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
      return "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR";
    case VK_SUBOPTIMAL_KHR:
      return "VK_SUBOPTIMAL_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR:
      return "VK_ERROR_OUT_OF_DATE_KHR";
    default:
      return "an unknown VkResult";
  }
}

Error vulkan_error(VkResult result, const std::string& what) {
  Error error{"Vulkan could not " + what + ": " + result_name(result)};
  // drivers report a lack of memory by several codes
  const bool may_lack_memory =
      result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_INITIALIZATION_FAILED;
  if (may_lack_memory && resource_limit(RLIMIT_AS)) error.message += " (" + describe_errno(ENOMEM) + ")";
  return error;
}

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::size_t kMaxMessages = 64;

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  static_cast<Messages*>(user)->add(data->pMessage ? data->pMessage : "(no text)");
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(Messages* messages) {
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = on_message;
  info.pUserData = messages;
  return info;
}

bool has_layer(const char* name) {
  std::uint32_t count = 0;
  if (vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkLayerProperties> layers(count);
  if (vkEnumerateInstanceLayerProperties(&count, layers.data()) != VK_SUCCESS) return false;
  return std::any_of(layers.begin(), layers.end(), [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

VkApplicationInfo application_info() {
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "catena";
  application.apiVersion = VK_API_VERSION_1_3;
  return application;
}

/// Holds an empty instance until the process ends. The loader unloads a driver with the last instance, and NVIDIA's driver (580) cannot be
/// loaded a 31st time, because its static thread-local storage is exhausted.
void keep_the_driver_loaded() {
  static const VkInstance retained = [] {
    const VkApplicationInfo application = application_info();
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    VkInstance created = VK_NULL_HANDLE;
    return vkCreateInstance(&info, nullptr, &created) == VK_SUCCESS ? created : VkInstance(VK_NULL_HANDLE);
  }();
  (void)retained;
}

}  // namespace

void Messages::add(std::string text) {
  const std::lock_guard lock(mutex_);
  ++count_;
  if (texts_.size() < kMaxMessages) texts_.push_back(std::move(text));
}

std::uint64_t Messages::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

std::vector<std::string> Messages::texts() const {
  const std::lock_guard lock(mutex_);
  return texts_;
}

Result<std::unique_ptr<Instance>> Instance::create(bool validation, const SurfaceFactory& surface, const VulkanProvider& maker) {
  std::unique_ptr<Instance> self(new Instance);

  // loader version
  std::uint32_t version = VK_API_VERSION_1_0;
  CATENA_VK(vkEnumerateInstanceVersion(&version), "query the loader's version");
  if (version < VK_API_VERSION_1_3)
    return Error{fmt::format("the Vulkan loader has version {}.{}, expected 1.3 or newer (package libvulkan1)",
                             VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version))};

  // layers and extensions
  std::vector<const char*> layers, extensions;
  for (const std::string& name : surface.instance_extensions) extensions.push_back(name.c_str());
  if (validation) {
    if (!has_layer(kValidationLayer))
      return Error{fmt::format("the layer {} is not installed, expected the package vulkan-validationlayers", kValidationLayer)};
    layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }

  keep_the_driver_loaded();
  const VkApplicationInfo application = application_info();

  // validation with synchronization checks
  VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(&self->messages_);
  const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{};
  features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = enabled;
  features.pNext = &messenger;

  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pNext = validation ? &features : nullptr;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = std::uint32_t(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = std::uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  self->owned_ = !maker.keeps_ownership;
  const VkResult created = maker.instance ? maker.instance(info, &self->instance_) : vkCreateInstance(&info, nullptr, &self->instance_);
  if (created == VK_ERROR_INCOMPATIBLE_DRIVER)  // no driver was found
    return Error{vulkan_error(created, "create an instance").message +
                 ", expected the driver of a GPU or Mesa's lavapipe (package mesa-vulkan-drivers)"};
  CATENA_VK(created, "create an instance");

  if (validation) {
    const auto create =
        reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(self->instance_, "vkCreateDebugUtilsMessengerEXT"));
    if (!create) return Error{"the Vulkan loader has no vkCreateDebugUtilsMessengerEXT"};
    CATENA_VK(create(self->instance_, &messenger, nullptr, &self->messenger_), "create the debug messenger");
  }
  if (surface) CATENA_VK(surface.create(self->instance_, &self->surface_), "create the window's surface");
  return self;
}

Instance::~Instance() {
  if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
  if (messenger_) {
    const auto destroy =
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    if (destroy) destroy(instance_, messenger_, nullptr);
  }
  if (instance_ && owned_) vkDestroyInstance(instance_, nullptr);
}

}  // namespace catena::render::vk
