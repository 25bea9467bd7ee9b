// SPDX-License-Identifier: MIT
/// Headset as seen by the program: opened before the Vulkan device (which its runtime creates), started on the device, then used frame by
/// frame.
///   auto headset = Headset::open();  options.provider = (*headset)->vulkan_provider(lock);  renderer = Renderer::create(options)
///   (*headset)->start(renderer->device());   while (..) { poll(); if (is_running()) { begin(); show(..); } }
/// After an error loss() states what must be re-created: for the session, stop() and start(); for the instance, another Headset and another
/// renderer, later, since the runtime may be unavailable for a while. Frame thread.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "render/passes/renderer.h"
#include "render/xr/actions.h"
#include "render/xr/clock.h"
#include "render/xr/depth_images.h"
#include "render/xr/frame.h"
#include "render/xr/quad_layer.h"
#include "render/xr/visibility_mask.h"

namespace catena::render::xr {

/// Frame counters of a headset.
struct FrameCounts {
  std::uint64_t frames = 0;    ///< frames begun and ended
  std::uint64_t rendered = 0;  ///< frames with a rendered image
};

inline constexpr double kMaxGazeTangent = 10;  ///< maximum gaze offset from a view's axis, as a tangent; no display shows more

/// Connection to a headset with its session, input and view images.
class Headset {
 public:
  /// Connects to the runtime. A one-line Error if there is no loader, runtime or headset.
  static Result<std::unique_ptr<Headset>> open(const char* library = "libopenxr_loader.so.1");
  ~Headset() { stop(); }

  const Instance& instance() const { return *instance_; }
  /// Returns the provider of the Vulkan device. `queue_lock` is held around every use of the queue and must outlive the device.
  vk::VulkanProvider vulkan_provider(std::mutex& queue_lock) { return instance_->vulkan_provider(queue_lock); }

  /// Starts a session. `device` must have been created with vulkan_provider(). An Error if the runtime refuses.
  Outcome start(vk::Device& device);
  /// Ends the session and releases its images.
  void stop();
  bool is_started() const { return session_ != nullptr; }
  Session& session() { return *session_; }
  /// Returns the controllers; only while started.
  Actions& actions() { return *actions_; }
  /// Shows a panel in the local space on top of the following images; null: none. The panel must be destroyed before stop().
  void show_panel(QuadLayer* panel) { panel_ = panel; }

  /// Processes the runtime's events.
  Outcome poll() { return session_->poll(); }
  bool is_running() const { return session_ && session_->is_running(); }
  Loss loss() const { return instance_->loss(); }

  /// Begins a frame: waits until it is due. Must be followed by show() or skip().
  Result<Frame> begin();
  /// Begins a frame with a time limit for the wait; nullopt if the runtime has not answered yet: call it again later.
  Result<std::optional<Frame>> begin_within(std::chrono::nanoseconds patience);
  /// Update of the parts of a packet that depend on the view.
  using ViewCallback = std::function<void(const View& view, FramePacket& packet)>;
  /// Renders every view of the packet's scene, if the frame requests it, and submits the images. The first view is rendered last, so that
  /// it is the renderer's last image, for the window. `share`: fraction of the recommended pixels in each direction. `aim` updates the
  /// parts of the packet that depend on the view. `gaze`: gaze direction in the local space, for foveation; nullopt: straight ahead.
  Outcome show(const Frame& frame, Renderer& renderer, FramePacket& packet, const RenderSettings& settings, const Placement& placement,
               double share = 1, const ViewCallback& aim = {}, const std::optional<Vec3>& gaze = {});
  /// Ends the frame without an image.
  Outcome skip(const Frame& frame) { return end_frame(*session_, frame, {}); }
  const FrameCounts& counts() const { return counts_; }

 private:
  explicit Headset(std::unique_ptr<Instance> instance) : instance_(std::move(instance)) {}
  Result<std::vector<SubmittedView>> render_views(const Frame& frame, Renderer& renderer, FramePacket& packet,
                                                  const RenderSettings& settings, const Placement& placement, double share,
                                                  const ViewCallback& aim, const std::optional<Vec3>& gaze);

  std::unique_ptr<Instance> instance_;  // declared first, destroyed last
  std::unique_ptr<Session> session_;
  std::unique_ptr<Actions> actions_;
  /// Images of one view; depth is null if not supported.
  struct ViewImages {
    std::unique_ptr<SwapchainImages> color;
    std::unique_ptr<DepthImages> depth;
    HiddenMesh hidden;
  };
  Outcome create_views();
  Outcome update_masks();
  std::vector<ViewImages> views_;
  std::uint64_t mask_change_count_ = 0;  ///< value for which the masks were loaded
  QuadLayer* panel_ = nullptr;
  FrameCounts counts_;
};

}  // namespace catena::render::xr
