// SPDX-License-Identifier: MIT
/// Connection to a headset's runtime: instance, system (the headset itself), its capabilities, and the provider of Vulkan objects for it.
///   required: XR_KHR_vulkan_enable2, two views (or as many as the primary stereo configuration has), an opaque or other blend mode
///   optional: depth layers, visibility masks, clock conversion, eye gaze; used if capabilities() has them
/// Errors are one-line messages. XR_ERROR_INSTANCE_LOST and a runtime failure set loss(): then everything that depends on this instance
/// must be destroyed, and another one may be opened later. Frame thread.
#pragma once
#include <mutex>
#include <vector>

#include "render/vk/instance.h"
#include "render/xr/xr_loader.h"

namespace catena::render::xr {

/// Object that is lost and must be re-created: nothing, the session, or the instance with everything that depends on it.
enum class Loss { none, session, instance };

/// Recommended size of one view, pixels.
struct ViewSize {
  std::uint32_t width = 0, height = 0;
};

/// Optional capabilities of the runtime.
struct Capabilities {
  bool depth = false;            ///< XR_KHR_composition_layer_depth
  bool visibility_mask = false;  ///< XR_KHR_visibility_mask
  bool clock = false;            ///< XR_KHR_convert_timespec_time
  bool gaze = false;             ///< XR_EXT_eye_gaze_interaction, and the headset tracks the eyes
};

/// OpenXR instance and system.
class Instance {
 public:
  /// Opens the loader and connects to the runtime. A one-line Error if there is no loader, runtime or headset.
  static Result<std::unique_ptr<Instance>> open(const char* library = "libopenxr_loader.so.1");
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  XrInstance handle() const { return instance_; }
  XrSystemId system() const { return system_; }
  const DispatchTable& dispatch() const { return dispatch_; }
  const Capabilities& capabilities() const { return capabilities_; }
  const std::vector<ViewSize>& view_sizes() const { return view_sizes_; }  ///< recommended sizes by view; at least one
  XrEnvironmentBlendMode blend_mode() const { return blend_mode_; }
  /// Returns "RUNTIME, HEADSET".
  const std::string& name() const { return name_; }

  /// Returns the provider for vk::DeviceOptions: the runtime creates instance and device, Catena owns them. The lock is held around every
  /// use of the queue and must outlive the device; this object must exist while the provider's functions are called.
  vk::VulkanProvider vulkan_provider(std::mutex& queue_lock);

  /// Returns the error of a failed call; records a loss if the result implies one.
  Error failed(XrResult result, const std::string& what);
  Loss loss() const { return loss_; }
  /// Abandons the instance when the runtime does not return from a call: it counts as lost, and its objects are deliberately leaked.
  void abandon();
  /// Clears a session loss when the session has been re-created.
  void clear_session_loss() { loss_ = loss_ == Loss::session ? Loss::none : loss_; }

 private:
  Instance() = default;
  Outcome create();
  Outcome query_system();

  std::unique_ptr<Loader> loader_;
  DispatchTable dispatch_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  Capabilities capabilities_;
  std::vector<ViewSize> view_sizes_;
  XrEnvironmentBlendMode blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  std::string name_;
  Loss loss_ = Loss::none;
};

}  // namespace catena::render::xr

/// Returns an error from the enclosing function unless the call succeeds; `instance` records losses.
#define CATENA_XR_CHECK(instance, call, what) \
  if (const XrResult xr_result = (call); XR_FAILED(xr_result)) return (instance).failed(xr_result, what)
