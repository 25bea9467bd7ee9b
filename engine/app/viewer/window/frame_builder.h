/// FrameBuilder says which picture of the scene comes next and what it is made of, whoever draws it and wherever it is shown: a window
/// (picture_view.h) or a browser (engine/app/server). It remembers what the last one showed. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/input/navigation.h"
#include "engine/app/viewer/input/pick.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/progressive_scheduler.h"
#include "render/passes/renderer.h"

namespace catena::app {

inline constexpr double kRefineDelayS = 0.25;  ///< without a change for so long: the picture may take its time

class FrameBuilder {
 public:
  FrameBuilder(SceneModel& scene, const Navigation& controls, ProgressiveScheduler& pacing)
      : scene_(scene), navigation_(controls), scheduler_(pacing) {}

  // which one comes next, in a picture of that many pixels
  FrameRequest final_frame() { return scheduler_.final_frame(ray_workload_); }
  FrameRequest interactive_frame() { return scheduler_.interactive_frame(ray_workload_); }
  std::optional<FrameRequest> refined_frame() { return scheduler_.refined_frame(ray_workload_); }
  /// After the hand has moved: as good as the last where rays meet what they met, else as while something moves.
  FrameRequest frame_after_probe_motion(std::uint32_t width, std::uint32_t height);
  /// In time while something moves, better ones when it rests; nothing where the last one stands.
  std::optional<FrameRequest> next_frame(bool moved, bool hand_moved, std::uint32_t width, std::uint32_t height);
  /// Since what the picture shows has changed, seconds.
  double idle_s() const;
  /// It has changed now.
  void mark_changed();

  /// Of the scene as it is now, for a picture of that many pixels.
  Result<render::FramePacket> make_packet(std::uint32_t width, std::uint32_t height) const;
  /// The same for this picture, each way so many pixels less; what followed() has made already is used.
  Result<render::FramePacket> make_packet(const FrameRequest& next, std::uint32_t width, std::uint32_t height);
  /// What followed() has made is not wanted.
  void discard_prebuilt() { prebuilt_packet_.reset(); }
  /// Where the error decides on the next picture: it is estimated.
  Outcome estimate_error_if_needed(render::Renderer& renderer, const render::FramePacket& packet, const FrameRequest& next);
  /// That packet was drawn.
  void on_rendered(render::FramePacket packet, const render::Renderer& renderer);
  /// What there is to draw in that packet: the next pictures are chosen by it.
  const RayWorkload& update_ray_workload(const render::FramePacket& packet, const render::Renderer& renderer);
  /// Another scene: nothing of the last picture counts.
  void reset() { last_packet_.reset(); }

  const std::optional<render::FramePacket>& last_packet() const { return last_packet_; }
  /// What the last picture shows beside the hand, in shares of its width and height.
  std::optional<PickHit> pick_at(double x, double y) const;
  /// "isosurfaces[0]"; empty: an id of no item.
  std::string item_label(std::uint32_t id) const;

 private:
  std::uint32_t pixel_stride(const FrameRequest& next) const;

  SceneModel& scene_;
  const Navigation& navigation_;
  ProgressiveScheduler& scheduler_;
  std::optional<render::FramePacket> last_packet_;      ///< the last picture's
  std::optional<render::FramePacket> prebuilt_packet_;  ///< the next one's, where followed() has made it
  RayWorkload ray_workload_;                            ///< the last picture's
  std::int64_t last_change_ns_ = 0;
};

}  // namespace catena::app
