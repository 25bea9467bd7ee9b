// SPDX-License-Identifier: MIT
/// The only place that includes OpenXR. Its functions come from the loader library, which is opened when a headset is requested (never
/// linked): a machine without it gets a one-line Error. Every XrResult becomes a Result with a one-line message. Frame thread.
#pragma once
#include <time.h>
#include <vulkan/vulkan.h>

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <memory>
#include <string>

#include "engine/base/result.h"

/// OpenXR functions by how they are obtained: without an instance; from every instance; from instances with the extension enabled.
#define CATENA_XR_GLOBAL(X) X(EnumerateInstanceExtensionProperties) X(CreateInstance)
// clang-format off
#define CATENA_XR_CORE(X) \
  X(DestroyInstance) X(GetInstanceProperties) X(PollEvent) X(GetSystem) X(GetSystemProperties) \
  X(EnumerateViewConfigurations) X(EnumerateViewConfigurationViews) X(EnumerateEnvironmentBlendModes) \
  X(CreateSession) X(DestroySession) X(BeginSession) X(EndSession) X(RequestExitSession) \
  X(EnumerateReferenceSpaces) X(CreateReferenceSpace) X(DestroySpace) X(LocateSpace) \
  X(EnumerateSwapchainFormats) X(CreateSwapchain) X(DestroySwapchain) X(EnumerateSwapchainImages) \
  X(AcquireSwapchainImage) X(WaitSwapchainImage) X(ReleaseSwapchainImage) X(WaitFrame) X(BeginFrame) \
  X(EndFrame) X(LocateViews) X(StringToPath) X(PathToString) X(CreateActionSet) X(DestroyActionSet) \
  X(CreateAction) X(SuggestInteractionProfileBindings) X(AttachSessionActionSets) X(CreateActionSpace) \
  X(SyncActions) X(GetActionStateBoolean) X(GetActionStateFloat) X(GetActionStateVector2f) \
  X(GetActionStatePose) X(GetCurrentInteractionProfile) X(ApplyHapticFeedback) X(StopHapticFeedback)
// clang-format on
#define CATENA_XR_VULKAN(X) \
  X(GetVulkanGraphicsRequirements2KHR) X(CreateVulkanInstanceKHR) X(GetVulkanGraphicsDevice2KHR) X(CreateVulkanDeviceKHR)
#define CATENA_XR_OPTIONAL(X) X(GetVisibilityMaskKHR) X(ConvertTimespecTimeToTimeKHR)

namespace catena::render::xr {

/// Returns the name of a result code, for instance "XR_ERROR_INSTANCE_LOST".
const char* result_name(XrResult result);
/// Returns an error "the headset could not WHAT: XR_ERROR_...".
Error xr_error(XrResult result, const std::string& what);

/// Function pointers of OpenXR.
struct DispatchTable {
  PFN_xrGetInstanceProcAddr GetInstanceProcAddr = nullptr;
#define CATENA_XR_MEMBER(name) PFN_xr##name name = nullptr;
  CATENA_XR_GLOBAL(CATENA_XR_MEMBER)
  CATENA_XR_CORE(CATENA_XR_MEMBER)
  CATENA_XR_VULKAN(CATENA_XR_MEMBER)
  CATENA_XR_OPTIONAL(CATENA_XR_MEMBER)
#undef CATENA_XR_MEMBER

  /// Loads the functions of an instance with XR_KHR_vulkan_enable2; optional functions stay null if their extension was not enabled.
  Outcome load(XrInstance instance);
  /// Makes all destroy functions do nothing and report success, as the runtime does not return from a call.
  void disable_destruction();
};

/// Loader library, open as long as this object exists.
class Loader {
 public:
  /// Opens the library. A one-line Error if it is missing or unusable.
  static Result<std::unique_ptr<Loader>> open(const char* library = "libopenxr_loader.so.1");
  ~Loader();
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;
  /// Returns a table with the global functions.
  const DispatchTable& dispatch() const { return dispatch_; }
  /// Keeps the library open forever.
  void keep_loaded() { library_ = nullptr; }

 private:
  Loader() = default;
  void* library_ = nullptr;
  DispatchTable dispatch_;
};

}  // namespace catena::render::xr
