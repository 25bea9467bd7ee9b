// SPDX-License-Identifier: MIT
/// Selects the next frame of the scene and makes its packet, independent of who renders it and where it is shown: a window (viewport.h) or
/// a browser (engine/app/server). Remembers the packet of the last frame. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/input/navigation.h"
#include "engine/app/viewer/input/pick.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/progressive_scheduler.h"
#include "render/passes/renderer.h"

namespace catena::app {

inline constexpr double kRefineDelayS = 0.25;  ///< Idle time after which frames are refined.

/// Refers to the scene, navigation and scheduler, which must outlive it.
class FrameBuilder {
 public:
  FrameBuilder(SceneModel& scene, const Navigation& controls, ProgressiveScheduler& pacing)
      : scene_(scene), navigation_(controls), scheduler_(pacing) {}

  // Requests for the next frame; sizes in pixels.
  FrameRequest final_frame() { return scheduler_.final_frame(ray_workload_); }
  FrameRequest interactive_frame() { return scheduler_.interactive_frame(ray_workload_); }
  std::optional<FrameRequest> refined_frame() { return scheduler_.refined_frame(ray_workload_); }
  /// Returns the frame after a motion of the probe: a reused frame if the rays still meet the same, else an interactive frame.
  FrameRequest frame_after_probe_motion(std::uint32_t width, std::uint32_t height);
  /// Returns the next frame: interactive after a change, reused or interactive after probe motion, refined when idle; nothing if the last
  /// one is final.
  std::optional<FrameRequest> next_frame(bool moved, bool probe_moved, std::uint32_t width, std::uint32_t height);
  /// Returns the seconds since the content of the image changed.
  double idle_s() const;
  /// Records a change of the content.
  void mark_changed();

  /// Makes the packet of the scene in its current state, for an image of that size in pixels.
  Result<render::FramePacket> make_packet(std::uint32_t width, std::uint32_t height) const;
  /// Makes the packet for a request, with the size divided by the pixel stride of the request; uses the packet prebuilt by
  /// frame_after_probe_motion() if there is one.
  Result<render::FramePacket> make_packet(const FrameRequest& next, std::uint32_t width, std::uint32_t height);
  /// Discards the prebuilt packet.
  void discard_prebuilt() { prebuilt_packet_.reset(); }
  /// Estimates the error of the frame if the selection of the next one depends on it. An Error if rendering fails.
  Outcome estimate_error_if_needed(render::Renderer& renderer, const render::FramePacket& packet, const FrameRequest& next);
  /// Records that the packet was rendered.
  void on_rendered(render::FramePacket packet, const render::Renderer& renderer);
  /// Determines from a rendered packet what it requires of ray casting; the next frames are selected by it.
  const RayWorkload& update_ray_workload(const render::FramePacket& packet, const render::Renderer& renderer);
  /// Resets the state for another scene.
  void reset() { last_packet_.reset(); }

  const std::optional<render::FramePacket>& last_packet() const { return last_packet_; }
  /// Returns what the last frame shows at (x, y), ignoring the probe; x and y are fractions of its width and height.
  std::optional<PickHit> pick_at(double x, double y) const;
  /// Returns "isosurfaces[0]"; empty for an id of no item.
  std::string item_label(std::uint32_t id) const;

 private:
  std::uint32_t pixel_stride(const FrameRequest& next) const;

  SceneModel& scene_;
  const Navigation& navigation_;
  ProgressiveScheduler& scheduler_;
  std::optional<render::FramePacket> last_packet_;      ///< Packet of the last frame.
  std::optional<render::FramePacket> prebuilt_packet_;  ///< Packet of the next frame, made by frame_after_probe_motion().
  RayWorkload ray_workload_;                            ///< Requirements of the last frame.
  std::int64_t last_change_ns_ = 0;
};

}  // namespace catena::app
