// SPDX-License-Identifier: MIT
#include "tests/xr_runtime/runtime.h"

#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

namespace catena::test::xr_runtime {

namespace {

constexpr const char* kExtensions[] = {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME,
                                       XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME,
                                       XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME};

XrView scripted_view(float x, float turn, float left, float right) {
  XrView view{};
  view.type = XR_TYPE_VIEW;
  view.pose.position = {x, 0.02f, 0.01f};
  view.pose.orientation = {0, std::sin(turn / 2), 0, std::cos(turn / 2)};
  view.fov = {left, right, 0.7f, -0.85f};
  return view;
}

/// A view canted outwards by 5 degrees, with a wider outer angle.
Script first_script() {
  Script script;
  script.views = {scripted_view(-0.032f, 0.087f, -0.9f, 0.75f), scripted_view(0.032f, -0.087f, -0.75f, 0.9f)};
  script.unsupported = {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME};
  return script;
}

std::string& record_path() {
  static std::string path;
  return path;
}

void write_record() {
  const Record& r = world().shared.record;
  std::FILE* file = std::fopen(record_path().c_str(), "w");
  if (!file) return;
  std::fprintf(file, "frames %llu\nquads %llu\npictures %llu\nmoved %llu\nillegal %zu\nobjects %llu\nvibrations %zu\n",
               (unsigned long long)r.frames, (unsigned long long)r.quads, (unsigned long long)r.projection_frames,
               (unsigned long long)r.moved_poses, r.illegal.size(), (unsigned long long)r.objects, r.vibrations.size());
  for (const std::string& line : r.illegal) std::fprintf(file, "# %s\n", line.c_str());
  std::fclose(file);
}

XrSessionState state_named(const std::string& word) {
  for (const auto& [name, state] : std::map<std::string, XrSessionState>{{"IDLE", XR_SESSION_STATE_IDLE},
                                                                         {"READY", XR_SESSION_STATE_READY},
                                                                         {"SYNCHRONIZED", XR_SESSION_STATE_SYNCHRONIZED},
                                                                         {"VISIBLE", XR_SESSION_STATE_VISIBLE},
                                                                         {"FOCUSED", XR_SESSION_STATE_FOCUSED},
                                                                         {"STOPPING", XR_SESSION_STATE_STOPPING},
                                                                         {"LOSS_PENDING", XR_SESSION_STATE_LOSS_PENDING},
                                                                         {"EXITING", XR_SESSION_STATE_EXITING}})
    if (name == word) return state;
  return XR_SESSION_STATE_UNKNOWN;
}

}  // namespace

RuntimeState& world() {
  static RuntimeState* one = [] {
    auto* made = new RuntimeState;  // never destroyed, so that it outlives exit handlers
    made->shared.script = first_script();
    return made;
  }();
  return *one;
}

void read_environment() {
  static bool done = false;
  const char* words = std::getenv("CATENA_XR_SCRIPT");
  if (std::exchange(done, true) || !words) return;
  Script& script = world().shared.script;
  std::istringstream in(words);
  for (std::string word; in >> word;) {
    const auto equals = word.find('=');
    const std::string key = word.substr(0, equals), value = equals == std::string::npos ? "" : word.substr(equals + 1);
    const auto colon = value.find(':');
    if (key == "fail") {
      const auto second = value.find(':', colon + 1);
      script.failures[value.substr(0, colon)] = {std::atoi(value.c_str() + colon + 1), XrResult(std::atoi(value.c_str() + second + 1))};
    }
    if (key == "size") std::sscanf(value.c_str(), "%ux%u", &script.width, &script.height);
    if (key == "period_ms") script.period_ns = std::int64_t(1e6 * std::atof(value.c_str()));
    if (key == "state") script.states.emplace(std::strtoull(value.c_str(), nullptr, 10), state_named(value.substr(colon + 1)));
    if (key == "without") script.unsupported.insert(value);
    if (key == "with") script.unsupported.erase(value);
    if (key == "menu") {
      script.menu_from = std::strtoull(value.c_str(), nullptr, 10);
      script.menu_to = std::strtoull(value.c_str() + colon + 1, nullptr, 10);
    }
    if (key == "gaze") {
      double right = 0, up = 0;
      std::sscanf(value.c_str(), "%lf:%lf", &right, &up);
      const double yaw = -std::atan(right), pitch = std::atan(up / std::hypot(1, right));
      const double sy = std::sin(yaw / 2), cy = std::cos(yaw / 2), sx = std::sin(pitch / 2), cx = std::cos(pitch / 2);
      script.gaze = XrPosef{{float(cy * sx), float(sy * cx), float(-sy * sx), float(cy * cx)}, {0, 0, 0}};
    }
    if (key == "head") {
      XrVector3f by{0, 0, 0};
      std::sscanf(value.c_str(), "%f:%f:%f", &by.x, &by.y, &by.z);
      for (XrView& view : script.views) {
        view.pose.position.x += by.x;
        view.pose.position.y += by.y;
        view.pose.position.z += by.z;
      }
    }
    if (XrVector3f& at = script.stage.position; key == "stage") std::sscanf(value.c_str(), "%f:%f:%f", &at.x, &at.y, &at.z);
    if (XrVector3f at{}; key == "grip" && std::sscanf(value.c_str() + colon + 1, "%f:%f:%f", &at.x, &at.y, &at.z) == 3)
      script.grip_path[std::strtoull(value.c_str(), nullptr, 10)] = at;
    if (key == "select")
      script.select_frames.emplace_back(std::strtoull(value.c_str(), nullptr, 10), std::strtoull(value.c_str() + colon + 1, nullptr, 10));
    if (key == "paced") script.sleeps_in_wait = true;
    if (key == "hang")
      script.slow_wait = {std::strtoull(value.c_str(), nullptr, 10), std::int64_t(1e6 * std::atof(value.c_str() + colon + 1))};
    if (key == "record") {
      record_path() = value;
      std::atexit(write_record);
    }
  }
}

std::uint64_t RuntimeState::add(std::unique_ptr<Object> object) {
  objects.emplace(++last_handle, std::move(object));
  shared.record.objects = objects.size();
  return last_handle;
}

void RuntimeState::remove(std::uint64_t handle) {
  std::vector<std::uint64_t> children;
  for (const auto& [one, object] : objects)
    if (object->parent == handle) children.push_back(one);
  for (const std::uint64_t child : children) remove(child);
  objects.erase(handle);
  shared.record.objects = objects.size();
}

std::optional<XrResult> enter(const char* function) {
  SharedState& stage = world().shared;
  const std::uint64_t call = ++stage.record.calls[function];
  const auto it = stage.script.failures.find(function);
  if (it == stage.script.failures.end() || call != std::uint64_t(it->second.at)) return std::nullopt;
  return it->second.result;
}

XrResult illegal(const char* function, XrResult result, const std::string& why) {
  world().shared.record.illegal.push_back(std::string(function) + ": " + why);
  return result;
}

XrTime clock_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return XrTime(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void post_state(std::uint64_t handle, SessionObject& session, XrSessionState state) {
  session.state = state;
  world().shared.record.states.push_back(state);
  auto* instance = world().find<InstanceObject>(session.parent, Kind::instance);
  XrEventDataBuffer buffer{};
  auto& event = reinterpret_cast<XrEventDataSessionStateChanged&>(buffer);
  event.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  event.session = as_handle<XrSession>(handle);
  event.state = state;
  event.time = clock_now();
  instance->events.push_back(buffer);
}

namespace {

XRAPI_ATTR XrResult XRAPI_CALL enumerate_extensions(const char* layer, std::uint32_t capacity, std::uint32_t* count,
                                                    XrExtensionProperties* out) {
  ENTER(xrEnumerateInstanceExtensionProperties);
  if (layer) return XR_ERROR_API_LAYER_NOT_PRESENT;
  read_environment();
  std::vector<XrExtensionProperties> all;
  for (const char* name : kExtensions) {
    if (world().shared.script.unsupported.contains(name)) continue;
    XrExtensionProperties one{};
    one.type = XR_TYPE_EXTENSION_PROPERTIES;
    std::strncpy(one.extensionName, name, sizeof one.extensionName - 1);
    one.extensionVersion = 1;
    all.push_back(one);
  }
  return fill(all, capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL create_instance(const XrInstanceCreateInfo* info, XrInstance* made) {
  ENTER(xrCreateInstance);
  auto instance = std::make_unique<InstanceObject>();
  for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
    if (world().shared.script.unsupported.contains(info->enabledExtensionNames[i])) return XR_ERROR_EXTENSION_NOT_PRESENT;
    instance->extensions.insert(info->enabledExtensionNames[i]);
  }
  *made = as_handle<XrInstance>(world().add(std::move(instance)));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL destroy_instance(XrInstance handle) {
  ENTER_TO_DESTROY(xrDestroyInstance);
  FIND(InstanceObject, instance, handle, instance);
  world().remove(number(handle));
  return answer;
}

XRAPI_ATTR XrResult XRAPI_CALL instance_properties(XrInstance handle, XrInstanceProperties* out) {
  ENTER(xrGetInstanceProperties);
  FIND(InstanceObject, instance, handle, instance);
  out->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::strcpy(out->runtimeName, "scripted runtime");
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL poll_event(XrInstance handle, XrEventDataBuffer* out) {
  ENTER(xrPollEvent);
  FIND(InstanceObject, instance, handle, instance);
  if (out->type != XR_TYPE_EVENT_DATA_BUFFER) return illegal(self, XR_ERROR_VALIDATION_FAILURE, "the buffer has another type");
  if (instance->events.empty()) return XR_EVENT_UNAVAILABLE;
  *out = instance->events.front();
  instance->events.pop_front();
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL get_system(XrInstance handle, const XrSystemGetInfo* info, XrSystemId* system) {
  ENTER(xrGetSystem);
  FIND(InstanceObject, instance, handle, instance);
  if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  *system = 1;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL system_properties(XrInstance handle, XrSystemId system, XrSystemProperties* out) {
  ENTER(xrGetSystemProperties);
  FIND(InstanceObject, instance, handle, instance);
  if (system != 1) return illegal(self, XR_ERROR_SYSTEM_INVALID, "no such system");
  out->systemId = 1;
  std::strcpy(out->systemName, "scripted headset");
  out->graphicsProperties = {8192, 8192, 16};
  out->trackingProperties = {XR_TRUE, XR_TRUE};
  for (auto* next = static_cast<XrBaseOutStructure*>(out->next); next; next = next->next)
    if (next->type == XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT)
      reinterpret_cast<XrSystemEyeGazeInteractionPropertiesEXT*>(next)->supportsEyeGazeInteraction = world().shared.script.supports_gaze;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL view_configurations(XrInstance handle, XrSystemId, std::uint32_t capacity, std::uint32_t* count,
                                                   XrViewConfigurationType* out) {
  ENTER(xrEnumerateViewConfigurations);
  FIND(InstanceObject, instance, handle, instance);
  return fill(std::vector{XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO}, capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL view_configuration_properties(XrInstance handle, XrSystemId, XrViewConfigurationType type,
                                                             XrViewConfigurationProperties* out) {
  ENTER(xrGetViewConfigurationProperties);
  FIND(InstanceObject, instance, handle, instance);
  out->viewConfigurationType = type;
  out->fovMutable = XR_FALSE;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL views(XrInstance handle, XrSystemId, XrViewConfigurationType type, std::uint32_t capacity,
                                     std::uint32_t* count, XrViewConfigurationView* out) {
  ENTER(xrEnumerateViewConfigurationViews);
  FIND(InstanceObject, instance, handle, instance);
  if (type != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO) return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
  const Script& script = world().shared.script;
  XrViewConfigurationView one{};
  one.type = XR_TYPE_VIEW_CONFIGURATION_VIEW;
  one.recommendedImageRectWidth = script.width;
  one.recommendedImageRectHeight = script.height;
  one.maxImageRectWidth = one.maxImageRectHeight = 8192;
  one.recommendedSwapchainSampleCount = one.maxSwapchainSampleCount = 1;
  return fill(std::vector(script.views.size(), one), capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL blend_modes(XrInstance handle, XrSystemId, XrViewConfigurationType, std::uint32_t capacity,
                                           std::uint32_t* count, XrEnvironmentBlendMode* out) {
  ENTER(xrEnumerateEnvironmentBlendModes);
  FIND(InstanceObject, instance, handle, instance);
  return fill(std::vector{XR_ENVIRONMENT_BLEND_MODE_OPAQUE}, capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL result_to_string(XrInstance, XrResult value, char out[XR_MAX_RESULT_STRING_SIZE]) {
  ENTER(xrResultToString);
  std::snprintf(out, XR_MAX_RESULT_STRING_SIZE, "XR_RESULT_%d", int(value));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL string_to_path(XrInstance handle, const char* text, XrPath* out) {
  ENTER(xrStringToPath);
  FIND(InstanceObject, instance, handle, instance);
  for (std::size_t i = 1; i < instance->paths.size(); ++i)
    if (instance->paths[i] == text) {
      *out = i;
      return XR_SUCCESS;
    }
  instance->paths.emplace_back(text);
  *out = instance->paths.size() - 1;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL path_to_string(XrInstance handle, XrPath path, std::uint32_t capacity, std::uint32_t* count, char* out) {
  ENTER(xrPathToString);
  FIND(InstanceObject, instance, handle, instance);
  if (path == 0 || path >= instance->paths.size()) return illegal(self, XR_ERROR_PATH_INVALID, "no such path");
  const std::string& text = instance->paths[path];
  return fill(std::vector<char>(text.c_str(), text.c_str() + text.size() + 1), capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL timespec_to_time(XrInstance handle, const timespec* at, XrTime* out) {
  ENTER(xrConvertTimespecTimeToTimeKHR);
  FIND(InstanceObject, instance, handle, instance);
  *out = XrTime(at->tv_sec) * 1'000'000'000 + at->tv_nsec;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL vulkan_requirements(XrInstance handle, XrSystemId, XrGraphicsRequirementsVulkan2KHR* out) {
  ENTER(xrGetVulkanGraphicsRequirements2KHR);
  FIND(InstanceObject, instance, handle, instance);
  instance->requirements_queried = true;
  out->minApiVersionSupported = XR_MAKE_VERSION(1, 0, 0);
  out->maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL vulkan_instance(XrInstance handle, const XrVulkanInstanceCreateInfoKHR* info, VkInstance* made,
                                               VkResult* result) {
  ENTER(xrCreateVulkanInstanceKHR);
  FIND(InstanceObject, instance, handle, instance);
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(info->pfnGetInstanceProcAddr(VK_NULL_HANDLE, "vkCreateInstance"));
  *result = create(info->vulkanCreateInfo, info->vulkanAllocator, made);
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL vulkan_physical(XrInstance handle, const XrVulkanGraphicsDeviceGetInfoKHR* info, VkPhysicalDevice* out) {
  ENTER(xrGetVulkanGraphicsDevice2KHR);
  FIND(InstanceObject, instance, handle, instance);
  std::uint32_t one = 1;
  const VkResult found = vkEnumeratePhysicalDevices(info->vulkanInstance, &one, out);
  return found == VK_SUCCESS || found == VK_INCOMPLETE ? XR_SUCCESS : XR_ERROR_RUNTIME_FAILURE;
}

XRAPI_ATTR XrResult XRAPI_CALL vulkan_device(XrInstance handle, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* made, VkResult* result) {
  ENTER(xrCreateVulkanDeviceKHR);
  FIND(InstanceObject, instance, handle, instance);
  // as in Monado: enables timeline semaphores unless the program configures them
  VkDeviceCreateInfo own = *info->vulkanCreateInfo;
  VkPhysicalDeviceTimelineSemaphoreFeatures timeline{};
  timeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  timeline.timelineSemaphore = VK_TRUE;
  bool there = false;
  for (auto* one = static_cast<const VkBaseInStructure*>(own.pNext); one; one = one->pNext) there = there || one->sType == timeline.sType;
  if (!there) {
    timeline.pNext = const_cast<void*>(own.pNext);
    own.pNext = &timeline;
  }
  *result = vkCreateDevice(info->vulkanPhysicalDevice, &own, info->vulkanAllocator, made);
  return XR_SUCCESS;
}

PFN_xrVoidFunction find_instance_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrEnumerateInstanceExtensionProperties", reinterpret_cast<PFN_xrVoidFunction>(enumerate_extensions)},
      {"xrCreateInstance", reinterpret_cast<PFN_xrVoidFunction>(create_instance)},
      {"xrDestroyInstance", reinterpret_cast<PFN_xrVoidFunction>(destroy_instance)},
      {"xrGetInstanceProperties", reinterpret_cast<PFN_xrVoidFunction>(instance_properties)},
      {"xrPollEvent", reinterpret_cast<PFN_xrVoidFunction>(poll_event)},
      {"xrGetSystem", reinterpret_cast<PFN_xrVoidFunction>(get_system)},
      {"xrGetSystemProperties", reinterpret_cast<PFN_xrVoidFunction>(system_properties)},
      {"xrEnumerateViewConfigurations", reinterpret_cast<PFN_xrVoidFunction>(view_configurations)},
      {"xrGetViewConfigurationProperties", reinterpret_cast<PFN_xrVoidFunction>(view_configuration_properties)},
      {"xrEnumerateViewConfigurationViews", reinterpret_cast<PFN_xrVoidFunction>(views)},
      {"xrEnumerateEnvironmentBlendModes", reinterpret_cast<PFN_xrVoidFunction>(blend_modes)},
      {"xrResultToString", reinterpret_cast<PFN_xrVoidFunction>(result_to_string)},
      {"xrStringToPath", reinterpret_cast<PFN_xrVoidFunction>(string_to_path)},
      {"xrPathToString", reinterpret_cast<PFN_xrVoidFunction>(path_to_string)},
      {"xrConvertTimespecTimeToTimeKHR", reinterpret_cast<PFN_xrVoidFunction>(timespec_to_time)},
      {"xrGetVulkanGraphicsRequirements2KHR", reinterpret_cast<PFN_xrVoidFunction>(vulkan_requirements)},
      {"xrCreateVulkanInstanceKHR", reinterpret_cast<PFN_xrVoidFunction>(vulkan_instance)},
      {"xrGetVulkanGraphicsDevice2KHR", reinterpret_cast<PFN_xrVoidFunction>(vulkan_physical)},
      {"xrCreateVulkanDeviceKHR", reinterpret_cast<PFN_xrVoidFunction>(vulkan_device)}};
  const auto it = all.find(name);
  return it == all.end() ? nullptr : it->second;
}

XRAPI_ATTR XrResult XRAPI_CALL get_proc_addr(XrInstance, const char* name, PFN_xrVoidFunction* out) {
  *out = nullptr;
  if (std::strcmp(name, "xrGetInstanceProcAddr") == 0) *out = reinterpret_cast<PFN_xrVoidFunction>(get_proc_addr);
  for (const auto find : {find_instance_function, find_session_function, find_swapchain_function, find_action_function})
    if (!*out) *out = find(name);
  return *out ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

}  // namespace

}  // namespace catena::test::xr_runtime

// negotiation structures of the loader, missing in its headers of this version
extern "C" {

struct XrNegotiateLoaderInfo {
  int structType;
  std::uint32_t structVersion;
  std::size_t structSize;
  std::uint32_t minInterfaceVersion, maxInterfaceVersion;
  XrVersion minApiVersion, maxApiVersion;
};
struct XrNegotiateRuntimeRequest {
  int structType;
  std::uint32_t structVersion;
  std::size_t structSize;
  std::uint32_t runtimeInterfaceVersion;
  XrVersion runtimeApiVersion;
  PFN_xrGetInstanceProcAddr getInstanceProcAddr;
};

__attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(const XrNegotiateLoaderInfo* loader,
                                                                                  XrNegotiateRuntimeRequest* runtime) {
  if (!loader || !runtime || loader->minInterfaceVersion > 1 || loader->maxInterfaceVersion < 1) return XR_ERROR_INITIALIZATION_FAILED;
  runtime->runtimeInterfaceVersion = 1;
  runtime->runtimeApiVersion = XR_MAKE_VERSION(1, 0, 0);
  runtime->getInstanceProcAddr = catena::test::xr_runtime::get_proc_addr;
  return XR_SUCCESS;
}

__attribute__((visibility("default"))) catena::test::xr_runtime::SharedState* catena_xr_stage() {
  return &catena::test::xr_runtime::world().shared;
}

__attribute__((visibility("default"))) void catena_xr_reset() {
  auto& world = catena::test::xr_runtime::world();
  world.shared = {};
  world.shared.script = catena::test::xr_runtime::first_script();
  world.shared.record.objects = world.objects.size();
}
}
