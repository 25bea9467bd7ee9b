// SPDX-License-Identifier: MIT
/// One frame of the headset, from the wait to the end:
///   wait (the runtime predicts the display time) -> begin -> locate the views at that time -> render -> end
/// The located poses are submitted with the images, so that the runtime can correct for head motion since then. Every frame that was begun
/// is ended, without layers if rendering failed. Frame thread.
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "render/stereo/xr_views.h"
#include "render/xr/swapchain_images.h"

namespace catena::render::xr {

/// Timing and views of a frame.
struct Frame {
  XrTime display_time = 0;             ///< predicted display time: the runtime's clock, ns
  std::int64_t display_period_ns = 0;  ///< predicted display period, clamped to a millisecond to a second; 1/90 s if unknown
  bool is_valid = true;                ///< the views are valid for rendering
  bool should_render = false;          ///< visible, and the head is tracked: every view can be rendered
  std::vector<XrView> views;           ///< located in the local space; submitted unchanged
};

/// Converts a located view to an eye in the local space.
XrEye make_xr_eye(const XrView& view);
/// Head pose in the local space: the midpoint between the eyes.
struct XrHeadPose {
  Vec3 position{0.0};
  Quat orientation = kIdentityRotation;
};
/// Returns the head pose of a frame.
XrHeadPose head_pose(const Frame& frame);

/// Submitted image of one view: the upper left part of its swapchain images.
struct SubmittedView {
  const SwapchainImages* images = nullptr;
  ViewSize size;
  const SwapchainImages* depth = nullptr;  ///< null: no depth is submitted
};

/// Waits for and begins a frame of a running session. nullopt if the runtime has not answered within `patience` (nullopt: no time limit):
/// call it again later.
Result<std::optional<Frame>> begin_frame(Session& session, std::optional<std::chrono::nanoseconds> patience);
/// Ends the frame. `shown`: by view; empty: nothing is displayed. `extra`: layers on top.
Outcome end_frame(Session& session, const Frame& frame, const std::vector<SubmittedView>& shown,
                  const std::vector<const XrCompositionLayerBaseHeader*>& extra = {});

}  // namespace catena::render::xr
