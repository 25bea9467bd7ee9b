/// The headset as the program sees it: opened before the Vulkan device (its runtime makes that), started on it, and then a frame at a time.
///   auto headset = Headset::open();  options.maker = (*headset)->maker(lock);  renderer = Renderer::create(options)
///   (*headset)->start(renderer->device());   while (..) { poll(); if (running()) { begin(); show(..); } }
/// After an error loss() says what has to be made again: of the session, stop() and start(); of the instance, another Headset and another
/// renderer, later, since the runtime may be gone for a while. Frame thread.
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

/// What the frames have been so far.
struct FrameCounts {
  std::uint64_t frames = 0;    ///< begun and ended
  std::uint64_t rendered = 0;  ///< of these, with a picture
};

inline constexpr double kMaxGazeTangent = 10;  ///< tangent off a view's axis; beyond, no display shows anything

class Headset {
 public:
  static Result<std::unique_ptr<Headset>> open(const char* library = "libopenxr_loader.so.1");
  ~Headset() { stop(); }

  const Instance& instance() const { return *instance_; }
  vk::VulkanProvider vulkan_provider(std::mutex& queue_lock) { return instance_->vulkan_provider(queue_lock); }

  /// The device is one that was made by maker().
  Outcome start(vk::Device& device);
  void stop();
  bool is_started() const { return session_ != nullptr; }
  Session& session() { return *session_; }
  /// The hands; while started.
  Actions& actions() { return *actions_; }
  /// A panel in the room over the next pictures; null: none. It is destroyed before stop().
  void show_panel(QuadLayer* panel) { panel_ = panel; }

  /// The runtime's events.
  Outcome poll() { return session_->poll(); }
  bool is_running() const { return session_ && session_->is_running(); }
  Loss loss() const { return instance_->loss(); }

  /// A frame begins: waits for its time. It is ended by show() or skip().
  Result<Frame> begin();
  /// The same, with the wait no longer than that: nothing where the runtime has not answered yet; ask again.
  Result<std::optional<Frame>> begin_within(std::chrono::nanoseconds patience);
  /// Draws every view of the packet's scene, where the frame wants a picture, and hands them over. The first view is drawn last, so that it
  /// is the renderer's last picture: for the window. `share`: of the recommended pixels, each way. `aim` changes what of the packet follows
  /// from the view. `gaze`: where the person looks, a direction in the room, for the fovea of the settings; nothing: straight ahead.
  using ViewCallback = std::function<void(const View& view, FramePacket& packet)>;
  Outcome show(const Frame& frame, Renderer& renderer, FramePacket& packet, const RenderSettings& settings, const Placement& placement,
               double share = 1, const ViewCallback& aim = {}, const std::optional<Vec3>& gaze = {});
  /// Nothing to show.
  Outcome skip(const Frame& frame) { return end_frame(*session_, frame, {}); }
  const FrameCounts& counts() const { return counts_; }

 private:
  explicit Headset(std::unique_ptr<Instance> instance) : instance_(std::move(instance)) {}
  Result<std::vector<SubmittedView>> render_views(const Frame& frame, Renderer& renderer, FramePacket& packet,
                                                  const RenderSettings& settings, const Placement& placement, double share,
                                                  const ViewCallback& aim, const std::optional<Vec3>& gaze);

  std::unique_ptr<Instance> instance_;  // first in, last out
  std::unique_ptr<Session> session_;
  std::unique_ptr<Actions> actions_;
  /// Of a view; depth: null without.
  struct ViewImages {
    std::unique_ptr<SwapchainImages> color;
    std::unique_ptr<DepthImages> depth;
    HiddenMesh hidden;
  };
  Outcome create_views();
  Outcome update_masks();
  std::vector<ViewImages> views_;
  std::uint64_t mask_change_count_ = 0;  ///< as the masks are
  QuadLayer* panel_ = nullptr;
  FrameCounts counts_;
};

}  // namespace catena::render::xr
