// SPDX-License-Identifier: MIT
/// Stretch of the image along the world's axes ("stretch" of a scene): display position = stretch * world position. Only the image is
/// stretched; lengths that are measured, and forces, stay in world units.
///   positions   are stretched; normals of planes and meshes so that they stay perpendicular
///   radii       are scaled by one factor, display diagonal / world diagonal of all items, so that tubes and spheres stay round
///   grids       share the voxels and have a stretched mapping; copies are cached, so that the residency of a grid is kept
///   extinction  is divided by the same factor, so that a volume is about as dense as without a stretch
/// Frame thread.
#pragma once
#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Prepares the cache of stretched data. To be called before stretch_items().
void prepare_stretch(scene::Scene& scene);

/// Stretches all items that are in the packet, which are in world units until then; sets view.stretch and size_scale.
void stretch_items(const scene::Scene& scene, FramePacket& packet);

/// Stretches the slices of a packet only; for views of planes.
void stretch_slices(const scene::Scene& scene, FramePacket& packet);

/// Stretches the positions and sizes of a cursor.
void stretch_cursor(const Vec3& stretch, double size_scale, CursorItem& cursor);

/// Returns display diagonal / world diagonal of a box; 1 for an empty one.
double size_scale(const Bounds& world, const Vec3& stretch);

}  // namespace catena::render
