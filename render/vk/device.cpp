// SPDX-License-Identifier: MIT
#include "render/vk/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "engine/base/threads.h"
#include "render/vk/instance.h"
#include "render/vk/timestamp_query.h"

namespace catena::render::vk {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

int preference(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_OTHER:
      return 1;
    default:
      return 0;
  }
}

bool matches(const VkPhysicalDeviceProperties& properties, const std::string& choice) {
  if (choice.empty()) return true;
  const bool cpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  if (choice == "cpu") return cpu;
  if (choice == "gpu") return !cpu;
  return lower(properties.deviceName).find(lower(choice)) != std::string::npos;
}

bool has_extension(VkPhysicalDevice physical, const char* name) {
  std::uint32_t count = 0;
  if (vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> extensions(count);
  if (vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()) != VK_SUCCESS) return false;
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

/// Returns the first queue family with graphics and, if there is a surface, presentation.
std::optional<std::uint32_t> find_queue(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) || !(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    VkBool32 presents = VK_TRUE;
    if (surface && vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, surface, &presents) != VK_SUCCESS) presents = VK_FALSE;
    if (presents) return i;
  }
  return std::nullopt;
}

}  // namespace

DeviceFeatures::DeviceFeatures() {
  core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  core.pNext = &v12;
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v12.pNext = &v13;
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
}

void enable_required(DeviceFeatures& features) {
  features.core.features.shaderClipDistance = VK_TRUE;
  features.core.features.independentBlend = VK_TRUE;
  features.core.features.fragmentStoresAndAtomics = VK_TRUE;
  features.v12.timelineSemaphore = VK_TRUE;
  features.v12.scalarBlockLayout = VK_TRUE;
  features.v13.dynamicRendering = VK_TRUE;
  features.v13.synchronization2 = VK_TRUE;
  features.v13.maintenance4 = VK_TRUE;  // glslang emits LocalSizeId for Vulkan 1.3
}

std::vector<const char*> required_extensions(bool presents) {
  std::vector<const char*> names{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  if (presents) names.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  return names;
}

std::string missing_requirement(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  if (properties.apiVersion < kApiVersion) return "Vulkan 1.3";
  for (const char* name : required_extensions(surface != VK_NULL_HANDLE))
    if (!has_extension(physical, name)) return name;
  DeviceFeatures features;
  vkGetPhysicalDeviceFeatures2(physical, &features.core);
  if (!features.core.features.shaderClipDistance) return "shaderClipDistance";
  if (!features.core.features.independentBlend) return "independentBlend";
  if (!features.core.features.fragmentStoresAndAtomics) return "fragmentStoresAndAtomics";
  if (!features.v12.timelineSemaphore) return "timelineSemaphore";
  if (!features.v12.scalarBlockLayout) return "scalarBlockLayout";
  if (!features.v13.dynamicRendering) return "dynamicRendering";
  if (!features.v13.synchronization2) return "synchronization2";
  if (!features.v13.maintenance4) return "maintenance4";
  if (!find_queue(physical, surface)) return surface ? "a queue with graphics and presentation" : "a queue with graphics";
  return {};
}

namespace {

Result<std::vector<VkPhysicalDevice>> physical_devices(VkInstance instance) {
  std::uint32_t count = 0;
  CATENA_VK(vkEnumeratePhysicalDevices(instance, &count, nullptr), "list the devices");
  std::vector<VkPhysicalDevice> devices(count);
  CATENA_VK(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "list the devices");
  if (devices.empty()) return Error{"no Vulkan device was found, expected a GPU or Mesa's lavapipe (package mesa-vulkan-drivers)"};
  return devices;
}

/// Returns an Error if lavapipe cannot start its threads. When the device is created, lavapipe (Mesa 22.3) starts one thread for its queue
/// and one per core for rendering, and waits forever for a rendering thread that cannot be started. So the same number of threads is
/// started and ended here first. lavapipe's other threads, for compute shaders and the cache, are not required.
Outcome driver_threads(const std::string& name) {
  constexpr std::size_t kMaxCores = 32, kQueue = 1;
  const char* stated = std::getenv("LP_NUM_THREADS");
  const std::size_t cores = std::min<std::size_t>(kMaxCores, std::max(1u, std::thread::hardware_concurrency()));
  const long thread_count = stated != nullptr ? std::strtol(stated, nullptr, 10) : -1;
  const std::size_t count = kQueue + (thread_count >= 0 ? std::min<std::size_t>(kMaxCores, static_cast<std::size_t>(thread_count)) : cores);
  std::atomic<bool> end{false};
  std::vector<std::thread> threads;
  threads.reserve(count);
  Outcome done = Done{};
  while (done && threads.size() < count) {
    auto started = start_thread(fmt::format("{} needs {} threads", name, count), [&] { end.wait(false); });
    if (started)
      threads.push_back(std::move(*started));
    else
      done = started.error();
  }
  end = true;
  end.notify_all();
  for (std::thread& thread : threads) thread.join();
  return done;
}

}  // namespace

Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options) {
  std::unique_ptr<Device> self(new Device);
  self->provider_ = options.provider;
  CATENA_TRY(self->instance_, Instance::create(options.validation, options.surface, options.provider));
  const char* environment = std::getenv("CATENA_DEVICE");
  if (options.provider.physical_device) {
    CATENA_CHECK(self->adopt_physical_device());
  } else {
    CATENA_CHECK(self->select_physical_device(!options.device_filter.empty() ? options.device_filter : environment ? environment : ""));
  }
  self->query_device_info();
  if (self->info_.type == VK_PHYSICAL_DEVICE_TYPE_CPU) CATENA_CHECK(driver_threads(self->info_.name));
  CATENA_CHECK(self->create_device());
  self->info_.memory_budget = options.memory_budget_bytes > 0 ? options.memory_budget_bytes : self->default_budget();
  self->inject_failure_ = options.inject_failure;
  return self;
}

