// SPDX-License-Identifier: MIT
#include "render/xr/frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/xr/depth_images.h"

namespace catena::render::xr {

namespace {

constexpr XrViewStateFlags kTracked = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;

Outcome locate(Session& session, Frame& frame) {
  XrViewLocateInfo info{};
  info.type = XR_TYPE_VIEW_LOCATE_INFO;
  info.viewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  info.displayTime = frame.display_time;
  info.space = session.space(SpaceKind::local);
  XrViewState state{};
  state.type = XR_TYPE_VIEW_STATE;
  XrView view{};
  view.type = XR_TYPE_VIEW;
  frame.views.assign(session.instance().view_sizes().size(), view);
  std::uint32_t count = 0;
  CATENA_XR_CHECK(
      session,
      session.dispatch().LocateViews(session.handle(), &info, &state, std::uint32_t(frame.views.size()), &count, frame.views.data()),
      "locate the eyes");
  // an eye without a usable projection is not tracked, whatever the flags say
  frame.is_valid =
      std::ranges::all_of(frame.views, [](const XrView& one) { return static_cast<bool>(make_xr_eye_view({}, make_xr_eye(one))); });
  frame.should_render =
      frame.should_render && count == frame.views.size() && (state.viewStateFlags & kTracked) == kTracked && frame.is_valid;
  return Done{};
}

}  // namespace

XrEye make_xr_eye(const XrView& view) {
  const auto& [x, y, z, w] = view.pose.orientation;
  XrEye eye;
  eye.position = Vec3(view.pose.position.x, view.pose.position.y, view.pose.position.z);
  eye.local_from_eye = glm::mat3_cast(normalized(Quat(w, x, y, z)));
  eye.tangents = {std::tan(double(view.fov.angleLeft)), std::tan(double(view.fov.angleRight)), std::tan(double(view.fov.angleUp)),
                  std::tan(double(view.fov.angleDown))};
  return eye;
}

XrHeadPose head_pose(const Frame& frame) {
  XrHeadPose head;
  Quat sum(0.0, 0.0, 0.0, 0.0);
  for (const XrView& view : frame.views) {
    const auto& [x, y, z, w] = view.pose.orientation;
    const Quat turn = normalized(Quat(w, x, y, z));
    sum += dot(sum, turn) < 0 ? -turn : turn;  // q and -q are the same rotation
    head.position += make_xr_eye(view).position / double(frame.views.size());
  }
  head.orientation = normalized(sum);
  return head;
}

Result<std::optional<Frame>> begin_frame(Session& session, std::optional<std::chrono::nanoseconds> timeout) {
  const DispatchTable& xr = session.dispatch();
  const std::optional<FrameWaiter::WaitResult> waited = session.frame_waiter().wait_for(timeout);
  if (!waited) return std::optional<Frame>();
  CATENA_XR_CHECK(session, waited->result, "wait for the next frame");
  const XrFrameState& state = waited->state;
  Frame frame;
  frame.display_time = state.predictedDisplayTime;
  constexpr std::int64_t kMinPeriod_ns = 1'000'000, kMaxPeriod_ns = 1'000'000'000,
                         kDefaultPeriod_ns = 11'111'111;  // limits of a stated period, and the default
  const std::int64_t period_ns = state.predictedDisplayPeriod;
  frame.display_period_ns = period_ns > 0 ? std::clamp(period_ns, kMinPeriod_ns, kMaxPeriod_ns) : kDefaultPeriod_ns;
  frame.should_render = state.shouldRender && is_visible(session.state());
  XrFrameBeginInfo begin{};
  begin.type = XR_TYPE_FRAME_BEGIN_INFO;
  {
    const auto turn = session.device().lock_queue();
    CATENA_XR_CHECK(session, xr.BeginFrame(session.handle(), &begin), "begin a frame");
  }
  if (const Outcome located = locate(session, frame); !located) {
    (void)end_frame(session, frame, {});
    return located.error();
  }
  return std::optional<Frame>(std::move(frame));
}

Outcome end_frame(Session& session, const Frame& frame, const std::vector<SubmittedView>& shown,
                  const std::vector<const XrCompositionLayerBaseHeader*>& extra) {
  std::vector<XrCompositionLayerProjectionView> views(shown.size());
  std::vector<XrCompositionLayerDepthInfoKHR> depths(shown.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    views[k].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
    views[k].pose = frame.views[k].pose;
    views[k].fov = frame.views[k].fov;
    views[k].subImage.swapchain = shown[k].images->handle();
    views[k].subImage.imageRect.extent = {std::int32_t(shown[k].size.width), std::int32_t(shown[k].size.height)};
    if (!shown[k].depth) continue;
    depths[k].type = XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR;
    depths[k].subImage = views[k].subImage;
    depths[k].subImage.swapchain = shown[k].depth->handle();
    depths[k].maxDepth = 1;
    depths[k].nearZ = DepthImages::kNearM;
    depths[k].farZ = DepthImages::kFarM;
    views[k].next = &depths[k];
  }
  XrCompositionLayerProjection projection{};
  projection.type = XR_TYPE_COMPOSITION_LAYER_PROJECTION;
  projection.space = session.space(SpaceKind::local);
  projection.viewCount = std::uint32_t(views.size());
  projection.views = views.data();
  std::vector<const XrCompositionLayerBaseHeader*> layers;
  if (!views.empty()) layers.push_back(reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection));
  layers.insert(layers.end(), extra.begin(), extra.end());
  XrFrameEndInfo end{};
  end.type = XR_TYPE_FRAME_END_INFO;
  end.displayTime = frame.display_time;
  end.environmentBlendMode = session.instance().blend_mode();
  end.layerCount = std::uint32_t(layers.size());
  end.layers = layers.data();
  const auto turn = session.device().lock_queue();
  CATENA_XR_CHECK(session, session.dispatch().EndFrame(session.handle(), &end), "end a frame");
  return Done{};
}

}  // namespace catena::render::xr
