// SPDX-License-Identifier: MIT
/// Mouse input in a page of orthogonal views (render/extract/plane_views.h), independent of the window.
///   left drag    moves the common point of the planes (in probe mode: the probe, in the plane)
///   wheel        moves the plane along its normal by a voxel; with Ctrl it zooms about the pointer
///   middle drag, or Shift and left drag   moves the images
///   right drag   to the right: a wider window of values; upwards: lower values, so that the image becomes brighter
/// Positions in window coordinates, y down. Pure, frame thread.
#pragma once
#include <optional>

#include "engine/app/viewer/input/navigation.h"
#include "engine/app/viewer/window/layout.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

/// Returns the part of the image area that shows view k of the page: 0 the 3D view, 1 to 3 the planes.
Area page_view_area(const Area& page, int view);
/// Returns the view of the page at a position in it.
int page_view_at(const Area& page, double x, double y);
/// Returns the point of the plane at a position in its area.
Vec3 plane_point(const render::FramePacket& plane, const Area& area, double x, double y);

/// Applies an input segment, in coordinates of the window, to the plane that it belongs to.
NavigationChanges apply_to_plane(Navigation& controls, const Input& input, const render::FramePacket& plane, const Area& area);

}  // namespace catena::app
