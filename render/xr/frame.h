/// One frame of the headset, from the wait to the end:
///   wait (the runtime says when its picture will be seen) -> begin -> locate the views at that time -> draw -> end
/// The poses that were located are those that are submitted, so that the runtime moves the picture by what the head has moved since.
/// Every frame that was begun is ended, with nothing to show where its picture failed. Frame thread.
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "render/stereo/xr_views.h"
#include "render/xr/swapchain_images.h"

namespace catena::render::xr {

struct Frame {
  XrTime display_time = 0;             ///< when it will be seen: the runtime's clock, ns
  std::int64_t display_period_ns = 0;  ///< between pictures, as predicted; a millisecond to a second; a 90th where none is
  bool is_valid = true;                ///< a picture can be made for all views
  bool should_render = false;          ///< seen, and the head is tracked: every view is one that can be drawn
  std::vector<XrView> views;           ///< as located in the local space, and as submitted
};

XrEye make_xr_eye(const XrView& view);
/// Between the eyes, in the local space.
struct XrHeadPose {
  Vec3 position{0.0};
  Quat orientation = kIdentityRotation;
};
XrHeadPose head_pose(const Frame& frame);

/// What is submitted of one view: the upper left part of its images.
struct SubmittedView {
  const SwapchainImages* images = nullptr;
  ViewSize size;
  const SwapchainImages* depth = nullptr;  ///< null: no depth is submitted
};

/// Of a session that runs. The frame is begun when this returns it; nothing where the runtime has not said within `patience` when it is due
/// (none: however long that takes): ask again.
Result<std::optional<Frame>> begin_frame(Session& session, std::optional<std::chrono::nanoseconds> patience);
/// `shown` by view; empty: nothing is shown. `extra`: layers over it.
Outcome end_frame(Session& session, const Frame& frame, const std::vector<SubmittedView>& shown,
                  const std::vector<const XrCompositionLayerBaseHeader*>& extra = {});

}  // namespace catena::render::xr
