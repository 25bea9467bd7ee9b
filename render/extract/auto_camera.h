/// Private to this room: what can be seen of volumes and isosurfaces, for the camera of a scene that states none. Frame thread.
///   isosurface   where neighbours lie on two sides of the level
///   volume       values that are at least 2 % opaque over a 25th of the domain's length
/// On a lattice of at most about 2^18 voxels, in rows along x; of each row its first and its last place, of a surface along every axis.
/// Kept in scene.made beside the thing.
///
/// The view: from the front, 80 % of the picture's height or 90 % of its width filled, less where a scalar bar, a title or axes take room;
/// beside the names of a legend a little from the middle.
///   patient   (engine/io/volume/units.h) from +y, a little from the side and above
///   flat      one edge of all that is drawn is under 0.4 of the middle one: from where that edge points
///   others    default_view_direction()
#pragma once
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// World places of the surface at the level.
std::vector<Vec3> find_visible_points(const field::ScalarGrid& grid, double level);
/// World places of the values that the table shows.
std::vector<Vec3> find_visible_points(const field::ScalarGrid& grid, const TransferTable& transfer);

/// Looks at what is new since the last time; nothing where the scene states a camera.
void prepare_auto_camera(scene::Scene& scene);
/// After everything that is drawn and written.
View make_auto_view(const scene::Scene& scene, const FramePacket& packet);

}  // namespace catena::render
