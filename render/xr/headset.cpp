// SPDX-License-Identifier: MIT
#include "render/xr/headset.h"

#include <algorithm>
#include <cmath>

namespace catena::render::xr {

namespace {

/// Moves the fovea to the gaze; keeps the center of the view if the gaze is unknown or points backwards.
void look_at(const std::optional<Vec3>& gaze, const XrEye& eye, RenderSettings& settings) {
  if (!gaze || !settings.fast || !(settings.fast->fovea_tangent > 0)) return;
  const Vec3 gaze_direction = *gaze * eye.local_from_eye;  // v * R = R^T v
  if (!(gaze_direction.z < 0)) return;
  settings.fast->gaze_right = std::clamp(-gaze_direction.x / gaze_direction.z, -kMaxGazeTangent, kMaxGazeTangent);
  settings.fast->gaze_up = std::clamp(-gaze_direction.y / gaze_direction.z, -kMaxGazeTangent, kMaxGazeTangent);
}

bool has_projection(const FramePacket& packet) {
  return std::ranges::any_of(packet.volumes, [](const VolumeItem& volume) { return volume.projection != Projection::composite; });
}

}  // namespace

Result<std::unique_ptr<Headset>> Headset::open(const char* library) {
  CATENA_TRY(std::unique_ptr<Instance> instance, Instance::open(library));
  return std::unique_ptr<Headset>(new Headset(std::move(instance)));
}

Outcome Headset::start(vk::Device& device) {
  stop();
  const auto made = [&]() -> Outcome {
    CATENA_TRY(session_, Session::create(*instance_, device));
    CATENA_TRY(actions_, Actions::create(*session_));
    return create_views();
  }();
  if (!made) stop();
  return made;
}

Outcome Headset::create_views() {
  for (const ViewSize& size : instance_->view_sizes()) {
    ViewImages view;
    CATENA_TRY(view.color, SwapchainImages::create(*session_, size));
    view.depth = DepthImages::create(*session_, size);
    views_.push_back(std::move(view));
  }
  // missing depth images are tolerated, a session lost meanwhile is not
  if (loss() != Loss::none) return session_->failed(XR_ERROR_SESSION_LOST, "create images");
  return update_masks();
}

Outcome Headset::update_masks() {
  mask_change_count_ = session_->mask_change_count();
  for (std::size_t k = 0; k < views_.size(); ++k) {
    CATENA_TRY(views_[k].hidden, load_hidden_mesh(*session_, k));
  }
  return Done{};
}

void Headset::stop() {
  if (session_) session_->stop_wait();  // before the resources that the waiting thread uses
  panel_ = nullptr;
  views_.clear();
  actions_.reset();
  session_.reset();
}

Result<Frame> Headset::begin() {
  CATENA_TRY(std::optional<Frame> frame, begin_frame(*session_, std::nullopt));
  ++counts_.frames;
  return std::move(*frame);
}

Result<std::optional<Frame>> Headset::begin_within(std::chrono::nanoseconds patience) {
  CATENA_TRY(std::optional<Frame> frame, begin_frame(*session_, patience));
  if (frame) ++counts_.frames;
  return frame;
}

Outcome Headset::show(const Frame& frame, Renderer& renderer, FramePacket& packet, const RenderSettings& settings,
                      const Placement& placement, double share, const ViewCallback& aim, const std::optional<Vec3>& gaze) {
  std::vector<SubmittedView> shown;
  if (frame.should_render) {
    auto drawn = render_views(frame, renderer, packet, settings, placement, share, aim, gaze);
    if (!drawn) {
      (void)skip(frame);
      return drawn.error();
    }
    shown = std::move(*drawn);
    ++counts_.rendered;
  }
  std::vector<const XrCompositionLayerBaseHeader*> panels;
  if (const auto* panel = panel_ && !shown.empty() ? panel_->composition_layer() : nullptr) panels.push_back(panel);
  return end_frame(*session_, frame, shown, panels);
}

Result<std::vector<SubmittedView>> Headset::render_views(const Frame& frame, Renderer& renderer, FramePacket& packet,
                                                         const RenderSettings& settings, const Placement& placement, double share,
                                                         const ViewCallback& aim, const std::optional<Vec3>& gaze) {
  const auto scaled = [&](std::uint32_t pixels) { return std::max(1u, std::uint32_t(std::lround(share * pixels))); };
  if (session_->mask_change_count() != mask_change_count_) CATENA_CHECK(update_masks());
  std::vector<SubmittedView> shown(frame.views.size());
  for (std::size_t k = frame.views.size(); k-- > 0;) {
    ViewImages& view = views_[k];
    const XrEye eye = make_xr_eye(frame.views[k]);
    packet.width = scaled(view.color->size().width);
    packet.height = scaled(view.color->size().height);
    CATENA_TRY(const View eye_view, make_xr_eye_view(placement, eye));
    if (aim) aim(eye_view, packet);
    packet.view = eye_view;
    packet.eyes.clear();
    packet.packing = Packing::single;
    if (!view.hidden.empty()) packet.meshes.push_back(make_mask_item(view.hidden, placement, eye));
    RenderSettings own = settings;
    look_at(gaze, eye, own);
    if (view.depth) own.ray_depth_spacing = DepthImages::kRaySpacing;
    const Outcome drawn = renderer.draw(packet, own);
    if (!view.hidden.empty()) packet.meshes.pop_back();
    if (!drawn) return drawn.error();
    CATENA_CHECK(view.color->submit_image(renderer.output_image()));
    shown[k] = {view.color.get(), {packet.width, packet.height}};
    if (!view.depth || has_projection(packet)) continue;
    CATENA_TRY(const bool has_depth, view.depth->submit_depth(renderer, placement.meters_per_unit));
    if (has_depth) shown[k].depth = &view.depth->images();
  }
  return shown;
}

}  // namespace catena::render::xr
