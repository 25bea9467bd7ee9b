/// The connection to a headset's runtime: instance, system (the headset itself), what it offers, and who makes Vulkan's objects for it.
///   needed:   XR_KHR_vulkan_enable2, two views (or however many the primary stereo configuration has), an opaque or other blend mode
///   optional: depth layers, visibility masks, clock conversion, eye gaze; used where `has` says so
/// What cannot be had is one sentence. XR_ERROR_INSTANCE_LOST and a runtime that fails make `loss()` tell so: then everything that hangs
/// on this instance is to be destroyed, and another one may be opened later. Frame thread.
#pragma once
#include <mutex>
#include <vector>

#include "render/vk/instance.h"
#include "render/xr/xr_loader.h"

namespace catena::render::xr {

/// What has gone for good and has to be made again.
enum class Loss { none, session, instance };

/// Of one view, as the headset recommends.
struct ViewSize {
  std::uint32_t width = 0, height = 0;
};

struct Capabilities {
  bool depth = false;            ///< XR_KHR_composition_layer_depth
  bool visibility_mask = false;  ///< XR_KHR_visibility_mask
  bool clock = false;            ///< XR_KHR_convert_timespec_time
  bool gaze = false;             ///< XR_EXT_eye_gaze_interaction, and a headset that sees the eyes
};

class Instance {
 public:
  static Result<std::unique_ptr<Instance>> open(const char* library = "libopenxr_loader.so.1");
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  XrInstance handle() const { return instance_; }
  XrSystemId system() const { return system_; }
  const DispatchTable& dispatch() const { return dispatch_; }
  const Capabilities& capabilities() const { return capabilities_; }
  const std::vector<ViewSize>& view_sizes() const { return view_sizes_; }  ///< at least one
  XrEnvironmentBlendMode blend_mode() const { return blend_mode_; }
  /// "RUNTIME, HEADSET".
  const std::string& name() const { return name_; }

  /// For vk::DeviceOptions: the runtime makes instance and device, Catena owns them. The lock is held around every use of the queue and
  /// outlives the device; the functions are called while this lives.
  vk::VulkanProvider vulkan_provider(std::mutex& queue_lock);

  /// The error of a call, which is remembered where it means a loss.
  Error failed(XrResult result, const std::string& what);
  Loss loss() const { return loss_; }
  /// The runtime does not come back from a call: it is lost, and nothing of it is ever destroyed.
  void abandon();
  /// The session has been made again.
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

/// Returns an error from the function around it unless the call succeeds; `instance` remembers losses.
#define CATENA_XR_CHECK(instance, call, what) \
  if (const XrResult xr_result = (call); XR_FAILED(xr_result)) return (instance).failed(xr_result, what)
