// SPDX-License-Identifier: MIT
/// Module-internal: automatic camera of a scene without one, fitted to the visible parts of volumes and isosurfaces. Frame thread.
///   isosurface   positions whose neighbors lie on both sides of the level
///   volume       values with an opacity of at least 2 % over a 25th of the domain's length
/// Sampled on at most about 2^18 voxels, in rows along x; of each row the first and the last position are used, for a surface along every
/// axis. The results are cached beside the entity (scene.cache).
///
/// The view: from the front, filling 88 % of the image's height or 94 % of its width, less where a scalar bar, a title or axes take up
/// space; beside the labels of a legend slightly off-center.
///   patient   data in a patient's coordinates (engine/io/volume/units.h): from +y, slightly from the side and from above
///   image       a single slice and nothing else: along its normal, y or z up; of a patient as radiologists look
///   flat      one edge of the bounds is shorter than 0.4 of the middle one: along that edge
///   others    default_view_direction()
#pragma once
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Returns world positions on the surface at the level.
std::vector<Vec3> find_visible_points(const field::ScalarGrid& grid, double level);
/// Returns world positions of the values that are visible under the transfer function.
std::vector<Vec3> find_visible_points(const field::ScalarGrid& grid, const TransferTable& transfer);

/// Analyzes the entities that changed since the last call; does nothing if the scene has a camera.
void prepare_auto_camera(scene::Scene& scene);
/// Returns the automatic view; to be called after all other items are in the packet.
View make_auto_view(const scene::Scene& scene, const FramePacket& packet);

}  // namespace catena::render
