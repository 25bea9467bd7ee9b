#include "render/xr/headset.h"

#include <algorithm>
#include <cmath>

namespace catena::render::xr {

namespace {

/// The fovea goes where the person looks; straight ahead of the view where that is not known, or behind it.
void look_at(const std::optional<Vec3>& gaze, const RoomEye& eye, RenderSettings& settings) {
  if (!gaze || !settings.fast || !(settings.fast->fovea > 0)) return;
  const Vec3 seen = *gaze * eye.room_from_eye;  // v * R = R^T v
  if (!(seen.z < 0)) return;
  settings.fast->gaze_right = std::clamp(-seen.x / seen.z, -kWidestGaze, kWidestGaze);
  settings.fast->gaze_up = std::clamp(-seen.y / seen.z, -kWidestGaze, kWidestGaze);
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
    return make_views();
  }();
  if (!made) stop();
  return made;
}

Outcome Headset::make_views() {
  for (const ViewSize& size : instance_->views()) {
    ViewImages view;
    CATENA_TRY(view.color, EyeImages::create(*session_, size));
    view.depth = DepthImages::create(*session_, size);
    views_.push_back(std::move(view));
  }
  // depths that could not be made are done without, but not what was lost on the way
  if (loss() != Loss::none) return session_->failed(XR_ERROR_SESSION_LOST, "make images");
  return take_masks();
}

Outcome Headset::take_masks() {
  mask_changes_ = session_->mask_changes();
  for (std::size_t k = 0; k < views_.size(); ++k) {
    CATENA_TRY(views_[k].hidden, hidden_mesh(*session_, k));
  }
  return Done{};
}

void Headset::stop() {
  if (session_) session_->end_wait();  // before anything that it uses goes
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
                      const Placement& placement, double share, const Aim& aim, const std::optional<Vec3>& gaze) {
  std::vector<Shown> shown;
  if (frame.wants_picture) {
    auto drawn = draw_views(frame, renderer, packet, settings, placement, share, aim, gaze);
    if (!drawn) {
      (void)skip(frame);
      return drawn.error();
    }
    shown = std::move(*drawn);
    ++counts_.pictures;
  }
  std::vector<const XrCompositionLayerBaseHeader*> panels;
  if (const auto* panel = panel_ && !shown.empty() ? panel_->layer() : nullptr) panels.push_back(panel);
  return end_frame(*session_, frame, shown, panels);
}

Result<std::vector<Shown>> Headset::draw_views(const Frame& frame, Renderer& renderer, FramePacket& packet, const RenderSettings& settings,
                                               const Placement& placement, double share, const Aim& aim, const std::optional<Vec3>& gaze) {
  const auto scaled = [&](std::uint32_t pixels) { return std::max(1u, std::uint32_t(std::lround(share * pixels))); };
  if (session_->mask_changes() != mask_changes_) CATENA_CHECK(take_masks());
  std::vector<Shown> shown(frame.views.size());
  for (std::size_t k = frame.views.size(); k-- > 0;) {
    ViewImages& view = views_[k];
    const RoomEye eye = room_eye(frame.views[k]);
    packet.width = scaled(view.color->size().width);
    packet.height = scaled(view.color->size().height);
    CATENA_TRY(const View seen, eye_view(placement, eye));
    if (aim) aim(seen, packet);
    packet.view = seen;
    packet.eyes.clear();
    packet.packing = Packing::single;
    if (!view.hidden.empty()) packet.meshes.push_back(mask_item(view.hidden, placement, eye));
    RenderSettings own = settings;
    look_at(gaze, eye, own);
    if (view.depth) own.ray_depth_spacing = DepthImages::kRaySpacing;
    const Outcome drawn = renderer.draw(packet, own);
    if (!view.hidden.empty()) packet.meshes.pop_back();
    if (!drawn) return drawn.error();
    CATENA_CHECK(view.color->take(renderer.picture()));
    shown[k] = {view.color.get(), {packet.width, packet.height}};
    if (!view.depth || has_projection(packet)) continue;
    CATENA_TRY(const bool has_depth, view.depth->take(renderer, placement.metres_per_unit));
    if (has_depth) shown[k].depth = &view.depth->images();
  }
  return shown;
}

}  // namespace catena::render::xr
