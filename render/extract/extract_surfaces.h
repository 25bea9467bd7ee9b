/// Meshes and slices of the scene as plain data. A vector field is shown by its magnitude: on slices by a grid of the magnitudes at the
/// voxels, made once and interpolated between them; on meshes at each vertex.
#pragma once
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// The drawn mesh is the felt one: the same object of the scene. Colours by a field are those of its values at the vertices;
/// grey outside its domain.
/// Makes plain triangles of the meshes.
Outcome prepare_meshes(scene::Scene& scene);
void extract_meshes(const scene::Scene& scene, FramePacket& packet);

/// Errors: a plane that misses the field, a spacing that gives more than scene::kMaxContours lines, a vector grid too large for
/// its magnitudes.
Outcome prepare_slices(scene::Scene& scene);
Outcome extract_slices(const scene::Scene& scene, FramePacket& packet);

/// Levels within lo..hi: those listed, `count` of them at equal distances with the ends left out, or all multiples of `spacing`.
Result<std::vector<double>> contour_levels(const scene::Slice::Contours& contours, double lo, double hi);

}  // namespace catena::render
