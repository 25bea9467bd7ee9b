/// The one place that includes OpenXR. Its functions come from the loader, which is opened when a headset is asked for (never linked), so
/// that a machine without it says one sentence. Every XrResult becomes a Result with one sentence. Frame thread.
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

/// Without an instance; of every instance; of instances whose extension was asked for.
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

const char* result_name(XrResult result);
/// "the headset could not WHAT: XR_ERROR_..."
Error xr_error(XrResult result, const std::string& what);

struct DispatchTable {
  PFN_xrGetInstanceProcAddr GetInstanceProcAddr = nullptr;
#define CATENA_XR_MEMBER(name) PFN_xr##name name = nullptr;
  CATENA_XR_GLOBAL(CATENA_XR_MEMBER)
  CATENA_XR_CORE(CATENA_XR_MEMBER)
  CATENA_XR_VULKAN(CATENA_XR_MEMBER)
  CATENA_XR_OPTIONAL(CATENA_XR_MEMBER)
#undef CATENA_XR_MEMBER

  /// Of an instance with XR_KHR_vulkan_enable2; an optional function stays empty where its extension was not asked for.
  Outcome load(XrInstance instance);
  /// From now on nothing is destroyed, and all that would be counts as destroyed: the runtime does not come back from a call.
  void disable_destruction();
};

/// The loader's library, kept open as long as this lives.
class Loader {
 public:
  static Result<std::unique_ptr<Loader>> open(const char* library = "libopenxr_loader.so.1");
  ~Loader();
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;
  /// With the global functions.
  const DispatchTable& dispatch() const { return dispatch_; }
  /// It stays open for good.
  void keep_loaded() { library_ = nullptr; }

 private:
  Loader() = default;
  void* library_ = nullptr;
  DispatchTable dispatch_;
};

}  // namespace catena::render::xr