std::uint64_t Device::default_budget() const {
  if (!has_extension(physical_, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)) return info_.memory_bytes / 10 * 8;
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{};
  budget.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT;
  VkPhysicalDeviceMemoryProperties2 memory{};
  memory.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2;
  memory.pNext = &budget;
  vkGetPhysicalDeviceMemoryProperties2(physical_, &memory);
  std::uint64_t max_bytes = 0;
  for (std::uint32_t i = 0; i < memory.memoryProperties.memoryHeapCount; ++i)
    if ((memory.memoryProperties.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && budget.heapBudget[i] > budget.heapUsage[i])
      max_bytes = std::max<std::uint64_t>(max_bytes, budget.heapBudget[i] - budget.heapUsage[i]);
  return max_bytes > 0 ? max_bytes / 10 * 9 : info_.memory_bytes / 10 * 8;
}

Error Device::failed(VkResult result, const std::string& what) {
  if (result == VK_ERROR_DEVICE_LOST) is_lost_ = true;
  return vulkan_error(result, what);
}

Outcome Device::select_physical_device(const std::string& choice) {
  CATENA_TRY(const auto devices, physical_devices(instance_->handle()));
  int best = -1;
  std::string found_devices;
  for (VkPhysicalDevice candidate : devices) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(candidate, &properties);
    const std::string missing = missing_requirement(candidate, instance_->surface());
    found_devices += fmt::format("{}{}{}", found_devices.empty() ? "" : ", ", properties.deviceName,
                                 missing.empty() ? "" : " (without " + missing + ")");
    if (!missing.empty() || !matches(properties, choice)) continue;
    if (preference(properties.deviceType) > best) {
      best = preference(properties.deviceType);
      physical_ = candidate;
    }
  }
  if (!physical_)
    return Error{choice.empty() ? fmt::format("no usable Vulkan device: {}", found_devices)
                                : fmt::format("no usable Vulkan device matches CATENA_DEVICE \"{}\", expected cpu, gpu or a part of: {}",
                                              choice, found_devices)};
  return Done{};
}

