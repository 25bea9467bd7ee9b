// SPDX-License-Identifier: MIT
/// Orthogonal views: three planes through one point of the data beside the 3D view, as a page of four views. The planes lie along the axes
/// of the base field's grid, also for oblique acquisitions. In patient space they are axial, coronal and sagittal, in the radiological
/// convention (the patient's right is on the left), with the letters of the directions; else they are named by the world axes.
///   base field   the first visible slice's field, else the first volume's, else the first isosurface's; preferably no label map
///   overlays     all label maps that the scene shows, half transparent, and further fields with a slice, as that slice
/// World units. Frame thread.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Axes of a plane's image and its texts.
struct PlaneFrame {
  Vec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}, back{0.0, 0.0, 1.0};  ///< unit vectors; `back` points to the viewer
  std::string name;                                                   ///< "axial", or "x y"
  std::array<std::string, 4> letters;                                 ///< directions at the left, right, top and bottom edge
};

/// The planes of a page, in the order of its views after the 3D view: axial, coronal, sagittal.
struct OrthoPlanes {
  scene::Entity base;                   ///< base field
  std::vector<scene::Entity> overlays;  ///< fields drawn over it
  std::array<PlaneFrame, 3> frames;     ///< frames of the planes
  std::array<Vec3, 8> corners;          ///< corners of the base field
  Vec3 center{0.0};                     ///< their middle
};

/// Finds the fields and frames. An Error if the scene shows no scalar field.
Result<OrthoPlanes> find_ortho_planes(scene::Scene& scene);

/// Turns the packet of the 3D view into a page of four views of its size: adds the packets of the planes, with the widgets of the scene
/// projected onto them. Call it after prepare_frame().
Outcome add_plane_views(const scene::Scene& scene, const OrthoPlanes& planes, const scene::OrthogonalViews& state, FramePacket& packet);

}  // namespace catena::render
