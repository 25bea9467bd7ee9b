// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/frame_builder.h"

#include <algorithm>
#include <utility>

#include "engine/base/clock.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"
#include "render/extract/plane_views.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {
constexpr std::uint32_t kMinPixels = 16;  // minimum image size in each direction: any packing of views has at least one pixel per view
}

Result<render::FramePacket> FrameBuilder::make_packet(std::uint32_t width, std::uint32_t height) const {
  scene::Scene& scene = scene_.scene();
  std::optional<render::OrthoPlanes> planes;
  if (navigation_.ortho.is_on && scene.stereo.mode == scene::StereoMode::mono)
    if (auto found = render::find_ortho_planes(scene)) planes = std::move(*found);
  const auto eye = planes ? render::view_size(render::Packing::grid, 4, std::max(kMinPixels, width), std::max(kMinPixels, height))
                          : render::view_size(render::stereo_packing(scene.stereo), render::stereo_view_count(scene.stereo),
                                              std::max(kMinPixels, width), std::max(kMinPixels, height));
  // with a mouse-driven probe, the drop line shows its depth
  const auto drop_line = [&]() -> bool& { return scene.entities.get<scene::Cursor>(scene.cursor).drop_line; };
  const bool stated = std::exchange(drop_line(), drop_line() || navigation_.probe_mode);
  auto packet = render::make_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height));
  drop_line() = stated;
  if (packet && planes) CATENA_CHECK(render::add_plane_views(scene, *planes, navigation_.ortho, *packet));
  return packet;
}

/// Pixel stride of the next frame; interlaced stereo needs the window's own pixels.
std::uint32_t FrameBuilder::pixel_stride(const FrameRequest& next) const {
  return render::is_interlaced(render::stereo_packing(scene_.scene().stereo)) ? 1 : next.pixel_stride;
}

Result<render::FramePacket> FrameBuilder::make_packet(const FrameRequest& next, std::uint32_t width, std::uint32_t height) {
  if (auto ahead = std::exchange(prebuilt_packet_, std::nullopt)) return std::move(*ahead);
  const std::uint32_t scale = pixel_stride(next);
  return make_packet(width / scale, height / scale);
}

FrameRequest FrameBuilder::frame_after_probe_motion(std::uint32_t width, std::uint32_t height) {
  if (!last_packet_ || !ray_workload_.uses_rays || !scheduler_.may_reuse()) return interactive_frame();
  const std::uint32_t scale = pixel_stride(scheduler_.current());
  auto packet = this->make_packet(width / scale, height / scale);
  if (!packet || !render::rays_match(*packet, *last_packet_)) return interactive_frame();
  prebuilt_packet_ = std::move(*packet);
  return scheduler_.reused_frame();
}

double FrameBuilder::idle_s() const { return 1e-3 * ms_since(last_change_ns_); }

void FrameBuilder::mark_changed() { last_change_ns_ = now_ns(); }

std::optional<FrameRequest> FrameBuilder::next_frame(bool moved, bool probe_moved, std::uint32_t width, std::uint32_t height) {
  if (moved) mark_changed();
  const double rested_s = idle_s();
  if (moved) return interactive_frame();
  if (!probe_moved) return rested_s >= kRefineDelayS ? refined_frame() : std::nullopt;
  const FrameRequest next = frame_after_probe_motion(width, height);
  if (!next.settings.reuse_rays) mark_changed();
  // also refine during probe motion if time permits
  if (next.settings.reuse_rays && rested_s >= kRefineDelayS && scheduler_.may_refine() && !scheduler_.is_finished())
    if (auto better = refined_frame()) {
      discard_prebuilt();  // it may have fewer pixels
      return better;
    }
  return next;
}

Outcome FrameBuilder::estimate_error_if_needed(render::Renderer& renderer, const render::FramePacket& packet, const FrameRequest& next) {
  if (!scheduler_.needs_estimate()) return Done{};
  CATENA_TRY(const double error, render::estimate_rmse(renderer, packet, next.settings));
  scheduler_.set_estimate(error);
  return Done{};
}

void FrameBuilder::on_rendered(render::FramePacket packet, const render::Renderer& renderer) {
  update_ray_workload(packet, renderer);
  last_packet_ = std::move(packet);
}

const RayWorkload& FrameBuilder::update_ray_workload(const render::FramePacket& packet, const render::Renderer& renderer) {
  ray_workload_ = {render::uses_raycast(packet), renderer.can_draw_fast(packet),
                   std::ranges::any_of(packet.volumes, &render::VolumeItem::is_shaded)};
  return ray_workload_;
}

std::optional<PickHit> FrameBuilder::pick_at(double x, double y) const {
  if (!last_packet_) return std::nullopt;
  return pick_on_cpu(*last_packet_, x * last_packet_->width, y * last_packet_->height);
}

std::string FrameBuilder::item_label(std::uint32_t id) const {
  return last_packet_ && id > 0 && id <= last_packet_->objects.size() ? last_packet_->objects[id - 1].scene_path : std::string();
}

}  // namespace catena::app