/// Takes the physical device that the provider chose.
Outcome Device::adopt_physical_device() {
  CATENA_VK(provider_.physical_device(instance_->handle(), &physical_), "select the requested device");
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical_, &properties);
  const std::string missing = missing_requirement(physical_, instance_->surface());
  if (!missing.empty()) return Error{fmt::format("the requested device {} lacks {}", properties.deviceName, missing)};
  return Done{};
}

void Device::query_device_info() {
  queue_family_ = provider_.queue_family ? *provider_.queue_family : *find_queue(physical_, instance_->surface());
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(physical_, &properties);
  info_.name = properties.properties.deviceName;
  info_.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  info_.type = properties.properties.deviceType;
  info_.limits = properties.properties.limits;
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      info_.memory_bytes = std::max<std::uint64_t>(info_.memory_bytes, memory.memoryHeaps[i].size);
}

Outcome Device::create_device() {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;

  DeviceFeatures features;
  enable_required(features);
  const std::vector<const char*> extensions = required_extensions(instance_->surface() != VK_NULL_HANDLE);

  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features.core;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = std::uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  CATENA_VK(provider_.device ? provider_.device(physical_, info, &device_) : vkCreateDevice(physical_, &info, nullptr, &device_),
            "create the device " + info_.name);
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  push_descriptors_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(vkGetDeviceProcAddr(device_, "vkCmdPushDescriptorSetKHR"));
  if (!push_descriptors_) return Error{"the driver of " + info_.name + " has no vkCmdPushDescriptorSetKHR"};

  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT | VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = queue_family_;
  CATENA_VK(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "create a command pool");
  timestamps_ = std::make_unique<TimestampQueries>(physical_, device_, queue_family_);

  VkSemaphoreTypeCreateInfo type{};
  type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo semaphore{};
  semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  semaphore.pNext = &type;
  CATENA_VK(vkCreateSemaphore(device_, &semaphore, nullptr, &timeline_), "create the timeline semaphore");
  return Done{};
}

Device::~Device() {
  if (device_) {
    // waits for all work; whatever the result, nothing runs on the device afterwards
    {
      const auto turn = lock_queue();
      (void)vkDeviceWaitIdle(device_);
    }
    completed_value_ = std::numeric_limits<std::uint64_t>::max();
    destroy_retired();
    timestamps_.reset();
    if (timeline_) vkDestroySemaphore(device_, timeline_, nullptr);
    if (pool_) vkDestroyCommandPool(device_, pool_, nullptr);
    if (!provider_.keeps_ownership) vkDestroyDevice(device_, nullptr);
  }
}

void Device::abandon() {
  provider_.keeps_ownership = true;
  instance_->abandon();
}

Result<VkCommandBuffer> Device::acquire_command_buffer() {
  VkCommandBuffer buffer = VK_NULL_HANDLE;
  if (!idle_commands_.empty()) {
    buffer = idle_commands_.back();
    idle_commands_.pop_back();
    return buffer;
  }
  VkCommandBufferAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  CATENA_VK(vkAllocateCommandBuffers(device_, &allocate, &buffer), "allocate a command buffer");
  return buffer;
}

void Device::release_command_buffer(VkCommandBuffer buffer) {
  if (vkResetCommandBuffer(buffer, VK_COMMAND_BUFFER_RESET_RELEASE_RESOURCES_BIT) == VK_SUCCESS) {
    idle_commands_.push_back(buffer);
  } else {
    vkFreeCommandBuffers(device_, pool_, 1, &buffer);
  }
}

