// SPDX-License-Identifier: MIT
#include "render/xr/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace catena::render::xr {

namespace {

constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;

bool is_among(const std::vector<XrExtensionProperties>& all, const char* name) {
  return std::ranges::any_of(all, [&](const XrExtensionProperties& one) { return std::strcmp(one.extensionName, name) == 0; });
}

}  // namespace

Error Instance::failed(XrResult result, const std::string& what) {
  const bool instance = result == XR_ERROR_INSTANCE_LOST || result == XR_ERROR_RUNTIME_FAILURE || result == XR_ERROR_RUNTIME_UNAVAILABLE ||
                        result == XR_ERROR_HANDLE_INVALID;
  loss_ = std::max(loss_, instance ? Loss::instance : Loss::session);
  return xr_error(result, what);
}

void Instance::abandon() {
  loss_ = Loss::instance;
  dispatch_.disable_destruction();
  loader_->keep_loaded();
}

Result<std::unique_ptr<Instance>> Instance::open(const char* library) {
  std::unique_ptr<Instance> self(new Instance);
  CATENA_TRY(self->loader_, Loader::open(library));
  self->dispatch_ = self->loader_->dispatch();
  CATENA_CHECK(self->create());
  CATENA_CHECK(self->dispatch_.load(self->instance_));
  CATENA_CHECK(self->query_system());
  return self;
}

Instance::~Instance() {
  if (instance_ && dispatch_.DestroyInstance) (void)dispatch_.DestroyInstance(instance_);
}

Outcome Instance::create() {
  std::uint32_t count = 0;
  CATENA_XR_CHECK(*this, dispatch_.EnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr), "list its extensions");
  std::vector<XrExtensionProperties> offered(count, {XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0});
  CATENA_XR_CHECK(*this, dispatch_.EnumerateInstanceExtensionProperties(nullptr, count, &count, offered.data()), "list its extensions");
  if (!is_among(offered, XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME))
    return Error{"the headset's runtime does not support Vulkan, expected the extension " XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME};

  std::vector<const char*> requested{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME};
  const auto take = [&](const char* name) {
    const bool there = is_among(offered, name);
    if (there) requested.push_back(name);
    return there;
  };
  capabilities_.depth = take(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
  capabilities_.visibility_mask = take(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME);
  capabilities_.clock = take(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  capabilities_.gaze = take(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);

  XrInstanceCreateInfo info{};
  info.type = XR_TYPE_INSTANCE_CREATE_INFO;
  std::strcpy(info.applicationInfo.applicationName, "catena");
  std::strcpy(info.applicationInfo.engineName, "catena");
  info.applicationInfo.applicationVersion = info.applicationInfo.engineVersion = 1;
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = std::uint32_t(requested.size());
  info.enabledExtensionNames = requested.data();
  CATENA_XR_CHECK(*this, dispatch_.CreateInstance(&info, &instance_), "be connected");
  return Done{};
}

Outcome Instance::query_system() {
  XrInstanceProperties runtime{};
  runtime.type = XR_TYPE_INSTANCE_PROPERTIES;
  CATENA_XR_CHECK(*this, dispatch_.GetInstanceProperties(instance_, &runtime), "report its runtime");
  XrSystemGetInfo requested{};
  requested.type = XR_TYPE_SYSTEM_GET_INFO;
  requested.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  CATENA_XR_CHECK(*this, dispatch_.GetSystem(instance_, &requested, &system_), "be found");
  XrSystemProperties system{};
  system.type = XR_TYPE_SYSTEM_PROPERTIES;
  XrSystemEyeGazeInteractionPropertiesEXT eyes{};
  eyes.type = XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT;
  if (capabilities_.gaze) system.next = &eyes;
  CATENA_XR_CHECK(*this, dispatch_.GetSystemProperties(instance_, system_, &system), "report its properties");
  capabilities_.gaze = capabilities_.gaze && eyes.supportsEyeGazeInteraction;
  name_ = std::string(runtime.runtimeName) + ", " + system.systemName;

  std::uint32_t count = 0;
  CATENA_XR_CHECK(*this, dispatch_.EnumerateViewConfigurationViews(instance_, system_, kStereo, 0, &count, nullptr),
                  "report its view sizes");
  constexpr std::uint32_t kMaxViews = 64;
  if (count > kMaxViews) return Error{fmt::format("the headset {} has {} views, expected at most {}", name_, count, kMaxViews)};
  XrViewConfigurationView view{};
  view.type = XR_TYPE_VIEW_CONFIGURATION_VIEW;
  std::vector<XrViewConfigurationView> views(count, view);
  CATENA_XR_CHECK(*this, dispatch_.EnumerateViewConfigurationViews(instance_, system_, kStereo, count, &count, views.data()),
                  "report its view sizes");
  views.resize(std::min<std::size_t>(views.size(), count));
  for (const XrViewConfigurationView& one : views)
    view_sizes_.push_back({std::clamp(one.recommendedImageRectWidth, 1u, std::max(1u, one.maxImageRectWidth)),
                           std::clamp(one.recommendedImageRectHeight, 1u, std::max(1u, one.maxImageRectHeight))});
  if (view_sizes_.empty()) return Error{"the headset " + name_ + " has no views, expected two"};

  // opaque if available: on a see-through display black is transparent
  CATENA_XR_CHECK(*this, dispatch_.EnumerateEnvironmentBlendModes(instance_, system_, kStereo, 0, &count, nullptr), "list its blend modes");
  std::vector<XrEnvironmentBlendMode> modes(count);
  CATENA_XR_CHECK(*this, dispatch_.EnumerateEnvironmentBlendModes(instance_, system_, kStereo, count, &count, modes.data()),
                  "list its blend modes");
  if (modes.empty()) return Error{"the headset " + name_ + " has no blend mode, expected one"};
  blend_mode_ = std::ranges::find(modes, XR_ENVIRONMENT_BLEND_MODE_OPAQUE) != modes.end() ? XR_ENVIRONMENT_BLEND_MODE_OPAQUE : modes[0];
  return Done{};
}

}  // namespace catena::render::xr
