/// Private to this room: the scene's widgets (engine/widget/widget.h; paper, Figure 6a) as tubes and arrows. Frame thread.
///   cutting plane  where its plane cuts the box of what is drawn (a square of edge L where it cuts nothing); the sphere as three great
///                  circles, each across one axis and in that axis' colour: x red, y green, z blue; an arrow along the normal
///                    explore     the plane's border is thick and bright
///                    translate   a double arrow along every axis that is free, a square across every axis that is held
///                    rotate      the circles are thick; turn: the more so. The circle that is held is bright
///   seed           a ball in a ring that faces the eye
///   rake, ruler    a tube with balls at its ends and its middle; the ruler's length is written beside it, and the way that it measures
///                  along a curve or a surface is drawn beside its straight line
///   isolevel       a ball, and an arrow along the field's gradient
///   box            twelve edges, a ball on every face and one in the middle
/// A handle that is hovered over is larger and brighter, one that is dragged brighter still; the axes along which it is free show as
/// double arrows. No tube is thinner than about a pixel of the packet's view, no ball smaller than a few. Clip planes do not touch
/// widgets, and the camera is not fitted to them.
#pragma once
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Measures the rulers (engine/scene/ruler.h). After scene::drive_widgets.
Outcome prepare_widgets(scene::Scene& scene);
/// After the view is known. `drawn` is the box of the data, which outlines a cutting plane.
void extract_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// What of it follows the view, made anew.
void set_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);

}  // namespace catena::render