Result<std::uint64_t> Device::submit(VkCommandBuffer commands, VkSemaphore wait_for, VkSemaphore signal) {
  VkCommandBufferSubmitInfo buffer{};
  buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  buffer.commandBuffer = commands;
  VkSemaphoreSubmitInfo wait_info{};
  wait_info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  wait_info.semaphore = wait_for;
  wait_info.stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  VkSemaphoreSubmitInfo signals[2]{};
  for (auto& s : signals) {
    s.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
    s.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  }
  signals[0].semaphore = timeline_;
  signals[0].value = submitted_value_ + 1;
  signals[1].semaphore = signal;
  VkSubmitInfo2 info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
  info.waitSemaphoreInfoCount = wait_for ? 1 : 0;
  info.pWaitSemaphoreInfos = &wait_info;
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &buffer;
  info.signalSemaphoreInfoCount = signal ? 2 : 1;
  info.pSignalSemaphoreInfos = signals;
  VkResult result = is_lost_ ? VK_ERROR_DEVICE_LOST : injected_failure(DriverCall::submit);
  if (result == VK_SUCCESS) {
    const auto turn = lock_queue();
    result = vkQueueSubmit2(queue_, 1, &info, VK_NULL_HANDLE);
  }
  if (result != VK_SUCCESS) return failed(result, "submit work to " + info_.name);
  ++counters_.submissions;
  return ++submitted_value_;
}

Outcome Device::wait(std::uint64_t value) {
  if (value > completed_value_) {
    VkSemaphoreWaitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &value;
    // no wait on a lost device: the value may never be signaled
    VkResult result = is_lost_ ? VK_ERROR_DEVICE_LOST : injected_failure(DriverCall::wait);
    if (result == VK_SUCCESS) result = vkWaitSemaphores(device_, &info, std::numeric_limits<std::uint64_t>::max());
    if (result != VK_SUCCESS) return failed(result, "wait for " + info_.name);
    completed_value_ = value;
  }
  destroy_retired();
  return Done{};
}

void Device::retire(std::function<void()> destroy) {
  retired_.push_back({submitted_value_, std::move(destroy)});
  destroy_retired();
}

void Device::destroy_retired() {
  while (!retired_.empty() && retired_.front().value <= completed_value_) {
    auto destroy = std::move(retired_.front().destroy);
    retired_.pop_front();
    destroy();
  }
}

Result<std::vector<std::string>> list_devices() {
  CATENA_TRY(const auto instance, Instance::create(false, {}));
  CATENA_TRY(const auto devices, physical_devices(instance->handle()));
  std::vector<std::string> lines;
  for (VkPhysicalDevice device : devices) {
    VkPhysicalDeviceProperties p{};
    vkGetPhysicalDeviceProperties(device, &p);
    const std::string missing = missing_requirement(device);
    lines.push_back(fmt::format("{} ({}), Vulkan {}.{}{}", p.deviceName, type_name(p.deviceType), VK_API_VERSION_MAJOR(p.apiVersion),
                                VK_API_VERSION_MINOR(p.apiVersion), missing.empty() ? "" : ", unusable: no " + missing));
  }
  return lines;
}

void ShaderReplacements::replace(Spirv embedded, std::vector<std::uint32_t> words) {
  std::erase_if(replacements_, [&](const auto& one) { return std::ranges::equal(one.first, embedded); });
  if (!std::ranges::equal(embedded, words)) replacements_.emplace_back(embedded, std::move(words));
}

Spirv ShaderReplacements::resolve(Spirv embedded) const {
  for (const auto& [from, to] : replacements_)
    if (std::ranges::equal(from, embedded)) return to;
  return embedded;
}

std::vector<std::uint32_t> declared_bindings(Spirv words) {
  constexpr std::uint32_t kOpDecorate = 71, kBinding = 33, kHeader = 5;
  std::vector<std::uint32_t> found;
  for (std::size_t i = kHeader; i < words.size(); i += words[i] >> 16) {
    const std::uint32_t length = words[i] >> 16;
    if (length == 0 || i + length > words.size()) break;
    if ((words[i] & 0xffff) == kOpDecorate && length == 4 && words[i + 2] == kBinding) found.push_back(words[i + 3]);
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace catena::render::vk
